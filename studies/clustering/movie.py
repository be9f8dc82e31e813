"""The movie of a cooling gas that forms clusters."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import FAINT, write_movie

from .figure import (
    PACKING_LABEL,
    SPIN_LABEL,
    TITLE,
    caption,
    collisions_label,
    collisions_so_far,
    draw_disks,
    draw_map,
    energies,
    move_disks,
    outline,
    packing,
    share,
)

FRAMES_PER_SECOND, LAST_FRAME = 12, 1.5  # seconds that the movie rests on its last frame


def draw(film: xr.Dataset, path: Path) -> None:
    """Write the movie of the film to `path`. Raises OSError."""
    frames = list(range(film.sizes["frame"]))
    frames += frames[-1:] * round(LAST_FRAME * FRAMES_PER_SECOND)
    write_movie(path, lambda: moving_picture(film), frames, FRAMES_PER_SECOND)


def moving_picture(film: xr.Dataset) -> tuple[Figure, Callable[[int], None]]:
    """Return a figure of the gas, and a function that updates it to a frame."""
    figure = Figure(figsize=(8.4, 4.1), dpi=160, layout="constrained")
    squares, graphs = np.asarray(figure.subfigures(1, 2, width_ratios=(2.5, 1)))
    full_map, zoom = squares.subplots(1, 2)
    image = draw_map(full_map, film, 0)
    disks = draw_disks(zoom, film, 0, outline(full_map, film))
    for mappable, axes, label in ((image, full_map, PACKING_LABEL), (disks, zoom, SPIN_LABEL)):
        squares.colorbar(mappable, ax=axes, label=label, location="bottom", shrink=0.8)
    zoom.set_title("the square", fontsize=TITLE)
    squares.suptitle(caption(film), fontsize=TITLE)
    marks = []
    above, below = graphs.subplots(2, 1, sharex=True)
    for axes, draw_graph in ((above, energies), (below, share)):
        draw_graph(axes, film)
        axes.set_title("", loc="left")
        axes.legend(fontsize=7)
        axes.label_outer()
        marks.append(axes.axvline(0, color=FAINT, zorder=0))

    def show(frame: int) -> None:
        image.set_data(packing(film, frame))
        move_disks(disks, film, frame)
        full_map.set_title(collisions_label(film, frame), fontsize=TITLE)
        for mark in marks:
            mark.set_xdata([collisions_so_far(film)[frame]] * 2)

    show(0)
    return figure, show
