"""The statistical error of R against CPU seconds: how run length and number of seeds lower it.

R is estimated many times, from disjoint stretches of independent simulations ("chains"), each of
which is equilibrated once. The estimates of one kind are called a level: means over runs of one
length, or over so many runs of the shortest length. Their root mean square distance from the mean
of other chains, the reference, is the observed error of the level. By the law of large numbers it
falls as t^(-1/2) with the time t of measurement, either way.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.studies.accuracy.square_root_law import noise, observed, slope, time_from_blocks

if TYPE_CHECKING:
    import xarray

SCENES = ("vibrated", "sheared", "cooling")
WAYS = ("length", "seeds")
REFERENCE = "reference"
RELATIVE_ERRORS = (0.01, 0.003, 0.001)
SCENE, WAY, LEVEL, ACCURACY = "scene", "way", "level", "relative_error"
BLOCK = 50  # autocorrelation times: beyond ten of them no tail is left
GENEROSITY = 4
"""A level gets more groups than it must have until it costs a fourth of the longest one."""


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """The independent jobs: for each scene the reference, and the levels of either way."""
    return [f"{scene}-{part}" for part in (REFERENCE, *WAYS) for scene in SCENES]


def run(
    task: str,
    settings: Mapping[str, Any],
    experiments: Mapping[str, Mapping[str, Any]],
    progress: Callable[[int, int], None] | None = None,
) -> "xarray.Dataset":
    """One job of `tasks`, as the estimates of R and their costs.

    A reference has dimension (chain,), levels have (level, group), NaN where a level has fewer
    groups. Raises InputError for settings that are illegal, CollapseError as a simulation does.
    """
    import xarray

    scene, part = task.split("-")
    setup = Setup(scene, settings, experiments[scene])
    setup.chain(np.random.SeedSequence(0)).measure(setup.shortest)  # compiles
    where = (SCENES.index(scene), (REFERENCE, *WAYS).index(part))
    streams = np.random.SeedSequence(settings["seed"], spawn_key=where)
    measured = {REFERENCE: _reference, "length": _lengths, "seeds": _seeds}[part]
    variables = measured(setup, streams, progress or (lambda done, total: None))
    return xarray.Dataset(variables, attrs={"task": task})


class Setup:
    """What the jobs of a scene have in common: its settings, and its chains."""

    def __init__(self, scene: str, settings: Mapping[str, Any], experiment: Mapping[str, Any]):
        own = settings["scenes"][scene]
        self.experiment = experiment
        self.r, self.beta = float(settings["r"]), float(settings["beta"])
        self.equilibrate, self.shortest = own["equilibrate"], own["shortest"]
        self.levels, self.groups = settings["levels"], settings["groups"]
        self.reference, self.chains = settings["reference"], settings["chains"]

    def chain(self, stream: np.random.SeedSequence):
        """A chain of its own random numbers."""
        from roughgas.studies.accuracy.chain import Chain

        rng = np.random.default_rng(stream)
        return Chain(self.experiment, self.r, self.beta, self.equilibrate, rng)

    def stretches(self, level: int) -> int:
        """How many groups of 2^`level` shortest stretches there are for each that there must be."""
        return max(1, 2 ** (self.levels - 1 - level) // GENEROSITY)


def _reference(setup, streams, progress) -> dict[str, tuple]:
    """Chains that are together `reference` times as long as the longest level."""
    total = setup.reference * 2 ** (setup.levels - 1) * setup.shortest
    parts = []
    for stream in _counted(streams.spawn(setup.chains), progress):
        chain = setup.chain(stream)
        length = math.ceil(total / setup.chains / setup.shortest) * setup.shortest
        parts.append((chain.equilibration, *_reference_chain(chain, length)))
    columns = zip(*parts, strict=True)
    return {name: ("chain", list(values)) for name, values in zip(PER_CHAIN, columns, strict=True)}


PER_CHAIN = (
    "equilibration",
    "R",
    "variance",
    "autocorrelation_time",
    "windowed_time",
    "time",
    "seconds",
    "contacts",
)


def _reference_chain(chain, length):
    from roughgas.statistics.errors import autocorrelation_time

    R, seconds, contacts = chain.measure(length)
    unit = length / len(R)
    windowed = autocorrelation_time(R)
    whole = time_from_blocks(R, math.ceil(BLOCK * windowed))
    return R.mean(), R.var(), whole * unit, windowed * unit, length, seconds, contacts


def _lengths(setup, streams, progress) -> dict[str, tuple]:
    """Estimates from one run each: level k takes 2^k times the shortest length."""
    found = [([], []) for _ in range(setup.levels)]
    equilibration = []
    for stream in _counted(streams.spawn(setup.groups), progress):
        chain = setup.chain(stream)
        equilibration.append(chain.equilibration)
        for level, (R, seconds) in enumerate(found):
            for _ in range(setup.stretches(level)):
                segment = chain.measure(2**level * setup.shortest)
                R.append(segment.R.mean())
                seconds.append(segment.seconds)
    return _levels(found, equilibration)


def _seeds(setup, streams, progress) -> dict[str, tuple]:
    """Estimates from 2^k runs of the shortest length, each of another chain, at level k."""
    chains = 2 ** (setup.levels - 1)
    counts = [
        math.ceil(setup.groups * setup.stretches(level) * 2**level / chains)
        for level in range(setup.levels)
    ]
    R, seconds = np.empty((2, chains, sum(counts)))
    equilibration = []
    for k, stream in enumerate(_counted(streams.spawn(chains), progress)):
        chain = setup.chain(stream)
        equilibration.append(chain.equilibration)
        for segment in range(sum(counts)):
            measured = chain.measure(setup.shortest)
            R[k, segment], seconds[k, segment] = measured.R.mean(), measured.seconds
    ends = np.cumsum(counts)
    found = []
    for level, (end, count) in enumerate(zip(ends, counts, strict=True)):
        own = (part[:, end - count : end].T.reshape(-1, 2**level) for part in (R, seconds))
        R_groups, seconds_groups = own
        found.append((R_groups.mean(axis=1), seconds_groups.sum(axis=1)))
    return _levels(found, equilibration)


def _levels(found, equilibration) -> dict[str, tuple]:
    """The groups of all levels as arrays, NaN where a level has no more."""
    most = max(len(R) for R, _ in found)
    filled = np.full((2, len(found), most), np.nan)
    for level, pair in enumerate(found):
        for array, values in zip(filled, pair, strict=True):
            array[level, : len(values)] = values
    return {
        "R": ((LEVEL, "group"), filled[0]),
        "seconds": ((LEVEL, "group"), filled[1]),
        "equilibration": ("chain", equilibration),
    }


def _counted(streams: list, progress) -> Iterator:
    for done, stream in enumerate(streams):
        progress(done, len(streams))
        yield stream
    progress(len(streams), len(streams))


def combine(parts: Mapping[str, "xarray.Dataset"], settings: Mapping[str, Any]) -> "xarray.Dataset":
    """Errors, slopes, autocorrelation times and what an accuracy costs; dimensions as named here.

    `parts` holds the result of every job of `tasks`.
    """
    import xarray

    rows = [_scene(scene, parts, settings) for scene in SCENES]
    variables = {
        name: ((SCENE, *dims), np.array([row[name] for row in rows]), _about(name))
        for name, dims in DIMENSIONS.items()
    }
    units = [LENGTH_UNITS[scene] for scene in SCENES]
    variables["length_unit"] = (SCENE, units, {"long_name": "unit of lengths", "units": ""})
    coordinates = {
        SCENE: list(SCENES),
        WAY: list(WAYS),
        ACCURACY: list(RELATIVE_ERRORS),
    }
    attributes = {key: settings[key] for key in ("r", "beta", "seed")}
    dataset = xarray.Dataset(variables, coordinates, attributes)
    for name, about in AXES.items():
        dataset[name].attrs["long_name"] = about
    return dataset


AXES = {
    SCENE: "what is simulated",
    WAY: "what is made longer or more: runs or seeds",
    ACCURACY: "error of R relative to R",
}
LENGTH_UNITS = {
    "vibrated": "T",
    "sheared": "T",
    "cooling": "collisions per particle",
}
ABOUT = {
    "R": ((), "R of the reference", "1"),
    "R_stderr": ((), "standard error of R of the reference", "1"),
    "variance": ((), "variance of R (over a period of the floor, if there is one)", "1"),
    "autocorrelation_time": ((), "integrated autocorrelation time of R", "length_unit"),
    "autocorrelation_time_stderr": ((), "its standard error", "length_unit"),
    "windowed_time": ((), "the same by emcee's window of three such times", "length_unit"),
    "noise": ((), "variance of R's mean times the length of the run", "length_unit"),
    "noise_stderr": ((), "its standard error", "length_unit"),
    "equilibration_seconds": ((), "CPU time to equilibrate a seed", "s"),
    "seconds_per_length": ((), "CPU time a unit of length", "s/length_unit"),
    "collisions_per_second": ((), "collisions a second of CPU time", "s-1"),
    "cpu_seconds": ((), "CPU time of all of the simulations", "s"),
    "length": ((WAY, LEVEL), "length of each run", "length_unit"),
    "seeds": ((WAY, LEVEL), "number of runs averaged", "1"),
    "groups": ((WAY, LEVEL), "number of independent estimates", "1"),
    "seconds": ((WAY, LEVEL), "CPU time of measurement for an estimate", "s"),
    "error": ((WAY, LEVEL), "root mean square error of R", "1"),
    "error_stderr": ((WAY, LEVEL), "standard error of the error", "1"),
    "slope": ((WAY,), "slope of log error against log CPU time", "1"),
    "slope_stderr": ((WAY,), "standard error of the slope", "1"),
    "length_needed": ((ACCURACY,), "length of the run for an error of R", "length_unit"),
    "seconds_needed": ((ACCURACY,), "CPU time for an error of R, equilibration included", "s"),
    "seconds_needed_stderr": ((ACCURACY,), "its standard error", "s"),
}
DIMENSIONS = {name: dims for name, (dims, _, _) in ABOUT.items()}


def _about(name):
    return {"long_name": ABOUT[name][1], "units": ABOUT[name][2]}


def _scene(scene, parts, settings) -> dict[str, Any]:
    """Every variable of one scene."""
    reference = parts[f"{scene}-{REFERENCE}"]
    ways = [parts[f"{scene}-{way}"] for way in WAYS]
    truth = float(reference.R.mean())
    levels = [observed(part.R.values, part.seconds.values, truth) for part in ways]
    sizes = 2.0 ** np.arange(settings["levels"])
    shortest, alone = settings["scenes"][scene]["shortest"], np.ones_like(sizes)
    lengths = np.array([sizes, alone]) * shortest
    lines = [slope(way) for way in levels]
    own = _about_reference(reference, ways) | {
        "length": lengths,
        "seeds": np.array([alone, sizes]).astype(int),
        "groups": [way.groups for way in levels],
        "seconds": [way.seconds for way in levels],
        "error": [way.error for way in levels],
        "error_stderr": [way.stderr for way in levels],
        "slope": [line.slope for line in lines],
        "slope_stderr": [line.stderr for line in lines],
    }
    return own | _costs(own, *noise(levels[0], lengths[0]))


def _about_reference(reference, ways) -> dict[str, float]:
    """What the reference tells about R, and all parts together about the costs."""
    chains, tau = reference.sizes["chain"], reference.autocorrelation_time
    seconds, time = float(reference.seconds.sum()), float(reference.time.sum())
    equilibration = np.concatenate([part.equilibration.values for part in (reference, *ways)])
    measured = seconds + sum(float(part.seconds.sum()) for part in ways)
    return {
        "R": float(reference.R.mean()),
        "R_stderr": float(reference.R.std(ddof=1)) / math.sqrt(chains),
        "variance": float(reference.variance.mean()),
        "autocorrelation_time": float(tau.mean()),
        "autocorrelation_time_stderr": float(tau.std(ddof=1)) / math.sqrt(chains),
        "windowed_time": float(reference.windowed_time.mean()),
        "equilibration_seconds": equilibration.mean(),
        "seconds_per_length": seconds / time,
        "collisions_per_second": float(reference.contacts.sum()) / seconds,
        "cpu_seconds": measured + equilibration.sum(),
    }


def _costs(own, noise, noise_stderr) -> dict[str, Any]:
    """What the relative errors cost on one core, with one seed."""
    length = noise / (np.array(RELATIVE_ERRORS) * own["R"]) ** 2
    seconds = own["seconds_per_length"] * length
    return {
        "noise": noise,
        "noise_stderr": noise_stderr,
        "length_needed": length,
        "seconds_needed": own["equilibration_seconds"] + seconds,
        "seconds_needed_stderr": seconds * noise_stderr / noise,
    }
