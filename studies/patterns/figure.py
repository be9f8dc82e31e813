"""Shaken layers from above, as in the published figure, with their heights and correlations over
time."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.plotting import FAINT, LINE_STYLES, TWO_WIDE, judged_title

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
    period,
    room,
    settled,
    side,
    wavelength,
)

HEIGHT = 6.9  # inches
COLUMNS = 4
SMALL_FONT = 5.5  # points
Q = {2: "Q₂", 4: "Q₄", 6: "Q₆"}
GREYS = (2, 98)  # percentiles of height that are black and white
DRAWN = "Heights of shaken layers, seen from above, beside published wavelengths and periods"


def draw(layers: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of layers."""
    figure = Figure(figsize=(TWO_WIDE, HEIGHT), layout="constrained")
    *above, below = figure.subfigures(3, 1, height_ratios=(1.22, 1.22, 1))
    simulated = {panel.panel: layer for panel, layer in layers_of_panels(layers)}
    pictures = np.concatenate([row.subplots(1, COLUMNS) for row in above])
    for axes, panel in zip(pictures, panels(), strict=True):
        _draw_picture(axes, panel, simulated.get(panel.panel), layers.attrs["particles"])
    shown = {panel.case: simulated[panel.panel] for panel in panels() if panel.panel in simulated}
    over, apart = below.subplots(1, 2)
    for axes in (over, apart):
        axes.tick_params(labelsize=7)
    for number, (case, gamma) in enumerate({panel.case: panel.gamma for panel in panels()}.items()):
        if case in shown:
            look, line = (
                LINE_STYLES[number % len(LINE_STYLES)],
                "-" if number < len(LINE_STYLES) else "--",
            )
            style: dict[str, Any] = {"color": look.colour, "lw": 1, "ls": line}
            style["label"] = f"{case}: " + ", ".join(f"{length:.2f}" for length in flights(gamma))
            draw_height(over, shown[case], style)
            _draw_correlation(apart, shown[case], style | {"marker": look.marker, "ms": 3})
    over.set_ylim(0.0, 1.5 * over.get_ylim()[1])
    title = "panel: flights of a ball that does not bounce, in cycles"
    keys: dict[str, Any] = {
        "fontsize": SMALL_FONT,
        "title_fontsize": SMALL_FONT,
        "handlelength": 1.5,
    }
    over.legend(**keys, title=title, ncols=3, loc="upper center")
    message = judged_title(__file__, "it_repeats_when_published", [layers], DRAWN)
    figure.suptitle(message, fontsize=8.5, fontweight="bold", x=0.01, ha="left")
    return figure


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
    look: dict[str, Any] = {"cmap": "gray", "vmin": low, "vmax": high}
    for number, axes in enumerate(row):
        deviation = heights[(first + number) % CYCLES].values.T
        axes.imshow(deviation, origin="lower", interpolation="bilinear", **look)
        axes.set(xticks=[], yticks=[])
        later = f"{number} cycle{'s' * (number > 1)} later" if number else "now"
        axes.set_title(later, fontsize=7.5)


def _draw_picture(axes, panel: Panel, layer, number):
    """Draw the mean height at its clearest phase, for panel d one cycle later."""
    axes.set(xticks=[], yticks=[])
    axes.set_title(f"({panel.panel}) {panel.pattern}", fontsize=7.5, loc="left")
    if layer is None:
        axes.text(0.5, 0.5, "not simulated", ha="center", va="center", color=FAINT)
        axes.set_aspect("equal")
        axes.set_xlabel(f"published: {published_text(panel)}", fontsize=SMALL_FONT)
        return
    best = clearest(layer)
    heights = layer.mean_height[(best + (panel.panel == "d")) % CYCLES].values.T
    low, high = np.percentile(heights, GREYS)
    axes.imshow(heights, cmap="gray", origin="lower", vmin=low, vmax=high, interpolation="bilinear")
    texts = measured_text(panel, layer), published_text(panel), size_text(panel, layer, number)
    text = f"ours: {texts[0]}\npublished: {texts[1]}\n{texts[2]}"
    axes.set_xlabel(text, fontsize=SMALL_FONT, linespacing=1.35)


def clearest(layer: xr.Dataset) -> int:
    """Return the phase, of four cycles, with the largest variation of heights."""
    return int(np.argmax(layer.mean_height.std(("cell_x", "cell_y")).values))


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
