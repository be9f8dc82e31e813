"""Fig. 7: the moment of inertia, from a ring (q = 1) towards a point mass in the centre (q = 0)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.figures.axis import INERTIA
from roughgas.show.style import LOOKS

RESTITUTION = 0.9
NAMES = {
    "vibrated_inertia": ("Vibrated bed", "lines: theory, Eq. (lun)"),
    "cooling_inertia": ("Cooling gas", "lines: theory, Eq. (K)"),
}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of disks with several moments of inertia."""
    figure, panels = panel.ratio_panels([INERTIA] * 2, width=panel.TWO_WIDE)
    every = []
    for data, (name, theory), (main, residual, axis) in zip(
        (bed, cooling), NAMES.values(), panels, strict=True
    ):
        drawn = []
        for beta, look in zip(data.beta.values, LOOKS, strict=False):
            place = {"r": RESTITUTION, "beta": beta}
            drawn.append(panel.series(data, rf"$\beta = {beta:g}$", look, **place))
            panel.draw_theory(main, data, look, axis, **place)
        panel.draw_series(main, residual, drawn, axis)
        panel.legend(main, drawn, "", title=theory, loc="best")
        panel.caption(main, [data], rf"{name}, $r = {RESTITUTION:g}$")
        every += drawn
    for _, residual, _ in panels:
        panel.frame_residuals(residual, every, every)
    return figure
