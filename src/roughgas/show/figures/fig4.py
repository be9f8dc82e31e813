"""Fig. 4: Coulomb friction. R against its coefficient, for several beta_0, forced and cooling."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.show.figures.axis import FRICTION
from roughgas.show.figures.panel import TWO_WIDE, Part, Series, ratio_figure, series_for_each

RESTITUTION = 0.9
COMMON = {"theories": "lines: rate equations", "axis": FRICTION}


def draw(bed: xr.Dataset, cooling: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed and of the cooling gas with friction.

    mu = 0, where R = 0, has no place on a logarithmic axis; it is in the data.
    """
    bed, cooling = (data.sel(mu=data.mu > 0.0) for data in (bed, cooling))
    forced, free = (
        series_for_each(data, "beta", r"\beta_0", r=RESTITUTION) for data in (bed, cooling)
    )
    return ratio_figure(
        Part(rf"Vibrated bed, $r = {RESTITUTION:g}$", [bed], forced, **COMMON),
        Part(
            rf"Cooling gas, $r = {RESTITUTION:g}$",
            [cooling],
            free,
            loc="upper right",
            scale=[_where_one_is_stable(one) for one in free],
            extra=lambda main: _shade_where_two_are_stable(main, free[0]),
            **COMMON,
        ),
        width=TWO_WIDE,
    )


def _where_one_is_stable(one: Series) -> Series:
    """Return the part of a series where R = 1 is not stable, too."""
    beyond = one.at > theory.critical_friction(RESTITUTION)
    return one._replace(data=one.data.isel(mu=beyond), at=one.at[beyond], theory=one.theory[beyond])


def _shade_where_two_are_stable(main: Axes, cooling: Series) -> None:
    """Shade from where theory has a stationary R < 1 up to where R = 1 ceases to be stable."""
    first = FRICTION.grid[np.argmax(cooling.predict(beta=0.0, mu=FRICTION.grid) < 1.0)]
    last = theory.critical_friction(RESTITUTION)
    label = r"two stable states, $R = 1$ the other"
    main.axvspan(first, last, color="0.9", linewidth=0, zorder=0, label=label)
