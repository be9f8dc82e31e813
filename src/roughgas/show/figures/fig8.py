"""Fig. 8: what the boundaries are made of. R, and how much rotation they put in."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel


def draw(floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed on rough floors and between rough walls.

    Lines above: the rate equations, with the share of rotation that is shown beneath.
    """
    figure, panels = panel.ratio_panels([panel.ROUGHNESS] * 2, width=panel.TWO_WIDE)
    parts = (floor, "Rough floor"), (walls, "Rough side walls")
    for one, (data, name) in zip(panels, parts, strict=True):
        drawn = panel.series_for_each(data, "beta")
        for series in drawn:
            _draw_shares(one, series)
        panel.draw_series(one, drawn, residuals=False)
        one.main.set_ylim(0.0, 0.78)  # room for the legend
        panel.add_legend(one.main, drawn, title="lines: rate equations", loc="upper left")
        panel.add_title(one.main, [data], rf"{name}, $r = {panel.RESTITUTION:g}$")
    panels[0].residual.set_ylabel("share of rotation in\nthe energy put in")
    return figure


def _draw_shares(panel: panel.Panel, one: panel.Series) -> None:
    """Draw the share of rotation in the energy put in, and R of the rate equations for it."""
    share, error = one.data.input_spin_share.values, one.data.input_spin_share_stderr.values
    look = {"color": one.look.colour, "linestyle": one.look.line}
    panel.residual.errorbar(one.at, share, error, marker=one.look.marker, markersize=4, **look)
    panel.main.plot(one.at, one.predict(spin_share=share), zorder=1, **look)
