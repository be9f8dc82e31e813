"""Figure of single particles that run away in a cooling gas with friction."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from roughgas.plotting import FAINT, GREY, LINE_STYLES, THEORY, LineStyle, Style
from roughgas.tasks import slices_along

SIZE = (7.0, 6.6)  # inches
BLACK = LineStyle("#222222", "P", "-")
SKY = LineStyle("#56B4E9", "X", (0, (4, 1)))
BY_FRICTION = (*LINE_STYLES, SKY, BLACK)
LABEL_RATIO = 1.4  # of values whose labels do not touch
THIN: Style = {"ls": "none", "elinewidth": 0.8, "capsize": 1.5}


def draw(data: xr.Dataset) -> Figure:
    """Draw the figure from the dataset of all tasks."""
    figure = Figure(figsize=SIZE, layout="constrained")
    for axes, (panel, title) in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        panel(axes, data)
        axes.set_title(title, loc="left", fontsize=8.5)
    figure.legend(*figure.axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


def draw_example(axes: Axes, data: xr.Dataset) -> None:
    """Draw R and the largest share over time."""
    looks = _looks(data)
    for run in slices_along(data, "example_mu"):
        mu = float(run.example_mu)
        look = looks.get(mu, LINE_STYLES[0])
        is_known = np.isfinite(run.example_R.values)
        passed = run.passed.values[is_known]
        axes.plot(passed, run.example_R.values[is_known], color=look.colour)
        axes.plot(passed, run.example_largest_share.values[is_known], ":", color=look.colour)
    for line, label in (("-", "$R$"), (":", "largest share")):
        axes.plot([], [], line, color=GREY, label=label)
    axes.set(xlabel="collisions per particle", ylabel="$R$, share of the energy of spins")
    axes.set_ylim(-0.02, 1.04)
    axes.legend(loc="upper left", title=f"DSMC, $N = {int(data.example_particles)}$")


def draw_times(axes: Axes, data: xr.Dataset) -> None:
    """Draw the time of escape over the number of particles, at each mu."""
    bounds: dict[tuple[float, ...], list[float]] = {}
    for (mu, look), gases in zip(_looks(data).items(), slices_along(data, "mu"), strict=True):
        for kind, fill in (("dsmc", look.colour), ("events", "white")):
            x = gases[f"{kind}_particles"].values
            time, error = (gases[f"{kind}_time{end}"].values for end in ("", "_stderr"))
            style: Style = {"color": look.colour, "mfc": fill, "marker": look.marker}
            axes.errorbar(x, time, error, ms=4, **style, **THIN)
        axes.plot(gases.dsmc_particles, gases.dsmc_time, color=look.colour, lw=0.7, ls=look.line)
        if np.isfinite(gases.dsmc_time).any():
            style = {"color": look.colour, "marker": look.marker, "ls": look.line}
            axes.plot([], [], lw=0.7, label=rf"$\mu = {mu:g}$", **style)
        bounds.setdefault(tuple(np.nan_to_num(gases.dsmc_bound.values)), []).append(mu)
    for fill, label in ((GREY, "DSMC"), ("white", "events")):
        axes.plot([], [], "o", color=GREY, mfc=fill, label=label)
    for bound, values in bounds.items():  # equal bounds share one symbol and one label
        if any(bound):
            label = rf"$\mu = {', '.join(f'{mu:g}' for mu in values)}$: later than (95 %)"
            bounds_known = np.where(bound, bound, np.nan)
            style = {"ls": "none", "marker": r"$\uparrow$", "ms": 8}
            axes.plot(data.dsmc_particles, bounds_known, color=BLACK.colour, label=label, **style)
    axes.set(xscale="log", yscale="log", xlabel="number of particles $N$")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel("collisions per particle until $R > 0.9$", fontsize=9)
    axes.set_ylim(top=2 * axes.get_ylim()[1])


def draw_rates(axes: Axes, data: xr.Dataset) -> None:
    """Draw the rate of crossings over mu, beside theory."""
    style: Style = {"color": GREY, "marker": "o", "label": "DSMC"}
    axes.errorbar(data.mu, data.rate, data.rate_stderr, **style, **THIN)
    below: Style = {"ls": "none", "marker": r"$\downarrow$", "ms": 8, "color": GREY}
    axes.plot(data.mu, data.rate_bound, label="DSMC: less than (95 %)", **below)
    shown = np.isfinite(data.rate.values) | np.isfinite(data.rate_bound.values)
    factor = np.exp(np.log(data.predicted_rate / data.rate).where(data.rate > 0).mean())
    label = f"theory, without its factor: {factor:.0f} times DSMC"
    axes.plot(data.mu, data.predicted_rate, color=THEORY, label=label)
    axes.plot(data.mu, data.maxwellian_share, "--", color=FAINT, label="share of a Maxwellian")
    measured = np.append(data.rate.values[shown], data.rate_bound.values[shown])
    if np.isfinite(measured).any():
        axes.set_ylim(np.nanmin(measured) / 100, 3.0)
    axes.set(xscale="log", yscale="log", xlabel=r"coefficient of friction $\mu$")
    axes.set_xticks(data.mu.values, _apart(data.mu.values))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_ylabel("crossings per particle and collision", fontsize=9)
    axes.legend(loc="upper right")


def _apart(values: np.ndarray) -> list[str]:
    """Return labels of increasing values on a logarithmic axis, "" where they would touch."""
    labels, last = [], 0.0
    for value in values:
        labels.append(f"{value:g}" if value > LABEL_RATIO * last else "")
        last = value if labels[-1] else last
    return labels


def draw_shares(axes: Axes, data: xr.Dataset) -> None:
    """Draw the largest share just after an escape over the number of particles."""
    for (_, look), gases in zip(_looks(data).items(), slices_along(data, "mu"), strict=True):
        for kind, fill in (("dsmc", look.colour), ("events", "white")):
            x, share = (gases[f"{kind}_{name}"].values for name in ("particles", "largest_share"))
            line = look.line if kind == "dsmc" else "none"
            style: Style = {"color": look.colour, "mfc": fill, "marker": look.marker, "lw": 0.7}
            axes.plot(x, share, ls=line, **style)
    axes.set(xscale="log", xlabel="number of particles $N$")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_ylabel("largest share in the energy of spins", fontsize=9)
    axes.set_ylim(-0.02, 1.04)


PANELS = (
    (draw_example, "(a) R, and the largest share in the spins"),
    (draw_times, "(b) time until $R > 0.9$"),
    (draw_rates, "(c) crossings of the threshold"),
    (draw_shares, r"(d) who holds the spin at $R = 0.9$"),
)


def _looks(data: xr.Dataset) -> dict[float, LineStyle]:
    """Return the look of each mu."""
    return dict(zip(map(float, data.mu.values), BY_FRICTION, strict=False))
