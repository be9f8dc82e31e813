"""R against one parameter, residuals beneath: the form that all figures of R share."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from roughgas.data.reduced import EQUILIBRATED
from roughgas.show.style import FAINT, GREY, HEIGHT, LOOKS, THEORY, WIDTH, Look
from roughgas.theory.prediction import predicted_ratio

ENERGY_RATIO = r"$R = E^\circ\!/(E^\circ + \bar{E})$"
TWO_WIDE = 7.6  # inches, for two panels
SIZE = 5.2
"""Marker size of the first series; each further one is smaller, so that none hides another."""
SIDESTEP = 0.0066
"""Distance between the residuals of two series, as a share of the axis: none hides another."""
RESTITUTION = 0.9
"""The r of figures that show only one."""
ANY_R = "theory, Eq. (lun), any $r$"
DOTS = (0, (1, 2))
RING = {"marker": "o", "markersize": 8, "markeredgewidth": 0.6, "fillstyle": "none"}


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
        if not self.logarithmic:
            step = 0.5 if self.limits[1] - self.limits[0] > 2 else 0.2
            axes.xaxis.set_major_locator(MultipleLocator(step))
            axes.xaxis.set_minor_locator(MultipleLocator(step / 5))

    def aside(self, at: np.ndarray, steps: float) -> np.ndarray:
        """Return places that are `steps` steps beside those given."""
        low, high = self.limits
        if self.logarithmic:
            return at * (high / low) ** (SIDESTEP * steps)
        return at + SIDESTEP * (high - low) * steps


BETA = Axis("beta", r"tangential restitution $\beta$", (-1.06, 1.06), (-1, 1))
FRICTION = Axis("mu", r"coefficient of friction $\mu$", (0.007, 14), (0.007, 14), True)
INERTIA = Axis("inertia", r"moment of inertia $q = I/(ma^2)$", (0.008, 1.25), (0.008, 1), True)
SHARE_LABEL = "share $s$ of the drive's power\nthat goes into rotation"
SPIN_SHARE = Axis("spin_share", SHARE_LABEL, (-0.15, 1.03), (-0.12, 1))
ROUGHNESS = Axis("roughness", r"roughness of the boundary", (-1.06, 1.06), (-1, 1))


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
        return self.data.R.values - self.theory

    @property
    def steady(self) -> np.ndarray:
        """Whether a steady state was found, (n,)."""
        return self.data.equilibrated.values > EQUILIBRATED

    @property
    def touched(self) -> np.ndarray:
        """Whether the contact-time model acted, (n,)."""
        return self.data.get("contact_time_fraction", 0 * self.data.R).values > 0


class Panel(NamedTuple):
    """R above, residuals beneath, both over one axis."""

    main: Axes
    residual: Axes
    axis: Axis


class PanelContent(NamedTuple):
    """What a figure shows in one of its panels."""

    title: str
    data: Sequence[xr.Dataset]  # whose size and seeds the title gives
    drawn: Sequence[Series]
    theory: str = ""  # of all series: a black line, so called in the legend
    theories: str = ""  # of each series: a line in its look; the title of the legend
    loc: str = "upper left"  # of the legend
    axis: Axis = BETA
    # of the series drawn: those whose residuals are to fit
    scale: Callable[[Sequence[Series]], Sequence[Series]] = lambda drawn: drawn
    # draws what only this figure has
    extra: Callable[[Axes, Sequence[Series]], None] = lambda main, drawn: None


def series(data: xr.Dataset, label: str, look: Look, **place: Any) -> Series:
    """Return the points that hold data along the one axis that `place` leaves, beside theory."""
    row = data.sel(place)
    (axis,) = row.R.dims
    row = row.isel({axis: np.isfinite(row.R.values)})

    def predict(**others):
        settings = data.attrs | place | others
        return predicted_ratio(settings, settings["r"], settings["beta"])

    at = row[axis].values
    return Series(label, look, row, at, predict(**{axis: at}), predict)


def series_for_each(
    data: xr.Dataset, name: str, symbol: str = r"\beta", looks: Sequence[Look] = LOOKS
) -> list[Series]:
    """Return one series for each r, from nearly elastic downwards; or for each other value of the
    coordinate `name` at RESTITUTION, the smallest first."""
    place = {} if name == "r" else {"r": RESTITUTION}
    values = sorted(data[name].values, reverse=name == "r")
    return [
        series(data, f"${symbol} = {value:g}$", looks[i % len(looks)], **{name: value}, **place)
        for i, value in enumerate(values)
    ]


def content_for_each_r(title: str, data: xr.Dataset, **how: Any) -> PanelContent:
    """Return a part with one series for each r."""
    return PanelContent(title, [data], series_for_each(data, "r", "r"), **how)


def content_for_each_beta(
    title: str, data: xr.Dataset, symbol: str = r"\beta", **how: Any
) -> PanelContent:
    """Return a part with one series for each beta, all at RESTITUTION."""
    drawn = series_for_each(data, "beta", symbol)
    return PanelContent(rf"{title}, $r = {RESTITUTION:g}$", [data], drawn, **how)


def ratio_figure(*parts: PanelContent, width: float = WIDTH) -> Figure:
    """Draw the parts side by side: points above theory, minus theory beneath, legends, titles."""
    figure, panels = ratio_panels([part.axis for part in parts], width)
    for part, panel in zip(parts, panels, strict=True):
        draw_series(panel, part.drawn)
        draw_theory(panel, part.drawn[:1] if part.theory else part.drawn, black=bool(part.theory))
        part.extra(panel.main, part.drawn)
        add_legend(panel.main, part.drawn, part.theory, title=part.theories or None, loc=part.loc)
        add_title(panel.main, part.data, part.title)
    scale = [one for part in parts for one in part.scale(part.drawn)]
    for part, panel in zip(parts, panels, strict=True):
        frame_residuals(panel.residual, part.drawn, scale)
    return figure


def ratio_panels(axes: Sequence[Axis], width: float = WIDTH) -> tuple[Figure, list[Panel]]:
    """Return an empty figure, and its panels side by side; R has the same scale in all."""
    figure = Figure(figsize=(width, HEIGHT), layout="constrained")
    above, beneath = figure.subplots(
        2, len(axes), sharex="col", sharey="row", height_ratios=(2.3, 1), squeeze=False
    )
    above[0].set_ylabel(ENERGY_RATIO)
    beneath[0].set_ylabel(r"$R - R_\mathrm{theory}$")
    panels = [Panel(*parts) for parts in zip(above, beneath, axes, strict=True)]
    for main, residual, axis in panels:
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=DOTS, zorder=0)
        residual.axhline(0, color=THEORY, linewidth=0.8)
        residual.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.prepare(residual)
    figure.align_ylabels()
    return figure, panels


def draw_theory(panel: Panel, drawn: Sequence[Series], black: bool = False) -> None:
    """Draw the predicted R of each series along the axis: in its look, or black."""
    for one in drawn:
        colour, line = (THEORY, "-") if black else (one.look.colour, one.look.line)
        predicted = one.predict(**{panel.axis.name: panel.axis.grid})
        panel.main.plot(panel.axis.grid, predicted, linestyle=line, color=colour, zorder=1)


def draw_series(panel: Panel, drawn: Sequence[Series], residuals: bool = True) -> None:
    """Draw points with error bars above; beneath them, residuals, set apart sideways."""
    for index, one in enumerate(drawn):
        size = max(SIZE - 0.6 * index, 3.0)
        _draw_points(panel.main, one, one.at, one.data.R.values, size)
        if residuals:
            aside = panel.axis.aside(one.at, index - (len(drawn) - 1) / 2)
            _draw_points(panel.residual, one, aside, one.residual, size=4)


def frame_residuals(residual: Axes, drawn: Sequence[Series], scale: Sequence[Series]) -> None:
    """Scale residuals to the steady points of `scale`; draw arrows for those beyond."""
    low, high = -0.005, 0.005
    for one in scale:
        bar = np.nan_to_num(one.data.R_stderr.values)[one.steady]
        low = np.min(one.residual[one.steady] - bar, initial=low)
        high = np.max(one.residual[one.steady] + bar, initial=high)
    room = 0.12 * (high - low)
    residual.set_ylim(low - room, high + room)
    beyond = [_draw_arrows(residual, one) for one in drawn]
    note = "series set apart sideways" + ("; arrows: beyond this scale" if any(beyond) else "")
    residual.set_title(note, fontsize=6.5, color=GREY, loc="right", pad=2)


def add_legend(main: Axes, drawn: Sequence[Series], theory: str = "", **how: Any) -> None:
    """Say what points and lines are. `theory` names a black line; without it each has its own."""
    handles = [
        _key(one.look.colour, one.label, one.look.marker, "none" if theory else one.look.line)
        for one in drawn
    ]
    if theory:
        handles.append(_key(THEORY, theory, "", "-"))
    handles.append(_key(FAINT, "equipartition, $R = 1/2$", "", DOTS))
    if not all(one.steady.all() for one in drawn):
        handles.append(_key(GREY, "open: no steady state found", "o", fillstyle="none"))
    if any(one.touched.any() for one in drawn):
        handles.append(_key(GREY, "ringed: contact-time model acted", **RING))
    handles += main.get_legend_handles_labels()[0]
    main.legend(handles=handles, **how)


def add_title(main: Axes, datasets: Sequence[xr.Dataset], what: str) -> None:
    """Write two lines above: what is shown, how large it is, and what the error bars are."""
    counts = np.concatenate([data.n_seeds.values.ravel() for data in datasets])
    low, high = counts[counts > 0].min(), counts.max()
    seeds = f"{high} seeds" if low == high else f"{low} to {high} seeds"
    bars = f"standard error from {seeds}" if high > 1 else "standard error within the run"
    about = datasets[0].attrs
    text = f"{what}, $N = {about['particles']}$ ({about['scale']} scale)\nError bars: {bars}"
    main.set_title(text, fontsize=8, loc="left")


def _key(colour: str, label: str, marker: str, linestyle: Any = "none", **how: Any) -> Line2D:
    return Line2D([], [], color=colour, label=label, marker=marker, linestyle=linestyle, **how)


def _draw_points(axes: Axes, one: Series, at: np.ndarray, values: np.ndarray, size: float) -> None:
    """Draw symbols: filled in a steady state, else open; ringed where contact times acted."""
    common = {"color": one.look.colour, "fmt": one.look.marker, "elinewidth": 0.8, "capsize": 1.5}
    for part, fill in ((one.steady, "full"), (~one.steady, "none")):
        bars = one.data.R_stderr.values[part]
        axes.errorbar(at[part], values[part], bars, fillstyle=fill, markersize=size, **common)
    axes.plot(at[one.touched], values[one.touched], color=GREY, linestyle="none", **RING)


def _draw_arrows(residual: Axes, one: Series) -> bool:
    """Draw an arrow at the rim for each residual beyond the scale; return whether there are any."""
    low, high = residual.get_ylim()
    above, below = one.residual > high, one.residual < low
    for beyond, height, marker in ((above, 0.95, "^"), (below, 0.05, "v")):
        heights = np.full(beyond.sum(), low + height * (high - low))
        style = {"color": one.look.colour, "fillstyle": "none", "ms": 3, "mew": 0.7}
        residual.plot(one.at[beyond], heights, marker, **style)
    return bool(above.any() or below.any())
