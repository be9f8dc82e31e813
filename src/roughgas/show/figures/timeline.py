"""A point over time: R(t) beside its mean and theory, and both energies."""

import math

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.data.netcdf import unit_of
from roughgas.data.variables import CLOCKS, ENERGY, START
from roughgas.show.style import LOOKS, THEORY, Style
from roughgas.statistics.errors import Estimate, block_means
from roughgas.theory.prediction import equation_of

SIZE = 6.0, 4.6  # inches
MOST = 400  # places along a line
WINDOW = "#eeeeee"
ENERGIES = {"E_trans": r"$E_\mathrm{trans}$", "E_rot": r"$E_\mathrm{rot}$"}
UNITS = {START: r"initial $E_\mathrm{trans}$", ENERGY: r"($m a^2/T^2$)"}
TRUST = {0: ", not trusted", -1: ", whether to trust it is not known"}


def draw(point: xr.Dataset, theory: float) -> Figure:
    """Draw the time series of a point, the window in which it is measured shaded.

    `theory` is R of theory; NaN for none. A series of many samples is drawn as means over blocks.
    """
    clock = next(name for name in CLOCKS[::-1] if name in point)
    cooling, spins = clock == "collisions_per_particle", "R_series" in point
    at = point[clock].values
    window = float(point.measured_from), float(point.get("plateau_end", at[-1]))
    block = math.ceil(at.size / MOST)
    figure = Figure(figsize=SIZE, layout="constrained")
    every = figure.subplots(1 + spins, 1, sharex=True, squeeze=False)[:, 0]
    for axes in every:
        axes.axvspan(*window, color=WINDOW, zorder=0)
        axes.set_xlim(at[0] - (at[-1] - at[0]) / 50, at[-1] + (at[-1] - at[0]) / 50)
    if spins:
        _draw_ratio(every[0], point, theory, at, block, window)
    _draw_energies(every[-1], point, at, block, cooling)
    every[-1].set_xlabel("collisions per particle" if cooling else "time / $T$")
    averaged = f"; lines: means over {block} samples" if block > 1 else ""
    every[0].set_title(f"{_title(point)}\nshaded: where R is measured{averaged}", fontsize=8)
    return figure


def _draw_ratio(axes: Axes, point, theory, at, block, window) -> None:
    look, R, half = LOOKS[0], float(point.R), float(point.R_ci95)
    shown = block_means(point.R_series.values, block)
    axes.plot(block_means(at, block), shown, color=look.colour, linewidth=0.8, label="$R(t)$")
    mean = Estimate(R, float(point.R_stderr))
    trust = TRUST.get(int(point.get("R_ci95_trusted", 1)), "")
    axes.plot(window, (R, R), color=LOOKS[1].colour, label=f"mean of $R(t)$: {mean}")
    band: Style = {"alpha": 0.3, "linewidth": 0.0, "label": f"95 % interval{trust}"}
    axes.fill_between(window, R - half, R + half, color=LOOKS[1].colour, **band)
    if "R_collisional" in point:
        found = Estimate(float(point.R_collisional), float(point.R_collisional_stderr))
        about: Style = {"color": LOOKS[2].colour, "linestyle": LOOKS[2].line}
        axes.plot(window, [found.value] * 2, label=f"over collisions: {found}", **about)
    if math.isfinite(theory):
        name = equation_of(point.attrs, point).name
        axes.axhline(theory, color=THEORY, linestyle="--", label=f"{name}: {theory:.4f}")
    levels = [*shown[np.isfinite(shown)], R - half, R + half, theory]
    low, high = np.nanmin(levels), np.nanmax(levels)
    room = 0.05 * ((high - low) or 0.1)
    axes.set(ylabel="$R$", ylim=(low - room, high + room))
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _draw_energies(axes: Axes, point, at, block, cooling) -> None:
    for (name, label), look in zip(ENERGIES.items(), LOOKS, strict=False):
        if f"{name}_series" in point:
            values = block_means(point[f"{name}_series"].values, block)
            style: Style = {"color": look.colour, "linestyle": look.line, "linewidth": 0.9}
            axes.plot(block_means(at, block), values, label=label, **style)
    unit = UNITS.get(unit_of(point.E_trans.attrs), "1")
    axes.set_ylabel(f"energy per degree of\nfreedom / {unit}")
    axes.set_yscale("log" if cooling else "linear")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def _title(point: xr.Dataset) -> str:
    about = point.attrs
    name = "/".join(about[key] for key in ("experiment", "variant") if key in about)
    place = rf"$r = {about['r']:g}$, $\beta = {about['beta']:g}$"
    return f"{name.replace('_', ' ')}: {place}, $N = {about['particles']}$, seed {about['seed']}"
