"""Fig. 5: drives that put energy into rotation, too. R against their share of it.

A stochastic drive has the share that is chosen. A floor and shaken side walls that are rough have
the one that their energy books say.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.figures.axis import SPIN_SHARE
from roughgas.show.style import GREY, LOOKS, Look

RESTITUTION = 0.9
NAMES = {
    "heated": ("stochastic drive", "o"),
    "floor_materials": ("rough floor", "^"),
    "shaken_walls": ("rough shaken walls", "D"),
}


def draw(heated: xr.Dataset, floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the three drives: colours and lines tell beta,
    symbols the drive."""
    figure, (one,) = panel.ratio_panels([SPIN_SHARE], width=panel.ONE_WIDE)
    drawn = []
    for data, (label, marker) in zip((heated, floor, walls), NAMES.values(), strict=True):
        looks = [look._replace(marker=marker) for look in LOOKS]
        place = _over_share if data is heated else _over_measured_share
        part = [
            place(data, look, beta) for beta, look in zip(data.beta.values, looks, strict=False)
        ]
        panel.draw_series(one.main, one.residual, part, one.axis)
        one.main.plot([], [], marker, color=GREY, label=label)
        drawn += part
    of_each_beta = drawn[: heated.beta.size]
    lines = [series._replace(look=series.look._replace(marker="")) for series in of_each_beta]
    for series, beta in zip(lines, heated.beta.values, strict=True):
        panel.draw_theory(one.main, heated, series.look, one.axis, r=RESTITUTION, beta=beta)
    one.main.set_ylim(0.03, 1.12)  # room for the legend
    panel.frame_residuals(one.residual, drawn, drawn)
    panel.legend(one.main, lines, "", title="lines: rate equations", loc="upper left")
    panel.caption(one.main, [heated], rf"Driven disks, $r = {RESTITUTION:g}$")
    return figure


def _over_share(data: xr.Dataset, look: Look, beta: float) -> panel.Series:
    return panel.series(data, rf"$\beta = {beta:g}$", look, r=RESTITUTION, beta=beta)


def _over_measured_share(data: xr.Dataset, look: Look, beta: float) -> panel.Series:
    """R over the share of the drive's work that was measured to go into rotation."""
    place = {"r": RESTITUTION, "beta": beta}
    share = data.input_spin_share.sel(place).values
    theory = panel.prediction(data, **place, spin_share=share)
    return _over_share(data, look, beta)._replace(at=share, theory=theory)
