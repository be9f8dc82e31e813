"""What is off in a model of a freely cooling gas, and what the model costs.

Closed form, rate equations, direct simulation Monte Carlo and event-driven dynamics of the gas of
experiment `cooling` at one (r, beta); and, over (r, beta), how far the homogeneous gas is from the
closed form, whose velocities are Maxwellian and uncorrelated.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

EXPERIMENT = "cooling"
# Each kind of job draws from streams of its own
REFERENCE, EVENT_DRIVEN, DSMC, MAP, DENSITY = range(5)
SECONDS = 0.2  # of CPU, over which the time of one call is averaged
WARM = 2.0  # collisions per particle that are simulated beforehand, to have the code compiled


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Names of the independent jobs, the longest first."""
    return [
        *(f"reference-{k}" for k in range(settings["reference"]["jobs"])),
        *(f"map-r{r}" for r in settings["map"]["r"]),
        *(f"density-r{r}-beta{beta}" for r, beta in settings["density"]["points"]),
        "event_driven",
        "dsmc",
        "theory",
    ]


def run(
    task: str,
    settings: Mapping[str, Any],
    experiments: Mapping[str, Any],
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> "xr.Dataset":
    """The dataset of one job: values of R, and CPU seconds without those of compiling."""
    experiment = experiments[EXPERIMENT]
    kind, _, rest = task.partition("-")
    if kind == "map":
        return _map(rest.removeprefix("r"), settings, experiment, progress)
    if kind == "density":
        r, beta = rest.removeprefix("r").split("-beta")
        return _density(r, beta, settings, experiment)
    point = _point(experiment, settings["r"], settings["beta"])
    if kind == "reference":
        return _reference(point, settings, int(rest))
    jobs = {"event_driven": _event_driven, "dsmc": _dsmc, "theory": _theory}
    return jobs[kind](point, settings, progress)


def combine(parts: Mapping[str, "xr.Dataset"], settings: Mapping[str, Any]) -> "xr.Dataset":
    """The group `models` of the dataset of all accuracy studies."""
    from roughgas.studies.accuracy.model_errors import combined

    return combined(parts, settings)


def stream(settings: Mapping[str, Any], *key: int) -> np.random.SeedSequence:
    """The seed of the stream that belongs to a kind of job, and to whatever else it counts."""
    return np.random.SeedSequence(settings["seed"], spawn_key=key)


def _point(experiment, r, beta):
    from roughgas.studies.accuracy.free_cooling import Point

    return Point(experiment, float(r), float(beta))


def _reference(point, settings, job):
    import xarray as xr

    from roughgas.studies.accuracy.free_cooling import event_driven

    chosen = settings["reference"]
    event_driven(point, WARM, WARM, stream(settings, REFERENCE))
    seed = stream(settings, REFERENCE, 1 + job)
    R, seconds = event_driven(point, chosen["length"] / chosen["jobs"], settings["segment"], seed)
    return xr.Dataset({"R": ("replica", R), "seconds": seconds})


def _event_driven(point, settings, progress):
    from roughgas.studies.accuracy.free_cooling import Result, event_driven

    def result(length, seed):
        R, seconds = event_driven(point, length, settings["segment"], seed)
        return Result(R.mean(), seconds)

    return _levels("event_driven", EVENT_DRIVEN, result, settings, progress)


def _dsmc(point, settings, progress):
    from roughgas.studies.accuracy.free_cooling import homogeneous, simulated

    def result(length, seed):
        return simulated(point, length, np.random.default_rng(seed))

    levels = _levels("dsmc", DSMC, result, settings, progress)
    rng = np.random.default_rng(stream(settings, MAP, DSMC))
    large = homogeneous(point, settings["map"]["particles"], settings["density"]["precision"], rng)
    return levels.assign({f"homogeneous_{name}": x for name, x in large._asdict().items()})


def _levels(name, kind, result, settings, progress):
    """R and CPU seconds of every length and group; all have random numbers of their own."""
    import xarray as xr

    lengths, groups = settings[name], settings["groups"]
    result(WARM, stream(settings, kind))
    values = np.empty((2, len(lengths), groups))
    for k, length in enumerate(lengths):
        for group in range(groups):
            values[:, k, group] = result(length, stream(settings, kind, 1 + k, group))
            progress(k * groups + group + 1, len(lengths) * groups)
    dims = (f"{name}_length", "group")
    variables = {"R": (dims, values[0]), "seconds": (dims, values[1])}
    return xr.Dataset(variables, {dims[0]: lengths})


def _theory(point, settings, progress):
    import xarray as xr

    from roughgas.studies.accuracy.free_cooling import closed_form, rate_equations

    closed = closed_form(point, _calls(closed_form(point, 10).seconds))
    durations = settings["rate_equations"]
    rates = []
    for k, duration in enumerate(durations):
        once = rate_equations(point, duration, 1).seconds
        rates.append(rate_equations(point, duration, _calls(once)))
        progress(k + 1, len(durations))
    R, seconds = zip(*rates, strict=True)
    return xr.Dataset(
        {
            "closed_form_R": closed.R,
            "closed_form_seconds": closed.seconds,
            "R": ("rate_equations_length", list(R)),
            "seconds": ("rate_equations_length", list(seconds)),
        },
        {"rate_equations_length": durations},
    )


def _calls(seconds):
    return max(1, round(SECONDS / max(seconds, 1e-7)))


def _map(r, settings, experiment, progress):
    """The homogeneous gas at one r and every beta."""
    import xarray as xr

    from roughgas.studies.accuracy.free_cooling import Homogeneous, homogeneous

    chosen, rows = settings["map"], []
    row = [str(one) for one in chosen["r"]].index(r)
    homogeneous(_point(experiment, r, 1.0), 10, 1.0, np.random.default_rng(0))
    for k, beta in enumerate(chosen["beta"]):
        rng = np.random.default_rng(stream(settings, MAP, row, k))
        point = _point(experiment, r, beta)
        found = homogeneous(point, chosen["particles"], chosen["precision"], rng)
        rows.append((*found, point.theory, point.with_cumulants(found.a20, found.a11)))
        progress(k + 1, len(chosen["beta"]))
    names = (*Homogeneous._fields, "theory", "explained")
    columns = zip(names, np.transpose(rows), strict=True)
    beta = [float(one) for one in chosen["beta"]]
    return xr.Dataset({name: ("beta", x) for name, x in columns}, {"beta": beta, "r": float(r)})


def _density(r, beta, settings, experiment):
    """Event-driven dynamics at several packing fractions, and DSMC of as many particles and of
    many: their ratio tells what is due to the number."""
    import xarray as xr

    from roughgas.studies.accuracy.free_cooling import homogeneous

    chosen = settings["density"]
    place = [[str(x) for x in one] for one in chosen["points"]].index([r, beta])
    point = _point(experiment, r, beta)
    R, seconds = zip(*_at_packings(point, place, settings), strict=True)
    few, many = (
        homogeneous(point, number, chosen["precision"], np.random.default_rng(seed))
        for number, seed in zip(
            (experiment["particles"], settings["map"]["particles"]),
            stream(settings, DENSITY, place, len(R)).spawn(2),
            strict=True,
        )
    )
    return xr.Dataset(
        {
            "R": (("packing", "replica"), np.array(R)),
            "seconds": ("packing", list(seconds)),
            "R_few": few.R,
            "R_few_stderr": few.R_stderr,
            "R_many": many.R,
            "R_many_stderr": many.R_stderr,
            "theory": point.theory,
            "dsmc_seconds": few.seconds + many.seconds,
        },
        {"packing": list(chosen["packings"]), "r": float(r), "beta": float(beta)},
    )


def _at_packings(point, place, settings):
    """R of the replicas, and CPU seconds, at each packing fraction."""
    from roughgas.studies.accuracy.free_cooling import at_packing, event_driven

    chosen = settings["density"]
    event_driven(point, WARM, WARM, stream(settings, DENSITY))
    for k, packing in enumerate(chosen["packings"]):
        moved = point._replace(experiment=at_packing(point.experiment, packing))
        seed = stream(settings, DENSITY, place, k)
        yield event_driven(moved, chosen["length"], settings["segment"], seed)
