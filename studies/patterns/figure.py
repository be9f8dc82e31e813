"""Shaken layers from above, as in the published figure, and how they move and stay."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.plotting import FAINT, LOOKS, TWO_WIDE

from .ball import flights
from .published import (
    DIAMETER,
    FAR,
    FITS,
    FITS_WELL,
    FOLDS,
    REPEATS,
    Panel,
    beside,
    cycles,
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
SMALL = 5.5  # points
Q = {2: "Q₂", 4: "Q₄", 6: "Q₆"}
GREYS = (2, 98)  # percentiles of height that are black and white
MESSAGE = "Shaken spheres stand in patterns that repeat after two or four cycles"


def draw(layers: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of layers."""
    figure = Figure(figsize=(TWO_WIDE, HEIGHT), layout="constrained")
    *above, below = figure.subfigures(3, 1, height_ratios=(1.22, 1.22, 1))
    there = {panel.panel: layer for panel, layer in beside(layers)}
    pictures = np.concatenate([part.subplots(1, COLUMNS) for part in above])
    for axes, panel in zip(pictures, panels(), strict=True):
        _picture(axes, panel, there.get(panel.panel), layers.attrs["particles"])
    shown = {panel.case: there[panel.panel] for panel in panels() if panel.panel in there}
    over, apart = below.subplots(1, 2)
    for axes in (over, apart):
        axes.tick_params(labelsize=7)
    for number, (case, gamma) in enumerate({one.case: one.gamma for one in panels()}.items()):
        if case in shown:
            look, line = LOOKS[number % len(LOOKS)], "-" if number < len(LOOKS) else "--"
            how: dict[str, Any] = {"color": look.colour, "lw": 1, "ls": line}
            how["label"] = f"{case}: " + ", ".join(f"{one:.2f}" for one in flights(gamma))
            draw_height(over, shown[case], how)
            _correlation(apart, shown[case], how | {"marker": look.marker, "ms": 3})
    over.set_ylim(0.0, 1.5 * over.get_ylim()[1])
    title = "panel: flights of a ball that does not bounce, in cycles"
    keys: dict[str, Any] = {"fontsize": SMALL, "title_fontsize": SMALL, "handlelength": 1.5}
    over.legend(**keys, title=title, ncols=3, loc="upper center")
    figure.suptitle(MESSAGE, fontsize=8.5, fontweight="bold", x=0.01, ha="left")
    return figure


def draw_full(layers: xr.Dataset) -> Figure:
    """Draw four cycles of each layer that is there, a layer a row."""
    there = {panel.case: (panel, layer) for panel, layer in beside(layers)}
    figure = Figure(figsize=(TWO_WIDE, 2.4 * len(there)), layout="constrained")
    parts = np.atleast_1d(figure.subfigures(len(there), 1))
    for part, (panel, layer) in zip(parts, there.values(), strict=True):
        draw_cycles(part.subplots(1, REPEATS), layer)
        how = size(panel, layer, layers.attrs["particles"])
        said = f"({panel.case}) {panel.pattern}; {how}: {measured(panel, layer)}"
        part.suptitle(f"{said}\npublished: {published(panel)}", fontsize=7.5)
    return figure


def draw_cycles(row: np.ndarray, layer: xr.Dataset) -> None:
    """Draw heights one cycle apart into four axes, each from its own mean, in the same greys."""
    first, heights = clearest(layer), layer.mean_height
    heights = heights - heights.mean(("cell_x", "cell_y"))
    low, high = np.percentile(heights.values, GREYS)
    look: dict[str, Any] = {"cmap": "gray", "vmin": low, "vmax": high}
    for number, axes in enumerate(row):
        one = heights[(first + number) % REPEATS].values.T
        axes.imshow(one, origin="lower", interpolation="bilinear", **look)
        axes.set(xticks=[], yticks=[])
        later = f"{number} cycle{'s' * (number > 1)} later" if number else "now"
        axes.set_title(later, fontsize=7.5)


def _picture(axes, panel: Panel, layer, number):
    """Draw the mean height at the phase at which it differs most, for d at the cycle after it."""
    axes.set(xticks=[], yticks=[])
    axes.set_title(f"({panel.panel}) {panel.pattern}", fontsize=7.5, loc="left")
    if layer is None:
        axes.text(0.5, 0.5, "not simulated", ha="center", va="center", color=FAINT)
        axes.set_aspect("equal")
        axes.set_xlabel(f"published: {published(panel)}", fontsize=SMALL)
        return
    best = clearest(layer)
    one = layer.mean_height[(best + (panel.panel == "d")) % REPEATS].values.T
    low, high = np.percentile(one, GREYS)
    axes.imshow(one, cmap="gray", origin="lower", vmin=low, vmax=high, interpolation="bilinear")
    said = measured(panel, layer), published(panel), size(panel, layer, number)
    text = f"ours: {said[0]}\npublished: {said[1]}\n{said[2]}"
    axes.set_xlabel(text, fontsize=SMALL, linespacing=1.35)


def clearest(layer: xr.Dataset) -> int:
    """Return the phase, of four cycles, at which heights differ most."""
    return int(np.argmax(layer.mean_height.std(("cell_x", "cell_y")).values))


def published(panel: Panel) -> str:
    """Return what is published of a panel."""
    order_said = f", {Q[panel.fold]} {panel.order:.2f}" if panel.fold else ""
    return f"λ {panel.wavelength:g} D{order_said}, {panel.repeats} cycles"


def measured(panel: Panel, layer: xr.Dataset) -> str:
    """Return what is measured, of a box that is large enough for it."""
    space, length, stays = room(panel, layer), wavelength(layer), settled(layer)
    ours = f"λ {length.value:.0f} ± {length.stderr:.0f} D" if space >= FITS else ""
    if panel.fold in FOLDS and space >= FITS_WELL:
        ours += f", {Q[panel.fold]} {order(layer, panel.fold).value:.2f}"
    ours += f", {period(layer)} cycles" if stays else ""
    return (ours.removeprefix(", ") or "no number") + ("" if stays else " (not settled)")


def size(panel: Panel, layer: xr.Dataset, number: int) -> str:
    """Return how large a run of so many spheres is, and how long."""
    box = f"N = {number}, {side(layer):g} D = {room(panel, layer):.1f} λ"
    return f"{box}, after {cycles(panel, layer):.0f} cycles"


def draw_height(axes: Axes, layer: xr.Dataset, how: dict[str, Any]) -> None:
    """Draw the mean height of the layer above the floor over four cycles."""
    axes.plot(REPEATS * layer.layer_phase, layer.layer_height / DIAMETER, **how)
    axes.set_xlabel("cycles of the floor", fontsize=8)
    axes.set_ylabel("mean height / D", fontsize=8)


def _correlation(axes, layer, how):
    """Draw the correlation of heights so many cycles apart."""
    apart = np.arange(1, layer.sizes["pattern_delay"])
    found = layer.height_autocorrelation[1:]
    axes.errorbar(apart, found, layer.height_autocorrelation_stderr[1:], **how)
    axes.axhline(0, color=FAINT, lw=0.6, zorder=0)
    axes.set_xlim(0, FAR + 0.5)
    axes.set_xlabel("cycles apart", fontsize=8)
    axes.set_ylabel("correlation of heights", fontsize=8)
