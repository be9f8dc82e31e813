"""Fig. 8: what the boundaries are made of. How far they shift R, and how much rotation they put in.

Shifts are from the same bed with a smooth boundary, beside those that the rate equations expect of
the measured share of rotation: what sets a bed apart from theory anyway is not shown (Fig. 1a is).
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.base.errors import InputError
from roughgas.show.figures import panel
from roughgas.show.style import THEORY

SMOOTH = -1.0
SIZE = (6.4, 4.6)  # inches
MESSAGES = {
    "Rough floor": "A floor matters by the spin it puts in",
    "Rough side walls": "So do side walls",
}


def draw(floor: xr.Dataset, walls: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed on rough floors and between rough walls.

    Raises InputError where a sweep has no smooth boundary.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 2, sharex="col", sharey="row")
    parts = (floor, "Rough floor"), (walls, "Rough side walls")
    for upper, lower, (data, name) in zip(above, beneath, parts, strict=True):
        if SMOOTH not in data.roughness:
            given = data.roughness.values
            raise InputError(f"roughness of {data.attrs['experiment']}", given, "include -1")
        for one in panel.series_for_each(data, "beta"):
            _draw_shift(upper, one)
            _draw_share(lower, one)
        for axes in (upper, lower):
            axes.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
        panel.ROUGHNESS.prepare(lower)
        panel.add_title(upper, [data], rf"{name}, $r = {panel.RESTITUTION:g}$", MESSAGES[name])
    above[0].legend(title="lines: rate equations", loc="upper left")
    above[0].set_ylabel("$R$ minus $R$ with\na smooth boundary")
    beneath[0].set_ylabel("share of rotation in\nthe energy put in")
    figure.align_ylabels()
    return figure


def _draw_shift(axes: Axes, one: panel.Series) -> None:
    """Draw the shift of R from the smooth boundary, measured and expected."""
    smooth, rough = one.data.sel(roughness=SMOOTH), one.at > SMOOTH
    error = np.hypot(one.data.R_stderr, smooth.R_stderr).where(rough, 0)
    shifted = one._replace(data=one.data.assign(R_stderr=error))
    expected = one.predict(spin_share=one.data.input_spin_share.values) - one.predict(spin_share=0)
    colour, marker, line = one.look
    axes.plot(one.at, expected, color=colour, linestyle=line, zorder=1)
    panel.draw_points(axes, shifted, one.at, (one.data.R - smooth.R).values)
    axes.plot([], [], color=colour, marker=marker, linestyle=line, label=one.label)


def _draw_share(axes: Axes, one: panel.Series) -> None:
    """Draw the share of rotation in the energy that all sources put in."""
    shared = one._replace(data=one.data.assign(R_stderr=one.data.input_spin_share_stderr))
    panel.draw_points(axes, shared, one.at, one.data.input_spin_share.values)
