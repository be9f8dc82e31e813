"""R against beta, residuals beneath: the form that all figures of the paper share."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from roughgas.plotting.style import FAINT, GREY, HEIGHT, LOOKS, THEORY, WIDTH, Look
from roughgas.reduce import EQUILIBRATED, predicted_ratio

BETA = np.linspace(-1, 1, 801)
ENERGY_RATIO = r"$R = E^\circ\!/(E^\circ + \bar{E})$"
SIZE = 5.2
"""Symbols of the first series; each further one is smaller, so that none hides another."""
SIDESTEP = 0.014
"""Distance in beta between the residuals of two series, which would else cover each other."""


class Series(NamedTuple):
    """Measured R at one r: arrays over beta, with the prediction, and how it is drawn."""

    label: str
    look: Look
    beta: np.ndarray
    ratio: np.ndarray
    error: np.ndarray
    theory: np.ndarray
    steady: np.ndarray
    contact_time: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Measured minus predicted R."""
        return self.ratio - self.theory


def series(data: xr.Dataset, r: float, label: str, look: Look) -> Series:
    """The points of a reduced dataset at `r` that hold data."""
    row = data.sel(r=r)
    row = row.isel(beta=np.isfinite(row.R.values))
    beta = row.beta.values
    touched = row.get("contact_time_fraction", 0 * row.R).values > 0
    theory = predicted_ratio(data.attrs, r, beta)
    steady = row.equilibrated.values > EQUILIBRATED
    return Series(label, look, beta, row.R.values, row.R_stderr.values, theory, steady, touched)


def series_of_all_r(data: xr.Dataset) -> list[Series]:
    """One series for each r of a reduced dataset, from nearly elastic downwards."""
    descending = sorted(data.r.values, reverse=True)
    looks = [LOOKS[index % len(LOOKS)] for index in range(len(descending))]
    return [
        series(data, r, f"$r = {r:g}$", look) for r, look in zip(descending, looks, strict=True)
    ]


def ratio_panel() -> tuple[Figure, Axes, Axes]:
    """A figure with R above and residuals beneath, both over beta."""
    figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
    main, residual = figure.subplots(2, 1, sharex=True, height_ratios=(2.3, 1))
    main.set_ylabel(ENERGY_RATIO)
    main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=(0, (1, 2)), zorder=0)
    residual.set_ylabel(r"$R - R_\mathrm{theory}$")
    residual.set_xlabel(r"tangential restitution $\beta$")
    residual.set_xlim(-1.06, 1.06)
    residual.xaxis.set_major_locator(MultipleLocator(0.5))
    residual.xaxis.set_minor_locator(MultipleLocator(0.1))
    residual.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    residual.axhline(0, color=THEORY, linewidth=0.8)
    figure.align_ylabels()
    return figure, main, residual


def draw_theory(main: Axes, data: xr.Dataset, r: float, look: Look | None = None) -> None:
    """The predicted R over beta as a line: black, or in the look of a series."""
    colour, line = (look.colour, look.line) if look else (THEORY, "-")
    main.plot(BETA, predicted_ratio(data.attrs, r, BETA), linestyle=line, color=colour, zorder=1)


def draw_series(main: Axes, residual: Axes, drawn: Sequence[Series]) -> None:
    """The points with error bars above; minus theory, a little apart, beneath."""
    for index, one in enumerate(drawn):
        _points(main, one, one.beta, one.ratio, size=SIZE - 0.6 * index)
        step = SIDESTEP * (index - (len(drawn) - 1) / 2)
        _points(residual, one, one.beta + step, one.residual, size=4)


def frame_residuals(residual: Axes, drawn: Sequence[Series], scale: Sequence[Series]) -> None:
    """Scale the residuals to the steady points of `scale`; for those beyond, arrows at the rim."""
    low, high = -0.005, 0.005
    for one in scale:
        bar, middle = np.nan_to_num(one.error)[one.steady], one.residual[one.steady]
        low = np.min(middle - bar, initial=low)
        high = np.max(middle + bar, initial=high)
    room = 0.12 * (high - low)
    residual.set_ylim(low - room, high + room)
    beyond = [_arrows(residual, one) for one in drawn]
    note = "series set apart sideways" + ("; arrows: beyond this scale" if any(beyond) else "")
    residual.set_title(note, fontsize=6.5, color=GREY, loc="right", pad=2)


def legend(main: Axes, drawn: Sequence[Series], theory: str, **place: Any) -> None:
    """What points and lines are; `theory` names a common black line, if empty each has its own."""
    handles = [
        _key(one.look.colour, one.label, one.look.marker, "none" if theory else one.look.line)
        for one in drawn
    ]
    if theory:
        handles.append(_key(THEORY, theory, "", "-"))
    handles.append(_key(FAINT, "equipartition, $R = 1/2$", "", (0, (1, 2))))
    if not all(one.steady.all() for one in drawn):
        handles.append(_key(GREY, "open: no steady state found", "o", fillstyle="none"))
    if any(one.contact_time.any() for one in drawn):
        handles.append(_key(GREY, "ringed: contact-time model acted", **RING))
    handles += main.get_legend_handles_labels()[0]
    main.legend(handles=handles, **place)


def caption(main: Axes, datasets: Sequence[xr.Dataset], what: str) -> None:
    """Two lines above the figure: what is shown, how large, and what the error bars are."""
    counts = np.concatenate([data.n_seeds.values.ravel() for data in datasets])
    low, high = counts[counts > 0].min(), counts.max()
    seeds = f"{high} seeds" if low == high else f"{low} to {high} seeds"
    bars = f"standard error from {seeds}" if high > 1 else "standard error within the run"
    about = datasets[0].attrs
    text = f"{what}, $N = {about['particles']}$ ({about['scale']} scale)\nError bars: {bars}"
    main.set_title(text, fontsize=8, loc="left")


RING = {"marker": "o", "markersize": 8, "markeredgewidth": 0.6, "fillstyle": "none"}


def _key(colour: str, label: str, marker: str, linestyle: Any = "none", **how: Any) -> Line2D:
    return Line2D([], [], color=colour, label=label, marker=marker, linestyle=linestyle, **how)


def _points(axes: Axes, one: Series, beta: np.ndarray, values: np.ndarray, size: float) -> None:
    """Filled symbols in a steady state, open ones elsewhere, rings where contact times mattered."""
    common = {"color": one.look.colour, "fmt": one.look.marker, "elinewidth": 0.8, "capsize": 1.5}
    common["markersize"] = size
    for part, fill in ((one.steady, "full"), (~one.steady, "none")):
        axes.errorbar(beta[part], values[part], one.error[part], fillstyle=fill, **common)
    ringed = one.contact_time
    axes.plot(beta[ringed], values[ringed], color=GREY, linestyle="none", **RING)


def _arrows(residual: Axes, one: Series) -> bool:
    """An arrow at the rim for each residual outside the scale; whether there are any."""
    low, high = residual.get_ylim()
    above, below = one.residual > high, one.residual < low
    for beyond, height, marker in ((above, 0.95, "^"), (below, 0.05, "v")):
        heights = np.full(beyond.sum(), low + height * (high - low))
        style = {"color": one.look.colour, "fillstyle": "none", "ms": 3, "mew": 0.7}
        residual.plot(one.beta[beyond], heights, marker, **style)
    return bool(above.any() or below.any())
