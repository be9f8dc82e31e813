"""Panels of R over one parameter: points and theory, and their residuals beneath.

All figures of R have this form. R = E_rot/(E_rot + E_trans), from energies per degree of freedom; r
is the normal restitution, beta the roughness. `data` is a reduced dataset; a residual is measured R
minus R of theory; an average of R is a key of AVERAGES, the name of its variable.
"""

import math
from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, MultipleLocator

from roughgas.data.reduced import STEADY_SHARE, particles_of
from roughgas.show.style import FAINT, GREY, HEIGHT, LINE_STYLES, THEORY, WIDTH, LineStyle, Style
from roughgas.theory.prediction import predicted_ratio

RESTITUTION = 0.9
"""The r of figures that show a single r, if the data have it."""


class Series(NamedTuple):
    """Measured R along an axis, the R of theory, and their line style."""

    label: str
    line_style: LineStyle
    data: xr.Dataset  # (n,) along the axis
    x: np.ndarray  # (n,) horizontal positions
    theory: np.ndarray  # (n,) predicted R
    predict: Callable[..., np.ndarray]  # R of theory; other parameters by name

    @property
    def residual(self) -> np.ndarray:
        """Measured minus predicted R, (n,)."""
        return self.residual_of("R")

    def residual_of(self, average: str) -> np.ndarray:
        """Return the measured values of the variable `average`, an average of R, minus R of theory,
        (n,)."""
        return self.data[average].values - self.theory

    def error_of(self, average: str) -> np.ndarray:
        """Return the standard errors of the variable `average`, an average of R, (n,); NaN if the
        data have none."""
        return self.data.get(f"{average}_stderr", math.nan * self.data.R).values

    @property
    def steady(self) -> np.ndarray:
        """Mask of points with a steady state, (n,)."""
        return self.data.equilibrated.values > STEADY_SHARE

    @property
    def steadiness_known(self) -> np.ndarray:
        """Mask of points that were long enough to decide whether they are steady, (n,)."""
        return self.data.equilibrated.values >= 0

    @property
    def contact_time_acted(self) -> np.ndarray:
        """Mask of points with contacts that the contact-time model altered, (n,)."""
        return self.data.get("contact_time_fraction", 0 * self.data.R).values > 0


def series(data: xr.Dataset, label: str, line_style: LineStyle, **selection: Any) -> Series:
    """Return the series along the axis that remains when `selection`, values by name, fixes all
    other coordinates of a reduced dataset.

    `label` is the text of its legend. Points without data are dropped. Raises KeyError if several
    axes remain, or if the data lack the selection.
    """
    row = data.sel(selection)
    axis, *parameters = row.R.dims
    if parameters:
        raise KeyError(f"one axis besides {', '.join(selection)}")
    row = row.isel({axis: np.isfinite(row.R.values)})

    def predict(**parameters):
        """Return R of theory at the selection, with the coordinates or attributes `parameters`
        replaced."""
        settings = data.attrs | selection | parameters
        return predicted_ratio(settings, settings["r"], settings["beta"])

    x = row[axis].values
    return Series(label, line_style, row, x, predict(**{axis: x}), predict)


def restitution_of(data: xr.Dataset) -> float:
    """Return the r of figures that show a single r: RESTITUTION if the data have it, or else their
    largest."""
    return RESTITUTION if RESTITUTION in data.r else float(data.r.max())


def series_for_each(
    data: xr.Dataset,
    axis: str,
    symbol: str = r"\beta",
    line_styles: Sequence[LineStyle] = LINE_STYLES,
) -> list[Series]:
    """Return a series for each value of the coordinate `axis` of a reduced dataset, each in the
    next of `line_styles`.

    `symbol` is the TeX of the coordinate in labels. For `axis` "r" the values decrease; for others
    they increase, all at one r (`restitution_of`).
    """
    selection = {} if axis == "r" else {"r": restitution_of(data)}
    values = sorted(data[axis].values, reverse=axis == "r")
    return [
        series(
            data,
            f"${symbol} = {value:g}$",
            line_styles[i % len(line_styles)],
            **{axis: value},
            **selection,
        )
        for i, value in enumerate(values)
    ]


ENERGY_RATIO = r"$R = E_\mathrm{rot}/(E_\mathrm{rot} + E_\mathrm{trans})$"
SYMBOLS = {
    "r": "r",
    "beta": r"\beta",
    "mu": r"\mu",
    "inertia": "q",
    "particles": "N",
    "spin_share": "s",
}
"""TeX of the symbols of coordinates."""
AVERAGES = {"R": "mean of $R(t)$", "R_collisional": "averaged over collisions"}
"""Averages of R, by the names of their variables; the first is the paper's."""
ANY_R = "Lun's formula, any $r$"
DOTS = (0, (1, 2))
NOT_STEADY: Style = {"markerfacecolor": "white", "zorder": 4}  # above all other symbols
NOT_KNOWN: Style = {"fillstyle": "bottom", "markerfacecoloralt": "white", "zorder": 4}
CONTACT_TIME_MARK = "†"


def symbol_of(name: str) -> str:
    """Return the symbol of a coordinate, or else its name in words."""
    symbol = SYMBOLS.get(name)
    return f"${symbol}$" if symbol else name.replace("_", " ")


class Axis(NamedTuple):
    """A coordinate of reduced datasets, drawn horizontally: its name, its label, and the ends of
    the axis (`limits`)."""

    name: str
    label: str
    limits: tuple[float, float]
    drawn: tuple[float, float]  # ends of the curves of theory
    logarithmic: bool = False
    words: Sequence[str] = ()  # of a coordinate of words, which lie at 0, 1, 2, ...

    @property
    def grid(self) -> np.ndarray:
        """Values of the coordinate for curves of theory, (801,)."""
        spaced = np.geomspace if self.logarithmic else np.linspace
        return spaced(*self.drawn, 801)

    def prepare(self, axes: Axes) -> None:
        """Set the label, scale, limits and ticks of the horizontal axis of a plot."""
        axes.set_xlabel(self.label)
        if self.logarithmic:
            axes.set_xscale("log")
        axes.set_xlim(*self.limits)
        span = self.limits[1] - self.limits[0]
        if self.words:
            axes.set_xticks(range(len(self.words)), [w.replace("_", "\n") for w in self.words])
            axes.xaxis.minorticks_off()
        elif not self.logarithmic and span < 4.0:
            step = 0.5 if span > 2.0 else 0.2
            axes.xaxis.set_major_locator(MultipleLocator(step))
            axes.xaxis.set_minor_locator(MultipleLocator(step / 5))

    def range_text(self, positions: np.ndarray) -> str:
        """Return the range of the coordinate at some horizontal positions, (n,), as text."""
        ends = [positions.min(), positions.max()]
        texts = [self.words[int(x)] if self.words else f"${x:g}$" for x in ends]
        return f"{symbol_of(self.name)} {' to '.join(dict.fromkeys(texts))}"


BETA = Axis("beta", r"roughness $\beta$", (-1.06, 1.06), (-1, 1))
FRICTION = Axis("mu", r"coefficient of friction $\mu$", (0.007, 14), (0.007, 14), True)
INERTIA = Axis("inertia", r"moment of inertia $q = I/(ma^2)$", (0.008, 1.25), (0.008, 1), True)
SHARE_LABEL = "share $s$ of the drive's power\nthat goes into rotation"
SPIN_SHARE = Axis("spin_share", SHARE_LABEL, (-0.03, 1.03), (0, 1))
ROUGHNESS = Axis("roughness", r"roughness of the boundary", (-1.06, 1.06), (-1, 1))


class Row(NamedTuple):
    """A row of residuals: an average of R, a key of AVERAGES, and the series that set its scale."""

    average: str = "R"
    scale: Callable[[Sequence[Series]], Sequence[Series]] = lambda drawn: drawn


class Panel(NamedTuple):
    """Axes of a panel: R above, and beneath it rows of residuals."""

    main: Axes
    residuals: Sequence[Axes]
    axis: Axis


LEGEND_AT_HALF: Style = {"loc": "half", "fontsize": 7, "labelspacing": 0.2}


class PanelContent(NamedTuple):
    """Content of a panel of a figure."""

    title: str
    data: Sequence[xr.Dataset]  # the title gives their size and number of seeds
    drawn: Sequence[Series]
    theory: str = ""  # label of a single black line for all series
    theories: str = ""  # title of the legend, if each series has its own line
    legend: Mapping[str, Any] = {"loc": "upper left"}  # options of add_legend; empty: no legend
    axis: Axis = BETA
    message: str = ""  # the conclusion, above the title
    room: float = 0.0  # empty space beneath the points, as a share of their height
    # draws additions of this figure
    extra: Callable[[Panel, Sequence[Series]], None] = lambda panel, drawn: None


def content_for_each_r(title: str, data: xr.Dataset, **options: Any) -> PanelContent:
    """Return the content of a panel with a series for each r; `options` are further fields of
    PanelContent."""
    return PanelContent(title, [data], series_for_each(data, "r", "r"), **options)


def content_for_each_beta(
    title: str, data: xr.Dataset, symbol: str = r"\beta", **options: Any
) -> PanelContent:
    """Return the content of a panel with a series for each beta, at one r (`restitution_of`).

    `title` is completed by this r; `symbol` is the TeX of beta in labels; `options` are further
    fields of PanelContent.
    """
    drawn = series_for_each(data, "beta", symbol)
    return PanelContent(rf"{title}, $r = {restitution_of(data):g}$", [data], drawn, **options)


def ratio_figure(
    *contents: PanelContent, width: float = WIDTH, rows: Sequence[Row] = (Row(),)
) -> Figure:
    """Return a figure of panels side by side, one for each of `contents`: points, theory, `rows` of
    residuals, legends, titles.

    `width` is in inches.
    """
    figure, panels = ratio_panels([content.axis for content in contents], width, rows)
    for content, panel in zip(contents, panels, strict=True):
        draw_series(panel, content.drawn, rows)
        draw_theory(
            panel,
            content.drawn[:1] if content.theory else content.drawn,
            black=bool(content.theory),
        )
        content.extra(panel, content.drawn)
        frame_rows(panel, content.drawn, rows)
        add_title(panel.main, content.data, content.title, content.message)
    explained: set[str] = set()
    for content, panel in zip(contents, panels, strict=True):
        low, high = panel.main.get_ylim()
        panel.main.set_ylim(low - content.room * (high - low), high)
        if content.legend:
            legend_options = {"title": content.theories or None, **content.legend}
            add_legend(panel.main, content.drawn, content.theory, explained, **legend_options)
            explained |= {_legend_label(curve) for curve in content.drawn} | {
                content.theory,
                "equipartition",
            }
    add_notes(figure, [curve for content in contents for curve in content.drawn])
    return figure


def rows_of(data: xr.Dataset) -> list[Row]:
    """Return a row of residuals for each average of R that theory describes (`averages_of`)."""
    return [Row(average) for average in averages_of(data)]


def averages_of(data: xr.Dataset) -> list[str]:
    """Return the names of the averages of R in a reduced dataset that theory describes.

    In a sheared gas this is R alone, since averages over contacts contain the mean flow.
    """
    return [name for name in AVERAGES if name in data][: 1 if "R_unsubtracted" in data else None]


def ratio_panels(
    axes: Sequence[Axis], width: float = WIDTH, rows: Sequence[Row] = (Row(),)
) -> tuple[Figure, list[Panel]]:
    """Return an empty figure, and its panels side by side, one for each of `axes`, their horizontal
    axes, with `rows` of residuals; all share the scale of R.

    `width` is in inches.
    """
    figure = Figure(figsize=(width, HEIGHT + len(rows) - 1), layout="constrained")
    heights = 2.3, *(1.0 for _ in rows)
    axes_grid = figure.subplots(
        len(heights), len(axes), sharex="col", height_ratios=heights, squeeze=False
    )
    axes_grid[0, 0].set_ylabel(ENERGY_RATIO)
    panels = [Panel(*column) for column in zip(axes_grid[0], axes_grid[1:].T, axes, strict=True)]
    for main, residuals, axis in panels:
        main.sharey(axes_grid[0, 0])
        main.label_outer()
        main.axhline(0.5, color=FAINT, linewidth=0.8, linestyle=DOTS, zorder=0)
        for residual in residuals:
            residual.axhline(0, color=THEORY, linewidth=0.8, zorder=0)
            residual.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
        axis.prepare(residuals[-1])
    for residual in axes_grid[1:, 0]:
        residual.set_ylabel(r"$R - R_\mathrm{theory}$")
    figure.align_ylabels()
    return figure, panels


def draw_theory(panel: Panel, drawn: Sequence[Series], black: bool = False) -> None:
    """Draw into `panel` the R of theory of each series in `drawn` along the axis: in its line
    style, or black."""
    for curve in drawn:
        colour, line = (THEORY, "-") if black else (curve.line_style.colour, curve.line_style.line)
        predicted = curve.predict(**{panel.axis.name: panel.axis.grid})
        predicted = np.broadcast_to(predicted, panel.axis.grid.shape)  # constant along some axes
        panel.main.plot(panel.axis.grid, predicted, linestyle=line, color=colour, zorder=1)


def draw_series(panel: Panel, drawn: Sequence[Series], rows: Sequence[Row] = (Row(),)) -> None:
    """Draw into `panel` the points of each series in `drawn` with error bars, and `rows` of their
    residuals beneath."""
    for index, curve in enumerate(drawn):
        size = 4.2 - 0.3 * index  # later symbols hide no earlier ones
        draw_points(panel.main, curve, curve.x, curve.data.R.values, size)
        for (average, _), residual in zip(rows, panel.residuals, strict=True):
            if average in curve.data:
                draw_points(
                    residual, curve, curve.x, curve.residual_of(average), size - 0.6, average
                )


def frame_rows(panel: Panel, drawn: Sequence[Series], rows: Sequence[Row]) -> None:
    """Set the limits of the `rows` of residuals of the series in `drawn`, and write their titles.

    The limits span the steady points of the series in the scale of a row. A title has the average
    of R, if rows differ in it, and number and place of the points outside of the limits.
    """
    heights = []
    for row, residual in zip(rows, panel.residuals, strict=True):
        shown = [curve for curve in drawn if row.average in curve.data]
        x = np.concatenate([curve.x for curve in shown])
        residuals = np.concatenate([curve.residual_of(row.average) for curve in shown])
        low, high = _residual_limits(residuals, row.scale(shown), row.average)
        residual.set_ylim(low, high)
        heights.append(high - low)
        notes = [
            f"{outside.sum()} point{'s' if outside.sum() > 1 else ''} {side} this scale,"
            f" {panel.axis.range_text(x[outside])}"
            for side, outside in (("above", residuals > high), ("below", residuals < low))
            if outside.any()
        ]
        residual.set_title("\n".join(notes), fontsize=7, color=GREY, loc="right", pad=5)
        words = [AVERAGES[row.average]] if len({average for average, _ in rows}) > 1 else []
        words += ["finer scale"] if heights[-1] < 0.8 * heights[0] else []
        residual.set_title(", ".join(words), fontsize=7.5, loc="left", pad=5)


def _residual_limits(residuals, scale, average) -> tuple[float, float]:
    """Return the limits (low, high) of a row of residuals (an array): they span the steady points
    of the series in `scale` with the errors of `average`, and cut through no symbol."""
    low, high = -0.005, 0.005
    for curve in scale:
        deviation, error = curve.residual_of(average), np.nan_to_num(curve.error_of(average))
        low = np.nanmin((deviation - error)[curve.steady], initial=low)
        high = np.nanmax((deviation + error)[curve.steady], initial=high)
    margin = 0.12 * (high - low)
    low, high = low - margin, high + margin
    for value in np.sort(residuals):
        high = value + margin / 2 if abs(value - high) < margin / 2 else high
    for value in np.sort(residuals)[::-1]:
        low = value - margin / 2 if abs(value - low) < margin / 2 else low
    return low, high


def add_legend(
    main: Axes, drawn: Sequence[Series], theory: str = "", explained: Container = (), **options: Any
) -> None:
    """Add to the axes `main` a legend of points and lines, without the labels in `explained`, which
    earlier panels have.

    `theory` is the label of a black line; if empty, each series has its own line. `options` are
    matplotlib's, but `loc` "half" puts the legend beneath the line at R = 1/2, "outside" beside the
    panel.
    """
    line_style = "none" if theory else None
    entries: list[Any] = [
        key(
            curve.line_style.colour,
            _legend_label(curve),
            curve.line_style.marker,
            line_style or curve.line_style.line,
        )
        for curve in drawn
    ]
    entries += [key(THEORY, theory, "", "-")] if theory else []
    entries += [key(FAINT, "equipartition", "", DOTS), *main.get_legend_handles_labels()[0]]
    entries = [entry for entry in entries if entry.get_label() not in explained]
    if options.get("loc") == "half":
        low, high = main.get_ylim()
        options |= {"bbox_to_anchor": (0.0, (0.5 - low) / (high - low)), "borderaxespad": 0.8}
    elif options.get("loc") == "outside":
        options |= {"bbox_to_anchor": (1.01, 1.02), "borderaxespad": 0.0}
    options |= {"loc": "upper left"} if "bbox_to_anchor" in options else {}
    if entries or options.get("title"):
        main.legend(handles=entries, **options)


def add_notes(figure: Figure, drawn: Sequence[Series]) -> None:
    """Explain open and half filled symbols and the dagger below the figure, if the series in
    `drawn` have any."""
    entries = keys_of_steadiness(drawn)
    if any(curve.contact_time_acted.any() for curve in drawn):
        entries.append(key(GREY, "contact-time model acted", f"${CONTACT_TIME_MARK}$"))
    if entries:
        figure.legend(
            handles=entries, loc="outside lower right", ncols=len(entries), columnspacing=1.0
        )


def keys_of_steadiness(drawn: Sequence[Series]) -> list[Line2D]:
    """Return legend entries for open and half filled symbols, as far as the series in `drawn` have
    any."""
    entries = []
    if any((curve.steadiness_known & ~curve.steady).any() for curve in drawn):
        entries.append(key(GREY, "open: not steady", "o", **NOT_STEADY))
    if not all(curve.steadiness_known.all() for curve in drawn):
        entries.append(key(GREY, "half: not known", "o", **NOT_KNOWN))
    return entries


NOT_TRUSTED: Style = {"alpha": 0.4}


def trusted(data: xr.Dataset, name: str) -> xr.DataArray:
    """Return a mask of the values of the variable `name` of an observable whose errors are trusted,
    in the variable's shape.

    It comes from the flags of a point, or from shares of seeds; without either it is all True.
    """
    flags = data.get(f"{name}_trusted", xr.ones_like(data[name]))
    return flags > STEADY_SHARE


def key_of_trust() -> Line2D:
    """Return the legend entry for paler symbols."""
    return key(GREY, "paler: the error is not trusted", "o", **NOT_TRUSTED)


def add_title(
    main: Axes,
    datasets: Sequence[xr.Dataset],
    subject: str,
    message: str = "",
    errors_as: str = "Bars",
) -> None:
    """Write a title above the axes `main`: the subject, the number of particles and the meaning of
    the errors of `datasets` (reduced), drawn as bars or bands, and the message above it."""
    counts = np.concatenate([data.n_seeds.values.ravel() for data in datasets])
    low, high = counts[counts > 0].min(), counts.max()
    seeds = f"{high} seeds" if low == high else f"{low} to {high} seeds"
    bars = f"standard error, {seeds}" if high > 1 else "standard error within the run"
    attributes = datasets[0].attrs
    scale = "" if attributes["scale"] == "paper" else f"\nScale: {attributes['scale']}"
    number = particles_of(datasets[0]).replace(" to ", "$ to $")
    text = f"{subject}, $N = {number}$\n{errors_as}: {bars}{scale}"
    main.set_title(text, fontsize=7.5, loc="left")
    if message:
        coordinates: Style = {"xycoords": "axes fraction", "textcoords": "offset points"}
        height = 10 * len(text.splitlines()) + 6
        main.annotate(message, (0, 1), (0, height), fontsize=8.5, fontweight="bold", **coordinates)


def draw_points(
    axes: Axes,
    curve: Series,
    x: np.ndarray,
    values: np.ndarray,
    size: float = 3.6,
    average: str = "R",
) -> None:
    """Draw the points of a series with error bars: filled if steady, open if not, half filled if
    not known.

    `x` and `values` are (n,), `size` is the size of symbols in points (1/72 inch). The error bars
    are the standard errors of the variable `average`, an average of R.
    """
    common: Style = {
        "color": curve.line_style.colour,
        "fmt": curve.line_style.marker,
        "elinewidth": 0.8,
    }
    variants: Any = (
        (curve.steady, {}),
        (curve.steadiness_known & ~curve.steady, NOT_STEADY),
        (~curve.steadiness_known, NOT_KNOWN),
    )
    for mask, marker_style in variants:
        bars = curve.error_of(average)[mask]
        axes.errorbar(x[mask], values[mask], bars, ms=size, capsize=1.5, **common, **marker_style)


def _legend_label(curve: Series) -> str:
    """Return the label of a series in a legend, with a dagger if the contact-time model altered
    contacts."""
    return curve.label + (CONTACT_TIME_MARK if curve.contact_time_acted.any() else "")


def key(colour: str, label: str, marker: str, linestyle: Any = "none", **options: Any) -> Line2D:
    """Return a legend entry: a line with a marker and a label; `options` are further properties of
    matplotlib's Line2D."""
    return Line2D([], [], color=colour, label=label, marker=marker, linestyle=linestyle, **options)
