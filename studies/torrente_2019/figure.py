"""Figure of two gases with the same noise: their temperatures over time, and the rate equations."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import LINE_STYLES, WIDTH, judged_title, particles_of

from .gases import temperatures

SIZE = (WIDTH, 2.9)  # inches


def draw(hot: xr.Dataset, cold: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the hotter gas and of the colder one."""
    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.subplots()
    for gas, name, style in zip((hot, cold), ("hotter", "colder"), LINE_STYLES, strict=False):
        curve = temperatures(gas)
        mean, stderr = curve.mean(), curve.stderr()
        axes.errorbar(
            curve.time, mean, stderr, fmt=style.marker, ms=2.5, color=style.colour, label=name
        )
        axes.plot(curve.time, curve.expected, color=style.colour, lw=0.9, zorder=1)
    axes.axvspan(curve.measured_from, curve.time[-1], color="0.92", zorder=0, label="compared")
    axes.plot([], [], color="0.3", lw=0.9, label="rate equations")
    axes.set(xlabel="time / $T$", ylabel=r"$T = (T_\mathrm{tr} + T_\mathrm{rot})/2$")
    axes.set_ylim(bottom=0.0)
    title = judged_title(__file__, "hotter_gets_colder", [hot, cold], "Temperatures of two gases")
    axes.set_title(title, fontsize=8.5, fontweight="bold", loc="left")
    figure.suptitle(
        f"Spheres with the same noise, $r = 0.7$, $\\beta = 0$, $N = {particles_of(hot)}$",
        fontsize=8,
    )
    axes.legend(frameon=False, fontsize=7)
    return figure
