"""Coulomb friction. R against its coefficient, for several beta_0, forced and cooling."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import TWO_WIDE, Style

BED = "A bed follows the rate equations"
COOLING = "A cooling gas does, unless spins run away"
COMMON: Style = {
    "symbol": r"\beta_0",
    "theories": "lines: rate equations",
    "axis": plotting.FRICTION,
}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed and of the cooling gas with friction.

    mu = 0, where R = 0, has no place on a logarithmic axis; it is in the data.
    """
    bed, cooling = (data.sel(mu=data.mu > 0.0) for data in (bed, cooling))
    columns = {"loc": "upper left", "ncols": 2}
    free: Style = {"legend": {"loc": "upper right"}, "scale": _staying, "extra": _tell_of_runaways}
    return plotting.ratio_figure(
        plotting.content_for_each_beta("Vibrated bed", bed, message=BED, legend=columns, **COMMON),
        plotting.content_for_each_beta("Cooling gas", cooling, message=COOLING, **COMMON, **free),
        width=TWO_WIDE,
    )


def _staying(drawn: Sequence[plotting.Series]) -> list[plotting.Series]:
    """Return the parts of series where R is nearer to theory than to 1, which spin has not left."""
    parts = []
    for one in drawn:
        stays = abs(one.residual) <= 1 - one.data.R.values
        data = one.data.isel(mu=stays)
        parts.append(one._replace(data=data, at=one.at[stays], theory=one.theory[stays]))
    return parts


def _tell_of_runaways(panel: plotting.Panel, drawn: Sequence[plotting.Series]) -> None:
    """Say in the legend what points above the lines are."""
    if any((abs(one.residual) > 1 - one.data.R.values).any() for one in drawn):
        panel.main.plot([], [], " ", label="above lines: runaway spins")
