"""Style of all figures and movies: readable in print, in grey, and for the colour-blind.

The same data give the same bytes. Without pyplot no display is needed, and figures share no state.
A movie is an .mp4 that any browser plays, or a .gif that loops forever.
"""

import subprocess
from collections.abc import Callable, Iterable
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from roughgas.base import InputError
from roughgas.base.files import atomic_write

SLIDE = 10.0, 5.625  # inches: 16 to 9
WIDTH, TWO_WIDE, HEIGHT = 4.4, 7.0, 4.8
"""Inches, in print: width of one panel (half a page of the README), of two (a page of a journal),
and height of R with its residuals. Letters have 7 points or more."""
# undoes the user's matplotlibrc, except for backends
DEFAULT_PARAMETERS = {
    name: value
    for name, value in rcParamsDefault.items()
    if not name.startswith(("backend", "interactive", "toolbar", "webagg"))
}
PARAMETERS = DEFAULT_PARAMETERS | {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so that figures are the same anywhere
    "mathtext.fontset": "dejavusans",
    "font.size": 9,
    "axes.labelsize": 10,
    "legend.fontsize": 7.5,
    "axes.linewidth": 0.7,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.minor.visible": True,
    "ytick.minor.visible": True,
    "lines.linewidth": 1.1,
    "lines.markersize": 4.5,
    "legend.title_fontsize": 7.5,
    "legend.labelspacing": 0.3,
    "legend.handlelength": 1.7,
    "legend.edgecolor": "none",
    "legend.framealpha": 0.8,
    "pdf.fonttype": 42,
    "svg.hashsalt": "roughgas",
    "savefig.dpi": 200,
}
SVG_DPI = 140  # of images in an .svg; with more, pages load slowly
PALETTE_SIZE = 256  # colours of a .png, which has a third of the size of one in full colour
METADATA: dict[str, dict[str, Any]] = {
    ".pdf": {"CreationDate": None, "Creator": "roughgas"},
    ".png": {"Software": "roughgas"},
    ".svg": {"Date": None, "Creator": "roughgas"},
}


Style = dict[str, Any]
"""Keywords of matplotlib."""


class LineStyle(NamedTuple):
    """Colour, marker and line of a series, as matplotlib names them: series differ in all three."""

    colour: str
    marker: str
    line: str | tuple


LINE_STYLES = (  # colours of Okabe and Ito
    LineStyle("#0072B2", "o", "-"),
    LineStyle("#D55E00", "s", "--"),
    LineStyle("#009E73", "^", "-."),
    LineStyle("#CC79A7", "D", (0, (9, 2))),
    LineStyle("#E69F00", "v", (0, (5, 1, 1, 1, 1, 1))),
)
THEORY = "#222222"
GREY = "#555555"
FAINT = "#888888"


def draw(figure: Callable[[], Figure], outputs: Iterable[str | Path], slide: bool = False) -> None:
    """Draw the figure that the function `figure` returns in this style, and save it as each of
    `outputs`; a `slide` has 16 to 9.

    Raises InputError for an output other than .pdf, .png and .svg.
    """
    paths = [Path(output) for output in outputs]
    for output in paths:
        if output.suffix not in METADATA:
            raise InputError("figure file", output, f"end in {' or '.join(METADATA)}")
    with rc_context(PARAMETERS):
        drawn = figure()
        if slide:
            drawn.set_size_inches(SLIDE)
        save(drawn, paths)


def save(figure: Figure, outputs: Iterable[str | Path]) -> None:
    """Write `figure` to each of `outputs` (.pdf, .png or .svg), atomically.

    The .png comes first, and the others have its layout.
    """
    for output in sorted(map(Path, outputs), key=lambda path: path.suffix != ".png"):
        with atomic_write(output) as draft:
            if (suffix := output.suffix) == ".png":
                _save_with_palette(figure, draft)
            else:
                options: dict[str, Any] = {"dpi": SVG_DPI} if suffix == ".svg" else {}
                file_format = suffix.removeprefix(".")
                figure.savefig(draft, format=file_format, metadata=METADATA[suffix], **options)
        figure.set_layout_engine("none")


def _save_with_palette(figure: Figure, path: Path) -> None:
    """Write `figure` to `path` as a PNG with PALETTE_SIZE colours."""
    full, texts = BytesIO(), PngInfo()
    figure.savefig(full, format="png")
    for key, text in METADATA[".png"].items():
        texts.add_text(key, text)
    with Image.open(full) as drawn:
        # rare colours stay as they are, and dithering would blur letters
        how: dict[str, Any] = {"method": Image.Quantize.MAXCOVERAGE, "kmeans": 2}
        picture = drawn.convert("RGB").quantize(PALETTE_SIZE, dither=Image.Dither.NONE, **how)
        picture.save(path, "png", optimize=True, pnginfo=texts, dpi=drawn.info["dpi"])


def add_circles(axes: Axes, **properties: Any) -> EllipseCollection:
    """Add to `axes` an empty collection of circles, with sizes in the units of the axes, and return
    it; `properties` are matplotlib's, such as linewidth."""
    circles = EllipseCollection([], [], [], units="xy", offsets=[], transOffset=axes.transData)
    circles.set(**properties)
    axes.add_collection(circles)
    return circles


def move_circles(
    circles: EllipseCollection, x: np.ndarray, y: np.ndarray, diameter: Any = 2.0
) -> None:
    """Set the centres (`x`, `y`), (N,) each, and the diameters, a number or (N,), of circles in the
    units of their axes."""
    diameters = np.full(len(x), 1.0) * diameter
    circles.set(widths=diameters, heights=diameters, angles=0.0 * diameters)
    circles.set_offsets(np.column_stack([x, y]))


# x264's constant rate factor: lower is better and larger
MP4 = "-vcodec libx264 -pix_fmt yuv420p -crf 28 -preset slow -f mp4"
# one palette for all frames, and only the changed rectangle of each frame; dithering would flicker
PALETTE = "split[a][b];[a]palettegen=max_colors=32[p];[b][p]paletteuse=dither=none"
GIF = f"-filter_complex {PALETTE}:diff_mode=rectangle -loop 0 -f gif"
ENCODERS = {".mp4": MP4, ".gif": GIF}


def check_movie_suffix(path: str | Path) -> None:
    """Raise InputError if `path` does not end in .mp4 or .gif."""
    if Path(path).suffix not in ENCODERS:
        raise InputError("file", path, f"end in {' or '.join(ENCODERS)}")


def write_movie(
    path: str | Path,
    picture: Callable[[], tuple[Figure, Callable[[int], None]]],
    frames: Iterable[int],
    per_second: float,
) -> None:
    """Write a movie to `path` (.mp4 or .gif) in the style of all figures, atomically.

    `picture` returns a figure, and a function that draws the frame of a number; these numbers come
    from `frames`, and `per_second` frames are shown a second. The width and height of the figure
    must be even numbers of pixels; its layout is fixed at the first frame. Raises InputError for
    another type of file, OSError.
    """
    check_movie_suffix(path)
    with rc_context(PARAMETERS), atomic_write(path) as draft:
        figure, show = picture()
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        figure.set_layout_engine("none")
        encoder = _encoder(path, draft, canvas.get_width_height(), per_second)
        try:
            with suppress(BrokenPipeError):  # the encoder ended, with a reason on stderr
                for frame in frames:
                    show(frame)
                    canvas.draw()
                    encoder.stdin.write(canvas.buffer_rgba())
            _, messages = encoder.communicate()
            if encoder.returncode:
                reason, *_ = messages.decode(errors="replace").splitlines() or [
                    "the encoder was stopped"
                ]
                raise OSError(None, f"not encoded: {reason}", str(path))
        finally:
            encoder.kill()
            encoder.wait()


def _encoder(path, draft, size, per_second):
    """Start the process that encodes a movie from frames on its standard input, pixels in RGBA.

    It writes to `draft`, in the format of the suffix of `path`; `size` is (width, height) in
    pixels, `per_second` the number of frames a second.
    """
    from imageio_ffmpeg import get_ffmpeg_exe

    command = [get_ffmpeg_exe(), "-y", "-v", "error", "-f", "rawvideo", "-pix_fmt", "rgba"]
    command += ["-s", "{}x{}".format(*size), "-r", f"{per_second:g}", "-i", "-"]
    command += [*ENCODERS[Path(path).suffix].split(), str(draft)]
    # in a new session: Ctrl-C must not reach the encoder before this process
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )
