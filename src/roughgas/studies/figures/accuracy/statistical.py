"""Panel: the statistical error of R against CPU seconds, by length of the run and by seeds."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from roughgas.show.style import FAINT, GREY, LOOKS

LINES = {"length": "-", "seeds": "--"}


def draw(axes: Axes, data: xr.Dataset) -> None:
    """Draw relative errors, their fits and the marks of what accuracy, from group `statistical`."""
    for look, name in zip(LOOKS, data.scene.values, strict=False):
        scene = data.sel(scene=name)
        label = f"{name}\n" + "\n".join(_slope(scene.sel(way=way)) for way in LINES)
        for way, line in LINES.items():
            filled = {"mfc": look.colour} if way == "length" else {"mfc": "white"}
            own, R = scene.sel(way=way), float(scene.R)
            axes.errorbar(
                *(own.seconds, own.error / R, own.error_stderr / R),
                **(filled | {"color": look.colour, "marker": look.marker, "ls": "none"}),
                **{"capsize": 1.5, "elinewidth": 0.8, "mew": 0.9, "zorder": 3},
                label=label if way == "length" else None,
            )
            axes.plot(*_fit(own, R), color=look.colour, ls=line, lw=0.9)
    axes.set(xscale="log", yscale="log")
    axes.set_ylim(bottom=min(data.relative_error.values) / 4)  # there the legend finds room
    axes.set(xlabel="CPU seconds of measurement", ylabel="relative error of $R$ (rms)")
    _mark_accuracies(axes, data.relative_error.values)
    axes.legend(loc="lower left", title="slopes of error against time", alignment="left")
    axes.text(
        *(0.97, 0.95, "filled: longer runs, open: more runs"),
        **{"transform": axes.transAxes, "color": GREY, "fontsize": 7.5, "ha": "right"},
    )


def _slope(own: xr.Dataset) -> str:
    return f"  {own.way.values!s}: ${float(own.slope):.3f} \\pm {float(own.slope_stderr):.3f}$"


def _fit(own: xr.Dataset, R: float) -> tuple[np.ndarray, np.ndarray]:
    """The fitted line, through the weighted centre of the points."""
    x, y = np.log(own.seconds.values), np.log(own.error.values / R) + 0.5 / own.groups.values
    weights = own.groups.values
    centre = np.average(x, weights=weights), np.average(y, weights=weights)
    ends = np.array([x.min(), x.max()])
    return np.exp(ends), np.exp(centre[1] + float(own.slope) * (ends - centre[0]))


def _mark_accuracies(axes: Axes, accuracies: np.ndarray) -> None:
    for accuracy in accuracies:
        axes.axhline(accuracy, color=FAINT, lw=0.6, ls=":", zorder=0)
        axes.annotate(
            *(f"{100 * accuracy:g} %", (1.0, accuracy)),
            **{"xycoords": ("axes fraction", "data"), "ha": "right", "va": "bottom"},
            **{"xytext": (-3, 1), "textcoords": "offset points", "color": GREY, "fontsize": 7.5},
        )
