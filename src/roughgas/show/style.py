"""One look for all figures: readable in print, in grey, and for the colour-blind.

The same data give the same bytes. There is no pyplot, hence no display, and no state that figures
share.

Many circles that move, drawn as one collection.
"""

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context, rcParamsDefault
from matplotlib.axes import Axes
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
    """Write `figure` to each of `outputs` (.pdf, .png or .svg), whole or not at all."""
    for output in map(Path, outputs):
        with whole_file(output) as draft:
            kind = output.suffix
            figure.savefig(draft, format=kind.removeprefix("."), metadata=METADATA[kind])


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
