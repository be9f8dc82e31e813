"""Shaken layers from above, as in the published figure, with their heights and correlations over
time."""

from collections.abc import Sequence
from textwrap import wrap
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from roughgas.plotting import FAINT, LINE_STYLES, TWO_WIDE, judged_title

from .appearance import appearance, clearest, pictured
from .ball import flights
from .published import (
    CYCLES,
    DIAMETER,
    FITS,
    FITS_WELL,
    FOLDS,
    STABILITY_DELAY,
    Panel,
    cycles,
    layers_of_panels,
    order,
    panels,
    panels_in,
    period,
    room,
    settled,
    side,
    wavelength,
)

PICTURE, CAPTION = 6.6, 1.05  # inches: sum of the widths of a row's pictures, height of texts
LETTERS_PER_INCH, NO_BREAK = 18, "\N{NO-BREAK SPACE}"
HEIGHT, BELOW = 8.3, 2.3  # inches: of the figure, and of the lowest row
SMALL_FONT = 7.0  # points
Q = {2: "Q₂", 4: "Q₄", 6: "Q₆"}
GREYS = (2, 98)  # percentiles of height that are black and white
GREY_SCALE: dict[str, Any] = {
    "cmap": colormaps["gray"].resampled(32),  # which makes small files
    "origin": "lower",
    "interpolation": "bilinear",
}
DRAWN = "Heights of shaken layers, seen from above, beside published patterns"


def draw(layers: xr.Dataset, large: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of layers and of large ones: pictures of cases that
    are large, then of all others, and heights and correlations of all `layers` over time."""
    figure = Figure(figsize=(TWO_WIDE, HEIGHT), layout="constrained")
    rows = [panels_in(large), panels_in(layers, without=large)]
    heights = [PICTURE / len(row) + CAPTION for row in rows if row]
    *above, below = np.atleast_1d(
        figure.subfigures(len(heights) + 1, 1, height_ratios=(*heights, BELOW))
    )
    for subfigure, row, data in zip(above, filter(None, rows), (large, layers), strict=False):
        for axes, (panel, layer) in zip(
            np.atleast_1d(subfigure.subplots(1, len(row))), row, strict=True
        ):
            _draw_picture(axes, panel, layer)
        subfigure.suptitle(_row_title(row, data.attrs["particles"]), fontsize=8)
    _draw_over_time(below, layers)
    message = judged_title(__file__, "it_repeats_when_published", [layers], DRAWN)
    figure.suptitle(message, fontsize=8.5, fontweight="bold", x=0.01, ha="left")
    return figure


def _draw_over_time(subfigure: SubFigure, layers: xr.Dataset) -> None:
    """Draw the mean height of each layer over four cycles, and correlations of heights."""
    shown = {panel.case: layer for panel, layer in layers_of_panels(layers)}
    handles: list[Line2D] = []
    over, apart = subfigure.subplots(1, 2)
    for axes in (over, apart):
        axes.tick_params(labelsize=7)
    for number, (case, gamma) in enumerate({panel.case: panel.gamma for panel in panels()}.items()):
        if case in shown:
            look, line = (
                LINE_STYLES[number % len(LINE_STYLES)],
                "-" if number < len(LINE_STYLES) else "--",
            )
            style: dict[str, Any] = {"color": look.colour, "lw": 1, "ls": line}
            draw_height(over, shown[case], style)
            style |= {"marker": look.marker, "ms": 3}
            _draw_correlation(apart, shown[case], style)
            label = f"{case}: " + ", ".join(f"{length:.2f}" for length in flights(gamma))
            handles.append(Line2D([], [], label=label, **style))
    over.set_ylim(0.0, 1.75 * over.get_ylim()[1])
    title = "panel: flights of a ball that does not bounce, in cycles"
    keys: dict[str, Any] = {
        "fontsize": SMALL_FONT,
        "title_fontsize": SMALL_FONT,
        "handlelength": 1.7,
    }
    over.legend(
        handles=handles, **keys, title=title, ncols=3, loc="upper center", columnspacing=1.0
    )
    size = f"{side(next(iter(shown.values()))):g} D"
    for axes, quantity in ((over, "mean height"), (apart, "correlation, symbols as left")):
        axes.set_title(f"{quantity}, boxes of {size}", fontsize=8, loc="left")


def _row_title(row: Sequence[tuple[Panel, xr.Dataset]], number: int) -> str:
    """Return the size of the boxes of a row of pictures, and the cycles before the measurement."""
    before = [round(cycles(*pair)) for pair in row]
    span = " to ".join(map(str, dict.fromkeys([min(before), max(before)])))
    return f"Boxes of {side(row[0][1]):g} D, $N = {number}$, after {span} cycles"


def draw_full(layers: xr.Dataset) -> Figure:
    """Draw four cycles of each layer in the data, one layer per row."""
    simulated = {panel.case: (panel, layer) for panel, layer in layers_of_panels(layers)}
    figure = Figure(figsize=(TWO_WIDE, 2.4 * len(simulated)), layout="constrained")
    rows = np.atleast_1d(figure.subfigures(len(simulated), 1))
    for row, (panel, layer) in zip(rows, simulated.values(), strict=True):
        draw_cycles(row.subplots(1, CYCLES), layer)
        run_size = size_text(panel, layer, layers.attrs["particles"])
        text = f"({panel.case}) {panel.pattern}; {run_size}: {measured_text(panel, layer)}"
        row.suptitle(f"{text}\npublished: {published_text(panel)}", fontsize=7.5)
    return figure


def draw_cycles(row: np.ndarray, layer: xr.Dataset) -> None:
    """Draw heights one cycle apart on four axes, each minus its mean, with a common grey scale."""
    first, heights = clearest(layer), layer.mean_height
    heights = heights - heights.mean(("cell_x", "cell_y"))
    low, high = np.percentile(heights.values, GREYS)
    for number, axes in enumerate(row):
        deviation = heights[(first + number) % CYCLES].values.T
        axes.imshow(deviation, vmin=low, vmax=high, **GREY_SCALE)
        axes.set(xticks=[], yticks=[])
        later = f"{number} cycle{'s' * (number > 1)} later" if number else "now"
        axes.set_title(later, fontsize=7.5)


def _draw_picture(axes: Axes, panel: Panel, layer: xr.Dataset) -> None:
    """Draw the mean height at its clearest phase, for panel d one cycle later, with what is seen
    there above, and what is published below."""
    axes.set(xticks=[], yticks=[])
    axes.set_title(f"({panel.panel}) {appearance(panel, layer)}", fontsize=7.5, loc="left")
    heights = pictured(panel, layer).T
    low, high = np.percentile(heights, GREYS)
    axes.imshow(heights, vmin=low, vmax=high, **GREY_SCALE)
    texts = (
        f"ours: {measured_text(panel, layer)}",
        f"published: {panel.pattern}, {published_text(panel)}",
    )
    width = int(LETTERS_PER_INCH * TWO_WIDE / axes.get_gridspec().ncols)
    # a line breaks only after a comma
    unbroken = [text.replace(" ", NO_BREAK).replace(f",{NO_BREAK}", ", ") for text in texts]
    lines = [line for text in unbroken for line in wrap(text, width)]
    lines.append(f"{side(layer):g} D = {room(panel, layer):.1f} λ")
    axes.set_xlabel("\n".join(lines), fontsize=SMALL_FONT, linespacing=1.35)


def published_text(panel: Panel) -> str:
    """Return the published wavelength, order and period of a panel, as text."""
    order_said = f", {Q[panel.fold]} {panel.order:.2f}" if panel.fold else ""
    return f"λ {panel.wavelength:g} D{order_said}, {panel.repeats} cycles"


def measured_text(panel: Panel, layer: xr.Dataset) -> str:
    """Return our wavelength, order and period, each if the box is large enough for it, as text."""
    space, length, stays = room(panel, layer), wavelength(layer), settled(layer)
    ours = f"λ {length.value:.0f} ± {length.stderr:.0f} D" if space >= FITS else ""
    if panel.fold in FOLDS and space >= FITS_WELL:
        ours += f", {Q[panel.fold]} {order(layer, panel.fold).value:.2f}"
    ours += f", {period(layer)} cycles" if stays else ""
    return (ours.removeprefix(", ") or "no number") + ("" if stays else " (not settled)")


def size_text(panel: Panel, layer: xr.Dataset, number: int) -> str:
    """Return number of particles, box and length of a run, as text."""
    box = f"N = {number}, {side(layer):g} D = {room(panel, layer):.1f} λ"
    return f"{box}, after {cycles(panel, layer):.0f} cycles"


def draw_height(axes: Axes, layer: xr.Dataset, style: dict[str, Any]) -> None:
    """Draw the mean height of the layer above the floor over four cycles."""
    axes.plot(CYCLES * layer.layer_phase, layer.layer_height / DIAMETER, **style)
    axes.set_xlabel("cycles of the floor", fontsize=8)
    axes.set_ylabel("mean height / D", fontsize=8)


def _draw_correlation(axes, layer, style):
    """Draw the correlation of heights over the number of cycles between them."""
    delays = np.arange(1, layer.sizes["pattern_delay"])
    correlations = layer.height_autocorrelation[1:]
    axes.errorbar(delays, correlations, layer.height_autocorrelation_stderr[1:], **style)
    axes.axhline(0, color=FAINT, lw=0.6, zorder=0)
    axes.set_xlim(0, STABILITY_DELAY + 0.5)
    axes.set_xlabel("cycles apart", fontsize=8)
    axes.set_ylabel("correlation of heights", fontsize=8)
