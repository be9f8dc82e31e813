"""What time steps and springs do to R: soft spheres against events, in the freely cooling gas.

A contact of linear springs has the same duration t_c however slow the gas is. So the velocities are
scaled back to temperature 1 m a^2/T^2 ten times per collision of a particle, which holds t_c nu,
the share of its time that a particle spends in contact; R does not depend on that. The reference is
the plain event-driven gas with the same N and box, which is scaled by powers of two only.

Deviations are (R - R_reference)/R_reference. Two methods are compared at a matched cost: the CPU
seconds after which the statistical error of a run is as large as its deviation, so that it is off
by sqrt(2) times the deviation, root mean square.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.statistics.errors import Estimate, period_means
from roughgas.statistics.fits import PowerLaw, limit_at_zero, signed_power_law
from roughgas.studies.tasks import VARIABLES
from roughgas.tasks import dataset, flat, stacked, variables

TARGETS = 0.03, 0.01, 0.003  # relative errors of R
EARLY = 0.05  # t_c nu up to which orders and limits are fitted: above, R is no power of it
CONVERGED = 3.0  # sigma
FINE = 1e-4, 400  # least t_c nu that the cheapest is sought from, and how many are tried
FEWEST_PARTS, SHORTEST = 20, 16  # of a series: parts, and samples in each
MEASURED = ("R", "R_stderr", "collisions", "cpu_seconds")
SPECIAL = ("frequency", "steps", "touched")  # measured by jobs of one kind
FITTED = ("R", "R_stderr", "deviation", "deviation_stderr", "cpu_seconds", "collisions")
ELASTIC = ("drift", "drift_stderr", "speed", "frequency")


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return deviations of R from the reference, orders and costs, from all tasks."""
    steps, t = settings["steps"], np.array(settings["contact_times"], float)
    runs = [parts[f"reference-{k}"] for k in range(settings["reference_runs"])]
    reference = {name: np.array([float(one[name]) for one in runs]) for name in MEASURED}
    stderr = math.sqrt((reference.pop("R_stderr") ** 2).sum()) / len(runs)
    R = Estimate(reference.pop("R").mean(), stderr)
    sums = {name: values.sum() for name, values in reference.items()}
    jobs = {
        "soft": [[f"soft-{n}-{k}" for k in range(len(t))] for n in steps],
        "model": [f"model-{k}" for k in range(len(settings["model_contact_times"]))],
        "event": "event",
        "single": "single",
    }
    found = {"reference_R": R} | {f"reference_{name}": x for name, x in sums.items()}
    for kind, names in jobs.items():
        found |= {
            f"{kind}_{name}": values
            for name, values in _compared(parts, np.array(names), R).items()
        }
    for name in (f"{one}_{precision}" for precision in ("single", "double") for one in ELASTIC):
        found[f"elastic_{name}"] = float(parts["single"][name])
    series = parts["event"].R_series.values
    lengths, (errors, stderr, _) = statistical_error(series, R.value)
    found["statistical_seconds"] = lengths * float(parts["event"].cpu_seconds) / len(series)
    found["statistical_error"] = Estimate(errors / R.value, stderr / R.value)
    events = sums["cpu_seconds"] / sums["collisions"]
    values = flat(found)
    rows = [{name: values[f"soft_{name}"][k] for name in FITTED} for k in range(len(steps))]
    found |= stacked([_fits(t, row, R, events) for row in rows])
    axes = {"steps": steps, "contact_time": t, "target": list(TARGETS)}
    axes["model_contact_time"] = settings["model_contact_times"]
    about = {key: settings[key] for key in ("r", "beta", "packing", "seed")}
    known = variables(VARIABLES, "discretisation")
    return dataset(known, found | axes, **about)


def statistical_error(series, truth) -> tuple[np.ndarray, Estimate]:
    """Return lengths in samples, and the rms errors of means over them, from one long series.

    Disjoint parts of the series, K of each length, are compared with `truth`; the error of their
    rms is that over sqrt(2 K).
    """
    most = max(SHORTEST, len(series) // FEWEST_PARTS)
    lengths = SHORTEST * 2 ** np.arange(int(math.log2(most / SHORTEST)) + 1)
    offsets = [period_means(series, int(length)) - truth for length in lengths]
    errors = np.array([math.sqrt(np.mean(one**2)) for one in offsets])
    return lengths, Estimate(errors, errors / np.sqrt(2.0 * (len(series) // lengths)))


def slowdown(target: float, t, seconds, deviation: PowerLaw, events: float) -> float:
    """Return how many times the CPU time of events soft spheres take for an error of R of `target`.

    The error is the root mean square of `deviation` and of the statistical error, relative to R;
    t_c is chosen for the least time. `seconds` are the soft spheres' CPU seconds per collision per
    particle at each t_c nu in `t`, interpolated as powers; below the least they are inversely
    proportional to t_c. `events` is the same of the event-driven gas.
    """
    fine = np.geomspace(FINE[0], t.max(), FINE[1])
    order = np.argsort(t)
    known = np.interp(np.log(fine), np.log(t[order]), np.log(seconds[order]))
    cost = np.exp(known) * np.maximum(1.0, t.min() / fine)
    left = np.asarray(1.0 - (deviation(fine) / target) ** 2)
    return float((cost[left > 0.0] / left[left > 0.0]).min(initial=math.inf) / events)


def _compared(parts, names, reference):
    """Return what the jobs `names` measured, in the shape of these, and how it compares."""
    found = {
        key: np.array([float(parts[name][key]) for name in names.flat]).reshape(names.shape)
        for key in (*MEASURED, *SPECIAL)
        if key in parts[names.flat[0]]
    }
    deviation = found["R"] / reference.value - 1.0
    stderr = np.hypot(found["R_stderr"], reference.stderr) / reference.value
    matched = (found["R_stderr"] / (reference.value * deviation)) ** 2
    found["matched_seconds"] = found["cpu_seconds"] * matched
    return found | {"deviation": Estimate(deviation, stderr)}


def _fits(t, row, reference, events):
    """Return order, limit and slowdowns; these are NaN for steps so coarse that R does not tend to
    the reference as t_c goes to 0. At least the two smallest t_c nu are fitted."""
    early = t <= max(EARLY, np.sort(t)[1])
    R, stderr, deviation, its_error = (row[name][early] for name in FITTED[:4])
    at_zero = Estimate(*limit_at_zero(t[early], R, stderr))
    law = signed_power_law(t[early], deviation, its_error)
    sigma = (at_zero.value - reference.value) / math.hypot(at_zero.stderr, reference.stderr)
    cost = row["cpu_seconds"] / row["collisions"]
    slower = [slowdown(target, t, cost, law, events) for target in TARGETS]
    return {
        "order": Estimate(law.exponent, law.stderr),
        "amplitude": law.prefactor,
        "order_chi_squared": law.chi_squared,
        "limit_R": at_zero,
        "limit_sigma": sigma,
        "slowdown": slower if abs(sigma) < CONVERGED else [math.nan] * len(TARGETS),
    }
