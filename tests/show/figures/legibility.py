"""Legibility of figures: letters of at least 7 pt, no text on data, nothing cut off, and a key for
each colour, marker and dash pattern."""

import re
from collections.abc import Callable, Iterator
from itertools import combinations

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import to_hex, to_rgb
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from roughgas.show.style import PARAMETERS

PAGE_WIDTH = 7.0
"""Width of a printed page in inches: wider figures are scaled down."""
MIN_POINTS = 7.0
"""Smallest legal size of letters in print, in points."""
MIN_GAP = 2.0
"""Smallest legal gap between text and data, in points."""
NO_MARKER = {"None", None, "", " "}
SAMPLE_SPACING = 0.5
"""Spacing of the sampled points along a line, in points of print."""


def faults(draw: Callable[[], Figure]) -> list[str]:
    """Draw a figure in the style of all figures, and return a line for each illegible element."""
    with rc_context(PARAMETERS):
        figure = draw()
        texts = _drawn_texts(figure)
        return [
            *_faults_of_letters(figure, texts),
            *_overlapping_texts(figure, texts),
            *_without_key(figure),
            *(fault for axes in figure.axes for fault in _texts_on_data(figure, axes, texts)),
            *(fault for axes in figure.axes for fault in _hidden_symbols(figure, axes)),
        ]


def faults_of_letters(draw: Callable[[], Figure]) -> list[str]:
    """Return the `faults` of a figure that do not depend on where its data lie."""
    with rc_context(PARAMETERS):
        figure = draw()
        return _faults_of_letters(figure, _drawn_texts(figure))


def _faults_of_letters(figure, texts) -> list[str]:
    return [*_small_texts(figure, texts), *_cropped_texts(figure, texts)]


def _drawn_texts(figure: Figure) -> list[Text]:
    """Draw a figure, and return all its visible texts at their final positions."""
    figure.draw_without_rendering()
    return list(_visible_texts(figure))


def _visible_texts(figure: Figure) -> Iterator[Text]:
    """Yield all visible texts; of ticks only those within the limits of their axis."""
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


def _text_box(text: Text) -> Bbox:
    """Return the box around a text, without the arrow of an annotation."""
    return Text.get_window_extent(text)


def _small_texts(figure, texts) -> Iterator[str]:
    scale = min(1.0, PAGE_WIDTH / figure.get_figwidth())
    for text in texts:
        if text.get_fontsize() * scale < MIN_POINTS - 1e-9:
            yield f"{text.get_text()!r} is printed at {text.get_fontsize() * scale:.1f} pt"


def _cropped_texts(figure, texts) -> Iterator[str]:
    page = figure.bbox.padded(1.0)
    for text in texts:
        box = _text_box(text)
        if not (page.contains(*box.min) and page.contains(*box.max)):
            yield f"{text.get_text()!r} is cut off by the edge of the figure"


def _overlapping_texts(figure, texts) -> Iterator[str]:
    boxes = [(text, _text_box(text).padded(-0.5)) for text in texts]
    for (text, box), (neighbour, neighbour_box) in combinations(boxes, 2):
        if box.overlaps(neighbour_box):
            yield f"{text.get_text()!r} lies on {neighbour.get_text()!r}"


def _texts_on_data(figure, axes, texts) -> Iterator[str]:
    """Yield faults of texts nearer than MIN_GAP to data of these axes, and of legends on data."""
    unit = figure.dpi / 72
    centres, radii = _drawn_disks(axes, unit)
    is_visible = _is_inside(axes, centres, radii)
    centres, radii = centres[is_visible], radii[is_visible]
    legends = [
        legend for legend in (*figure.legends, *(a.get_legend() for a in figure.axes)) if legend
    ]
    keys = {text for legend in legends for text in legend.findobj(Text)}
    boxes = [(text.get_text(), _text_box(text), MIN_GAP) for text in texts if text not in keys]
    boxes += [("the legend", legend.get_window_extent(), 0.0) for legend in legends]
    for name, box, min_gap in boxes:
        distances = np.maximum(np.maximum(box.min - centres, centres - box.max), 0.0)
        is_near = np.hypot(*distances.T) < radii + min_gap * unit
        if is_near.any():
            x, y = axes.transData.inverted().transform(centres[is_near][0])
            yield f"{name!r} is within {min_gap:g} pt of data, at ({x:.3g}, {y:.3g})"


def _without_key(figure: Figure) -> Iterator[str]:
    """Yield each colour, marker and dash pattern of drawn lines that no legend explains.

    A colour may be paler than that of its key. A pattern needs no key of its own where a legend has
    the colour, and says what "lines" are. Full lines between two points, such as the axis at 0, and
    figures without a legend need none.
    """
    legends = figure.findobj(Legend)
    keys = [line for legend in legends for line in legend.findobj(Line2D)]
    if not keys:
        return
    says_lines = any(
        "line" in text.get_text() for legend in legends for text in legend.findobj(Text)
    )
    colours = {to_rgb(key.get_color()) for key in keys}
    markers = {key.get_marker() for key in keys} | NO_MARKER
    patterns = {_pattern(key) for key in keys} | {None}
    for line in _lines_of_data(figure):
        colour = to_rgb(line.get_color())
        has_colour = any(_is_paler(colour, key) for key in colours)
        if not has_colour:
            yield f"no key has the colour {to_hex(colour)}"
        if line.get_marker() not in markers:
            yield f"no key has the marker {line.get_marker()!r} of colour {to_hex(colour)}"
        if _pattern(line) not in patterns and not (has_colour and says_lines):
            yield f"no key has the dashes {_pattern(line)} of colour {to_hex(colour)}"


def _lines_of_data(figure: Figure) -> Iterator[Line2D]:
    """Yield the lines and symbols of all axes, without caps of error bars and full straight
    lines."""
    for axes in figure.axes:
        bars = [bar for bar in axes.containers if isinstance(bar, ErrorbarContainer)]
        caps = {cap for bar in bars for cap in bar.lines[1]}
        for line in axes.lines:
            is_straight = len(line.get_xdata()) == 2 and line.get_linestyle() == "-"
            if line.get_visible() and line not in caps and not is_straight:
                if np.isfinite(line.get_xydata()).all(axis=1).any():
                    yield line


def _pattern(line: Line2D) -> tuple | None:
    """Return the lengths of dashes and gaps of a line; None without a line, () for a full one."""
    if line.get_linestyle() == "None":
        return None
    return tuple(line._unscaled_dash_pattern[1] or ())


def _is_paler(colour: tuple[float, float, float], key: tuple[float, float, float]) -> bool:
    """Return whether a colour is that of a key, or a mixture of it and white."""
    ink, ink_of_key = 1.0 - np.array(colour), 1.0 - np.array(key)
    share = ink @ ink_of_key / (ink_of_key @ ink_of_key)
    return 0.0 < share < 1.01 and np.allclose(ink, share * ink_of_key, atol=0.01)


def _hidden_symbols(figure, axes) -> Iterator[str]:
    """Yield a fault if the frame hides or cuts more symbols than texts of the axes declare."""
    centres, radii = _symbol_disks(axes, figure.dpi / 72)
    hidden = int((~_is_inside(axes, centres, -radii)).sum())
    texts = " ".join(text.get_text() for text in axes.findobj(Text) if text.get_visible())
    declared = sum(int(number) for number in re.findall(r"(\d+) points?\b", texts))
    if hidden > declared:
        yield f"{hidden} points are cut off by the frame"


def _is_inside(axes: Axes, centres: np.ndarray, margin: np.ndarray) -> np.ndarray:
    """Return a mask of the centres within the frame of the axes, widened by `margin`."""
    allowance = np.asarray(margin)[:, None] + 0.01
    return ((centres > axes.bbox.min - allowance) & (centres < axes.bbox.max + allowance)).all(
        axis=1
    )


def _drawn_disks(axes: Axes, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Return disks that cover all symbols and lines, in pixels: centres (n, 2) and radii (n,)."""
    disks = [_symbol_disks(axes, unit)]
    for line in axes.lines:
        if line.get_visible() and line.get_linestyle() != "None":
            vertices = line.get_transform().transform(line.get_xydata())
            disks.append(_along_path(vertices, line.get_linewidth() * unit / 2, unit))
    for bars in axes.collections:
        if isinstance(bars, LineCollection) and bars.get_visible():
            for segment in bars.get_segments():
                vertices = bars.get_transform().transform(segment)
                disks.append(_along_path(vertices, bars.get_linewidth()[0] * unit / 2, unit))
    centres, radii = zip(*disks, strict=True)
    return np.concatenate(centres), np.concatenate(radii)


def _symbol_disks(axes: Axes, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the centres of all symbols, in pixels, (n, 2), and their radii, (n,)."""
    disks = [(np.empty((0, 2)), np.empty(0))]
    for line in axes.lines:
        if line.get_visible() and line.get_marker() not in ("None", None, "", " ", "_", "|"):
            radius = (line.get_markersize() + line.get_markeredgewidth()) * unit / 2
            disks.append(_as_disks(line.get_transform().transform(line.get_xydata()), radius))
    for scatter in axes.collections:
        if isinstance(scatter, PathCollection) and scatter.get_visible():
            centres = scatter.get_offset_transform().transform(
                np.ma.filled(scatter.get_offsets(), np.nan)
            )
            disks.append(_as_disks(centres, np.sqrt(scatter.get_sizes().max()) * unit / 2))
    centres, radii = zip(*disks, strict=True)
    return np.concatenate(centres), np.concatenate(radii)


def _as_disks(centres: np.ndarray, radius: float) -> tuple[np.ndarray, np.ndarray]:
    centres = centres[np.isfinite(centres).all(axis=1)]
    return centres, np.full(len(centres), radius)


def _along_path(vertices: np.ndarray, radius: float, unit: float) -> tuple[np.ndarray, np.ndarray]:
    """Return disks with centres at small spacing along a path."""
    vertices = np.clip(vertices, -1e4, 1e4).reshape(-1, 2)  # NaN stays; a bar may be empty
    if len(vertices) < 2:
        return _as_disks(vertices, radius)
    lengths = np.nan_to_num(np.hypot(*np.diff(vertices, axis=0).T))
    steps = np.ceil(lengths / (SAMPLE_SPACING * unit)).astype(int) + 1
    segments = zip(vertices[:-1], vertices[1:], steps, strict=True)
    return _as_disks(np.concatenate([np.linspace(*segment) for segment in segments]), radius)
