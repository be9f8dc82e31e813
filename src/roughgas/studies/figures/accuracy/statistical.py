"""Panel: the statistical error of R against CPU seconds, by length of the run and by seeds."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from roughgas.show.style import FAINT, GREY, LOOKS
from roughgas.statistics.fits import power_law

LINES = {"length": "-", "seeds": "--"}
BARS = {"ls": "none", "capsize": 1.5, "elinewidth": 0.8, "mew": 0.9, "zorder": 3}


def draw(axes: Axes, data: xr.Dataset) -> None:
    """Draw relative errors, their fits and the marks of what accuracy, from group `statistical`."""
    for look, name in zip(LOOKS, data.scene.values, strict=False):
        scene = data.sel(scene=name)
        label = f"{name}\n" + "\n".join(_slope(scene.sel(way=way)) for way in LINES)
        for way, line in LINES.items():
            own, R = scene.sel(way=way), float(scene.R)
            x, error, groups = own.seconds.values, own.error.values / R, own.groups.values
            filled = way == "length"
            axes.errorbar(
                *(x, error, own.error_stderr / R),
                **{"color": look.colour, "marker": look.marker},
                mfc=look.colour if filled else "white",
                label=label if filled else None,
                **BARS,
            )
            ends = np.array([x.min(), x.max()])
            law = power_law(x, error, groups, bias=-0.5 / groups)
            axes.plot(ends, law(ends), color=look.colour, ls=line, lw=0.9)
    axes.set(xscale="log", yscale="log")
    axes.set_ylim(bottom=min(data.relative_error.values) / 4)  # leaves room for the legend
    axes.set(xlabel="CPU seconds of measurement", ylabel="relative error of $R$ (rms)")
    _mark_accuracies(axes, data.relative_error.values)
    axes.legend(loc="lower left", title="slopes of error against time", alignment="left")
    about = {"transform": axes.transAxes, "color": GREY, "fontsize": 7.5, "ha": "right"}
    axes.text(0.97, 0.95, "filled: longer runs, open: more runs", **about)


def _slope(own: xr.Dataset) -> str:
    return f"  {own.way.values!s}: ${float(own.slope):.3f} \\pm {float(own.slope_stderr):.3f}$"


def _mark_accuracies(axes: Axes, accuracies: np.ndarray) -> None:
    about = {"xytext": (-3, 1), "textcoords": "offset points", "ha": "right", "va": "bottom"}
    about |= {"xycoords": ("axes fraction", "data"), "color": GREY, "fontsize": 7.5}
    for accuracy in accuracies:
        axes.axhline(accuracy, color=FAINT, lw=0.6, ls=":", zorder=0)
        axes.annotate(f"{100 * accuracy:g} %", (1.0, accuracy), **about)
