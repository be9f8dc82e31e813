"""What is off in a model of a freely cooling gas, and what the model costs.

Closed form, rate equations, direct simulation Monte Carlo and event-driven dynamics of the gas of
experiment `cooling` at one (r, beta); and, over (r, beta), how far the homogeneous gas is from the
closed form, whose velocities are Maxwellian and uncorrelated.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from roughgas.statistics.errors import Estimate
from roughgas.statistics.fits import power_law
from roughgas.studies.tasks import VARIABLES
from roughgas.tasks import dataset, estimate, mean, over, stacked, variables

METHODS = ("rate_equations", "dsmc", "event_driven")


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return errors and costs of all methods, and the map of what theory misses, from all tasks."""
    density = settings["density"]
    densities = [parts[f"density-r{r}-beta{beta}"] for r, beta in density["points"]]
    references = [parts[f"reference-{k}"] for k in range(settings["reference"]["jobs"])]
    reference = mean(np.concatenate([part.R.values for part in references]))
    closed = float(parts["theory"].closed_form_R)
    closed_stderr = closed / reference.value**2 * reference.stderr
    found = {
        "R_reference": reference,
        "reference_seconds": sum(float(part.seconds) for part in references),
        "reference_replicas": sum(part.sizes["replica"] for part in references),
        "closed_form_R": closed,
        "closed_form_error": Estimate(abs(closed / reference.value - 1), closed_stderr),
        "closed_form_seconds": float(parts["theory"].closed_form_seconds),
        **_methods(parts, settings, reference),
        **_shares(parts, reference),
        **_map([parts[f"map-r{r}"] for r in settings["map"]["r"]]),
        **stacked([_density(part) for part in densities]),
        "density_replicas": densities[0].sizes["replica"],
        "density_seconds": sum(float(part.seconds.sum() + part.dsmc_seconds) for part in densities),
        "map_r": np.array(settings["map"]["r"], float),
        "packing": np.array(density["packings"], float),
    }
    found["density_r"], found["density_beta"] = np.array(density["points"], float).T
    about = {"r": float(settings["r"]), "beta": float(settings["beta"]), "seed": settings["seed"]}
    known = variables(VARIABLES, "models")
    return dataset(known, found, **about).set_coords(["density_r", "density_beta"])


def error_bar(errors: np.ndarray, reference_stderr: float) -> np.ndarray:
    """Return the standard error of the rms over groups, axis -1, of Gaussian errors.

    It follows from their scatter about their mean, that mean, and the error of the reference, which
    is common to all.
    """
    groups = errors.shape[-1]
    square = np.mean(errors**2, axis=-1)
    scatter = errors.var(axis=-1, ddof=1) if groups > 1 else np.zeros(errors.shape[:-1])
    offset = np.maximum(square - scatter, 0.0)
    variance = (scatter**2 / 2 + offset * scatter) / groups + offset * reference_stderr**2
    return np.sqrt(variance / square)


def _methods(parts, settings, reference):
    """Return the rms relative error over groups of each length; rate equations have one group.

    The law is fitted to runs of whole segments: each of these has a transient to wait for.
    """
    found = {}
    for method in METHODS:
        part, lengths = parts.get(method, parts["theory"]), np.array(settings[method], float)
        R, seconds = (part[x].values.reshape(len(lengths), -1) for x in ("R", "seconds"))
        errors = R / reference.value - 1
        bar = error_bar(errors, reference.stderr / reference.value)
        found |= {
            f"{method}_length": lengths,
            f"{method}_R": R.mean(axis=-1),
            f"{method}_error": Estimate(np.sqrt(np.mean(errors**2, axis=-1)), bar),
            f"{method}_seconds": seconds.mean(axis=-1),
            f"{method}_groups": R.shape[1],
        }
    whole = np.array(settings["event_driven"]) >= settings["segment"]
    error, stderr, _ = found["event_driven_error"]
    weight = (error / stderr) ** 2
    law = power_law(found["event_driven_seconds"][whole], error[whole], weight[whole])
    found["event_driven_slope"] = Estimate(law.exponent, law.stderr)
    return found | {"event_driven_prefactor": law.prefactor}


def _shares(parts, reference):
    """Return what each approximation adds to the error of the closed form: factors whose product
    is that error, minus 1. Runs of DSMC are weighted by their lengths."""
    part = parts["dsmc"]
    many, R = estimate(part, "homogeneous_R"), part.R.values
    weights = np.broadcast_to(part.dsmc_length.values[:, np.newaxis], R.shape).astype(float)
    weights /= weights.sum()
    variances = R.var(axis=1, ddof=1)[:, np.newaxis]
    few = Estimate(np.sum(weights * R), np.sqrt(np.sum(weights**2 * variances)))
    closed, dilution = Estimate(float(parts["theory"].closed_form_R), 0.0), over(few, reference)
    factors = {"maxwellian": over(closed, many), "number": over(many, few), "dilution": dilution}
    return {
        "dsmc_floor": Estimate(abs(few.value / reference.value - 1), dilution.stderr),
        "dsmc_many_R": many,
        **{f"of_{name}": one._replace(value=one.value - 1) for name, one in factors.items()},
    }


def _map(rows: Sequence[xr.Dataset]):
    found = stacked([{str(k): one.values for k, one in row.data_vars.items()} for row in rows])
    theory, explained = found["theory"], found.pop("explained")
    found["gap"] = Estimate(found["R"] / theory - 1, found["R_stderr"] / theory)
    found["gap_explained"], found["beta"] = explained / theory - 1, rows[0].beta.values
    return {f"map_{name}": values for name, values in found.items()}


def _density(part: xr.Dataset):
    """Return R of an event-driven gas at each packing, and that over theory, its number of
    particles corrected for by DSMC."""
    many, few, theory = estimate(part, "R_many"), estimate(part, "R_few"), float(part.theory)
    rows = []
    for R in map(mean, part.R.values):
        gap = over(R, over(few, many))
        gap = Estimate(gap.value / theory - 1, gap.stderr / theory)
        rows.append({"density_R": R, "density_gap": gap})
    return stacked(rows)
