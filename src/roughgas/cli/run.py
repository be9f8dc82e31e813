"""`roughgas run` simulates points of an experiment."""

import re
import sys
from argparse import Namespace
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from roughgas import config
from roughgas.base import InputError, as_json
from roughgas.cli.parser import check_outputs, labels
from roughgas.config.labels import SPECIES, holder, names_of
from roughgas.data.point import Point, read_point, write_point
from roughgas.simulation import schedule
from roughgas.simulation.points import points, variant_attributes
from roughgas.simulation.restart import Initial
from roughgas.simulation.saved import initial_of, seeded
from roughgas.statistics.errors import NO, UNKNOWN, YES, Estimate
from roughgas.theory.prediction import over_collisions

IDENTITY = ("experiment", "variant", "scale", "r", "beta", "seed")
"""The attributes that name a point."""
NOT_TO_SET = (*config.NOT_OF_A_POINT, config.SWEPT, config.CASE, "extends")
REACHED = {YES: "met", NO: "NOT met", UNKNOWN: "not known to be met"}


def run(options: Namespace) -> None:
    """Simulate the points that `options` name, and write each dataset as soon as it is there."""
    initial, seed = initial_in(options)
    at, settings = points_of(options, seed)
    settings = config.point_settings(settings)
    outputs = options.output or [_own_name(options, place) for place in at]
    if len(outputs) != len(at):
        raise InputError("--output", " ".join(outputs), f"name {len(at)}, one per point")
    if options.output is None:
        check_outputs(options, outputs)
    if options.keep_state:
        settings["keep_state"] = True
    told = ["--from", options.start_from] if initial else []
    where = options.experiment, settings, at, options.scale, outputs, initial
    made = points(*where, told=told, checkpoints=True)
    for output, point in zip(outputs, made, strict=True):
        write_point(output, point)
        if options.json:
            print(_as_line(output, point), flush=True)
        elif options.output is None:
            from roughgas.cli.show import summary

            print(summary(output), flush=True)
        else:
            _say_done(output, point)


def initial_in(options: Namespace) -> tuple[list[Initial], Any]:
    """Return the states in the file that a run goes on from, none where it starts anew; and the
    seed of its noise, or a list of seeds."""
    states: list[Initial] = []
    if options.start_from is not None:
        point = read_point(options.start_from)
        if "last_position" not in point:
            legal = "be a point that has kept its last state, by --keep-state"
            raise InputError("--from", options.start_from, legal)
        states = initial_of(point)
    return seeded(states, options.seed, options.reseed)


def points_of(options: Namespace, seed: Any = None) -> tuple[list[config.Place], dict[str, Any]]:
    """Return the places that are named, and the settings of their experiment.

    `seed`, one or a list, stands in place of that of the options, whose default is 1. Raises
    InputError for illegal values, and for a name that disagrees with --settings.
    """
    settings = _settings(options)
    chosen = options.seed if seed is None else seed
    seeds = chosen if isinstance(chosen, list) else [str(1 if chosen is None else chosen)]
    r, beta, seeds = (
        labels(f"--{name}", values)
        for name, values in (("r", options.r), ("beta", options.beta), ("seed", seeds))
    )
    at = config.places(r, beta, seeds, prefix="--")
    config.check_one_variant(options.experiment, settings)
    variant_attributes(options.experiment, settings)
    return at, settings


def _settings(options: Namespace) -> dict[str, Any]:
    """Return the settings of the experiment, with what --set and --observe change."""
    if options.settings is not None:
        found = config.from_text(options.settings, "--settings", options.checked)
    else:
        found = config.load_experiment(options.config, options.experiment, options.scale)
    told, watched = getattr(options, "changes", ()), getattr(options, "observe", None)
    if watched:
        found = config.merged(found, {"observables": {name: {} for name in watched}})
    if told or watched:
        found = config.validated(changed_by(found, told), options.experiment)
    if told or watched or not options.checked:
        schedule.check(found)
    return found


def _own_name(options: Namespace, place: config.Place) -> str:
    """Return the file in the present folder for a point that was given none.

    What --set changes is a part of its name: mu0.3 for effects.friction.mu=0.3.
    """
    r, beta, seed = place.labels
    pairs = (one.partition("=") for one in options.changes)
    told = [re.sub(r"[^\w.+-]", "", f"{key.rpartition('.')[2]}{text}") for key, _, text in pairs]
    scale = [] if options.scale == config.PAPER else [options.scale]
    name = [options.experiment.replace("/", "_"), *told, *scale]
    return "_".join([*name, f"r{r}", f"beta{beta}", f"seed{seed}.nc"])


def _as_line(output: str, point: Point) -> str:
    """Return a line of JSON: what names a point, and all its single numbers."""
    about = {name: point.attributes[name] for name in IDENTITY if name in point.attributes}
    found = {name: one for name, one in point.variables.items() if np.ndim(one) == 0}
    return as_json({"file": output} | about | found, indent=None)


def _say_done(output: str, point: Point) -> None:
    """Print the result of a point, and what it took."""
    found = point.variables
    name = "R" if "R" in found else "E_trans"
    value = f"{Estimate(float(found[name]), float(found[f'{name}_stderr']))}"
    if "R_collisional" in found:
        errors = float(found["R_collisional"]), float(found["R_collisional_stderr"])
        said = over_collisions(point.attributes, found)
        value += f" over time, {Estimate(*errors)} over collisions ({said})"
    if "R_corrected" in found:
        value += f", {float(found['R_corrected']):.4f} corrected for the number of particles"
    if "target_met" in found:
        value += f", target {REACHED[int(found['target_met'])]}"
    took = f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    print(f"{output}: {name} = {value}, {took}", file=sys.stderr)


def changed_by(settings: Mapping[str, Any], told: Iterable[str]) -> dict[str, Any]:
    """Return settings with what `told` changes, each KEY=VALUE, VALUE in YAML; null removes a key.

    A KEY is dotted, as schedule.measure; as in a sweep `effects.` may be left out, a species be
    named, and `box` be a width alone. Raises InputError for another form, and for a key given
    twice; whether keys and values are legal is left to the schema.
    """
    from roughgas.config.reading import parse_yaml

    found, seen = dict(settings), set()
    for one in told:
        key, _, text = one.partition("=")
        if not key or not text:
            raise InputError("--set", one, "be KEY=VALUE, such as particles=80")
        if key in seen:
            raise InputError("--set", key, "be given once")
        if key.partition(".")[0] in NOT_TO_SET:
            raise InputError("--set", key, "be a setting of one point")
        seen.add(key)
        found = config.changed_by(found, _change(found, key, parse_yaml(text, f"--set {key}")))
    return found


def _change(settings: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    """Return the change to settings that gives a dotted key this value."""
    from roughgas import effects

    part = key.rpartition(".")[0]
    if part.startswith(SPECIES):
        if holder(settings, part) is None:
            known = ", ".join(names_of(settings)) or "there are none"
            raise InputError("--set", key, f"name one of species: {known}")
        return config.swept_to(settings, key, value)
    if key == "box" and isinstance(value, int | float):
        return config.swept_to(settings, key, value)
    names = key.split(".")
    if names[0] in effects.schema()["properties"]:
        names.insert(0, "effects")
    for name in reversed(names):
        value = {name: value}
    return value
