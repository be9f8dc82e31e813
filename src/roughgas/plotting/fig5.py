"""Fig. 5: drives that put energy into rotation, too. R against their share of it.

A stochastic drive has the share that is chosen. A floor and shaken side walls that are rough have
the one that their energy books say.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import panel
from roughgas.plotting.axis import SPIN_SHARE
from roughgas.plotting.style import LOOKS, Look

RESTITUTION = 0.9
NAMES = {
    "heated": ("stochastic drive", "o"),
    "floor_materials": ("rough floor", "^"),
    "shaken_walls": ("rough shaken walls", "D"),
}
EXPERIMENTS = tuple(NAMES)


def draw(heated: xr.Dataset, floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the three drives."""
    figure, (one,) = panel.ratio_panels([SPIN_SHARE], width=panel.ONE_WIDE)
    drawn = []
    for beta, look in zip(heated.beta.values, LOOKS, strict=False):
        place = {"r": RESTITUTION, "beta": beta}
        panel.draw_theory(one.main, heated, look, one.axis, **place)
        drawn.append(panel.series(heated, rf"$\beta = {beta:g}$", look, **place))
    for data, (label, marker) in zip((floor, walls), list(NAMES.values())[1:], strict=True):
        drawn += [
            _boundary_drive(data, label, look._replace(marker=marker), beta)
            for beta, look in zip(heated.beta.values, LOOKS, strict=False)
            if beta in data.beta
        ]
    panel.draw_series(one.main, one.residual, drawn, one.axis)
    panel.frame_residuals(one.residual, drawn, drawn)
    panel.legend(one.main, drawn, "", title="lines: rate equations", loc="lower right")
    panel.caption(one.main, [heated], rf"Driven disks, $r = {RESTITUTION:g}$")
    return figure


def _boundary_drive(data: xr.Dataset, label: str, look: Look, beta: float) -> panel.Series:
    """R over the share of the drive's work that was measured to go into rotation."""
    place = {"r": RESTITUTION, "beta": beta}
    found = panel.series(data, rf"{label}, $\beta = {beta:g}$", look, **place)
    share = data.input_spin_share.sel(place).values
    theory = panel.prediction(data, **place, spin_share=share)
    return found._replace(at=share, theory=theory)
