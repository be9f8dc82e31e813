"""A slide of each layer: four cycles seen from above, with the published and our values."""

from collections.abc import Iterator

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import GREY, LINE_STYLES, THEORY

from .appearance import appearance
from .ball import CYCLE, ball_heights, flights
from .figure import draw_cycles, draw_height, measured_text, published_text, size_text
from .published import CYCLES, Panel, panels, panels_in

WIDTH, HEIGHT, LAYER_HEIGHT = 5.0, 3.6, 2.7  # inches: letters are legible on a phone
FLOOR_BOTTOM = -1.2  # amplitudes of the floor
SETUP_TEXT = """\
A layer of spheres, 5.42 diameters D deep, lies on a plate that moves as a sine; Γ is its largest
acceleration over gravity. The layer lands like a ball that does not bounce (line): it stays on the
plate (grey), and leaves when that next falls away faster than gravity. **At each landing the
pattern turns over**: spheres slide off the hills, on through the hollows, and make hills there. So
it is itself after two flights. At Γ = 3 and 4 a flight takes about a cycle, at 5 to 7 about two.

C. Bizon, M. D. Shattuck, J. B. Swift, W. D. McCormick and H. L. Swinney published the pictures
(Phys. Rev. Lett. 80, 57, 1998): squares, stripes and hexagons, in simulations and experiments."""
LAYER_TEXT = """\
Γ = {gamma:g}, f\\* = {f_star:g}; flights of the ball: {flights} cycles.

- **Published** (60 000 spheres in a box of 100 D): {published}.
- **Found here** ({size}): {measured}.

From above, the lighter the higher, grey the mean; in flight there is no pattern."""


def draw(layers: xr.Dataset, large: xr.Dataset) -> Iterator[tuple[str, str, Figure]]:
    """Yield name, text and figure of each slide: of a large layer where the case has one."""
    yield "What is shaken, and why the pattern turns over", SETUP_TEXT, _draw_balls()
    cases: dict[str, tuple[list[Panel], xr.Dataset, int]] = {}
    for data, pairs in ((large, panels_in(large)), (layers, panels_in(layers, without=large))):
        for panel, layer in pairs:  # c and d are the same layer
            cases.setdefault(panel.case, ([], layer, data.attrs["particles"]))[0].append(panel)
    for _, (case_panels, layer, number) in sorted(cases.items()):
        panel = case_panels[0]
        text = LAYER_TEXT.format(
            gamma=panel.gamma,
            f_star=panel.f_star,
            flights=" and ".join(f"{length:.2f}" for length in flights(panel.gamma)),
            published=f"{panel.pattern}, {published_text(panel)}",
            size=size_text(panel, layer, number),
            measured=measured_text(panel, layer),
        )
        yield (
            f"({', '.join(panel.panel for panel in case_panels)}) {appearance(panel, layer)}",
            text,
            _draw_layer(layer),
        )


def _draw_balls():
    """Draw the floor and the ball over four cycles, for each acceleration."""
    figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
    phase = np.linspace(0.0, CYCLES * CYCLE, 1000)
    accelerations = list(dict.fromkeys(panel.gamma for panel in panels()))
    rows = figure.subplots(2, 3, sharex=True, sharey=True)
    for axes, gamma in zip(rows.flat, accelerations, strict=True):
        axes.plot(phase / CYCLE, ball_heights(gamma, phase), color=LINE_STYLES[1].colour)
        axes.fill_between(phase / CYCLE, np.sin(phase), FLOOR_BOTTOM, color=GREY, lw=0)
        axes.set_title(f"Γ = {gamma:g}", fontsize=9, loc="left")
        axes.set_xlim(0, CYCLES)
    axes.set_ylim(FLOOR_BOTTOM, None)
    figure.supxlabel("cycles of the floor", fontsize=9)
    figure.supylabel("height / amplitude of the floor", fontsize=9)
    return figure


def _draw_layer(layer):
    """Draw four cycles from above, and the mean height over them."""
    figure = Figure(figsize=(WIDTH, LAYER_HEIGHT), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(1.3, 1))
    row = above.subplots(1, CYCLES)
    draw_cycles(row, layer)
    for axes in row:
        axes.title.set_fontsize(9)
    axes = below.subplots()
    draw_height(axes, layer, {"color": THEORY})
    axes.tick_params(labelsize=8)
    return figure
