"""Fig. 4: Coulomb friction. R against its coefficient, for several beta_0, forced and cooling."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.show.figures import panel

LAST = theory.critical_friction(panel.RESTITUTION)
"""Up to this coefficient, R = 1 is stable in a cooling gas."""
COMMON = {"symbol": r"\beta_0", "theories": "lines: rate equations", "axis": panel.FRICTION}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed and of the cooling gas with friction.

    mu = 0, where R = 0, has no place on a logarithmic axis; it is in the data.
    """
    bed, cooling = (data.sel(mu=data.mu > 0.0) for data in (bed, cooling))
    free = {"loc": "upper right", "scale": _beyond, "extra": _shade_where_two_are_stable}
    return panel.ratio_figure(
        panel.content_for_each_beta("Vibrated bed", bed, **COMMON),
        panel.content_for_each_beta("Cooling gas", cooling, **COMMON, **free),
        width=panel.TWO_WIDE,
    )


def _beyond(drawn: Sequence[panel.Series]) -> list[panel.Series]:
    """Return the parts of series where R = 1 is not stable, too."""
    parts = []
    for one in drawn:
        beyond = one.at > LAST
        data = one.data.isel(mu=beyond)
        parts.append(one._replace(data=data, at=one.at[beyond], theory=one.theory[beyond]))
    return parts


def _shade_where_two_are_stable(main: Axes, drawn: Sequence[panel.Series]) -> None:
    """Shade from where theory has a stationary R < 1 up to where R = 1 ceases to be stable."""
    along = panel.FRICTION.grid
    first = along[np.argmax(drawn[0].predict(beta=0.0, mu=along) < 1.0)]
    label = r"two stable states, $R = 1$ the other"
    main.axvspan(first, LAST, color="0.9", linewidth=0, zorder=0, label=label)
