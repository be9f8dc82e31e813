"""What is handed to a simulation and written down of it: settings, observables, attributes.

Nothing here changes a number of a point: rules/simulate.smk runs none again after an edit of what
this imports.
"""

import hashlib
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from roughgas import config
from roughgas.base import EndedEarlyError, InputError
from roughgas.config import Place
from roughgas.data.point import Point
from roughgas.scene import build
from roughgas.simulation import schedule
from roughgas.simulation.journal import Journal
from roughgas.simulation.point import run_point
from roughgas.simulation.progress import Progress
from roughgas.simulation.restart import CARRIED, SEED, Initial

ROOMS = "base compiling effects kernel observables scene simulation statistics theory".split()
"""Where the sources are that a run's numbers depend on, between a stop and its going on."""
UNNAMED = "scene"
"""What messages and datasets call an experiment that has no name."""


def settings_of(
    name: str | None, changes: Mapping[str, Any], scale: str, path: str | Path | None
) -> dict[str, Any]:
    """Return the settings of a point, checked as those of the pipeline are.

    `changes` that are None change nothing. Without a name they are all that there is. Raises
    InputError.
    """
    given = {key: _plain(value) for key, value in changes.items() if value is not None}
    known = {} if name is None else config.load_experiment(path or config.SHIPPED, name, scale)
    settings = config.changed_by(config.point_settings(known), given)
    settings = config.validated(settings, name or UNNAMED)
    schedule.check(settings)
    return settings


def observables_of(
    observe: Sequence[str] | Mapping[str, Any] | None,
) -> tuple[dict[str, Any] | None, dict[str, Callable[[Any], Any]]]:
    """Return the observables that settings name, and those that are functions."""
    if observe is None:
        return None, {}
    named = [observe] if isinstance(observe, str) else observe
    given = named if isinstance(named, Mapping) else dict.fromkeys(named)
    functions = {name: one for name, one in given.items() if callable(one)}
    return {name: one or {} for name, one in given.items() if not callable(one)}, functions


def _plain(value: Any) -> Any:
    """Return a value as JSON would have it: no numpy, no tuples."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(inner) for inner in value]
    return value


def points(
    name: str,
    settings: Mapping[str, Any],
    at: Sequence[Place],
    scale: str,
    outputs: Sequence[str],
    initial: Sequence[Initial] = (),
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    told: Sequence[str] = (),
    quiet: bool = False,
    checkpoints: bool = False,
) -> Iterator[Point]:
    """Simulate the points of an experiment, and yield each with its attributes.

    Messages and attributes call it `name`, and attributes say that a command which is `told` more
    writes it to one of `outputs`. With `checkpoints` a point that takes minutes keeps beside its
    output how far it is, until all are there.

    Raises InputError and CollapseError as `run_point`, those of an illegal scene before anything is
    simulated.
    """
    scenes = {(r, beta): build(settings, r, beta) for r, beta, *_ in at}
    sources = _sources() if checkpoints else ""
    journals: list[Journal] = []
    for place, output in zip(at, outputs, strict=True):
        r, beta, seed, labels = place
        one = name if len(at) == 1 else f"{name}, r = {labels[0]}, beta = {labels[1]}, seed {seed}"
        noise = initial[0].noise if initial else SEED
        about = provenance(name, settings, labels, scale, output, told=told, noise=noise)
        journal = _journal(output, sources, settings, place, initial) if checkpoints else None
        journals += [journal] if journal else []
        with Progress(one, scenes[r, beta], settings, quiet=quiet) as bar:
            found = _run(scenes[r, beta], settings, seed, bar, initial, functions, journal)
        yield found._replace(attributes=about | found.attributes)
    for journal in journals:
        journal.discard()


def _sources() -> str:
    from roughgas.compiling.compiler import source_hash  # only a run needs the compiler

    return source_hash(*ROOMS)


def _journal(
    output: str,
    sources: str,
    settings: Mapping[str, Any],
    place: Place,
    initial: Sequence[Initial],
) -> Journal:
    """Return the journal of a point, beside the `output` that it is written to."""
    about = [sources, np.__version__, config.as_text(settings), place[:3]]
    text = repr([*about, [(state.digest(), state.noise) for state in initial]])
    owner = hashlib.sha256(text.encode()).hexdigest()
    return Journal(f"{output}.checkpoint.npz", owner)


def _run(scene, settings, seed, bar, initial, functions, journal):
    """Simulate a point; where it is stopped, say whether the next run goes on from there."""
    if journal and journal.refused:
        bar.say(f"{journal.path} {journal.refused}: starting afresh")
    if journal and journal.begun:
        bar.say(f"going on from {journal.path}")
    try:
        return run_point(scene, settings, seed, bar, initial, functions, journal)
    except EndedEarlyError:
        if journal:
            journal.discard()
        raise
    except KeyboardInterrupt:
        if journal and journal.path.exists():
            legal = f"the same command goes on from {journal.path}"
            raise KeyboardInterrupt(legal) from None
        raise


def provenance(
    experiment: str,
    settings: Mapping[str, Any],
    point: tuple[str, str, str],
    scale: str,
    output: str,
    verb: str = "run",
    told: Sequence[str] = (),
    noise: str = SEED,
) -> dict[str, Any]:
    """Return the attributes of a point's dataset that say how to make it again.

    `point` has its labels (r, beta, seed); the command among the attributes, `roughgas VERB`, is
    told what else is in `told`, and writes to `output`. Its option `noise` has the seed, or none
    where the state that it begins in has it (see roughgas.simulation.restart).
    Raises InputError where the name of the experiment and the settings disagree.
    """
    text = config.as_text(config.point_settings(settings))
    r, beta, seed = point
    command = ["roughgas", verb, experiment, "--scale", scale]
    # joined by =, so that a negative number is not taken for an option
    command += [f"--r={r}", f"--beta={beta}"]
    command += [] if noise == CARRIED else [f"--{noise}={seed}"]
    command += [*told, "--settings", text, "--output", output]
    return {
        "title": f"{experiment}: r = {r}, beta = {beta}",
        **variant_attributes(experiment, settings),
        "scale": scale,
        "r_label": r,
        "beta_label": beta,
        "experiment_json": text,
        "command": shlex.join(command),
    }


def variant_attributes(name: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of a dataset that name its experiment, and its variant if any.

    Raises InputError where name and settings disagree.
    """
    base, slash, variant = name.partition("/")
    key = settings.get(config.SWEPT)
    if key is None and not slash:
        return {"experiment": base}
    parameter = config.parameter_of(key or "")
    value = config.swept_value(settings, key or "")
    label = variant.removeprefix(parameter)
    if value is None or label == variant or config.level(label) != value:
        raise InputError("experiment", name, "be the variant that its settings are of")
    return {"experiment": base, "variant": variant, "swept": key, "swept_value": value}
