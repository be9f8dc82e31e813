"""What the boundaries are made of, and how far that shifts R.

Shifts are from the same bed with a smooth boundary, beside those that the rate equations expect of
the measured share of rotation: what sets a bed apart from theory anyway is not shown (Fig. 1a is).
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import THEORY, TWO_WIDE, InputError

SMOOTH = -1.0
MESSAGE = "Boundaries shift R by the spin they put in"


def draw(floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed on rough floors and between rough walls.

    Raises InputError where a sweep has no smooth boundary.
    """
    figure = Figure(figsize=(TWO_WIDE, 3.2), layout="constrained")
    both = figure.subplots(1, 2, sharey=True)
    drawn: list[plotting.Series] = []
    parts = (floor, "Rough floor", MESSAGE), (walls, "Rough side walls", "")
    for axes, (data, name, message) in zip(both, parts, strict=True):
        if SMOOTH not in data.roughness:
            given = data.roughness.values
            raise InputError(f"roughness of {data.attrs['experiment']}", given, "include -1")
        drawn += (series := plotting.series_for_each(data, "beta"))
        for one in series:
            _draw_shift(axes, one)
        axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
        plotting.ROUGHNESS.prepare(axes)
        plotting.add_title(axes, [data], rf"{name}, $r = {plotting.RESTITUTION:g}$", message)
    both[0].legend(title="dashes: rate equations", loc="upper left")
    plotting.add_notes(figure, drawn)
    both[0].set_ylabel("$R$ minus $R$ with\na smooth boundary")
    return figure


def _draw_shift(axes: Axes, one: plotting.Series) -> None:
    """Draw the shift of R from the smooth boundary, measured and expected."""
    smooth, rough = one.data.sel(roughness=SMOOTH), one.at > SMOOTH
    error = np.hypot(one.data.R_stderr, smooth.R_stderr).where(rough, 0)
    shifted = one._replace(data=one.data.assign(R_stderr=error))
    expected = one.predict(spin_share=one.data.input_spin_share.values) - one.predict(spin_share=0)
    axes.plot(one.at, expected, "_", color=one.look.colour, markersize=11, zorder=1)
    plotting.draw_points(axes, shifted, one.at, (one.data.R - smooth.R).values)
    axes.plot([], [], one.look.marker, color=one.look.colour, label=one.label)
