"""Shift of R by the roughness of the boundaries.

Shifts are from the same bed with a smooth boundary, next to the shifts that the rate equations
predict from the measured share of rotation. So deviations of the bed itself from theory do not show
(see Fig. 1a).
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import GREY, THEORY, TWO_WIDE, InputError

SMOOTH = -1.0
PANELS = {
    "Rough floor": ("only_spinning_floors_matter", "Shift of R by a rough floor"),
    "Rough side walls": ("only_spinning_walls_matter", "Shift of R by rough side walls"),
}
"""Statement that titles a panel where it holds, and its title elsewhere."""


def draw(floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed on rough floors and between rough walls.

    Raises InputError where a sweep has no smooth boundary.
    """
    figure = Figure(figsize=(TWO_WIDE, 3.2), layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    drawn: list[plotting.Series] = []
    for axes, data, (name, title) in zip(panels, (floor, walls), PANELS.items(), strict=True):
        if SMOOTH not in data.roughness:
            roughness = data.roughness.values
            raise InputError(f"roughness of {data.attrs['experiment']}", roughness, "include -1")
        drawn += (curves := plotting.series_for_each(data, "beta"))
        for curve in curves:
            _draw_shift(axes, curve)
        axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
        plotting.ROUGHNESS.prepare(axes)
        statement, title_of_data = title
        message = plotting.judged_title(__file__, statement, [data], title_of_data)
        plotting.add_title(axes, [data], rf"{name}, $r = {plotting.RESTITUTION:g}$", message)
    panels[0].plot([], [], "_", color=GREY, markersize=11, label="rate equations")
    panels[0].legend(loc="upper left")
    plotting.add_notes(figure, drawn)
    panels[0].set_ylabel("$R$ minus $R$ with\na smooth boundary")
    return figure


def _draw_shift(axes: Axes, series: plotting.Series) -> None:
    """Draw the shift of R from the smooth boundary, measured and expected."""
    smooth, rough = series.data.sel(roughness=SMOOTH), series.x > SMOOTH
    error = np.hypot(series.data.R_stderr, smooth.R_stderr).where(rough, 0)
    shifted = series._replace(data=series.data.assign(R_stderr=error))
    expected = series.predict(spin_share=series.data.input_spin_share.values) - series.predict(
        spin_share=0
    )
    axes.plot(series.x, expected, "_", color=series.line_style.colour, markersize=11, zorder=1)
    plotting.draw_points(axes, shifted, series.x, (series.data.R - smooth.R).values)
    axes.plot([], [], series.line_style.marker, color=series.line_style.colour, label=series.label)
