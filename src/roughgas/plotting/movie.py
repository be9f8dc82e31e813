"""A figure that moves, as an .mp4 file that any browser plays."""

from collections.abc import Callable, Iterable
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from roughgas.atomic import whole_file

QUALITY = 28  # x264's constant rate factor: lower is better and larger
ENCODER = {
    "codec": "libx264",
    "pix_fmt_in": "rgba",
    "pix_fmt_out": "yuv420p",
    "quality": None,
    "macro_block_size": 2,
    # the draft's name does not say what kind of file it is
    "output_params": ["-crf", str(QUALITY), "-preset", "slow", "-f", "mp4"],
}


def write_movie(
    path: str | Path,
    figure: Figure,
    show: Callable[[int], None],
    frames: Iterable[int],
    per_second: float,
) -> None:
    """Write the movie of `figure`, which `show` brings to each of `frames`, to `path` (.mp4).

    Whole or not at all; what is drawn may not change the figure's layout. Raises OSError.
    """
    import imageio_ffmpeg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    figure.set_layout_engine("none")  # as it is now
    with whole_file(path) as draft:
        size = canvas.get_width_height()
        encoder = imageio_ffmpeg.write_frames(str(draft), size, fps=per_second, **ENCODER)
        encoder.send(None)
        try:
            for frame in frames:
                show(frame)
                canvas.draw()
                encoder.send(bytes(canvas.buffer_rgba()))
        finally:
            encoder.close()
