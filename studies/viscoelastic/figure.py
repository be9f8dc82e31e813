"""Figure of a cooling gas of viscoelastic disks: its energy over time, and R against its energy.

Theory of the energies is from the rate equations with the restitution at the present temperature; R
is compared with the theory of free cooling at that restitution.
"""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas import theory
from roughgas.plotting import (
    FAINT,
    GREY,
    LINE_STYLES,
    THEORY,
    LineStyle,
    Style,
    judged_title,
    key,
    particles_of,
)

SIZE = (7.0, 4.4)  # inches
MARKERS = "o", "^"
"""Markers of the values of r, the largest first."""
DRAWN_INTERVAL = 8
"""Samples per drawn symbol."""
POWERS = {r"$t^{-5/3}$": -5 / 3, r"$t^{-2}$": -2.0}
LATEST_TIME = 1e7
"""T up to which energies are drawn; those of rough disks keep falling for longer."""
TITLES = {
    "viscoelastic_cools_as_time_to_the_five_thirds": "Energy over time",
    "viscoelastic_ratio_follows_present_r": "R, and theory at the present r",
}
"""Titles of the panels where a statement, by its name, fails."""


def draw(gas: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of the viscoelastic cooling gas."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    keys, later = [key(THEORY, "theory", "", "-", lw=0.9)], 0
    for beta, look in zip(gas.beta.values, LINE_STYLES, strict=False):
        keys.append(key(look.colour, rf"$\beta = {beta:g}$", "s"))
        for r, marker in zip(sorted(gas.r.values, reverse=True), MARKERS, strict=False):
            gas_at_point = gas.sel(r=r, beta=beta)
            if np.isfinite(gas_at_point.E_trans):
                later += _draw_energy(left, gas_at_point, look._replace(marker=marker))
                _draw_ratio(right, gas_at_point, look._replace(marker=marker))
    for r, marker in zip(sorted(gas.r.values, reverse=True), MARKERS, strict=False):
        keys.append(key(GREY, f"$r = {r:g}$ at first", marker))
    keys.append(key(FAINT, "power laws", "", "--"))
    _draw_powers(left)
    if later:
        text = f"{later} points beyond\n$10^{{{np.log10(LATEST_TIME):.0f}}}\\,T$ are not drawn"
        left.text(0.04, 0.04, text, transform=left.transAxes, fontsize=7.5, color=GREY)
    energy = r"$E_\mathrm{trans}$ / initial $E_\mathrm{trans}$"
    left.set(xscale="log", yscale="log", xlabel="time / $T$", ylabel=energy)
    left.set(xlim=(0.5, 2 * LATEST_TIME), ylim=(2e-11, 4))
    right.set(xscale="log", xlabel=f"{energy}: falls to the right", ylabel="$R$")
    right.invert_xaxis()
    for axes, (statement, drawn) in zip((left, right), TITLES.items(), strict=True):
        message = judged_title(__file__, statement, [gas], drawn)
        axes.set_title(message, fontsize=8.5, fontweight="bold", loc="left")
    figure.suptitle(f"Viscoelastic disks that cool, $N = {particles_of(gas)}$", fontsize=8)
    figure.legend(handles=keys, loc="outside lower center", ncols=(len(keys) + 1) // 2)
    return figure


def _draw_energy(axes: Axes, point: xr.Dataset, look: LineStyle) -> int:
    """Draw E_trans over time, and theory; return the number of symbols beyond LATEST_TIME."""
    time, energy = point.time_series.values, point.E_trans_series.values
    symbols = np.arange(DRAWN_INTERVAL - 1, len(time), DRAWN_INTERVAL)
    drawn = symbols[time[symbols] <= LATEST_TIME]
    style: Style = {"color": look.colour, "ms": 3.2, "linestyle": "none"}
    axes.plot(time[drawn], energy[drawn], marker=look.marker, **style)
    frequency = theory.collision_frequency(1.0, float(point.attrs["packing"]))
    gas = theory.viscoelastic_cooling(
        float(point.collisions_per_particle.max()),
        1.0,
        float(point.r),
        float(point.beta),
        frequency,
        point.attrs["r_at_speed"],
        point.attrs["dimension"],
        point.attrs["inertia"],
    )
    axes.plot(gas.time[1:], gas.T_tr[1:], color=look.colour, lw=0.9, zorder=1)
    return len(symbols) - len(drawn)


def _draw_powers(axes: Axes) -> None:
    """Draw dashed lines with the slopes of the laws, in empty areas of the panel."""
    time = np.array([1e4, LATEST_TIME])
    for (label, power), level, factor in zip(POWERS.items(), (0.3, 1e-4), (3, 0.02), strict=True):
        line = level * (time / time[0]) ** power
        axes.plot(time, line, color=FAINT, ls="--", lw=1.0, zorder=0)
        axes.annotate(label, (time[0] * 10, level * 10**power * factor), fontsize=8)


def _draw_ratio(axes: Axes, gas: xr.Dataset, look: LineStyle) -> None:
    if float(gas.beta) == -1.0:
        return  # smooth disks, whose spins never change
    drawn = slice(DRAWN_INTERVAL - 1, None, DRAWN_INTERVAL)
    energy = gas.E_trans_series.values
    style: Style = {"color": look.colour, "ms": 3.2, "linestyle": "none"}
    axes.plot(energy[drawn], gas.R_series.values[drawn], marker=look.marker, **style)
    parameters = gas.attrs["r_at_speed"], gas.attrs["dimension"], gas.attrs["inertia"]
    expected = theory.viscoelastic_ratio(energy, float(gas.r), float(gas.beta), *parameters)
    axes.plot(energy, expected, color=look.colour, lw=0.9, zorder=1)
