"""Fig. 7: the moment of inertia, from a ring (q = 1) towards a point mass in the centre (q = 0)."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.axis import INERTIA
from roughgas.show.figures.panel import TWO_WIDE, Part, ratio_figure, series_for_each

RESTITUTION = 0.9


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of disks with several moments of inertia."""
    parts = [
        Part(
            rf"{name}, $r = {RESTITUTION:g}$",
            [data],
            series_for_each(data, "beta", r"\beta", r=RESTITUTION),
            theories=f"lines: theory, {equation}",
            loc="best",
            axis=INERTIA,
        )
        for name, data, equation in (
            ("Vibrated bed", bed, "Eq. (lun)"),
            ("Cooling gas", cooling, "Eq. (K)"),
        )
    ]
    return ratio_figure(*parts, width=TWO_WIDE)
