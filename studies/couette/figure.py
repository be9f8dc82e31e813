"""Couette flow between rough walls next to shear between sliding images: R, and the shear rates."""

import json
import math

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import FAINT, GREY, LINE_STYLES, THEORY, key, predicted_ratio
from roughgas.theory import lun_ratio

SIZE = (4.6, 5.2)  # inches
GASES = {"rough walls": "o", "sliding images": "D"}
"""Their markers, in the order of the datasets."""
EXPECTED_LABEL = "rate equations, measured share of rotation"
DRAWN = "R between rough walls, and between sliding images"


def draw(couette: xr.Dataset, sheared: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of Couette flow and of the sheared gas.

    Colours stand for r; only values of r and beta in both datasets are drawn. The rate equations
    need the measured share of rotation, and are drawn at the points alone.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    betas = np.intersect1d(couette.beta, sheared.beta)
    values = sorted(np.intersect1d(couette.r, sheared.r), reverse=True)
    drawn = []
    for r, look in zip(values, LINE_STYLES, strict=False):
        for data, marker in zip((couette, sheared), GASES.values(), strict=True):
            look = look._replace(marker=marker)
            series = plotting.series(data.sel(beta=betas), f"$r = {r:g}$", look, r=r)
            plotting.draw_points(above, series, series.x, series.data.R.values)
            beneath.plot(series.x, _reduced_rate(series.data), marker, color=look.colour, ms=3.6)
            if data is couette and "input_spin_share" in series.data:
                above.plot(
                    series.x, _expected_ratio(series.data), "_", color=look.colour, ms=10, mew=1.2
                )
            drawn.append(series)
    grid = np.linspace(-1, 1, 401)
    above.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=plotting.DOTS, zorder=0)
    above.plot(grid, lun_ratio(grid, couette.attrs["inertia"]), color=THEORY, zorder=0)
    above.set(ylabel=plotting.ENERGY_RATIO, ylim=(-0.02, 1.15))
    above.legend(handles=_legend_keys(drawn), loc="upper right")
    plotting.BETA.prepare(beneath)
    beneath.set(ylabel="shear rate\n" r"$\Gamma a\,(m/T_\mathrm{tr})^{1/2}$")
    beneath.set_ylim(0, 1.1 * beneath.get_ylim()[1])
    gases = [couette, sheared]
    message = plotting.judged_title(__file__, "couette_agrees_with_lees_edwards", gases, DRAWN)
    plotting.add_title(above, gases, "Couette flow and Lees-Edwards images", message)
    figure.align_ylabels()
    return figure


def _legend_keys(drawn: list[plotting.Series]) -> list:
    """Return the legend's keys of colours, symbols, dashes and the line."""
    looks = {series.label: series.line_style for series in drawn}
    keys = [key(look.colour, label, "s") for label, look in looks.items()]
    keys += [key(GREY, label, marker) for label, marker in GASES.items()]
    keys += [key(GREY, EXPECTED_LABEL, "_", ms=10, mew=1.2), key(THEORY, plotting.ANY_R, "", "-")]
    keys.append(key(FAINT, "equipartition", "", plotting.DOTS))
    return keys + plotting.keys_of_steadiness(drawn)


def _expected_ratio(data: xr.Dataset) -> np.ndarray:
    """Return R of the rate equations for a drive with the measured share of rotation."""
    share = data.input_spin_share.values
    return predicted_ratio(data.attrs | {"spin_share": share}, float(data.r), data.beta.values)


def _reduced_rate(data: xr.Dataset) -> np.ndarray:
    """Return the shear rate over the thermal speed, per radius."""
    rate = data.shear_rate if "shear_rate" in data else _rate_of_images(data)
    return rate / np.sqrt(2 * data.E_trans)


def _rate_of_images(data: xr.Dataset) -> float:
    """Return the shear rate of sliding images, from the dataset's settings."""
    settings = json.loads(data.attrs.get("experiment_json", "{}"))
    if "shear" not in settings.get("effects", {}):
        return math.nan
    return float(settings["effects"]["shear"]["velocity"]) / float(settings["box"][1])
