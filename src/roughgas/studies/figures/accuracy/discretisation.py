"""What springs and time steps cost: error of R against CPU seconds, soft spheres and events."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from roughgas.show.style import GREY, LOOKS, THEORY

BOTH = np.sqrt(2.0)  # statistical error and deviation being equal
RESOLVED = 2.0  # standard errors: deviations below are not told from zero
BARS = {"elinewidth": 0.8, "capsize": 1.5}
SMALL = {"fontsize": 6.5, "color": GREY}


def draw(axes: Axes, data: xr.Dataset) -> None:
    """Draw the panel from group `discretisation`."""
    axes.set(
        xscale="log", yscale="log", xlabel="CPU seconds", ylabel=r"relative error of $R$, r.m.s."
    )
    _events(axes, data)
    for look, steps in zip(LOOKS, data.steps.values, strict=False):
        row = data.sel(steps=steps)
        label = f"soft spheres, {steps} steps a contact"
        _method(axes, row, "soft", look.colour, look.marker, look.line, label)
    _name_contact_times(axes, data)
    _method(axes, data, "model", THEORY, "x", ":", "events, contact-time model")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{100.0 * y:g} %"))
    axes.legend(loc="lower left")


def _events(axes, data):
    """The event-driven gas has a statistical error alone; the law goes on beyond the data."""
    seconds, error = data.statistical_seconds.values, data.statistical_error.values
    axes.errorbar(
        seconds, error, data.statistical_error_stderr.values, fmt="o", color=THEORY, ms=3, **BARS
    )
    last = float(data.event_cpu_seconds), float(data.event_R_stderr / data.reference_R)
    scale = last[1] * np.sqrt(last[0])
    reach = np.array([seconds[len(seconds) // 2], 10.0 * last[0]])
    axes.plot(reach, scale / np.sqrt(reach), color=THEORY, label="events: statistical error")


def _method(axes, data, kind, colour, marker, line, label):
    """sqrt(2) |deviation| against the CPU seconds after which the statistical error is as large."""
    deviation, stderr = (data[f"{kind}_deviation{end}"].values for end in ("", "_stderr"))
    seen = np.abs(deviation) > RESOLVED * stderr
    size, bar = BOTH * np.abs(deviation[seen]), BOTH * stderr[seen]
    seconds = data[f"{kind}_matched_seconds"].values[seen]
    # both coordinates stem from one measured deviation: its error moves a point along a slanted bar
    (x0, y0), (x1, y1) = ((seconds / (1.0 + s * bar / size) ** 2, size + s * bar) for s in (-1, 1))
    axes.plot([x0, x1], [y0, y1], color=colour, linewidth=0.8)
    axes.plot(seconds, size, color=colour, marker=marker, linestyle=line, label=label)


def _name_contact_times(axes, data):
    """t_c nu beside the outermost of the points that share it."""
    seen = np.abs(data.soft_deviation) > RESOLVED * data.soft_deviation_stderr
    seconds = data.soft_matched_seconds.where(seen, 0.0)
    for share in data.contact_time.values[seen.any("steps").values]:
        steps = seconds.sel(contact_time=share).idxmax("steps")
        point = data.sel(contact_time=share, steps=steps)
        place = point.soft_matched_seconds.item(), BOTH * abs(point.soft_deviation.item())
        axes.annotate(f"{share:g}", place, (4, 3), textcoords="offset points", **SMALL)
    about = {"transform": axes.transAxes, "ha": "right", "va": "top"}
    axes.text(0.98, 0.97, r"numbers: $t_c\nu$ of soft spheres", **about, **SMALL)
