"""Values of R of a freely cooling gas by every method, and CPU seconds without compiling."""

import functools
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.studies.accuracy.runs.free_cooling import (
    FreeCooling,
    event_driven,
    few_particles,
    homogeneous,
    rate_equations,
)
from roughgas.theory import cooling_ratio

# Each kind of job draws from streams of its own
REFERENCE, EVENT_DRIVEN, DSMC, MAP, DENSITY = range(5)
SECONDS = 0.2  # of CPU, over which the time of one call is averaged
WARM = 2.0  # collisions per particle that are simulated beforehand, to have the code compiled


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what one task finds, as roughgas.studies.accuracy.models combines it."""
    kind, _, place = task.partition("-")
    cooling = FreeCooling(experiments["cooling"], float(settings["r"]), float(settings["beta"]))
    jobs = {"map": _map, "density": _density, "reference": _reference, "theory": _theory}
    jobs |= {"event_driven": _event_driven, "dsmc": _dsmc}
    return xr.Dataset(*jobs[kind](cooling, settings, progress, place))


def stream(settings: Mapping[str, Any], *key: int) -> np.random.SeedSequence:
    """Return the seed of the stream that belongs to a kind of job, and to what else it counts."""
    return np.random.SeedSequence(settings["seed"], spawn_key=key)


def _reference(cooling, settings, _, place):
    chosen = settings["reference"]
    event_driven(cooling, WARM, WARM, stream(settings, REFERENCE))
    length, seed = chosen["length"] / chosen["jobs"], stream(settings, REFERENCE, 1 + int(place))
    R, seconds = event_driven(cooling, length, settings["segment"], seed)
    return ({"R": ("replica", R), "seconds": seconds},)


def _event_driven(cooling, settings, progress, _):
    def one(length, seed):
        R, seconds = event_driven(cooling, length, settings["segment"], seed)
        return R.mean(), seconds

    return _levels("event_driven", EVENT_DRIVEN, one, settings, progress)


def _dsmc(cooling, settings, progress, _):
    one = functools.partial(few_particles, cooling)
    found, lengths = _levels("dsmc", DSMC, one, settings, progress)
    rng = np.random.default_rng(stream(settings, MAP, DSMC))
    number, precision = settings["map"]["particles"], settings["density"]["precision"]
    many = homogeneous(cooling, number, precision, rng)
    return found | {f"homogeneous_{name}": x for name, x in many.items()}, lengths


def _levels(name, kind, one, settings, progress):
    """Return R and CPU seconds of every length and group; all have random numbers of their own."""
    lengths, groups = settings[name], settings["groups"]
    one(WARM, stream(settings, kind))
    values = np.empty((2, len(lengths), groups))
    for k, length in enumerate(lengths):
        for group in range(groups):
            values[:, k, group] = one(length, stream(settings, kind, 1 + k, group))
            progress(k * groups + group + 1, len(lengths) * groups)
    dims = (f"{name}_length", "group")
    return {"R": (dims, values[0]), "seconds": (dims, values[1])}, {dims[0]: lengths}


def _theory(cooling, settings, progress, _):
    constants = cooling.constants
    closed_R, closed_seconds = _timed(lambda: float(cooling_ratio(*constants)))
    lengths, rates = settings["rate_equations"], []
    for k, length in enumerate(lengths):
        rates.append(_timed(functools.partial(rate_equations, length, *constants)))
        progress(k + 1, len(lengths))
    R, seconds = (("rate_equations_length", list(x)) for x in zip(*rates, strict=True))
    found = {"closed_form_R": closed_R, "closed_form_seconds": closed_seconds}
    return found | {"R": R, "seconds": seconds}, {"rate_equations_length": lengths}


def _timed(function):
    """Return what a function returns, and the CPU seconds of a call, its mean over SECONDS."""
    calls, begin = 0, time.process_time()
    while (seconds := time.process_time() - begin) < SECONDS:
        found, calls = function(), calls + 1
    return found, seconds / calls


def _map(cooling, settings, progress, place):
    """The homogeneous gas at one r and every beta."""
    chosen, r, rows = settings["map"], place.removeprefix("r"), []
    row = [str(one) for one in chosen["r"]].index(r)
    homogeneous(cooling._replace(r=float(r), beta=1.0), 10, 1.0, np.random.default_rng(0))
    for k, beta in enumerate(chosen["beta"]):
        rng = np.random.default_rng(stream(settings, MAP, row, k))
        there = cooling._replace(r=float(r), beta=float(beta))
        found = homogeneous(there, chosen["particles"], chosen["precision"], rng)
        explained = there.with_cumulants(found["a20"], found["a11"])
        rows.append(found | {"theory": there.ratio, "explained": explained})
        progress(k + 1, len(chosen["beta"]))
    columns = {name: ("beta", [found[name] for found in rows]) for name in rows[0]}
    return columns, {"beta": [float(one) for one in chosen["beta"]], "r": float(r)}


def _density(cooling, settings, _, place):
    """Event-driven dynamics at several packing fractions, and DSMC of as many particles and of
    many: their ratio tells what is due to the number."""
    chosen, (r, beta) = settings["density"], place.removeprefix("r").split("-beta")
    row = [[str(x) for x in one] for one in chosen["points"]].index([r, beta])
    cooling = cooling._replace(r=float(r), beta=float(beta))
    event_driven(cooling, WARM, WARM, stream(settings, DENSITY))
    R, seconds = [], []
    for k, packing in enumerate(chosen["packings"]):
        seed = stream(settings, DENSITY, row, k)
        there = cooling.at_packing(packing)
        found = event_driven(there, chosen["length"], settings["segment"], seed)
        R.append(found[0])
        seconds.append(found[1])
    numbers = cooling.experiment["particles"], settings["map"]["particles"]
    seeds = stream(settings, DENSITY, row, len(R)).spawn(2)
    few, many = (
        homogeneous(cooling, number, chosen["precision"], np.random.default_rng(seed))
        for number, seed in zip(numbers, seeds, strict=True)
    )
    found = {"R": (("packing", "replica"), np.array(R)), "seconds": ("packing", seconds)}
    for name, one in (("R_few", few), ("R_many", many)):
        found |= {name: one["R"], f"{name}_stderr": one["R_stderr"]}
    found |= {"theory": cooling.ratio, "dsmc_seconds": few["seconds"] + many["seconds"]}
    return found, {"packing": list(chosen["packings"]), "r": float(r), "beta": float(beta)}
