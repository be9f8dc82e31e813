"""Figures of velocity memory, diffusion, viscosity and conductivity."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.judging import Estimate
from roughgas.plotting import GREY, LINE_STYLES, THEORY, Style, key, particles_of

from . import dilute
from .coefficients import (
    MEMORY_LENGTHS,
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
SHOWN_MEMORY = 5.0
"""Collisions per particle up to which memory is drawn."""
DIFFUSION_MESSAGES = "Memory of velocities, elastic", "Diffusion of driven disks"
FLUX_MESSAGES = "Viscosity of driven disks in shear", "Elastic gases beside theory"
WALLS = "conductivity, between walls"
SMOOTH_AT = -0.04
"""Abscissa of smooth gases, which have no q."""
MARKERS = {"viscosity": "o", "conductivity": "s", WALLS: "D", f"{WALLS} twice as far": "^"}
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
    _add_messages((left, right), DIFFUSION_MESSAGES)
    numbers = f"elastic: N = {particles_of(rough_disks)}, driven: N = {particles_of(heated)}"
    figure.suptitle(f"Dilute gases, packing 0.01; {numbers}", fontsize=8)
    return figure


def draw_fluxes(strained: xr.Dataset, *elastic: xr.Dataset) -> Figure:
    """Draw viscosity and conductivity, of driven and of elastic gases."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    _draw_viscosity(left, strained)
    _draw_elastic(right, elastic)
    _add_messages((left, right), FLUX_MESSAGES)
    walled = sorted({gas.attrs["particles"] for gas in elastic if "heat_flux" in gas})
    numbers = f"driven: N = {particles_of(strained)}, elastic: N = {particles_of(elastic[0])}"
    numbers += f", between walls: N = {walled[0]} to {walled[-1]}"
    figure.suptitle(f"Packing 0.01, between walls 0.05; {numbers}", fontsize=8)
    return figure


def draw_inertia(tasks: xr.Dataset) -> Figure:
    """Draw viscosity and conductivity of rough elastic gases without positions over q."""
    figure = Figure(figsize=SIZE, layout="constrained")
    panels, rows = figure.subplots(1, 2, sharey=True), dilute.rows_of(tasks)
    for axes, kind in zip(panels, ("spheres", "disks"), strict=True):
        _draw_rough(axes, rows, kind)
    panels[0].set_ylabel("coefficient over first approximation")
    keys = panels[0].get_legend_handles_labels()
    panels[1].legend(*keys, fontsize=7, loc="upper right")
    _add_messages(panels, ("Perfectly rough elastic spheres", "Perfectly rough elastic disks"))
    return figure


def _draw_rough(axes: Axes, rows: Sequence[dilute.LongRow], kind: str) -> None:
    """Draw coefficients of rough gases of a kind over q, theory, and smooth gases at the left."""
    fine = np.linspace(1e-4, 0.7, 100)
    for look, quantity in zip(LINE_STYLES, MEMORY_LENGTHS, strict=False):
        colour, label = look.colour, f"{quantity}, "
        for method, fill, name in (
            ("equilibrium", colour, "Green-Kubo"),
            ("forced", "w", "forced"),
        ):
            points = dilute.limits(rows, quantity, kind, method)
            at = np.array([q or SMOOTH_AT for q in points]) + 0.008 * (method == "forced")
            values = np.array([estimate.value for estimate in points.values()])
            errors = [estimate.stderr for estimate in points.values()]
            style: Style = {"fmt": MARKERS[quantity], "color": colour, "ms": 4, "lw": 0.9}
            axes.errorbar(at, values, errors, mfc=fill, label=label + name, **style)
        events = dilute.events_by_state(rows, quantity) if kind == "spheres" else {}
        for number, estimate in enumerate(events.values()):
            style = {"fmt": "x", "color": colour, "ms": 4, "lw": 0.7}
            text = None if number else f"{label}events"
            at_event = 0.4 + 0.012 * (number + 2)
            axes.errorbar(at_event, estimate.value, estimate.stderr, label=text, **style)
        dimension = dilute.DIMENSIONS[kind]
        factors = theory.spin_corrections(fine, dimension)[list(MEMORY_LENGTHS).index(quantity)]
        axes.plot(fine, factors, color=colour, lw=0.9, label=f"{label}spins correlated")
    label = "first approximation"
    axes.axhline(1.0, color=THEORY, lw=0.9, ls="--", zorder=0, label=label)
    axes.axvline(SMOOTH_AT / 2.0, color=GREY, lw=0.7, ls=":", zorder=0)
    axes.set(xlabel="$q = I/(m a^2)$ (left of the dots: smooth)", xlim=(2.0 * SMOOTH_AT, 0.7))


def _add_messages(panels: Sequence[Axes], messages: Sequence[str]) -> None:
    for axes, message in zip(panels, messages, strict=True):
        axes.set_title(message, fontsize=8.5, fontweight="bold", loc="left")


def _draw_memory(axes: Axes, gases: Mapping[str, xr.Dataset]) -> None:
    for (label, gas), look in zip(gases.items(), LINE_STYLES, strict=False):
        gas_at_point = point(gas)
        times = gas_at_point.delay.values * per_collision(gas_at_point)[1]
        drawn = np.flatnonzero(times <= SHOWN_MEMORY)[::2]
        memory = gas_at_point.velocity_autocorrelation.values
        style: Style = {"color": look.colour, "ms": 3.5, "linestyle": "none"}
        axes.plot(times[drawn], memory[drawn] / memory[0], marker=look.marker, label=label, **style)
        fine = np.linspace(0.0, SHOWN_MEMORY, 100)
        axes.plot(fine, np.exp(-fine / expected(gas_at_point)), color=look.colour, lw=0.9)
    axes.set(xlabel="collisions per particle", ylabel=r"$C_v(t)/C_v(0)$", yscale="log")
    axes.set(xlim=(-0.12, SHOWN_MEMORY), ylim=(3e-3, 1.5))
    axes.legend(title="lines: theory")


def _draw_diffusion(axes: Axes, gas: xr.Dataset) -> None:
    parameters = gas.attrs["packing"], gas.attrs["dimension"], gas.attrs["inertia"]
    nu = theory.collision_frequency(1.0, *parameters[:2])

    def line(r, beta):
        return nu * theory.self_diffusion(1.0, parameters[0], r, beta, *parameters[1:])

    _draw_driven(axes, gas, by_displacement, line)
    axes.set(ylabel=r"$D_s\,\nu/T$")


def _draw_viscosity(axes: Axes, gas: xr.Dataset) -> None:
    """Draw viscosities at no shear; T_rot/T_tr of theory is from Lun's formula."""
    packing, dimension, q = gas.attrs["packing"], gas.attrs["dimension"], gas.attrs["inertia"]
    unit = theory.collision_frequency(1.0, packing, dimension)
    unit = float(unit / theory.number_density(packing, dimension))

    def line(r, beta):
        R = theory.lun_ratio(beta, q)
        parameters = packing, r, beta, dimension, q
        return unit * theory.shear_viscosity(1.0, R / (1.0 - R), *parameters)

    def viscosity(gas_at_point):
        theta = 2.0 * gas_at_point.E_rot.values[0] / temperature(gas_at_point).values[0]
        parameters = packing, float(gas_at_point.r), float(gas_at_point.beta), dimension, q
        return in_shear(gas_at_point)[-1].scaled(
            unit * float(theory.shear_viscosity(1.0, theta, *parameters))
        )

    _draw_driven(axes, gas, viscosity, line)
    axes.set(ylabel=r"viscosity $\times\ \nu/(n T)$")


def _draw_driven(
    axes: Axes,
    gas: xr.Dataset,
    estimate: Callable[[xr.Dataset], Estimate],
    line: Callable[[float, np.ndarray], np.ndarray],
) -> None:
    """Draw a coefficient of driven disks over their roughness, and theory."""
    fine, keys = np.linspace(-1.0, 1.0, 101), []
    for r, look in zip(sorted(gas.r.values, reverse=True), LINE_STYLES, strict=False):
        points = [gas.sel(r=r, beta=beta) for beta in gas.beta.values]
        points = [row for row in points if np.isfinite(row.R).all()]
        estimates = [estimate(row) for row in points]
        at, values = [float(row.beta) for row in points], [point.value for point in estimates]
        style: Style = {"fmt": look.marker, "color": look.colour, "ms": 4, "lw": 0.9}
        axes.errorbar(at, values, [point.stderr for point in estimates], **style)
        axes.plot(fine, line(r, fine), color=look.colour, lw=0.9)
        keys.append(key(look.colour, f"$r = {r:g}$", look.marker, "-", ms=4, lw=0.9))
    axes.set(xlabel=r"roughness $\beta$", xlim=(-1.05, 1.05))
    axes.legend(handles=keys, title="lines: theory", loc="best")


def _draw_elastic(axes: Axes, gases: Sequence[xr.Dataset]) -> None:
    """Draw coefficients of elastic gases over theory."""
    kinds: list[str] = []
    for gas in map(point, gases):
        kind = f"{'smooth' if gas.beta == -1.0 else 'rough'}\n"
        kind += "disks" if gas.attrs["dimension"] == 2 else "spheres"
        kinds += [] if kind in kinds else [kind]
        if "heat_flux" in gas:
            far = gas.attrs["experiment"].endswith("far_walls")
            coefficients = {f"{WALLS} twice as far" if far else WALLS: between_walls(gas)}
        else:
            coefficients = {name: in_equilibrium(gas, name)[-1] for name in MEMORY_LENGTHS}
        for number, (name_of_coefficient, marker) in enumerate(MARKERS.items()):
            if name_of_coefficient in coefficients:
                value, stderr, _ = coefficients[name_of_coefficient]
                at, colour = kinds.index(kind) + 0.2 * (number - 1.5), LINE_STYLES[number].colour
                axes.errorbar(at, value, stderr, fmt=marker, color=colour, ms=4, lw=0.9)
    keys = [
        key(look.colour, name_of_coefficient, marker)
        for (name_of_coefficient, marker), look in zip(MARKERS.items(), LINE_STYLES, strict=False)
    ]
    axes.axhline(1.0, color=THEORY, lw=0.9, zorder=0)
    axes.set(xticks=range(len(kinds)), xticklabels=kinds, ylabel="coefficient over theory")
    axes.set(xlim=(-0.5, len(kinds) - 0.5))
    axes.tick_params(axis="x", which="minor", length=0)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.4 * (high - low))
    axes.legend(handles=keys, loc="upper left")
