"""The jobs of roughgas.studies.accuracy.discretisation put together: deviations, orders and costs.

Deviations are (R - R_reference)/R_reference. Two methods are compared at a matched cost: the CPU
seconds after which the statistical error of a run is as large as its deviation, so that it is off
by sqrt(2) times the deviation, root mean square.
"""

import math

import numpy as np
import xarray as xr

from roughgas.studies.accuracy.discretisation_fits import Power, limit, power_law, slowdown
from roughgas.studies.accuracy.discretisation_fits import statistical_error as errors_of_parts

TARGETS = 0.03, 0.01, 0.003  # relative errors of R
EARLY = 0.05  # t_c nu up to which orders and limits are fitted: above, R is no power of it
CONVERGED = 3.0  # sigma
MEASURED = {  # by every job
    "R": ("R, mean over the run", "1"),
    "R_stderr": ("standard error of R, from blocks of the run", "1"),
    "collisions": ("collisions per particle in the run", "1"),
    "cpu_seconds": ("CPU seconds of the run", "s"),
}
COMPARED = {  # of each with the reference
    "deviation": ("(R - R_reference)/R_reference", "1"),
    "deviation_stderr": ("standard error of the deviation, that of the reference included", "1"),
    "matched_seconds": ("CPU seconds until statistical error and deviation are equal", "s"),
}
SPECIAL = {
    "frequency": ("collisions per particle and time over Enskog's", "1"),
    "steps": ("time steps of the run", "1"),
    "touched": ("share of the contacts that the contact-time model made elastic", "1"),
}
ELASTIC = {
    "drift": ("relative change of an elastic gas's energy per collision", "1"),
    "drift_stderr": ("standard error of that change", "1"),
    "speed": ("collisions per CPU second of an elastic gas", "1/s"),
    "frequency": ("collisions per particle and time of an elastic gas", "1/T"),
}
FITTED = {
    "order": ("p of deviation = A (t_c nu)^p, fitted up to t_c nu = 0.05", "1"),
    "order_stderr": ("standard error of p", "1"),
    "amplitude": ("A of that fit", "1"),
    "order_chi_squared": ("chi^2 per degree of freedom of that fit", "1"),
    "limit_R": ("R at t_c = 0, from a parabola through R up to t_c nu = 0.05", "1"),
    "limit_R_stderr": ("standard error of that R", "1"),
    "limit_sigma": ("that R less R_reference, in standard errors", "1"),
}
STATISTICAL = {
    "statistical_seconds": ("CPU seconds of a part of the event-driven run", "s"),
    "statistical_error": ("rms of (R of a part - R_reference)/R_reference", "1"),
    "statistical_error_stderr": ("standard error of that rms", "1"),
}
SLOWDOWN = "CPU time of soft spheres over that of events, t_c chosen for the least"
AXES = {
    "steps": ("time steps in a contact", "1"),
    "contact_time": ("t_c nu of soft spheres: contact duration times collision frequency", "1"),
    "model_contact_time": ("t_c nu of the contact-time model", "1"),
    "target": ("relative error of R, root mean square", "1"),
}


def together(parts, settings) -> xr.Dataset:
    """The group of this part; see the long_name of each variable."""
    steps, t = settings["steps"], np.array(settings["contact_times"], float)
    models = range(len(settings["model_contact_times"]))
    data = _reference([parts[f"reference-{k}"] for k in range(settings["reference_runs"])])
    soft = [[f"soft-{n}-{k}" for k in range(len(t))] for n in steps]
    data |= _compared("soft", ("steps", "contact_time"), parts, soft, data)
    data |= _compared("model", ("model_contact_time",), parts, [f"model-{k}" for k in models], data)
    data |= _compared("event", (), parts, "event", data)
    data |= _compared("single", (), parts, "single", data)
    data |= _elastic(parts["single"]) | _statistical(parts["event"], data)
    data |= _fits(t, data)
    data |= _slowdowns(t, data)
    axes = {"steps": steps, "contact_time": t, "target": list(TARGETS)}
    axes["model_contact_time"] = settings["model_contact_times"]
    coords = {name: (name, values, _attributes(AXES[name])) for name, values in axes.items()}
    about = {key: settings[key] for key in ("r", "beta", "packing", "seed")}
    return xr.Dataset(data, coords, about)


def _attributes(described, prefix=""):
    return {"long_name": prefix + described[0], "units": described[1]}


def _reference(runs):
    """All reference runs as one."""
    gathered = {name: np.array([float(one[name]) for one in runs]) for name in MEASURED}
    values = {
        "R": gathered["R"].mean(),
        "R_stderr": math.sqrt((gathered["R_stderr"] ** 2).sum()) / len(runs),
        "collisions": gathered["collisions"].sum(),
        "cpu_seconds": gathered["cpu_seconds"].sum(),
    }
    return {
        f"reference_{name}": ((), value, _attributes(MEASURED[name], "reference: "))
        for name, value in values.items()
    }


def _compared(kind, dims, parts, names, reference):
    """What the jobs `names` measured, in the shape of these, and how it compares."""
    names = np.array(names)
    known = MEASURED | {name: SPECIAL[name] for name in SPECIAL if name in parts[names.flat[0]]}
    found = {
        key: np.array([float(parts[name][key]) for name in names.flat]).reshape(names.shape)
        for key in known
    }
    R, spread = (reference[name][1] for name in ("reference_R", "reference_R_stderr"))
    found["deviation"] = found["R"] / R - 1.0
    found["deviation_stderr"] = np.hypot(found["R_stderr"], spread) / R
    matched = (found["R_stderr"] / (R * found["deviation"])) ** 2
    found["matched_seconds"] = found["cpu_seconds"] * matched
    about = known | COMPARED
    return {
        f"{kind}_{name}": (dims, values, _attributes(about[name], f"{kind}: "))
        for name, values in found.items()
    }


def _elastic(single):
    return {
        f"elastic_{name}_{precision}": (
            (),
            float(single[f"{name}_{precision}"]),
            _attributes(about, f"{precision} precision: "),
        )
        for precision in ("single", "double")
        for name, about in ELASTIC.items()
    }


def _statistical(event, reference):
    R, series = reference["reference_R"][1], event.R_series.values
    lengths, errors, spread = errors_of_parts(series, R)
    seconds = lengths * float(event.cpu_seconds) / len(series)
    return {
        name: ("length", values, _attributes(about))
        for (name, about), values in zip(
            STATISTICAL.items(), (seconds, errors / R, spread / R), strict=True
        )
    }


def _early(t):
    """Which t_c nu are fitted: at least the two smallest."""
    return t <= max(EARLY, np.sort(t)[:2][-1])


def _rows(data, *names):
    return zip(*(data[f"soft_{name}"][1] for name in names), strict=True)


def _fits(t, data):
    """Order and limit for each number of steps."""
    early, R, spread = _early(t), data["reference_R"][1], data["reference_R_stderr"][1]
    rows = []
    for deviation, error, values, stderr in _rows(
        data, "deviation", "deviation_stderr", "R", "R_stderr"
    ):
        at_zero, error_at_zero = limit(t[early], values[early], stderr[early])
        sigma = (at_zero - R) / math.hypot(error_at_zero, spread)
        power = power_law(t[early], deviation[early], error[early])
        rows.append((*power, at_zero, error_at_zero, sigma))
    return {
        name: ("steps", np.array(values), _attributes(FITTED[name]))
        for name, values in zip(FITTED, zip(*rows, strict=True), strict=True)
    }


def _slowdowns(t, data):
    """NaN for steps so coarse that R does not tend to the reference as t_c goes to 0."""
    events = data["reference_cpu_seconds"][1] / data["reference_collisions"][1]
    fits = zip(*(data[name][1] for name in list(FITTED)[:4]), strict=True)
    costs = data["soft_cpu_seconds"][1] / data["soft_collisions"][1]
    factors = [
        [slowdown(target, t, cost, Power(*fit), events) for target in TARGETS]
        for fit, cost in zip(fits, costs, strict=True)
    ]
    converged = np.abs(data["limit_sigma"][1]) < CONVERGED
    values = np.where(converged[:, None], factors, np.nan)
    return {"slowdown": (("steps", "target"), values, _attributes((SLOWDOWN, "1")))}
