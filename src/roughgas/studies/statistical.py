"""The statistical error of R against CPU seconds: how run length and number of seeds lower it.

R is estimated many times, from disjoint stretches of independent simulations ("chains"), each of
which is equilibrated once. The estimates of one kind are called a level: means over runs of one
length, or over several runs of the shortest length. Their root mean square distance from the mean
of other chains, the reference, is the observed error of the level. By the law of large numbers it
falls as t^(-1/2) with the time t of measurement, either way.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.statistics.errors import Estimate
from roughgas.statistics.fits import power_law
from roughgas.studies.tasks import PARTS, SCENES, VARIABLES, WAYS
from roughgas.tasks import dataset, mean, stacked, variables

RELATIVE_ERRORS = (0.01, 0.003, 0.001)
LENGTH_UNITS = {"vibrated": "T", "sheared": "T", "cooling": "collisions per particle"}


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return errors, slopes, autocorrelation times and what an accuracy costs, from all tasks."""
    found = stacked([_scene(scene, parts, settings) for scene in SCENES]) | {
        "length_unit": [LENGTH_UNITS[scene] for scene in SCENES],
        "scene": list(SCENES),
        "way": list(WAYS),
        "relative_error": list(RELATIVE_ERRORS),
    }
    return dataset(
        variables(VARIABLES, "statistical"),
        found,
        **{key: settings[key] for key in ("r", "beta", "seed")},
    )


def observed(R: np.ndarray, seconds: np.ndarray, truth: float) -> dict[str, Any]:
    """Return errors of the estimates `R`, shape (levels, groups) with NaN where a level has fewer.

    K normal estimates know their root mean square error to (2 K)^(-1/2) of itself, and its
    logarithm, which is too small by 1/(2 K) on average, with the variance 1/(2 K).
    """
    groups = np.isfinite(R).sum(axis=1)
    error, seconds = np.sqrt(np.nanmean((R - truth) ** 2, axis=1)), np.nanmean(seconds, axis=1)
    law = power_law(seconds, error, 2.0 * groups, bias=-0.5 / groups)
    return {
        "groups": groups,
        "seconds": seconds,
        "error": Estimate(error, error / np.sqrt(2 * groups)),
        "slope": Estimate(law.exponent, law.stderr),
    }


def noise(error: np.ndarray, groups: np.ndarray, length: np.ndarray) -> Estimate:
    """Return the variance of R's mean times the length of the run, mean over levels.

    It is the variance of R times its integrated autocorrelation time, less the share tau/(2 length)
    that a short run of exponentially correlated samples misses.
    """
    average = float(np.average(error**2 * length, weights=groups))
    return Estimate(average, average * math.sqrt(2 / groups.sum()))


def _scene(scene, parts, settings) -> dict[str, Any]:
    """Return every variable of one scene; costs are those on one core, with one seed."""
    reference, *ways = (parts[f"{scene}-{part}"] for part in PARTS)
    R = mean(reference.R.values)
    levels = stacked([observed(part.R.values, part.seconds.values, R.value) for part in ways])
    sizes = 2.0 ** np.arange(settings["levels"])
    alone = np.ones_like(sizes)
    lengths = np.array([sizes, alone]) * settings["scenes"][scene]["shortest"]
    equilibration = np.concatenate([part.equilibration.values for part in (reference, *ways)])
    seconds = float(reference.seconds.sum())
    measured = seconds + sum(float(part.seconds.sum()) for part in ways)
    per_length, error = seconds / float(reference.time.sum()), levels["error"]
    spread = noise(error[0], levels["groups"][0], lengths[0])
    needed = spread.value / (np.array(RELATIVE_ERRORS) * R.value) ** 2
    measuring = per_length * needed
    return levels | {
        "R": R,
        "variance": float(reference.variance.mean()),
        "autocorrelation_time": mean(reference.autocorrelation_time.values),
        "windowed_time": float(reference.windowed_time.mean()),
        "noise": spread,
        "equilibration_seconds": equilibration.mean(),
        "seconds_per_length": per_length,
        "collisions_per_second": float(reference.contacts.sum()) / seconds,
        "cpu_seconds": measured + equilibration.sum(),
        "length": lengths,
        "seeds": np.array([alone, sizes]).astype(int),
        "length_needed": needed,
        "seconds_needed": Estimate(
            equilibration.mean() + measuring, measuring * spread.stderr / spread.value
        ),
    }
