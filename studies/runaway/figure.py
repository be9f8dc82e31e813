"""The figure of single particles that run away from a cooling gas with friction."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from roughgas.plotting import FAINT, GREY, LOOKS, THEORY, Look, Style
from roughgas.tasks import along

SIZE = (7.0, 6.6)  # inches
BLACK = Look("#222222", "P", "-")
SKY = Look("#56B4E9", "X", (0, (4, 1)))
BY_FRICTION = (*LOOKS, SKY, BLACK)
THIN: Style = {"ls": "none", "elinewidth": 0.8, "capsize": 1.5}


def draw(data: xr.Dataset) -> Figure:
    """Return the figure, of what all tasks have found."""
    figure = Figure(figsize=SIZE, layout="constrained")
    for axes, (panel, title) in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        panel(axes, data)
        axes.set_title(title, loc="left", fontsize=8.5)
    figure.legend(*figure.axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


def draw_example(axes: Axes, data: xr.Dataset) -> None:
    """Draw R and the largest share over time."""
    looks = _looks(data)
    for one in along(data, "example_mu"):
        mu = float(one.example_mu)
        look = looks.get(mu, LOOKS[0])
        there = np.isfinite(one.example_R.values)
        passed = one.passed.values[there]
        axes.plot(passed, one.example_R.values[there], color=look.colour)
        axes.plot(passed, one.example_largest_share.values[there], ":", color=look.colour)
    for line, label in (("-", "$R$"), (":", "largest share")):
        axes.plot([], [], line, color=GREY, label=label)
    axes.set(xlabel="collisions per particle", ylabel="$R$, share of the energy of spins")
    axes.set_ylim(-0.02, 1.04)
    axes.legend(loc="upper left", title=f"DSMC, $N = {int(data.example_particles)}$")


def draw_times(axes: Axes, data: xr.Dataset) -> None:
    """Draw the time of escape over the number of particles, at each mu."""
    bounds: dict[tuple[float, ...], list[float]] = {}
    for (mu, look), one in zip(_looks(data).items(), along(data, "mu"), strict=True):
        for kind, fill in (("dsmc", look.colour), ("events", "white")):
            x = one[f"{kind}_particles"].values
            time, error = (one[f"{kind}_time{end}"].values for end in ("", "_stderr"))
            about: Style = {"color": look.colour, "mfc": fill, "marker": look.marker}
            axes.errorbar(x, time, error, ms=4, **about, **THIN)
        axes.plot(one.dsmc_particles, one.dsmc_time, color=look.colour, lw=0.7, ls=look.line)
        if np.isfinite(one.dsmc_time).any():
            about = {"color": look.colour, "marker": look.marker, "ls": look.line}
            axes.plot([], [], lw=0.7, label=rf"$\mu = {mu:g}$", **about)
        bounds.setdefault(tuple(np.nan_to_num(one.dsmc_bound.values)), []).append(mu)
    for fill, label in ((GREY, "DSMC"), ("white", "events")):
        axes.plot([], [], "o", color=GREY, mfc=fill, label=label)
    for bound, values in bounds.items():  # those of one value hide no other
        if any(bound):
            label = rf"$\mu = {', '.join(f'{mu:g}' for mu in values)}$: later than (95 %)"
            there = np.where(bound, bound, np.nan)
            about = {"ls": "none", "marker": r"$\uparrow$", "ms": 8}
            axes.plot(data.dsmc_particles, there, color=BLACK.colour, label=label, **about)
    axes.set(xscale="log", yscale="log", xlabel="number of particles $N$")
    axes.set_ylabel("collisions per particle until $R > 0.9$", fontsize=9)
    axes.set_ylim(top=2 * axes.get_ylim()[1])


def draw_rates(axes: Axes, data: xr.Dataset) -> None:
    """Draw the rate of crossings over mu, beside theory."""
    about: Style = {"color": GREY, "marker": "o", "label": "DSMC"}
    axes.errorbar(data.mu, data.rate, data.rate_stderr, **about, **THIN)
    below: Style = {"ls": "none", "marker": r"$\downarrow$", "ms": 8, "color": GREY}
    axes.plot(data.mu, data.rate_bound, **below)
    shown = np.isfinite(data.rate.values) | np.isfinite(data.rate_bound.values)
    axes.plot(data.mu, data.predicted_rate, color=THEORY, label="theory, up to a factor")
    axes.plot(data.mu, data.maxwellian_share, "--", color=FAINT, label="share of a Maxwellian")
    measured = np.append(data.rate.values[shown], data.rate_bound.values[shown])
    if np.isfinite(measured).any():
        axes.set_ylim(np.nanmin(measured) / 100, 3.0)
    axes.set(xscale="log", yscale="log", xlabel=r"coefficient of friction $\mu$")
    axes.set_xticks(data.mu.values, [f"{mu:g}" for mu in data.mu.values])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylabel("crossings per particle and collision", fontsize=9)
    axes.legend(loc="upper right")


def draw_shares(axes: Axes, data: xr.Dataset) -> None:
    """Draw the largest share just after an escape over the number of particles."""
    for (_, look), one in zip(_looks(data).items(), along(data, "mu"), strict=True):
        for kind, fill in (("dsmc", look.colour), ("events", "white")):
            x, share = (one[f"{kind}_{name}"].values for name in ("particles", "largest_share"))
            line = look.line if kind == "dsmc" else "none"
            about: Style = {"color": look.colour, "mfc": fill, "marker": look.marker, "lw": 0.7}
            axes.plot(x, share, ls=line, **about)
    axes.set(xscale="log", xlabel="number of particles $N$")
    axes.set_ylabel("largest share in the energy of spins", fontsize=9)
    axes.set_ylim(-0.02, 1.04)


PANELS = (
    (draw_example, "(a) one particle outgrows the gas"),
    (draw_times, "(b) the more particles, the sooner"),
    (draw_rates, "(c) crossings of the threshold"),
    (draw_shares, r"(d) who holds the spin at $R = 0.9$"),
)


def _looks(data: xr.Dataset) -> dict[float, Look]:
    """Return the look of each mu."""
    return dict(zip(map(float, data.mu.values), BY_FRICTION, strict=False))
