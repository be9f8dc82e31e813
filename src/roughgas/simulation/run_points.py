"""The loop over the points of an experiment, with provenance attributes and checkpoints.

Nothing here changes the numbers of a point: after an edit of this module's imports,
rules/simulate.smk does not run points again.
"""

import hashlib
import marshal
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np

from roughgas.base import InputError, NamedValues
from roughgas.base.labels import GridPoint, level, parameter_of
from roughgas.data.point import Point, check
from roughgas.effects import sources_of
from roughgas.scene import Scene, build
from roughgas.simulation.checkpoint import Checkpoint, discard, resumable
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.finished_points import FinishedPoints
from roughgas.simulation.initial_states import CARRIED, SEED, InitialState
from roughgas.simulation.point import run_point
from roughgas.simulation.progress import RunProgress
from roughgas.simulation.state_encoding import UnusableCheckpoint
from roughgas.simulation.tracker import Tracker

SOURCE_FOLDERS = (
    "base compiling effects kernel observables scene simulation statistics theory".split()
)
"""Folders of the sources that a run depends on: if they change, its checkpoint is not used."""
MARSHAL_VERSION = 2  # of marshal's format, without references, which are not deterministic


def simulate_points(
    name: str,
    experiment: Experiment[Any],
    grid_points: Sequence[GridPoint],
    scale: str,
    outputs: Sequence[str],
    initial: Sequence[InitialState] = (),
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    extra_arguments: Sequence[str] = (),
    quiet: bool = False,
    checkpoints: Sequence[str] = (),
    trackers: Sequence[Tracker] = (),
    finished: FinishedPoints | None = None,
) -> Iterator[Point]:
    """Simulate the points of an experiment, and yield each with its attributes.

    `name` is the experiment's name in messages and attributes, and `scale` the name of its size in
    the attributes. The `grid_points` have r, beta and seed; `outputs` has the path of each point's
    dataset, for its attribute `command`, which also has `extra_arguments`. `initial` has the
    initial states of the replicas of each point, and `functions` are observables of frames by name.
    `quiet` shows no progress. `checkpoints` are the paths of the points' checkpoints, one for each
    or none, which are removed after the last point. `trackers` receive the samples of all points.
    Points in `finished` are not simulated again; they, too, are removed after the last point.

    Raises InputError and CollapseError as `run_point`; an illegal scene raises before any point is
    simulated.
    """
    scenes = {(r, beta): build(experiment, r, beta) for r, beta, *_ in grid_points}
    paths: Sequence[str | None] = checkpoints or [None] * len(grid_points)
    for grid_point, output, path in zip(grid_points, outputs, paths, strict=True):
        r, beta, seed, labels = grid_point
        label = name
        if len(grid_points) > 1:
            label = f"{name}, r = {labels[0]}, beta = {labels[1]}, seed {seed}"
        noise = initial[0].noise if initial else SEED
        attributes = provenance(
            name, experiment, labels, scale, output, extra_arguments=extra_arguments, noise=noise
        )
        run_arguments = scenes[r, beta], experiment, grid_point, initial, functions
        point = None
        if finished is not None:
            point = finished.take(
                output, checkpoint_owner(*run_arguments, attributes, _sources("data"))
            )
        if point is None:
            point = _simulated(label, *run_arguments, trackers, path=path, quiet=quiet)
        yield point._replace(attributes=attributes | point.attributes)
    for path in checkpoints:
        discard(path)
    if finished is not None:
        finished.discard()


def _simulated(
    name: str,
    scene: Scene,
    experiment: Experiment[Any],
    grid_point: GridPoint,
    initial: Sequence[InitialState],
    functions: Mapping[str, Callable[[Any], Any]] | None,
    trackers: Sequence[Tracker],
    path: str | None,
    quiet: bool,
) -> Point:
    """Simulate a point, with `name` in messages, and a checkpoint at `path`.

    If the content of the checkpoint makes the run fail, it restarts without it.
    """
    owner = checkpoint_owner(scene, experiment, grid_point, initial, functions) if path else ""
    while True:  # twice at most: a checkpoint that is refused is removed
        with (
            RunProgress(name, scene, experiment, quiet=quiet) as bar,
            resumable(path, owner, bar.say) as checkpoint,
        ):
            all_trackers = [bar, *trackers]
            try:
                point = run_point(
                    scene, experiment, grid_point.seed, initial, functions, all_trackers, checkpoint
                )
                check(point)
                return point
            except Exception as error:
                if checkpoint is None or not checkpoint.may_have_caused(error):
                    raise
                _refuse(checkpoint, error, bar.say, trackers, functions)


def _refuse(
    checkpoint: Checkpoint,
    error: Exception,
    say: Callable[[str], None],
    trackers: Sequence[Tracker],
    functions: Mapping[str, Callable[[Any], Any]] | None,
) -> None:
    """Refuse a checkpoint whose content may have caused the `error` of a run; `say` reports it.

    Raises InputError if user trackers have received samples of the run, and the error itself if
    user functions or trackers may have raised it.
    """
    if (functions or trackers) and not isinstance(error, UnusableCheckpoint):
        raise error
    if trackers:
        legal = "hold what a run of these settings has kept: remove it, and begin with new trackers"
        raise InputError("checkpoint", checkpoint.path, legal) from error
    checkpoint.refuse(error, say)


def checkpoint_owner(
    scene: Scene,
    experiment: Experiment[Any],
    grid_point: GridPoint,
    initial: Sequence[InitialState],
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    *extra_facts: Any,
) -> str:
    """Return a hash that identifies a run and the sources of its results, for its checkpoint.

    Other runs do not resume from the checkpoint. `extra_facts` are further values to be hashed.
    Sources are the package, registered effects and observables, and user `functions`.
    """
    sources = _sources(*SOURCE_FOLDERS), sources_of(scene.effects)
    facts = [*sources, np.__version__, experiment.text, grid_point[:3]]
    codes = {name: _code(function) for name, function in (functions or {}).items()}
    states = [(state.digest(), state.noise) for state in initial]
    text = repr([*facts, *extra_facts, codes, _codes_of_registered(experiment), states])
    return hashlib.sha256(text.encode()).hexdigest()


def _codes_of_registered(experiment: Experiment[Any]) -> dict[str, str | list[bytes]]:
    """Return the compiled code of the observables that users have registered, by name.

    Of an observable of a study it is the hash of its sources.
    """
    if not experiment.observables:
        return {}
    from roughgas.observables import OBSERVABLES  # slow to import

    kinds = {name: OBSERVABLES[name] for name in experiment.observables}
    return {
        name: getattr(kind, "source_hash", None) or _code(kind)
        for name, kind in kinds.items()
        if not kind.__module__.startswith("roughgas.")
    }


def _code(definition: Any) -> list[bytes]:
    """Return the compiled code of a function, or of the methods of a class or of an object's class.

    It does not include the code of functions that these call.
    """
    if not hasattr(definition, "__code__"):
        kind = definition if isinstance(definition, type) else type(definition)
        methods = [method for method in vars(kind).values() if hasattr(method, "__code__")]
    else:
        methods = [definition]
    return [marshal.dumps(method.__code__, MARSHAL_VERSION) for method in methods]


@cache
def _sources(*rooms: str) -> str:
    """Return a hash of the sources in folders of the package, given by name."""
    from roughgas.compiling.cache_folders import source_hash  # only a run needs the compiler

    return source_hash(*rooms)


def provenance(
    name: str,
    experiment: Experiment[Any],
    point: tuple[str, str, str],
    scale: str,
    output: str,
    verb: str = "run",
    extra_arguments: Sequence[str] = (),
    noise: str = SEED,
) -> NamedValues:
    """Return the attributes of a point's dataset that suffice to reproduce it, by name.

    `point` has its labels (r, beta, seed), and `scale` is the name of the size of the experiment.
    The attribute `command` is `roughgas VERB` with `extra_arguments` and `output`, the path. Its
    option `noise` has the seed, unless the initial state carries it (see
    roughgas.simulation.initial_states). Raises InputError if the `name` of the experiment and the
    settings disagree.
    """
    text = experiment.text
    r, beta, seed = point
    command = ["roughgas", verb, name, "--scale", scale]
    # joined by =, so that a negative number is not taken for an option
    command += [f"--r={r}", f"--beta={beta}"]
    command += [] if noise == CARRIED else [f"--{noise}={seed}"]
    command += [*extra_arguments, "--settings", text, "--output", output]
    return {
        "title": f"{name}: r = {r}, beta = {beta}",
        **variant_attributes(name, experiment),
        "scale": scale,
        "r_label": r,
        "beta_label": beta,
        "experiment_json": text,
        "command": shlex.join(command),
    }


def variant_attributes(name: str, experiment: Experiment[Any]) -> NamedValues:
    """Return the attributes that identify a dataset's experiment and its variant, if any.

    `name` is `EXPERIMENT` or `EXPERIMENT/VARIANT`. Raises InputError if name and settings disagree.
    """
    base, slash, variant = name.partition("/")
    key, value = experiment.swept, experiment.level
    if key is None and not slash:
        return {"experiment": base}
    label = variant.removeprefix(parameter_of(key or ""))
    if value is None or label == variant or level(label) != value:
        raise InputError("experiment", name, "be the variant that its settings are of")
    return {"experiment": base, "variant": variant, "swept": key, "swept_value": value}
