"""A cooling gas of viscoelastic disks: how its energy falls, and R, which follows its r.

Theory of the energies is that of the rate equations with the restitution of the present
temperature; R is compared with the theory of free cooling at that restitution.
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.plotting import FAINT, GREY, LOOKS, THEORY, Look, Style, key, particles_of

SIZE = (7.0, 4.4)  # inches
MARKERS = "o", "^"
"""Of the values of r, the largest first."""
EVERY = 8
"""Of so many samples one is drawn."""
POWERS = {r"$t^{-5/3}$": -5 / 3, r"$t^{-2}$": -2.0}
LATEST = 1e7
"""T up to which energies are drawn: those of rough disks fall on for longer."""
MESSAGES = r"$t^{-5/3}$ at $\beta = \pm 1$, else $t^{-2}$", "R follows the present restitution"


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the viscoelastic cooling gas."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    keys = [key(THEORY, "theory", "", "-", lw=0.9)]
    for beta, look in zip(gas.beta.values, LOOKS, strict=False):
        keys.append(key(look.colour, rf"$\beta = {beta:g}$", "s"))
        for r, marker in zip(sorted(gas.r.values, reverse=True), MARKERS, strict=False):
            one = gas.sel(r=r, beta=beta)
            if np.isfinite(one.E_trans):
                _draw_energy(left, one, look._replace(marker=marker))
                _draw_ratio(right, one, look._replace(marker=marker))
    for r, marker in zip(sorted(gas.r.values, reverse=True), MARKERS, strict=False):
        keys.append(key(GREY, f"$r = {r:g}$ at first", marker))
    _draw_powers(left)
    energy = r"$E_\mathrm{trans}$ / initial $E_\mathrm{trans}$"
    left.set(xscale="log", yscale="log", xlabel="time / $T$", ylabel=energy)
    left.set(xlim=(0.5, 2 * LATEST), ylim=(2e-11, 4))
    right.set(xscale="log", xlabel=f"{energy}: falls to the right", ylabel="$R$")
    right.invert_xaxis()
    for axes, message in zip((left, right), MESSAGES, strict=True):
        axes.set_title(message, fontsize=8.5, fontweight="bold", loc="left")
    figure.suptitle(f"Viscoelastic disks that cool, $N = {particles_of(gas)}$", fontsize=8)
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _draw_energy(axes: Axes, one: xr.Dataset, look: Look) -> None:
    time, energy = one.time_series.values, one.E_trans_series.values
    few = np.flatnonzero(time <= LATEST)[EVERY - 1 :: EVERY]
    style: Style = {"color": look.colour, "ms": 3.2, "linestyle": "none"}
    axes.plot(time[few], energy[few], marker=look.marker, **style)
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
    for (label, power), level, place in zip(POWERS.items(), (0.3, 1e-4), (3, 0.02), strict=True):
        line = level * (time / time[0]) ** power
        axes.plot(time, line, color=FAINT, ls="--", lw=1.0, zorder=0)
        axes.annotate(label, (time[0] * 10, level * 10**power * place), fontsize=8)


def _draw_ratio(axes: Axes, one: xr.Dataset, look: Look) -> None:
    if float(one.beta) == -1.0:
        return  # spins that nothing changes
    few = slice(EVERY - 1, None, EVERY)
    energy = one.E_trans_series.values
    style: Style = {"color": look.colour, "ms": 3.2, "linestyle": "none"}
    axes.plot(energy[few], one.R_series.values[few], marker=look.marker, **style)
    about = one.attrs["r_at_speed"], one.attrs["dimension"], one.attrs["inertia"]
    expected = theory.viscoelastic_ratio(energy, float(one.r), float(one.beta), *about)
    axes.plot(energy, expected, color=look.colour, lw=0.9, zorder=1)
