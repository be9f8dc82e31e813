"""Couette flow between rough walls, beside shear between sliding images: R, and the shear rates."""

import json
import math

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import ANY_R, ENERGY_RATIO, add_title
from roughgas.show.style import GREY, LOOKS, THEORY
from roughgas.theory.closed_forms import lun_ratio
from roughgas.theory.prediction import predicted_ratio

SIZE = (5.6, 5.2)  # inches
GASES = "rough walls", "sliding images"


def draw(couette: xr.Dataset, sheared: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of Couette flow and of the sheared gas.

    Filled symbols stand for walls, open ones for images; only values of r and beta of both.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    betas = np.intersect1d(couette.beta, sheared.beta)
    values = sorted(np.intersect1d(couette.r, sheared.r), reverse=True)
    for r, look in zip(values, LOOKS, strict=False):
        for data, name, fill in zip((couette, sheared), GASES, ("full", "none"), strict=True):
            one = data.sel(r=r, beta=betas)
            style = {"color": look.colour, "fmt": look.marker, "fillstyle": fill, "ms": 4}
            above.errorbar(
                betas, one.R, one.R_stderr, label=f"$r = {r:g}$, {name}", capsize=1.5, **style
            )
            if data is couette and "input_spin_share" in one:
                above.plot(betas, _at_share(one), color=look.colour, lw=0.9, zorder=1)
            beneath.plot(betas, _rate(one), look.marker, color=look.colour, fillstyle=fill, ms=4)
    grid = np.linspace(-1, 1, 401)
    above.plot(grid, lun_ratio(grid, couette.attrs["inertia"]), color=THEORY, label=ANY_R, zorder=0)
    above.set(ylabel=ENERGY_RATIO, ylim=(0, 1.02))
    above.plot(
        [], [], color=GREY, lw=0.9, label="rate equations at the\nmeasured share of rotation"
    )
    above.legend(fontsize=6.5, ncols=2)
    beneath.set(xlabel=r"roughness $\beta$", ylabel=r"$\Gamma a\,(m/T_\mathrm{tr})^{1/2}$", ylim=0)
    message = "Rough walls that slide put in spin, sliding images do not"
    add_title(above, [couette, sheared], "Couette flow and Lees-Edwards images", message)
    return figure


def _at_share(data: xr.Dataset) -> np.ndarray:
    """Return R of the rate equations for a drive with the measured share of rotation."""
    share = data.input_spin_share.values
    return predicted_ratio(data.attrs | {"spin_share": share}, float(data.r), data.beta.values)


def _rate(data: xr.Dataset) -> np.ndarray:
    """Return the shear rate over the thermal speed, per radius."""
    rate = data.shear_rate if "shear_rate" in data else _rate_of_images(data)
    return rate / np.sqrt(2 * data.E_trans)


def _rate_of_images(data: xr.Dataset) -> float:
    """Return that of sliding images, from the settings that the dataset was made with."""
    settings = json.loads(data.attrs.get("experiment_json", "{}"))
    if "shear" not in settings.get("effects", {}):
        return math.nan
    return float(settings["effects"]["shear"]["velocity"]) / float(settings["box"][1])
