"""From the R of every method to its error against the reference, and the map of the homogeneous
gas against the closed form. Fits are made here; figures only show them.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

METHODS = {
    "rate_equations": "rate equations",
    "dsmc": "direct simulation Monte Carlo",
    "event_driven": "event-driven dynamics",
}


class Measured(NamedTuple):
    """A number with its standard error."""

    value: float
    stderr: float

    def over(self, other: "Measured") -> "Measured":
        """The quotient of two independent numbers."""
        quotient = self.value / other.value
        error = np.hypot(self.stderr / self.value, other.stderr / other.value)
        return Measured(quotient, abs(quotient) * error)


def combined(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """The group `models`, from the datasets of all its jobs."""
    references = [parts[f"reference-{k}"] for k in range(settings["reference"]["jobs"])]
    reference = _mean(np.concatenate([part.R.values for part in references]))
    variables = _reference(reference, references) | _closed_form(parts["theory"], reference)
    for method, part in (
        ("rate_equations", parts["theory"]),
        ("dsmc", parts["dsmc"]),
        ("event_driven", parts["event_driven"]),
    ):
        variables |= _method(method, part, reference)
    variables |= _slope("event_driven", variables, settings) | _shares(parts, reference)
    variables |= _map([parts[f"map-r{r}"] for r in settings["map"]["r"]])
    points = settings["density"]["points"]
    variables |= _density([parts[f"density-r{r}-beta{beta}"] for r, beta in points])
    about = {"r": float(settings["r"]), "beta": float(settings["beta"]), "seed": settings["seed"]}
    return xr.Dataset(variables, _coordinates(parts, settings), about)


def error_bar(errors: np.ndarray, reference_stderr: float) -> np.ndarray:
    """Standard error of the rms over groups, axis -1, of Gaussian errors: from their scatter about
    their mean, that mean, and that of the reference, which is common to all."""
    groups = errors.shape[-1]
    square = np.mean(errors**2, axis=-1)
    scatter = errors.var(axis=-1, ddof=1) if groups > 1 else np.zeros(errors.shape[:-1])
    offset = np.maximum(square - scatter, 0.0)
    variance = (scatter**2 / 2 + offset * scatter) / groups + offset * reference_stderr**2
    return np.sqrt(variance / square)


def power_law(x: np.ndarray, y: np.ndarray, y_stderr: np.ndarray) -> tuple[Measured, float]:
    """The exponent p of y = c x^p by weighted least squares in the logarithms, and c."""
    weight = (y / y_stderr) ** 2
    log_x, log_y = np.log(x), np.log(y)
    middle = np.average(log_x, weights=weight)
    spread = np.sum(weight * (log_x - middle) ** 2)
    slope = np.sum(weight * (log_x - middle) * log_y) / spread
    prefactor = np.exp(np.average(log_y, weights=weight) - slope * middle)
    return Measured(slope, spread**-0.5), prefactor


def _mean(values):
    return Measured(values.mean(), values.std(ddof=1) / np.sqrt(len(values)))


def _variable(value, long_name, units="1", dims=()):
    return dims, value, {"long_name": long_name, "units": units}


def _reference(reference, parts):
    seconds = sum(float(part.seconds) for part in parts)
    replicas = sum(part.sizes["replica"] for part in parts)
    return {
        "R_reference": _variable(reference.value, "R of the event-driven reference"),
        "R_reference_stderr": _variable(reference.stderr, "standard error of R_reference"),
        "reference_seconds": _variable(seconds, "CPU time of the reference", "s"),
        "reference_replicas": _variable(replicas, "independent runs of the reference"),
    }


def _closed_form(part, reference):
    R = float(part.closed_form_R)
    offset = abs(R / reference.value - 1)
    return {
        "closed_form_R": _variable(R, "R of Eq. (K)"),
        "closed_form_error": _variable(offset, "relative error of Eq. (K)"),
        "closed_form_error_stderr": _variable(
            R / reference.value**2 * reference.stderr, "standard error of closed_form_error"
        ),
        "closed_form_seconds": _variable(
            float(part.closed_form_seconds), "CPU time of one call of Eq. (K)", "s"
        ),
    }


def _method(method, part, reference):
    """The rms relative error over groups of each length; rate equations have a single group."""
    name, dims = METHODS[method], (f"{method}_length",)
    R, seconds = (part[x].values.reshape(part.sizes[dims[0]], -1) for x in ("R", "seconds"))
    errors = R / reference.value - 1
    bar = error_bar(errors, reference.stderr / reference.value)
    return {
        f"{method}_R": _variable(R.mean(axis=-1), f"R by {name}, mean over groups", dims=dims),
        f"{method}_error": _variable(
            np.sqrt(np.mean(errors**2, axis=-1)),
            f"relative error of R by {name}, rms over groups",
            dims=dims,
        ),
        f"{method}_error_stderr": _variable(bar, f"standard error of {method}_error", dims=dims),
        f"{method}_seconds": _variable(
            seconds.mean(axis=-1), f"CPU time of one run by {name}", "s", dims
        ),
        f"{method}_groups": _variable(R.shape[1], f"independent runs of each length by {name}"),
    }


def _slope(method, variables, settings):
    """Fitted to runs that consist of whole segments: each of these has a transient to wait for."""
    whole = np.array(settings[method]) >= settings["segment"]
    seconds, error, bar = (
        variables[f"{method}_{x}"][1][whole] for x in ("seconds", "error", "error_stderr")
    )
    slope, prefactor = power_law(seconds, error, bar)
    name = METHODS[method]
    return {
        f"{method}_slope": _variable(slope.value, f"exponent of error over CPU time, {name}"),
        f"{method}_slope_stderr": _variable(slope.stderr, f"standard error of {method}_slope"),
        f"{method}_prefactor": _variable(prefactor, f"fitted error after 1 s, {name}"),
    }


def _shares(parts, reference):
    """What each approximation adds to the error of the closed form: factors whose product is it."""
    part = parts["dsmc"]
    many = Measured(float(part.homogeneous_R), float(part.homogeneous_R_stderr))
    few = _pooled(part.R.values, part.dsmc_length.values)
    closed = Measured(float(parts["theory"].closed_form_R), 0.0)
    factors = {
        "of_maxwellian": (
            closed.over(many),
            "Maxwellian, uncorrelated velocities (Eq. K over DSMC)",
        ),
        "of_number": (many.over(few), "infinitely many particles (DSMC of many over DSMC of few)"),
        "of_dilution": (
            few.over(reference),
            "no correlations, no density (DSMC over event-driven)",
        ),
    }
    variables = {
        "dsmc_floor": _variable(abs(few.value / reference.value - 1), "error that DSMC tends to"),
        "dsmc_floor_stderr": _variable(few.over(reference).stderr, "standard error of dsmc_floor"),
        "dsmc_many_R": _variable(many.value, "R by DSMC of many particles"),
        "dsmc_many_R_stderr": _variable(many.stderr, "standard error of dsmc_many_R"),
    }
    for name, (factor, text) in factors.items():
        variables[name] = _variable(factor.value - 1, f"relative error of R by assuming {text}")
        variables[f"{name}_stderr"] = _variable(factor.stderr, f"standard error of {name}")
    return variables


def _pooled(R, lengths):
    """Mean of all runs, weighted by their lengths."""
    weights = np.broadcast_to(lengths[:, np.newaxis], R.shape).astype(float)
    weights /= weights.sum()
    mean = np.sum(weights * R)
    variances = R.var(axis=1, ddof=1)[:, np.newaxis]
    return Measured(mean, np.sqrt(np.sum(weights**2 * variances)))


MAP = {
    "R": "R of the homogeneous gas",
    "R_stderr": "standard error of map_R",
    "drift": "map_R of the second half of the run minus that of the first",
    "drift_stderr": "standard error of map_drift",
    "a20": "cumulant D <v^4>/[(D+2) <v^2>^2] - 1",
    "a02": "cumulant n <w^4>/[(n+2) <w^2>^2] - 1, n = 2D-3",
    "a11": "correlation <v^2 w^2>/(<v^2> <w^2>) - 1",
    "theory": "R of Eq. (K)",
}


def _map(rows):
    dims = ("map_r", "map_beta")
    names = (*MAP, "explained", "length", "seconds")
    stacked = {name: np.array([row[name].values for row in rows]) for name in names}
    theory = stacked["theory"]
    variables = {f"map_{x}": _variable(stacked[x], text, dims=dims) for x, text in MAP.items()}
    return variables | {
        "map_gap": _variable(stacked["R"] / theory - 1, "map_R over Eq. (K), minus 1", dims=dims),
        "map_gap_stderr": _variable(
            stacked["R_stderr"] / theory, "standard error of map_gap", dims=dims
        ),
        "map_gap_explained": _variable(
            stacked["explained"] / theory - 1, "map_gap to first order in a20 and a11", dims=dims
        ),
        "map_length": _variable(
            stacked["length"], "length of a run", "collisions per particle", dims
        ),
        "map_seconds": _variable(stacked["seconds"], "CPU time of a run", "s", dims),
    }


def _density(parts):
    """The event-driven gas against Eq. (K), its number of particles corrected for by DSMC."""
    dims = ("density_point", "packing")
    gaps = np.array([[_gap(part, k) for k in range(part.sizes["packing"])] for part in parts])
    R = np.array([part.R.values.mean(axis=-1) for part in parts])
    replicas = parts[0].sizes["replica"]
    stderr = np.array([part.R.values.std(axis=-1, ddof=1) for part in parts]) / np.sqrt(replicas)
    seconds = sum(float(part.seconds.sum() + part.dsmc_seconds) for part in parts)
    return {
        "density_R": _variable(R, "R of the event-driven gas", dims=dims),
        "density_R_stderr": _variable(stderr, "standard error of density_R", dims=dims),
        "density_gap": _variable(
            gaps[..., 0], "density_R, as of many particles, over Eq. (K), minus 1", dims=dims
        ),
        "density_gap_stderr": _variable(gaps[..., 1], "standard error of density_gap", dims=dims),
        "density_replicas": _variable(replicas, "independent runs at each packing"),
        "density_seconds": _variable(seconds, "CPU time of all these runs", "s"),
    }


def _gap(part, k):
    many = Measured(float(part.R_many), float(part.R_many_stderr))
    few = Measured(float(part.R_few), float(part.R_few_stderr))
    gap = _mean(part.R.values[k]).over(few.over(many))
    return gap.value / float(part.theory) - 1, gap.stderr / float(part.theory)


def _coordinates(parts, settings):
    points = np.array(settings["density"]["points"], float)
    row = parts[f"map-r{settings['map']['r'][0]}"]
    restitution, roughness = "normal restitution", "tangential restitution"
    lengths = {
        f"{x}_length": _variable(
            np.array(settings[x], float),
            f"length of a run by {name}",
            "collisions per particle",
            (f"{x}_length",),
        )
        for x, name in METHODS.items()
    }
    return lengths | {
        "map_r": _variable(np.array(settings["map"]["r"], float), restitution, dims="map_r"),
        "map_beta": _variable(row.beta.values, roughness, dims="map_beta"),
        "density_r": _variable(points[:, 0], restitution, dims="density_point"),
        "density_beta": _variable(points[:, 1], roughness, dims="density_point"),
        "packing": _variable(
            np.array(settings["density"]["packings"], float), "packing fraction", dims="packing"
        ),
    }
