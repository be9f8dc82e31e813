"""Fig. 8: what the boundaries are made of. R, and how much rotation they put in."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.figures.axis import ROUGHNESS
from roughgas.show.style import LOOKS

RESTITUTION = 0.9
NAMES = {"floor_materials": "Rough floor", "wall_materials": "Rough side walls"}


def draw(floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the bed on rough floors and between rough walls.

    Lines above: the rate equations, with the share of rotation that is shown beneath.
    """
    figure, panels = panel.ratio_panels([ROUGHNESS] * 2, width=panel.TWO_WIDE)
    for data, name, (main, beneath, _) in zip((floor, walls), NAMES.values(), panels, strict=True):
        drawn = [
            panel.series(data, rf"$\beta = {beta:g}$", look, r=RESTITUTION, beta=beta)
            for beta, look in zip(data.beta.values, LOOKS, strict=False)
        ]
        for one, beta in zip(drawn, data.beta.values, strict=False):
            _draw_shares(main, beneath, data, one, beta)
        panel.draw_points(main, drawn)
        main.set_ylim(0.0, 0.78)  # room for the legend
        panel.legend(main, drawn, "", title="lines: rate equations", loc="upper left")
        panel.caption(main, [data], rf"{name}, $r = {RESTITUTION:g}$")
    panels[0].residual.set_ylabel("share of rotation in\nthe energy put in")
    return figure


def _draw_shares(main: Axes, beneath: Axes, data: xr.Dataset, one: panel.Series, beta: float):
    """The share of rotation in the energy put in, and R of the rate equations at that share."""
    place = {"r": RESTITUTION, "beta": beta}
    share = data.input_spin_share.sel(place)
    error = data.input_spin_share_stderr.sel(place)
    style = {"color": one.look.colour, "linestyle": one.look.line}
    beneath.errorbar(one.at, share, error, marker=one.look.marker, markersize=4, **style)
    expected = panel.prediction(data, **place, spin_share=share.values)
    main.plot(one.at, expected, zorder=1, **style)
