"""R against one parameter beside theory, residuals beneath: the form of all figures of R."""

import math
from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from roughgas.data.reduced import EQUILIBRATED, particles_of
from roughgas.show.style import FAINT, GREY, HEIGHT, LOOKS, THEORY, WIDTH, Look, Style
from roughgas.theory.prediction import predicted_ratio

RESTITUTION = 0.9
"""The r of figures that show only one, where it is in the data."""


class Series(NamedTuple):
    """Measured R along an axis, beside theory, and how it is drawn."""

    label: str
    look: Look
    data: xr.Dataset  # (n,) along the axis
    at: np.ndarray  # (n,) where it is drawn
    theory: np.ndarray  # (n,) predicted R
    predict: Callable[..., np.ndarray]  # R of theory at other values of the axis, given by name

    @property
    def residual(self) -> np.ndarray:
        """Measured minus predicted R, (n,)."""
        return self.residual_of("R")

    def residual_of(self, average: str) -> np.ndarray:
        """Return the same of another average of R, called so in the data."""
        return self.data[average].values - self.theory

    def error_of(self, average: str) -> np.ndarray:
        """Return its standard errors, (n,); NaN where the data have none."""
        return self.data.get(f"{average}_stderr", math.nan * self.data.R).values

    @property
    def steady(self) -> np.ndarray:
        """Whether a steady state was found, (n,)."""
        return self.data.equilibrated.values > EQUILIBRATED

    @property
    def known(self) -> np.ndarray:
        """Whether there was evidence to tell, (n,)."""
        return self.data.equilibrated.values >= 0

    @property
    def touched(self) -> np.ndarray:
        """Whether the contact-time model acted, (n,)."""
        return self.data.get("contact_time_fraction", 0 * self.data.R).values > 0


def series(data: xr.Dataset, label: str, look: Look, **place: Any) -> Series:
    """Return the points that hold data along the one axis that `place` leaves, beside theory.

    Raises KeyError where it leaves more, or is not in the data.
    """
    row = data.sel(place)
    axis, *others = row.R.dims
    if others:
        raise KeyError(f"one axis besides {', '.join(place)}")
    row = row.isel({axis: np.isfinite(row.R.values)})

    def predict(**others):
        settings = data.attrs | place | others
        return predicted_ratio(settings, settings["r"], settings["beta"])

    at = row[axis].values
    return Series(label, look, row, at, predict(**{axis: at}), predict)


def restitution_of(data: xr.Dataset) -> float:
    """Return the r that figures of only one show: RESTITUTION, or else the largest."""
    return RESTITUTION if RESTITUTION in data.r else float(data.r.max())


def series_for_each(
    data: xr.Dataset, name: str, symbol: str = r"\beta", looks: Sequence[Look] = LOOKS
) -> list[Series]:
    """Return one series for each r, from nearly elastic downwards; or for each other value of the
    coordinate `name` at one r (`restitution_of`), the smallest first."""
    place = {} if name == "r" else {"r": restitution_of(data)}
    values = sorted(data[name].values, reverse=name == "r")
    return [
        series(data, f"${symbol} = {value:g}$", looks[i % len(looks)], **{name: value}, **place)
        for i, value in enumerate(values)
    ]


ENERGY_RATIO = r"$R = E_\mathrm{rot}/(E_\mathrm{rot} + E_\mathrm{trans})$"
AVERAGES = {"R": "mean of $R(t)$", "R_collisional": "averaged over collisions"}
"""The ways in which R is averaged, by the names of variables; the first is the paper's."""
ANY_R = "Lun's formula, any $r$"
DOTS = (0, (1, 2))
NOT_STEADY: Style = {"markerfacecolor": "white", "zorder": 4}  # which no other symbol hides
NOT_KNOWN: Style = {"fillstyle": "bottom", "markerfacecoloralt": "white", "zorder": 4}
TOUCHED = "†"


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


BETA = Axis("beta", r"roughness $\beta$", (-1.06, 1.06), (-1, 1))
FRICTION = Axis("mu", r"coefficient of friction $\mu$", (0.007, 14), (0.007, 14), True)
INERTIA = Axis("inertia", r"moment of inertia $q = I/(ma^2)$", (0.008, 1.25), (0.008, 1), True)
SHARE_LABEL = "share $s$ of the drive's power\nthat goes into rotation"
SPIN_SHARE = Axis("spin_share", SHARE_LABEL, (-0.03, 1.03), (0, 1))
ROUGHNESS = Axis("roughness", r"roughness of the boundary", (-1.06, 1.06), (-1, 1))


class Panel(NamedTuple):
    """R above, residuals beneath, of one average of R or more, all over one axis."""

    main: Axes
    residuals: Sequence[Axes]
    axis: Axis


HALF: Style = {"loc": "half", "fontsize": 7, "labelspacing": 0.2}


class PanelContent(NamedTuple):
    """What a figure shows in one of its panels."""

    title: str  # what is shown
    data: Sequence[xr.Dataset]  # whose size and seeds the title gives
    drawn: Sequence[Series]
    theory: str = ""  # of all series: a black line, so called in the legend
    theories: str = ""  # of each series: a line in its look; the title of the legend
    legend: Mapping[str, Any] = {"loc": "upper left"}  # of draw_legend; empty: there is none
    axis: Axis = BETA
    message: str = ""  # what one learns from it, above the title
    room: float = 0.0  # beneath the points, as a share of their height
    # of the series drawn: those whose residuals are to fit
    scale: Callable[[Sequence[Series]], Sequence[Series]] = lambda drawn: drawn
    # draws what only this figure has
    extra: Callable[[Panel, Sequence[Series]], None] = lambda panel, drawn: None


def content_for_each_r(title: str, data: xr.Dataset, **how: Any) -> PanelContent:
    """Return a part with one series for each r."""
    return PanelContent(title, [data], series_for_each(data, "r", "r"), **how)


def content_for_each_beta(
    title: str, data: xr.Dataset, symbol: str = r"\beta", **how: Any
) -> PanelContent:
    """Return a part with one series for each beta, all at one r (`restitution_of`)."""
    drawn = series_for_each(data, "beta", symbol)
    return PanelContent(rf"{title}, $r = {restitution_of(data):g}$", [data], drawn, **how)


def ratio_figure(
    *parts: PanelContent, width: float = WIDTH, averages: Sequence[str] = ("R",)
) -> Figure:
    """Draw the parts side by side: points above theory, minus theory beneath, legends, titles.

    There is a row of residuals for each of `averages`; R itself is the first of AVERAGES.
    """
    figure, panels = ratio_panels([part.axis for part in parts], width, averages)
    for part, panel in zip(parts, panels, strict=True):
        draw_series(panel, part.drawn, averages)
        draw_theory(panel, part.drawn[:1] if part.theory else part.drawn, black=bool(part.theory))
        part.extra(panel, part.drawn)
        frame_rows(panel, part.drawn, part.scale(part.drawn), averages)
        add_title(panel.main, part.data, part.title, part.message)
    known: set[str] = set()
    for part, panel in zip(parts, panels, strict=True):
        low, high = panel.main.get_ylim()
        panel.main.set_ylim(low - part.room * (high - low), high)
        if part.legend:
            how = {"title": part.theories or None, **part.legend}
            add_legend(panel.main, part.drawn, part.theory, known, **how)
            known |= {_mark(one) for one in part.drawn} | {part.theory, "equipartition"}
    add_notes(figure, [one for part in parts for one in part.drawn])
    return figure


def averages_of(data: xr.Dataset) -> list[str]:
    """Return the averages of R that theory is for: in a sheared gas contacts see the mean flow."""
    return [name for name in AVERAGES if name in data][: 1 if "R_unsubtracted" in data else None]


def ratio_panels(
    axes: Sequence[Axis], width: float = WIDTH, averages: Sequence[str] = ("R",)
) -> tuple[Figure, list[Panel]]:
    """Return an empty figure, and its panels side by side; R has the same scale in all."""
    rows = len(averages)
    figure = Figure(figsize=(width, HEIGHT + rows - 1), layout="constrained")
    every = figure.subplots(
        1 + rows, len(axes), sharex="col", height_ratios=(2.3, *[1.0] * rows), squeeze=False
    )
    every[0, 0].set_ylabel(ENERGY_RATIO)
    panels = [Panel(*column) for column in zip(every[0], every[1:].T, axes, strict=True)]
    for main, residuals, axis in panels:
        main.sharey(every[0, 0])
        main.label_outer()
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=DOTS, zorder=0)
        for residual in residuals:
            residual.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
            residual.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.prepare(residuals[-1])
    for residual in every[1:, 0]:
        residual.set_ylabel(r"$R - R_\mathrm{theory}$")
    figure.align_ylabels()
    return figure, panels


def draw_theory(panel: Panel, drawn: Sequence[Series], black: bool = False) -> None:
    """Draw the predicted R of each series along the axis: in its look, or black."""
    for one in drawn:
        colour, line = (THEORY, "-") if black else (one.look.colour, one.look.line)
        predicted = one.predict(**{panel.axis.name: panel.axis.grid})
        predicted = np.broadcast_to(predicted, panel.axis.grid.shape)  # constant along some axes
        panel.main.plot(panel.axis.grid, predicted, linestyle=line, color=colour, zorder=1)


def draw_series(panel: Panel, drawn: Sequence[Series], averages: Sequence[str] = ("R",)) -> None:
    """Draw points with error bars above, and beneath what they differ from theory by."""
    for index, one in enumerate(drawn):
        size = 4.2 - 0.3 * index  # none hides another
        draw_points(panel.main, one, one.at, one.data.R.values, size)
        for average, residual in zip(averages, panel.residuals, strict=True):
            if average in one.data:
                draw_points(residual, one, one.at, one.residual_of(average), size - 0.6, average)


def frame_rows(
    panel: Panel, drawn: Sequence[Series], scale: Sequence[Series], averages: Sequence[str]
) -> None:
    """Scale residuals to steady points of `scale`; say which average, and how many lie outside."""
    heights = []
    for average, residual in zip(averages, panel.residuals, strict=True):
        away = np.concatenate([one.residual_of(average) for one in drawn if average in one.data])
        low, high = _limits(away, scale, average)
        residual.set_ylim(low, high)
        heights.append(high - low)
        beyond = {"above": np.sum(away > high), "below": np.sum(away < low)}
        notes = [f"{n} point{'s' if n > 1 else ''} {where}" for where, n in beyond.items() if n]
        if notes:
            note = f"{', '.join(notes)} this scale"
            residual.set_title(note, fontsize=7, color=GREY, loc="right", pad=2)
        if len(averages) > 1:
            finer = ", finer scale" if heights[-1] < 0.8 * heights[0] else ""
            residual.set_title(f"{AVERAGES[average]}{finer}", fontsize=7.5, loc="left", pad=2)


def _limits(away, scale, average) -> tuple[float, float]:
    """Return what spans the steady points of `scale`, and halves no symbol of those at `away`."""
    low, high = -0.005, 0.005
    for one in (one for one in scale if average in one.data):
        middle, bar = one.residual_of(average), np.nan_to_num(one.error_of(average))
        low = np.nanmin((middle - bar)[one.steady], initial=low)
        high = np.nanmax((middle + bar)[one.steady], initial=high)
    room = 0.12 * (high - low)
    low, high = low - room, high + room
    for value in np.sort(away):
        high = value + room / 2 if abs(value - high) < room / 2 else high
    for value in np.sort(away)[::-1]:
        low = value - room / 2 if abs(value - low) < room / 2 else low
    return low, high


def add_legend(
    main: Axes, drawn: Sequence[Series], theory: str = "", known: Container = (), **how: Any
) -> None:
    """Say what points and lines are, but for labels that are `known` from panels before.

    `theory` names a black line; without it each series has its own. `loc` "half" is beneath the
    line at 1/2, "outside" beside the panel.
    """
    line = "none" if theory else None
    keys: list[Any] = [
        key(one.look.colour, _mark(one), one.look.marker, line or one.look.line) for one in drawn
    ]
    keys += [key(THEORY, theory, "", "-")] if theory else []
    keys += [key(FAINT, "equipartition", "", DOTS), *main.get_legend_handles_labels()[0]]
    keys = [one for one in keys if one.get_label() not in known]
    if how.get("loc") == "half":
        low, high = main.get_ylim()
        how |= {"bbox_to_anchor": (0.0, (0.5 - low) / (high - low)), "borderaxespad": 0.8}
    elif how.get("loc") == "outside":
        how |= {"bbox_to_anchor": (1.01, 1.02), "borderaxespad": 0.0}
    how |= {"loc": "upper left"} if "bbox_to_anchor" in how else {}
    if keys or how.get("title"):
        main.legend(handles=keys, **how)


def add_notes(figure: Figure, drawn: Sequence[Series]) -> None:
    """Say below the figure what open and half filled symbols and a dagger are, if there are any."""
    keys = keys_of_steadiness(drawn)
    if any(one.touched.any() for one in drawn):
        keys.append(key(GREY, "contact-time model acted", f"${TOUCHED}$"))
    if keys:
        figure.legend(handles=keys, loc="outside lower right", ncols=len(keys), columnspacing=1.0)


def keys_of_steadiness(drawn: Sequence[Series]) -> list[Line2D]:
    """Return what open and half filled symbols are, if there are any."""
    keys = []
    if any((one.known & ~one.steady).any() for one in drawn):
        keys.append(key(GREY, "open: not steady", "o", **NOT_STEADY))
    if not all(one.known.all() for one in drawn):
        keys.append(key(GREY, "half: not known", "o", **NOT_KNOWN))
    return keys


NOT_TRUSTED: Style = {"alpha": 0.4}


def trusted(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return where the error of a variable of an observable is trusted, in the shape of that: by
    flags of a point, or shares of seeds. Everywhere in datasets without either."""
    flags = data.get(f"{name}_trusted", xr.ones_like(data[name]))
    return flags > EQUILIBRATED


def key_of_trust() -> Line2D:
    """Return what paler symbols are."""
    return key(GREY, "paler: the error is not trusted", "o", **NOT_TRUSTED)


def add_title(main: Axes, datasets: Sequence[xr.Dataset], what: str, message: str = "") -> None:
    """Write above what one learns, what is shown, how large it is, and what error bars are."""
    counts = np.concatenate([data.n_seeds.values.ravel() for data in datasets])
    low, high = counts[counts > 0].min(), counts.max()
    seeds = f"{high} seeds" if low == high else f"{low} to {high} seeds"
    bars = f"standard error, {seeds}" if high > 1 else "standard error within the run"
    about = datasets[0].attrs
    scale = "" if about["scale"] == "paper" else f"\nScale: {about['scale']}"
    number = particles_of(datasets[0]).replace(" to ", "$ to $")
    text = f"{what}, $N = {number}$\nBars: {bars}{scale}"
    main.set_title(text, fontsize=7.5, loc="left")
    if message:
        place: Style = {"xycoords": "axes fraction", "textcoords": "offset points"}
        height = 10 * len(text.splitlines()) + 6
        main.annotate(message, (0, 1), (0, height), fontsize=8.5, fontweight="bold", **place)


def draw_points(
    axes: Axes,
    one: Series,
    at: np.ndarray,
    values: np.ndarray,
    size: float = 3.6,
    average: str = "R",
) -> None:
    """Draw symbols: filled in a steady state, open in none, half filled where it is not known."""
    common: Style = {"color": one.look.colour, "fmt": one.look.marker, "elinewidth": 0.8}
    looks: Any = (one.steady, {}), (one.known & ~one.steady, NOT_STEADY), (~one.known, NOT_KNOWN)
    for part, look in looks:
        bars = one.error_of(average)[part]
        axes.errorbar(at[part], values[part], bars, ms=size, capsize=1.5, **common, **look)


def _mark(one: Series) -> str:
    return one.label + (TOUCHED if one.touched.any() else "")


def key(colour: str, label: str, marker: str, linestyle: Any = "none", **how: Any) -> Line2D:
    """Return an entry of a legend."""
    return Line2D([], [], color=colour, label=label, marker=marker, linestyle=linestyle, **how)
