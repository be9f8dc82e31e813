"""Self-diffusion: how long velocities are remembered, and how far particles get."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas import theory
from roughgas.plotting import GREY, LOOKS, THEORY, Style, particles_of

from .coefficients import by_displacement, expected, per_collision, point

SIZE = (7.0, 3.4)  # inches
SHOWN = 5.0
"""Collisions per particle up to which memory is drawn."""
MESSAGES = "Rough particles forget faster", "Inelastic particles remember longer"


def draw(
    rough_disks: xr.Dataset,
    smooth_disks: xr.Dataset,
    rough_spheres: xr.Dataset,
    smooth_spheres: xr.Dataset,
    heated: xr.Dataset,
) -> Figure:
    """Draw the figure from the reduced datasets of elastic and of driven gases."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    gases = {"smooth disks": smooth_disks, "rough disks": rough_disks}
    _draw_memory(left, gases | {"smooth spheres": smooth_spheres, "rough spheres": rough_spheres})
    _draw_diffusion(right, heated)
    for axes, message in zip((left, right), MESSAGES, strict=True):
        axes.set_title(message, fontsize=8.5, fontweight="bold", loc="left")
    numbers = f"elastic: N = {particles_of(rough_disks)}, driven: N = {particles_of(heated)}"
    figure.suptitle(f"Dilute gases, packing 0.01; {numbers}", fontsize=8)
    return figure


def _draw_memory(axes: Axes, gases: Mapping[str, xr.Dataset]) -> None:
    for (label, gas), look in zip(gases.items(), LOOKS, strict=False):
        one = point(gas)
        times = one.delay.values * per_collision(one)[1]
        few = np.flatnonzero(times <= SHOWN)[::2]
        memory = one.velocity_autocorrelation.values
        style: Style = {"color": look.colour, "ms": 3.5, "linestyle": "none"}
        axes.plot(times[few], memory[few] / memory[0], marker=look.marker, label=label, **style)
        fine = np.linspace(0.0, SHOWN, 100)
        axes.plot(fine, np.exp(-fine / expected(one)), color=look.colour, lw=0.9)
    axes.set(xlabel="collisions per particle", ylabel=r"$C_v(t)/C_v(0)$", yscale="log")
    axes.set(xlim=(0.0, SHOWN), ylim=(3e-3, 1.2))
    axes.legend(title="elastic; lines: theory")


def _draw_diffusion(axes: Axes, gas: xr.Dataset) -> None:
    fine, about = np.linspace(-1.0, 1.0, 101), gas.attrs
    nu = theory.collision_frequency(1.0, about["packing"], about["dimension"])
    keys = [Line2D([], [], color=THEORY, lw=0.9, label="theory")]
    for r, look in zip(sorted(gas.r.values, reverse=True), LOOKS, strict=False):
        there = [gas.sel(r=r, beta=beta) for beta in gas.beta.values]
        there = [one for one in there if np.isfinite(one.mean_square_displacement).any()]
        found = [by_displacement(one) for one in there]
        axes.errorbar(
            [float(one.beta) for one in there],
            [one.value for one in found],
            [one.stderr for one in found],
            fmt=look.marker,
            color=look.colour,
            ms=4,
            lw=0.9,
        )
        line = theory.self_diffusion(
            1.0, about["packing"], r, fine, about["dimension"], about["inertia"]
        )
        axes.plot(fine, nu * line, color=look.colour, lw=0.9)
        keys.append(
            Line2D([], [], ls="none", marker=look.marker, color=look.colour, label=f"$r = {r:g}$")
        )
    axes.set(xlabel=r"$\beta$", ylabel=r"$D_s\,\nu/T$", xlim=(-1.05, 1.05))
    axes.axhline(1.0, color=GREY, lw=0.7, ls=":", zorder=0)
    axes.legend(handles=keys, title="driven disks", loc="upper right")
