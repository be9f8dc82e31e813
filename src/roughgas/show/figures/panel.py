"""R against one parameter, residuals beneath: the form that all figures of R share."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from roughgas.data.reduced import EQUILIBRATED
from roughgas.show.figures.axis import BETA, Axis
from roughgas.show.style import FAINT, GREY, HEIGHT, LOOKS, THEORY, WIDTH, Look
from roughgas.theory.prediction import predicted_ratio

ENERGY_RATIO = r"$R = E^\circ\!/(E^\circ + \bar{E})$"
ONE_WIDE, TWO_WIDE, THREE_WIDE = 5.6, 7.6, 10.4
"""Width of a figure of so many panels with much to tell, in inches."""
SIZE = 5.2
"""Symbols of the first series; each further one is smaller, so that none hides another."""


class Panel(NamedTuple):
    """R above, residuals beneath, both over one axis."""

    main: Axes
    residual: Axes
    axis: Axis


class Series(NamedTuple):
    """Measured R along an axis: arrays, with the prediction, and how it is drawn."""

    label: str
    look: Look
    at: np.ndarray
    ratio: np.ndarray
    error: np.ndarray
    theory: np.ndarray
    steady: np.ndarray
    contact_time: np.ndarray

    @property
    def residual(self) -> np.ndarray:
        """Measured minus predicted R."""
        return self.ratio - self.theory


def series(data: xr.Dataset, label: str, look: Look, **place: Any) -> Series:
    """The points of a reduced dataset that hold data, along the one axis that `place` leaves."""
    row = data.sel(place)
    (axis,) = row.R.dims
    row = row.isel({axis: np.isfinite(row.R.values)})
    at = row[axis].values
    touched = row.get("contact_time_fraction", 0 * row.R).values > 0
    steady = row.equilibrated.values > EQUILIBRATED
    theory = prediction(data, **place, **{axis: at})
    return Series(label, look, at, row.R.values, row.R_stderr.values, theory, steady, touched)


def prediction(data: xr.Dataset, r: Any, beta: Any, **place: Any) -> np.ndarray:
    """R of theory at these coordinates of a reduced dataset."""
    return predicted_ratio(data.attrs | place, r, beta)


def series_of_all_r(data: xr.Dataset) -> list[Series]:
    """One series over beta for each r of a reduced dataset, from nearly elastic downwards."""
    descending = sorted(data.r.values, reverse=True)
    looks = [LOOKS[index % len(LOOKS)] for index in range(len(descending))]
    return [
        series(data, f"$r = {r:g}$", look, r=r) for r, look in zip(descending, looks, strict=True)
    ]


def ratio_panel() -> tuple[Figure, Axes, Axes]:
    """A figure with R above and residuals beneath, both over beta."""
    figure, (panel,) = ratio_panels([BETA])
    return figure, panel.main, panel.residual


def ratio_panels(axes: Sequence[Axis], width: float = WIDTH) -> tuple[Figure, list[Panel]]:
    """A figure of several such panels side by side, one an axis; R has the same scale in all."""
    figure = Figure(figsize=(width, HEIGHT), layout="constrained")
    above, beneath = figure.subplots(
        2, len(axes), sharex="col", sharey="row", height_ratios=(2.3, 1), squeeze=False
    )
    above[0].set_ylabel(ENERGY_RATIO)
    beneath[0].set_ylabel(r"$R - R_\mathrm{theory}$")
    panels = [Panel(*parts) for parts in zip(above, beneath, axes, strict=True)]
    for main, residual, axis in panels:
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=(0, (1, 2)), zorder=0)
        residual.axhline(0, color=THEORY, linewidth=0.8)
        residual.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.prepare(residual)
    figure.align_ylabels()
    return figure, panels


def draw_theory(
    main: Axes, data: xr.Dataset, look: Look | None = None, axis: Axis = BETA, **place: Any
) -> None:
    """The predicted R along an axis as a line: black, or in the look of a series."""
    colour, line = (look.colour, look.line) if look else (THEORY, "-")
    predicted = prediction(data, **place, **{axis.name: axis.grid})
    main.plot(axis.grid, predicted, linestyle=line, color=colour, zorder=1)


def draw_series(main: Axes, residual: Axes, drawn: Sequence[Series], axis: Axis = BETA) -> None:
    """The points with error bars above; minus theory, a little apart, beneath."""
    draw_points(main, drawn)
    for index, one in enumerate(drawn):
        steps = index - (len(drawn) - 1) / 2
        _points(residual, one, axis.aside(one.at, steps), one.residual, size=4)


def draw_points(main: Axes, drawn: Sequence[Series]) -> None:
    """The points with error bars."""
    for index, one in enumerate(drawn):
        _points(main, one, one.at, one.ratio, size=max(SIZE - 0.6 * index, 3.0))


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


def _points(axes: Axes, one: Series, at: np.ndarray, values: np.ndarray, size: float) -> None:
    """Filled symbols in a steady state, open ones elsewhere, rings where contact times mattered."""
    common = {"color": one.look.colour, "fmt": one.look.marker, "elinewidth": 0.8, "capsize": 1.5}
    common["markersize"] = size
    for part, fill in ((one.steady, "full"), (~one.steady, "none")):
        axes.errorbar(at[part], values[part], one.error[part], fillstyle=fill, **common)
    ringed = one.contact_time
    axes.plot(at[ringed], values[ringed], color=GREY, linestyle="none", **RING)


def _arrows(residual: Axes, one: Series) -> bool:
    """An arrow at the rim for each residual outside the scale; whether there are any."""
    low, high = residual.get_ylim()
    above, below = one.residual > high, one.residual < low
    for beyond, height, marker in ((above, 0.95, "^"), (below, 0.05, "v")):
        heights = np.full(beyond.sum(), low + height * (high - low))
        style = {"color": one.look.colour, "fillstyle": "none", "ms": 3, "mew": 0.7}
        residual.plot(one.at[beyond], heights, marker, **style)
    return bool(above.any() or below.any())
