"""A cooling gas of viscoelastic disks: how its energy falls, and R, which follows its r.

Theory of the energies is that of the rate equations with the restitution of the present
temperature; R is compared with the theory of free cooling at that restitution.
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.data.reduced import particles_of
from roughgas.show.style import FAINT, LOOKS

SIZE = (8.4, 4.4)  # inches
EVERY = 8
"""Of so many samples one is drawn."""
POWERS = {r"$t^{-5/3}$": -5 / 3, r"$t^{-2}$": -2.0}
LATEST = 1e7
"""T up to which energies are drawn: those of rough disks fall on for longer."""


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the viscoelastic cooling gas."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    styles = {float(beta): look for beta, look in zip(gas.beta.values, LOOKS, strict=False)}
    for r, fill in zip(sorted(gas.r.values, reverse=True), ("full", "none"), strict=False):
        for beta, look in styles.items():
            one = gas.sel(r=r, beta=beta)
            if np.isfinite(one.E_trans):
                label = rf"$r = {r:g}$, $\beta = {beta:g}$"
                _draw_energy(left, one, look, fill, label)
                _draw_ratio(right, one, look, fill)
    _draw_powers(left)
    left.set(xscale="log", yscale="log", xlabel="time / $T$", ylabel=r"$E_\mathrm{trans}$/initial")
    left.set(xlim=(0.5, LATEST), ylim=(1e-12, 2))
    left.legend(fontsize=6, loc="lower left")
    right.set(xscale="log", xlabel=r"$E_\mathrm{trans}$/initial", ylabel="$R$", ylim=0)
    right.invert_xaxis()
    left.set_title(f"Viscoelastic disks that cool, $N = {particles_of(gas)}$", fontsize=8)
    right.set_title("Lines: the theory of free cooling at the present restitution", fontsize=8)
    return figure


def _draw_energy(axes: Axes, one: xr.Dataset, look, fill: str, label: str) -> None:
    few = slice(EVERY - 1, None, EVERY)
    time, energy = one.time_series.values, one.E_trans_series.values
    style = {"color": look.colour, "fillstyle": fill, "ms": 3.2, "linestyle": "none"}
    axes.plot(time[few], energy[few], marker=look.marker, label=label, **style)
    frequency = theory.collision_frequency(1.0, float(one.attrs["packing"]))
    gas = theory.viscoelastic_cooling(
        float(one.collisions_per_particle.max()),
        1.0,
        float(one.r),
        float(one.beta),
        frequency,
        one.attrs["r_at_speed"],
        one.attrs["dimension"],
        one.attrs["inertia"],
    )
    axes.plot(gas.time[1:], gas.T_tr[1:], color=look.colour, lw=0.9, zorder=1)


def _draw_powers(axes: Axes) -> None:
    """Draw dashed lines of the slopes that are expected, where there is room."""
    time = np.array([1e4, LATEST])
    for (label, power), level in zip(POWERS.items(), (0.3, 3e-6), strict=True):
        line = level * (time / time[0]) ** power
        axes.plot(time, line, color=FAINT, ls="--", lw=1.0, zorder=0)
        axes.annotate(label, (time[0] * 10, level * 10**power * 2), fontsize=8)


def _draw_ratio(axes: Axes, one: xr.Dataset, look, fill: str) -> None:
    if float(one.beta) == -1.0:
        return  # spins that nothing changes
    few = slice(EVERY - 1, None, EVERY)
    energy = one.E_trans_series.values
    style = {"color": look.colour, "fillstyle": fill, "ms": 3.2, "linestyle": "none"}
    axes.plot(energy[few], one.R_series.values[few], marker=look.marker, **style)
    about = one.attrs["r_at_speed"], one.attrs["dimension"], one.attrs["inertia"]
    expected = theory.viscoelastic_ratio(energy, float(one.r), float(one.beta), *about)
    axes.plot(energy, expected, color=look.colour, lw=0.9, zorder=1)
