"""What a referee asks of any figure: letters of 7 pt, text beside the data, nothing cut off."""

import re
from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from roughgas.show.style import PARAMETERS

PRINTED = 7.0
"""Width of a page in inches: a wider figure is printed smaller."""
LEAST = 7.0
"""Points of the smallest letter, in print."""
ROOM = 2.0
"""Points between text and data."""
STEP = 0.5
"""Points between places along a line at which it is looked at."""


def faults(draw: Callable[[], Figure]) -> list[str]:
    """Draw a figure in the style of all, and return a line for each thing that cannot be read."""
    with rc_context(PARAMETERS):
        figure = draw()
        figure.draw_without_rendering()
        texts = list(_texts(figure))
        return [
            *_small(figure, texts),
            *_off_the_figure(figure, texts),
            *_on_each_other(figure, texts),
            *(fault for axes in figure.axes for fault in _on_data(figure, axes, texts)),
            *(fault for axes in figure.axes for fault in _cut_off(figure, axes)),
        ]


def _texts(figure: Figure) -> Iterator[Text]:
    """Every text that is seen; of ticks those within their axis."""
    outside = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
                if not low <= tick.get_loc() <= high:
                    outside |= {tick.label1, tick.label2}
    for text in figure.findobj(Text):
        if text.get_visible() and text.get_text().strip() and text not in outside:
            yield text


def _box(text: Text) -> Bbox:
    return Text.get_window_extent(text)  # of an annotation without its arrow


def _small(figure, texts) -> Iterator[str]:
    scale = min(1.0, PRINTED / figure.get_figwidth())
    for text in texts:
        if text.get_fontsize() * scale < LEAST - 1e-9:
            yield f"{text.get_text()!r} is printed at {text.get_fontsize() * scale:.1f} pt"


def _off_the_figure(figure, texts) -> Iterator[str]:
    page = figure.bbox.padded(1.0)
    for text in texts:
        box = _box(text)
        if not (page.contains(*box.min) and page.contains(*box.max)):
            yield f"{text.get_text()!r} is cut off by the edge of the figure"


def _on_each_other(figure, texts) -> Iterator[str]:
    boxes = [(text, _box(text).padded(-0.5)) for text in texts]
    for (one, first), (other, second) in combinations(boxes, 2):
        if first.overlaps(second):
            yield f"{one.get_text()!r} lies on {other.get_text()!r}"


def _on_data(figure, axes, texts) -> Iterator[str]:
    """Text nearer than ROOM to data of these axes, and legends on them."""
    unit = figure.dpi / 72
    places, radii = _data(axes, unit)
    inside = _inside(axes, places, radii)
    places, radii = places[inside], radii[inside]
    legends = [one for one in (*figure.legends, *(a.get_legend() for a in figure.axes)) if one]
    keys = {text for legend in legends for text in legend.findobj(Text)}
    boxes = [(text.get_text(), _box(text), ROOM) for text in texts if text not in keys]
    boxes += [("the legend", legend.get_window_extent(), 0.0) for legend in legends]
    for name, box, room in boxes:
        gap = np.maximum(np.maximum(box.min - places, places - box.max), 0.0)
        near = np.hypot(*gap.T) < radii + room * unit
        if near.any():
            x, y = axes.transData.inverted().transform(places[near][0])
            yield f"{name!r} is within {room:g} pt of data, at ({x:.3g}, {y:.3g})"


def _cut_off(figure, axes) -> Iterator[str]:
    """Symbols that the frame hides or cuts, unless a text in or above the axes says how many."""
    places, radii = _symbols(axes, figure.dpi / 72)
    hidden = int((~_inside(axes, places, -radii)).sum())
    texts = " ".join(text.get_text() for text in axes.findobj(Text) if text.get_visible())
    said = sum(int(number) for number in re.findall(r"(\d+) points?\b", texts))
    if hidden > said:
        yield f"{hidden} points are cut off by the frame"


def _inside(axes: Axes, places: np.ndarray, margin: np.ndarray) -> np.ndarray:
    """Whether places are within the frame of the axes, or outside it by less than the margin."""
    by = np.asarray(margin)[:, None] + 0.01
    return ((places > axes.bbox.min - by) & (places < axes.bbox.max + by)).all(axis=1)


def _data(axes: Axes, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Places of all that is drawn, in pixels, (n, 2), and how far it reaches around these, (n,)."""
    parts = [_symbols(axes, unit)]
    for line in axes.lines:
        if line.get_visible() and line.get_linestyle() != "None":
            vertices = line.get_transform().transform(line.get_xydata())
            parts.append(_along(vertices, line.get_linewidth() * unit / 2, unit))
    for bars in axes.collections:
        if isinstance(bars, LineCollection) and bars.get_visible():
            for segment in bars.get_segments():
                vertices = bars.get_transform().transform(segment)
                parts.append(_along(vertices, bars.get_linewidth()[0] * unit / 2, unit))
    places, radii = zip(*parts, strict=True)
    return np.concatenate(places), np.concatenate(radii)


def _symbols(axes: Axes, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Centres of all symbols, in pixels, (n, 2), and their radii, (n,)."""
    parts = [(np.empty((0, 2)), np.empty(0))]
    for line in axes.lines:
        if line.get_visible() and line.get_marker() not in ("None", None, "", " ", "_", "|"):
            radius = (line.get_markersize() + line.get_markeredgewidth()) * unit / 2
            parts.append(_round(line.get_transform().transform(line.get_xydata()), radius))
    for dots in axes.collections:
        if isinstance(dots, PathCollection) and dots.get_visible():
            places = dots.get_offset_transform().transform(np.ma.filled(dots.get_offsets(), np.nan))
            parts.append(_round(places, np.sqrt(dots.get_sizes().max()) * unit / 2))
    places, radii = zip(*parts, strict=True)
    return np.concatenate(places), np.concatenate(radii)


def _round(places: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    places = places[np.isfinite(places).all(axis=1)]
    return places, np.full(len(places), radius)


def _along(vertices: np.ndarray, radius: float, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Close places along a path."""
    vertices = np.clip(vertices, -1e4, 1e4).reshape(-1, 2)  # NaN stays; a bar may be empty
    if len(vertices) < 2:
        return _round(vertices, radius)
    length = np.nan_to_num(np.hypot(*np.diff(vertices, axis=0).T))
    steps = np.ceil(length / (STEP * unit)).astype(int) + 1
    pieces = zip(vertices[:-1], vertices[1:], steps, strict=True)
    return _round(np.concatenate([np.linspace(*piece) for piece in pieces]), radius)
