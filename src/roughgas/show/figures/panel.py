"""R against one parameter, residuals beneath: the form that all figures of R share."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from roughgas.data.reduced import particles_of
from roughgas.show.figures.series import RESTITUTION, Series, series, series_for_each
from roughgas.show.style import FAINT, GREY, HEIGHT, THEORY, WIDTH, Style

__all__ = ["RESTITUTION", "Series", "series", "series_for_each"]
ENERGY_RATIO = r"$R = E_\mathrm{rot}/(E_\mathrm{rot} + E_\mathrm{trans})$"
WIDE, TWO_WIDE = 5.6, 7.6  # inches, for one panel of many points, and for two
SIZE = 4.2
"""Marker size of the first series; each further one is smaller."""
SIDESTEP = 0.012
"""Distance between the points of two series, as a share of the axis: none hides another."""
ROW = 1.05
"""Height of each row of residuals beyond the first, in inches."""
AVERAGES = {
    "R": "mean of $R(t)$",
    "R_ratio_of_means": "ratio of the mean energies",
    "R_collisional": "averaged over collisions",
}
"""The ways in which R is averaged, by the names of variables; the first is the paper's."""
ANY_R = "Lun's formula, any $r$"
DOTS = (0, (1, 2))
RING: Style = {"marker": "o", "markersize": 7, "markeredgewidth": 0.5, "fillstyle": "none"}


class Axis(NamedTuple):
    """A coordinate of reduced datasets, drawn horizontally."""

    name: str
    label: str
    limits: tuple[float, float]
    drawn: tuple[float, float]  # where theory is drawn from and to
    logarithmic: bool = False

    @property
    def grid(self) -> np.ndarray:
        """Close values at which theory is drawn, (801,)."""
        spaced = np.geomspace if self.logarithmic else np.linspace
        return spaced(*self.drawn, 801)

    def prepare(self, axes: Axes) -> None:
        """Label the axis of a plot, and set its scale and its limits."""
        axes.set_xlabel(self.label)
        if self.logarithmic:
            axes.set_xscale("log")
        axes.set_xlim(*self.limits)
        span = self.limits[1] - self.limits[0]
        if not self.logarithmic and span < 4.0:
            step = 0.5 if span > 2.0 else 0.2
            axes.xaxis.set_major_locator(MultipleLocator(step))
            axes.xaxis.set_minor_locator(MultipleLocator(step / 5))

    def aside(self, at: np.ndarray, steps: float) -> np.ndarray:
        """Return places that are `steps` steps beside those given."""
        low, high = self.limits
        if self.logarithmic:
            return at * (high / low) ** (SIDESTEP * steps)
        return at + SIDESTEP * (high - low) * steps


BETA = Axis("beta", r"roughness $\beta$", (-1.06, 1.06), (-1, 1))
FRICTION = Axis("mu", r"coefficient of friction $\mu$", (0.007, 14), (0.007, 14), True)
INERTIA = Axis("inertia", r"moment of inertia $q = I/(ma^2)$", (0.008, 1.25), (0.008, 1), True)
SHARE_LABEL = "share $s$ of the drive's power\nthat goes into rotation"
SPIN_SHARE = Axis("spin_share", SHARE_LABEL, (-0.15, 1.03), (-0.12, 1))
ROUGHNESS = Axis("roughness", r"roughness of the boundary", (-1.06, 1.06), (-1, 1))


class Panel(NamedTuple):
    """R above, residuals beneath, of one average of R or more, all over one axis."""

    main: Axes
    residuals: Sequence[Axes]
    axis: Axis

    @property
    def residual(self) -> Axes:
        """The first row of residuals, those of R."""
        return self.residuals[0]


class PanelContent(NamedTuple):
    """What a figure shows in one of its panels."""

    title: str  # what is shown
    data: Sequence[xr.Dataset]  # whose size and seeds the title gives
    drawn: Sequence[Series]
    theory: str = ""  # of all series: a black line, so called in the legend
    theories: str = ""  # of each series: a line in its look; the title of the legend
    # of the legend; "half" is beneath the line at 1/2, "outside" beside the panel
    loc: str = "upper left"
    axis: Axis = BETA
    message: str = ""  # what one learns from it, above the title
    # of the series drawn: those whose residuals are to fit
    scale: Callable[[Sequence[Series]], Sequence[Series]] = lambda drawn: drawn
    # draws what only this figure has
    extra: Callable[[Axes, Sequence[Series]], None] = lambda main, drawn: None


def content_for_each_r(title: str, data: xr.Dataset, **how: Any) -> PanelContent:
    """Return a part with one series for each r."""
    return PanelContent(title, [data], series_for_each(data, "r", "r"), **how)


def content_for_each_beta(
    title: str, data: xr.Dataset, symbol: str = r"\beta", **how: Any
) -> PanelContent:
    """Return a part with one series for each beta, all at RESTITUTION."""
    drawn = series_for_each(data, "beta", symbol)
    return PanelContent(rf"{title}, $r = {RESTITUTION:g}$", [data], drawn, **how)


def ratio_figure(*parts: PanelContent, width: float = WIDTH, averaged: bool = False) -> Figure:
    """Draw the parts side by side: points above theory, minus theory beneath, legends, titles.

    Where R is `averaged` in several ways, there is a row of residuals for each that the data hold.
    """
    known = {name for part in parts for one in part.drawn for name in one.data.data_vars}
    averages = [name for name in AVERAGES if name in known] if averaged else ["R"]
    figure, panels = ratio_panels([part.axis for part in parts], width, averages)
    for part, panel in zip(parts, panels, strict=True):
        draw_series(panel, part.drawn, averages, apart=True)
        draw_theory(panel, part.drawn[:1] if part.theory else part.drawn, black=bool(part.theory))
        part.extra(panel.main, part.drawn)
        add_legend(panel.main, part.drawn, part.theory, title=part.theories or None, loc=part.loc)
        add_title(panel.main, part.data, part.title, part.message)
    scale = [one for part in parts for one in part.scale(part.drawn)]
    for part, panel in zip(parts, panels, strict=True):
        frame_rows(panel, part.drawn, scale, averages)
    return figure


def ratio_panels(
    axes: Sequence[Axis], width: float = WIDTH, averages: Sequence[str] = ("R",)
) -> tuple[Figure, list[Panel]]:
    """Return an empty figure, and its panels side by side; R has the same scale in all."""
    rows = len(averages)
    figure = Figure(figsize=(width, HEIGHT + ROW * (rows - 1)), layout="constrained")
    heights = (2.3, *(1 if rows == 1 else 0.75 for _ in averages))
    above, *beneath = figure.subplots(
        1 + rows, len(axes), sharex="col", sharey="row", height_ratios=heights, squeeze=False
    )
    above[0].set_ylabel(ENERGY_RATIO)
    for row in beneath:
        row[0].set_ylabel(r"$R - R_\mathrm{theory}$")
    columns = zip(above, zip(*beneath, strict=True), axes, strict=True)
    panels = [Panel(*parts) for parts in columns]
    for main, residuals, axis in panels:
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=DOTS, zorder=0)
        for residual in residuals:
            residual.axhline(0, color=THEORY, linewidth=0.8)
            residual.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.prepare(residuals[-1])
    figure.align_ylabels()
    return figure, panels


def draw_theory(panel: Panel, drawn: Sequence[Series], black: bool = False) -> None:
    """Draw the predicted R of each series along the axis: in its look, or black."""
    for one in drawn:
        colour, line = (THEORY, "-") if black else (one.look.colour, one.look.line)
        predicted = one.predict(**{panel.axis.name: panel.axis.grid})
        predicted = np.broadcast_to(predicted, panel.axis.grid.shape)  # constant along some axes
        panel.main.plot(panel.axis.grid, predicted, linestyle=line, color=colour, zorder=1)


def draw_series(
    panel: Panel,
    drawn: Sequence[Series],
    averages: Sequence[str] = ("R",),
    apart: bool = False,
) -> None:
    """Draw points with error bars above, series set `apart` sideways; beneath, residuals, which
    always are."""
    for index, one in enumerate(drawn):
        aside = panel.axis.aside(one.at, index - (len(drawn) - 1) / 2)
        at, size = aside if apart else one.at, SIZE - 0.3 * index
        draw_points(panel.main, one, at, one.data.R.values, size)
        for average, residual in zip(averages, panel.residuals, strict=True):
            if average in one.data:
                draw_points(residual, one, aside, one.residual_of(average), average=average)


def frame_rows(
    panel: Panel, drawn: Sequence[Series], scale: Sequence[Series], averages: Sequence[str]
) -> None:
    """Frame the residuals of each average of R, and say which one it is if there are several."""
    for average, residual in zip(averages, panel.residuals, strict=True):
        frame_residuals(residual, drawn, scale, average, averages)
        if len(averages) > 1:
            residual.set_title(AVERAGES[average], fontsize=7.5, loc="left", pad=2)


def frame_residuals(
    residual: Axes,
    drawn: Sequence[Series],
    scale: Sequence[Series],
    average: str = "R",
    averages: Sequence[str] = ("R",),
) -> None:
    """Scale residuals to the steady points of `scale`, all averages of R having the same scale;
    draw arrows for those beyond."""
    low, high = -0.005, 0.005
    for one, name in ((one, name) for one in scale for name in averages if name in one.data):
        bar = np.nan_to_num(one.error_of(name))[one.steady]
        low = np.nanmin(one.residual_of(name)[one.steady] - bar, initial=low)
        high = np.nanmax(one.residual_of(name)[one.steady] + bar, initial=high)
    room = 0.12 * (high - low)
    residual.set_ylim(low - room, high + room)
    beyond = [_draw_arrows(residual, one, average) for one in drawn if average in one.data]
    notes = ["points shifted sideways for legibility"] * (average == averages[0])
    notes += ["arrows: beyond this scale"] * any(beyond)
    residual.set_title("; ".join(notes), fontsize=6.5, color=GREY, loc="right", pad=2)
    if not beyond:
        note: Style = {"color": GREY, "fontsize": 7.5, "ha": "center"}
        residual.text(0.5, 0.6, "only in a steady state", transform=residual.transAxes, **note)


def add_legend(main: Axes, drawn: Sequence[Series], theory: str = "", **how: Any) -> None:
    """Say what points and lines are. `theory` names a black line; without it each has its own."""
    handles: list[Any] = [
        _key(one.look.colour, one.label, one.look.marker, "none" if theory else one.look.line)
        for one in drawn
    ]
    if theory:
        handles.append(_key(THEORY, theory, "", "-"))
    handles.append(_key(FAINT, "equipartition, $R = 1/2$", "", DOTS))
    handles += keys_of_steadiness(drawn)
    if any(one.touched.any() for one in drawn):
        handles.append(_key(GREY, "ringed: contact-time model acted", **RING))
    handles += main.get_legend_handles_labels()[0]
    if how.get("loc") == "half":
        low, high = main.get_ylim()
        how |= {"loc": "upper left", "bbox_to_anchor": (0.0, (0.5 - low) / (high - low))}
        how |= {"borderaxespad": 0.8}
    elif how.get("loc") == "outside":
        how |= {"loc": "upper left", "bbox_to_anchor": (1.01, 1.02), "borderaxespad": 0.0}
    main.legend(handles=handles, **how)


def keys_of_steadiness(drawn: Sequence[Series]) -> list[Line2D]:
    """Return what open symbols are, if there are any."""
    if all(one.steady.all() for one in drawn):
        return []
    return [_key(GREY, "open: no steady state found", "o", fillstyle="none")]


def add_title(main: Axes, datasets: Sequence[xr.Dataset], what: str, message: str = "") -> None:
    """Write above what one learns, what is shown, how large it is, and what error bars are."""
    counts = np.concatenate([data.n_seeds.values.ravel() for data in datasets])
    low, high = counts[counts > 0].min(), counts.max()
    seeds = f"{high} seeds" if low == high else f"{low} to {high} seeds"
    bars = f"standard error from {seeds}" if high > 1 else "standard error within the run"
    about = datasets[0].attrs
    scale = "" if about["scale"] == "paper" else f" (scale: {about['scale']})"
    number = particles_of(datasets[0]).replace(" to ", "$ to $")
    text = f"{what}, $N = {number}${scale}\nError bars: {bars}"
    main.set_title(text, fontsize=8, loc="left")
    if message:
        place: Style = {"xycoords": "axes fraction", "textcoords": "offset points"}
        main.annotate(message, (0, 1), (0, 27), fontsize=8.5, fontweight="bold", **place)


def draw_points(
    axes: Axes,
    one: Series,
    at: np.ndarray,
    values: np.ndarray,
    size: float = 3.6,
    average: str = "R",
) -> None:
    """Draw symbols: filled in a steady state, else open; ringed where contact times acted."""
    common: Style = {"color": one.look.colour, "fmt": one.look.marker, "elinewidth": 0.8}
    open_ones: Style = {"markerfacecolor": "white", "zorder": 4}  # which no other symbol hides
    for part, look in ((one.steady, common), (~one.steady, common | open_ones)):
        bars = one.error_of(average)[part]
        axes.errorbar(at[part], values[part], bars, markersize=size, capsize=1.5, **look)
    axes.plot(at[one.touched], values[one.touched], color=GREY, linestyle="none", zorder=1, **RING)


def _key(colour: str, label: str, marker: str, linestyle: Any = "none", **how: Any) -> Line2D:
    return Line2D([], [], color=colour, label=label, marker=marker, linestyle=linestyle, **how)


def _draw_arrows(residual: Axes, one: Series, average: str) -> bool:
    """Draw an arrow at the rim for each residual beyond the scale; return whether there are any."""
    low, high = residual.get_ylim()
    away = one.residual_of(average)
    above, below = away > high, away < low
    for beyond, height, marker in ((above, 0.95, "^"), (below, 0.05, "v")):
        heights = np.full(beyond.sum(), low + height * (high - low))
        style: Style = {"color": one.look.colour, "fillstyle": "none", "ms": 3, "mew": 0.7}
        residual.plot(one.at[beyond], heights, marker, **style)
    return bool(above.any() or below.any())
