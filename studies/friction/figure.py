"""Coulomb friction: R against its coefficient, for several beta_0, forced and cooling."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import TWO_WIDE, Style, content_for_each_beta, judged_title

BED = "vibrated_friction_follows_rates", "R of a bed with Coulomb friction"
COOLING = "cooling_friction_follows_rates", "R of a cooling gas with friction"
"""Statement that titles each panel where it holds, and its title elsewhere."""
COMMON: Style = {
    "symbol": r"\beta_0",
    "theories": "lines: rate equations",
    "axis": plotting.FRICTION,
}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed and of the cooling gas with friction.

    The data also hold mu = 0, where R = 0; the logarithmic axis leaves it out.
    """
    titles = [
        judged_title(__file__, statement, [data], drawn)
        for data, (statement, drawn) in zip((bed, cooling), (BED, COOLING), strict=True)
    ]
    bed, cooling = (data.sel(mu=data.mu > 0.0) for data in (bed, cooling))
    columns = {"loc": "upper left", "ncols": 2}
    free: Style = {
        "legend": {"loc": "lower left"},
        "extra": _label_runaways,
    }
    return plotting.ratio_figure(
        content_for_each_beta("Vibrated bed", bed, message=titles[0], legend=columns, **COMMON),
        content_for_each_beta("Cooling gas", cooling, message=titles[1], **COMMON, **free),
        width=TWO_WIDE,
        rows=[plotting.Row(scale=_near_theory)],
    )


def _near_theory(drawn: Sequence[plotting.Series]) -> list[plotting.Series]:
    """Return the points of each series whose R is nearer to theory than to 1, its value after a
    runaway."""
    retained = []
    for series in drawn:
        near_theory = abs(series.residual) <= 1 - series.data.R.values
        data = series.data.isel(mu=near_theory)
        retained.append(
            series._replace(data=data, x=series.x[near_theory], theory=series.theory[near_theory])
        )
    return retained


def _label_runaways(panel: plotting.Panel, drawn: Sequence[plotting.Series]) -> None:
    """Add a line to the legend for points far above the lines."""
    if any((abs(series.residual) > 1 - series.data.R.values).any() for series in drawn):
        panel.main.plot([], [], " ", label="above lines: runaway spins")
