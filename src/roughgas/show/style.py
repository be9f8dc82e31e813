"""One look for all figures, still or moving: readable in print, in grey, and for the colour-blind.

The same data give the same bytes. There is no pyplot, hence no display, and no state that figures
share. A figure that moves is an .mp4 that any browser plays, or a .gif that loops forever.
"""

import subprocess
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import EllipseCollection
from matplotlib.figure import Figure

from roughgas.base import InputError
from roughgas.base.files import whole_file

SLIDE = 10.0, 5.625  # inches: 16 to 9
WIDTH, TWO_WIDE, HEIGHT = 4.4, 7.0, 4.8
"""Inches, in print: of one panel, half of a page of the README; of two, a page of a journal; and
how high R with its residuals is. Letters have 7 points or more."""
# what a matplotlibrc of the user may change, except where figures are shown
PLAIN = {
    name: value
    for name, value in rcParamsDefault.items()
    if not name.startswith(("backend", "interactive", "toolbar", "webagg"))
}
PARAMETERS = PLAIN | {
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
ON_PAGES = 140  # dots per inch of what is no line in an .svg, or a page takes long to load
METADATA = {
    ".pdf": {"CreationDate": None, "Creator": "roughgas"},
    ".png": {"Software": "roughgas"},
    ".svg": {"Date": None, "Creator": "roughgas"},
}


Style = dict[str, Any]
"""Keywords of matplotlib."""


class Look(NamedTuple):
    """What tells a series from the others: colour, marker and line at once."""

    colour: str
    marker: str
    line: str | tuple


LOOKS = (  # colours of Okabe and Ito
    Look("#0072B2", "o", "-"),
    Look("#D55E00", "s", "--"),
    Look("#009E73", "^", "-."),
    Look("#CC79A7", "D", (0, (9, 2))),
    Look("#E69F00", "v", (0, (5, 1, 1, 1, 1, 1))),
)
THEORY = "#222222"
GREY = "#555555"
FAINT = "#888888"


def draw(figure: Callable[[], Figure], outputs: Iterable[str | Path], slide: bool = False) -> None:
    """Draw `figure()` in this style into each of `outputs`, in the shape of a `slide` if asked for.

    Raises InputError if one of them is none of .pdf, .png and .svg.
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
    """Write `figure` to each of `outputs` (.pdf, .png or .svg), whole or not at all.

    The .png first, whatever the order, and the others in its layout.
    """
    for output in sorted(map(Path, outputs), key=lambda path: path.suffix != ".png"):
        with whole_file(output) as draft:
            kind = output.suffix
            how: dict[str, Any] = {"dpi": ON_PAGES} if kind == ".svg" else {}
            figure.savefig(draft, format=kind.removeprefix("."), metadata=METADATA[kind], **how)
        figure.set_layout_engine("none")


def add_circles(axes: Axes, **look: Any) -> EllipseCollection:
    """Add a collection of circles, none as yet, whose sizes are in the units of the axes."""
    circles = EllipseCollection([], [], [], units="xy", offsets=[], transOffset=axes.transData)
    circles.set(**look)
    axes.add_collection(circles)
    return circles


def move(circles: EllipseCollection, x: np.ndarray, y: np.ndarray, diameter: Any = 2.0) -> None:
    """Bring circles to these centres (N,), with one diameter or (N,) of them."""
    size = np.full(len(x), 1.0) * diameter
    circles.set(widths=size, heights=size, angles=0.0 * size)
    circles.set_offsets(np.column_stack([x, y]))


# x264's constant rate factor: lower is better and larger
MP4 = "-vcodec libx264 -pix_fmt yuv420p -crf 28 -preset slow -f mp4"
# one palette for all frames, and only the part of each frame that changes; dithering would flicker
PALETTE = "split[a][b];[a]palettegen=max_colors=32[p];[b][p]paletteuse=dither=none"
GIF = f"-filter_complex {PALETTE}:diff_mode=rectangle -loop 0 -f gif"
ENCODERS = {".mp4": MP4, ".gif": GIF}


def check_kind(path: str | Path) -> None:
    """Raise InputError if `path` does not end as a movie does."""
    if Path(path).suffix not in ENCODERS:
        raise InputError("file", path, f"end in {' or '.join(ENCODERS)}")


def write_movie(
    path: str | Path,
    picture: Callable[[], tuple[Figure, Callable[[int], None]]],
    frames: Iterable[int],
    per_second: float,
) -> None:
    """Write a movie to `path` in the style of all figures, whole or not at all.

    `picture` returns a figure, and a function that brings it to each of `frames`. Its width and
    height must be even numbers of pixels; its layout stays as it is at the start. Raises InputError
    for another kind of file, OSError.
    """
    check_kind(path)
    with rc_context(PARAMETERS), whole_file(path) as draft:
        figure, show = picture()
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        figure.set_layout_engine("none")
        encoder = _encoder(path, draft, canvas.get_width_height(), per_second)
        try:
            with suppress(BrokenPipeError):  # the encoder ended; it says why
                for frame in frames:
                    show(frame)
                    canvas.draw()
                    encoder.stdin.write(canvas.buffer_rgba())
            _, said = encoder.communicate()
            if encoder.returncode:
                why, *_ = said.decode(errors="replace").splitlines() or ["the encoder was stopped"]
                raise OSError(None, f"not encoded: {why}", str(path))
        finally:
            encoder.kill()
            encoder.wait()


def _encoder(path, draft, size, per_second):
    from imageio_ffmpeg import get_ffmpeg_exe

    command = [get_ffmpeg_exe(), "-y", "-v", "error", "-f", "rawvideo", "-pix_fmt", "rgba"]
    command += ["-s", "{}x{}".format(*size), "-r", f"{per_second:g}", "-i", "-"]
    command += [*ENCODERS[Path(path).suffix].split(), str(draft)]
    # in a session of its own, so that Ctrl-C does not reach it first
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )
