"""Fig. 4: Coulomb friction. R against its coefficient, for several beta_0, forced and cooling."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import panel
from roughgas.plotting.axis import FRICTION
from roughgas.plotting.style import LOOKS

RESTITUTION = 0.9
NAMES = {"vibrated_friction": "Vibrated bed", "cooling_friction": "Cooling gas"}
EXPERIMENTS = tuple(NAMES)


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the bed and of the cooling gas with friction.

    mu = 0, where R = 0, has no place on a logarithmic axis; it is in the data.
    """
    figure, panels = panel.ratio_panels([FRICTION] * 2, width=panel.TWO_WIDE)
    every, places = [], dict(zip(NAMES.values(), ("upper left", "upper right"), strict=True))
    for data, name, (main, residual, axis) in zip(
        (bed, cooling), NAMES.values(), panels, strict=True
    ):
        data = data.sel(mu=data.mu > 0.0)
        drawn = [
            panel.series(data, rf"$\beta_0 = {beta:g}$", look, r=RESTITUTION, beta=beta)
            for beta, look in zip(data.beta.values, LOOKS, strict=False)
        ]
        panel.draw_series(main, residual, drawn, axis)
        for beta, look in zip(data.beta.values, LOOKS, strict=False):
            panel.draw_theory(main, data, look, axis, r=RESTITUTION, beta=beta)
        panel.legend(main, drawn, "", title="lines: rate equations", loc=places[name])
        panel.caption(main, [data], rf"{name}, $r = {RESTITUTION:g}$")
        every += drawn
    for _, residual, _ in panels:
        panel.frame_residuals(residual, every, every)
    return figure
