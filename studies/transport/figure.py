"""How long velocities are remembered, how far particles get, and what they carry."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from roughgas import theory
from roughgas.judging import Estimate
from roughgas.plotting import GREY, LOOKS, THEORY, Style, particles_of

from .coefficients import (
    REMEMBERED,
    between_walls,
    by_displacement,
    expected,
    in_equilibrium,
    in_shear,
    per_collision,
    point,
    temperature,
)

SIZE = (7.0, 3.4)  # inches
SHOWN = 5.0
"""Collisions per particle up to which memory is drawn."""
MESSAGES = "Rough particles forget faster", "Inelastic particles remember longer"
CARRIED = "Roughness makes a gas more viscous", "Elastic gases beside theory"
WALLS = "conductivity, between walls"
WAYS = {"viscosity": "o", "conductivity": "s", WALLS: "D", f"{WALLS} twice as far": "^"}
"""Markers of coefficients."""


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
    _tell((left, right), MESSAGES)
    numbers = f"elastic: N = {particles_of(rough_disks)}, driven: N = {particles_of(heated)}"
    figure.suptitle(f"Dilute gases, packing 0.01; {numbers}", fontsize=8)
    return figure


def draw_fluxes(strained: xr.Dataset, *elastic: xr.Dataset) -> Figure:
    """Draw viscosity and conductivity, of driven and of elastic gases."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    _draw_viscosity(left, strained)
    _draw_elastic(right, elastic)
    _tell((left, right), CARRIED)
    walled = sorted({gas.attrs["particles"] for gas in elastic if "heat_flux" in gas})
    numbers = f"driven: N = {particles_of(strained)}, elastic: N = {particles_of(elastic[0])}"
    numbers += f", between walls: N = {walled[0]} to {walled[-1]}"
    figure.suptitle(f"Packing 0.01, between walls 0.05; {numbers}", fontsize=8)
    return figure


def _tell(panels: Sequence[Axes], messages: Sequence[str]) -> None:
    for axes, message in zip(panels, messages, strict=True):
        axes.set_title(message, fontsize=8.5, fontweight="bold", loc="left")


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
    about = gas.attrs["packing"], gas.attrs["dimension"], gas.attrs["inertia"]
    nu = theory.collision_frequency(1.0, *about[:2])

    def line(r, beta):
        return nu * theory.self_diffusion(1.0, about[0], r, beta, *about[1:])

    _draw_driven(axes, gas, by_displacement, line)
    axes.set(ylabel=r"$D_s\,\nu/T$")
    axes.axhline(1.0, color=GREY, lw=0.7, ls=":", zorder=0)


def _draw_viscosity(axes: Axes, gas: xr.Dataset) -> None:
    """Draw viscosities at no shear; theory has the T_rot/T_tr of Lun's formula."""
    packing, dimension, q = gas.attrs["packing"], gas.attrs["dimension"], gas.attrs["inertia"]
    unit = theory.collision_frequency(1.0, packing, dimension)
    unit = float(unit / theory.number_density(packing, dimension))

    def line(r, beta):
        R = theory.lun_ratio(beta, q)
        places = packing, r, beta, dimension, q
        return unit * theory.shear_viscosity(1.0, R / (1.0 - R), *places)

    def found(one):
        theta = 2.0 * one.E_rot.values[0] / temperature(one).values[0]
        places = packing, float(one.r), float(one.beta), dimension, q
        return in_shear(one)[-1].scaled(unit * float(theory.shear_viscosity(1.0, theta, *places)))

    _draw_driven(axes, gas, found, line)
    axes.set(ylabel=r"viscosity $\times\ \nu/(n T)$")


def _draw_driven(
    axes: Axes,
    gas: xr.Dataset,
    estimate: Callable[[xr.Dataset], Estimate],
    line: Callable[[float, np.ndarray], np.ndarray],
) -> None:
    """Draw a coefficient of driven disks over their roughness, and theory."""
    fine, keys = np.linspace(-1.0, 1.0, 101), [Line2D([], [], color=THEORY, lw=0.9, label="theory")]
    for r, look in zip(sorted(gas.r.values, reverse=True), LOOKS, strict=False):
        there = [gas.sel(r=r, beta=beta) for beta in gas.beta.values]
        there = [one for one in there if np.isfinite(one.R).all()]
        found = [estimate(one) for one in there]
        at, values = [float(one.beta) for one in there], [one.value for one in found]
        style: Style = {"fmt": look.marker, "color": look.colour, "ms": 4, "lw": 0.9}
        axes.errorbar(at, values, [one.stderr for one in found], **style)
        axes.plot(fine, line(r, fine), color=look.colour, lw=0.9)
        keys.append(
            Line2D([], [], ls="none", marker=look.marker, color=look.colour, label=f"$r = {r:g}$")
        )
    axes.set(xlabel=r"$\beta$", xlim=(-1.05, 1.05))
    axes.legend(handles=keys, title="driven disks", loc="best")


def _draw_elastic(axes: Axes, gases: Sequence[xr.Dataset]) -> None:
    """Draw coefficients of elastic gases over theory."""
    kinds: list[str] = []
    for gas in map(point, gases):
        kind = f"{'smooth' if gas.beta == -1.0 else 'rough'}\n"
        kind += "disks" if gas.attrs["dimension"] == 2 else "spheres"
        kinds += [] if kind in kinds else [kind]
        if "heat_flux" in gas:
            far = gas.attrs["experiment"].endswith("far_walls")
            found = {f"{WALLS} twice as far" if far else WALLS: between_walls(gas)}
        else:
            found = {name: in_equilibrium(gas, name)[-1] for name in REMEMBERED}
        for number, (way, marker) in enumerate(WAYS.items()):
            if way in found:
                value, stderr, _ = found[way]
                at, colour = kinds.index(kind) + 0.2 * (number - 1.5), LOOKS[number].colour
                axes.errorbar(at, value, stderr, fmt=marker, color=colour, ms=4, lw=0.9)
    keys = [
        Line2D([], [], ls="none", marker=marker, color=look.colour, label=way)
        for (way, marker), look in zip(WAYS.items(), LOOKS, strict=False)
    ]
    axes.axhline(1.0, color=THEORY, lw=0.9, zorder=0)
    axes.set(xticks=range(len(kinds)), xticklabels=kinds, ylabel="coefficient over theory")
    axes.set(xlim=(-0.5, len(kinds) - 0.5))
    axes.tick_params(axis="x", which="minor", length=0)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.4 * (high - low))
    axes.legend(handles=keys, loc="upper left")
