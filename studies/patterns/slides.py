"""A slide of each layer: from above, four cycles in turn, beside what is published of it."""

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import GREY, LOOKS, THEORY

from .ball import CYCLE, flights, path
from .figure import draw_cycles, draw_height, measured, published, size
from .published import REPEATS, Panel, beside, panels

WIDE, TALL = 8.4, 4.2  # inches
SHAKEN = """\
A layer of spheres, 5.42 diameters D deep, lies on a plate that moves as a sine; Γ is its largest
acceleration over gravity. The layer lands like a ball that does not bounce (line): it stays on the
plate (grey), and leaves when that next falls away faster than gravity. **At each landing the
pattern turns over**: spheres slide off the hills, on through the hollows, and make hills there. So
it is itself after two flights. At Γ = 3 and 4 a flight takes about a cycle, at 5 to 7 about two.

C. Bizon, M. D. Shattuck, J. B. Swift, W. D. McCormick and H. L. Swinney published the pictures
(Phys. Rev. Lett. 80, 57, 1998): squares, stripes and hexagons, in simulations and experiments."""
OF_EACH = """\
Γ = {gamma:g}, f\\* = {f_star:g}; flights of the ball: {flights} cycles.

- **Published** (60 000 spheres in a box of 100 D): {published}.
- **Found here** ({size}): {measured}.

From above, the lighter the higher, grey the mean; in flight there is no pattern."""


def draw(layers: xr.Dataset) -> Iterator[tuple[str, str, Figure]]:
    """Yield name, text and figure of each slide."""
    yield "What is shaken, and why the pattern turns over", SHAKEN, _balls()
    there: dict[str, tuple[list[Panel], xr.Dataset]] = {}
    for panel, layer in beside(layers):  # c and d are one layer
        there.setdefault(panel.case, ([], layer))[0].append(panel)
    for of_case, layer in there.values():
        panel, number = of_case[0], layers.attrs["particles"]
        text = OF_EACH.format(
            gamma=panel.gamma,
            f_star=panel.f_star,
            flights=" and ".join(f"{one:.2f}" for one in flights(panel.gamma)),
            published=published(panel),
            size=size(panel, layer, number),
            measured=measured(panel, layer),
        )
        yield f"({', '.join(one.panel for one in of_case)}) {panel.pattern}", text, _cycles(layer)


def _balls():
    """Draw the floor and the ball over four cycles, for each acceleration."""
    figure = Figure(figsize=(WIDE, TALL), layout="constrained")
    phase = np.linspace(0.0, REPEATS * CYCLE, 1000)
    every = list(dict.fromkeys(panel.gamma for panel in panels()))
    for axes, gamma in zip(figure.subplots(2, 3, sharex=True).flat, every, strict=True):
        axes.plot(phase / CYCLE, path(gamma, phase), color=LOOKS[1].colour)
        axes.fill_between(phase / CYCLE, np.sin(phase), -1.2, color=GREY, lw=0)
        axes.set_title(f"Γ = {gamma:g}", fontsize=9, loc="left")
        axes.set(yticks=[], xlim=(0, REPEATS), ylim=(-1.2, None))
    figure.supxlabel("cycles of the floor", fontsize=8)
    return figure


def _cycles(layer):
    """Draw four cycles from above, and the mean height over them."""
    figure = Figure(figsize=(WIDE, TALL), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(2.2, 1))
    draw_cycles(above.subplots(1, REPEATS), layer)
    axes = below.subplots()
    draw_height(axes, layer, {"color": THEORY})
    axes.tick_params(labelsize=7)
    return figure
