"""Values of R of a freely cooling gas by every method, and CPU seconds without compiling."""

import time
from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr

from roughgas.tasks import stream, timed
from roughgas.tasks.free_cooling import (
    FreeCooling,
    corrected_ratio,
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
    """Return what one task finds, as roughgas.studies.models combines it."""
    kind, _, place = task.partition("-")
    cooling = FreeCooling(experiments["cooling"], float(settings["r"]), float(settings["beta"]))
    jobs = {"map": _map, "density": _density, "reference": _reference, "theory": _theory}
    jobs |= {"event_driven": _event_driven, "dsmc": _dsmc}
    return xr.Dataset(*jobs[kind](cooling, settings, progress, place))


def _reference(cooling, settings, _, place):
    chosen = settings["reference"]
    event_driven(cooling, WARM, WARM, stream(settings, REFERENCE))
    length, seed = chosen["length"] / chosen["jobs"], stream(settings, REFERENCE, 1 + int(place))
    R, seconds = timed(event_driven, cooling, settings["segment"], length, seed)
    return ({"R": ("replica", R), "seconds": seconds},)


def _event_driven(cooling, settings, progress, _):
    one = partial(event_driven, cooling, settings["segment"])
    return _levels("event_driven", EVENT_DRIVEN, one, settings, progress)


def _dsmc(cooling, settings, progress, _):
    one = partial(few_particles, cooling)
    found, lengths = _levels("dsmc", DSMC, one, settings, progress)
    number, precision = settings["map"]["particles"], settings["density"]["precision"]
    many = homogeneous(cooling, number, precision, stream(settings, MAP, DSMC))
    return found | {f"homogeneous_{name}": x for name, x in many.items()}, lengths


def _levels(name, kind, one, settings, progress):
    """Return R and CPU seconds of every length and group; all have random numbers of their own."""
    lengths, groups = settings[name], settings["groups"]
    one(WARM, stream(settings, kind))
    values = np.empty((2, len(lengths), groups))
    for k, length in enumerate(lengths):
        for group in range(groups):
            R, seconds = timed(one, length, stream(settings, kind, 1 + k, group))
            values[:, k, group] = np.mean(R), seconds
            progress(k * groups + group + 1, len(lengths) * groups)
    dims = (f"{name}_length", "group")
    return {"R": (dims, values[0]), "seconds": (dims, values[1])}, {dims[0]: lengths}


def _theory(cooling, settings, progress, _):
    constants, lengths = cooling.constants, settings["rate_equations"]
    closed_R, closed_seconds = _averaged(lambda: float(cooling_ratio(*constants)))
    rates = []
    for k, length in enumerate(lengths):
        rates.append(_averaged(partial(rate_equations, length, *constants)))
        progress(k + 1, len(lengths))
    R, seconds = (("rate_equations_length", list(x)) for x in zip(*rates, strict=True))
    found = {"closed_form_R": closed_R, "closed_form_seconds": closed_seconds}
    return found | {"R": R, "seconds": seconds}, {"rate_equations_length": lengths}


def _averaged(function):
    """Return what a function returns, and the CPU seconds of a call, its mean over SECONDS."""
    calls, begin = 0, time.process_time()
    while (seconds := time.process_time() - begin) < SECONDS:
        found, calls = function(), calls + 1
    return found, seconds / calls


def _map(cooling, settings, progress, place):
    """The homogeneous gas at one r and every beta."""
    chosen, r, rows = settings["map"], place.removeprefix("r"), []
    row = [str(one) for one in chosen["r"]].index(r)
    homogeneous(cooling._replace(r=float(r), beta=1.0), 10, 1.0, 0)
    for k, beta in enumerate(chosen["beta"]):
        there = cooling._replace(r=float(r), beta=float(beta))
        seed = stream(settings, MAP, row, k)
        found = homogeneous(there, chosen["particles"], chosen["precision"], seed)
        explained = corrected_ratio(found["a20"], found["a11"], *there.constants)
        rows.append(found | {"theory": cooling_ratio(*there.constants), "explained": explained})
        progress(k + 1, len(chosen["beta"]))
    columns = {name: ("beta", [float(found[name]) for found in rows]) for name in rows[0]}
    return columns, {"beta": [float(one) for one in chosen["beta"]], "r": float(r)}


def _density(cooling, settings, _, place):
    """Event-driven dynamics at several packing fractions, and DSMC of as many particles and of
    many: their ratio tells what is due to the number."""
    chosen, (r, beta) = settings["density"], place.removeprefix("r").split("-beta")
    row = [[str(x) for x in one] for one in chosen["points"]].index([r, beta])
    cooling = cooling._replace(r=float(r), beta=float(beta))
    event_driven(cooling, WARM, WARM, stream(settings, DENSITY))
    runs = []
    for k, packing in enumerate(chosen["packings"]):
        there, seed = cooling.at_packing(packing), stream(settings, DENSITY, row, k)
        runs.append(timed(event_driven, there, settings["segment"], chosen["length"], seed))
    R, seconds = zip(*runs, strict=True)
    found = {"R": (("packing", "replica"), np.array(R)), "seconds": ("packing", list(seconds))}
    numbers = {"few": cooling.experiment["particles"], "many": settings["map"]["particles"]}
    seeds, dsmc_seconds = stream(settings, DENSITY, row, len(R)).spawn(2), 0.0
    for (name, number), seed in zip(numbers.items(), seeds, strict=True):
        one = homogeneous(cooling, number, chosen["precision"], seed)
        found |= {f"R_{name}": one["R"], f"R_{name}_stderr": one["R_stderr"]}
        dsmc_seconds += one["seconds"]
    found |= {"theory": float(cooling_ratio(*cooling.constants)), "dsmc_seconds": dsmc_seconds}
    return found, {"packing": list(chosen["packings"]), "r": float(r), "beta": float(beta)}
