"""Fig. 4: Coulomb friction. R against its coefficient, for several beta_0, forced and cooling."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.show.figures import panel
from roughgas.show.figures.axis import FRICTION
from roughgas.show.style import LOOKS

RESTITUTION = 0.9


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the bed and of the cooling gas with friction.

    mu = 0, where R = 0, has no place on a logarithmic axis; it is in the data.
    """
    figure, panels = panel.ratio_panels([FRICTION] * 2, width=panel.TWO_WIDE)
    bed, cooling = (data.sel(mu=data.mu > 0.0) for data in (bed, cooling))
    _shade_where_two_are_stable(panels[1].main, cooling)
    every = [_draw(one, data) for one, data in zip(panels, (bed, cooling), strict=True)]
    beyond = theory.critical_friction(RESTITUTION)
    alone = [one._replace(steady=one.steady & (one.at > beyond)) for one in every[1]]
    for one, drawn in zip(panels, every, strict=True):
        panel.frame_residuals(one.residual, drawn, [*every[0], *alone])
    for one, drawn, place in zip(panels, every, ("upper left", "upper right"), strict=True):
        panel.legend(one.main, drawn, "", title="lines: rate equations", loc=place)
    panel.caption(panels[0].main, [bed], rf"Vibrated bed, $r = {RESTITUTION:g}$")
    panel.caption(panels[1].main, [cooling], rf"Cooling gas, $r = {RESTITUTION:g}$")
    return figure


def _draw(one: panel.Panel, data: xr.Dataset) -> list[panel.Series]:
    drawn = []
    for beta, look in zip(data.beta.values, LOOKS, strict=False):
        place = {"r": RESTITUTION, "beta": beta}
        panel.draw_theory(one.main, data, look, one.axis, **place)
        drawn.append(panel.series(data, rf"$\beta_0 = {beta:g}$", look, **place))
    panel.draw_series(one.main, one.residual, drawn, one.axis)
    return drawn


def _shade_where_two_are_stable(main: Axes, cooling: xr.Dataset) -> None:
    """From where theory has a stationary R < 1 up to where R = 1 ceases to be stable."""
    expected = panel.prediction(cooling, r=RESTITUTION, beta=0.0, mu=FRICTION.grid)
    first = FRICTION.grid[np.argmax(expected < 1.0)]
    last = theory.critical_friction(RESTITUTION)
    label = r"two stable states, $R = 1$ the other"
    main.axvspan(first, last, color="0.9", linewidth=0, zorder=0, label=label)
