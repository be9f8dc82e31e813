"""A figure that moves: an .mp4 that any browser plays, or a .gif that loops forever."""

import subprocess
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from roughgas.base import InputError
from roughgas.base.files import whole_file
from roughgas.show import style

# x264's constant rate factor: lower is better and larger
MP4 = "-vcodec libx264 -pix_fmt yuv420p -crf 28 -preset slow -f mp4"
# one palette for all frames, and only the part of each frame that changes; dithering would flicker
PALETTE = "split[a][b];[a]palettegen=max_colors=48[p];[b][p]paletteuse=dither=none"
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
    with rc_context(style.PARAMETERS), whole_file(path) as draft:
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
