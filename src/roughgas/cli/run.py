"""`roughgas run` simulates points of an experiment."""

import sys
from argparse import Namespace
from typing import Any

import numpy as np

from roughgas import config
from roughgas.base.errors import InputError
from roughgas.base.layout import as_json
from roughgas.cli.changes import as_label, changed_by
from roughgas.cli.options import labels
from roughgas.cli.outputs import check_outputs
from roughgas.config.provenance import provenance, variant_attributes
from roughgas.config.schema import check_schema
from roughgas.data.point import Point, read_point, write_point
from roughgas.scene import Scene, build
from roughgas.simulation import schedule
from roughgas.simulation.ends import Initial, initial_of
from roughgas.simulation.point import run_point
from roughgas.simulation.progress import Progress
from roughgas.statistics.estimate import Estimate
from roughgas.statistics.evidence import NO, UNKNOWN, YES

IDENTITY = ("experiment", "variant", "scale", "r", "beta", "seed")
"""The attributes that name a point."""
REACHED = {YES: "met", NO: "NOT met", UNKNOWN: "not known to be met"}


def run(options: Namespace) -> None:
    """Simulate the points that `options` name, and write each dataset as soon as it is there."""
    initial, seeds = initial_in(options), labels("--seed", options.seed, config.seed)
    points = points_of(options)
    places = [(r, beta, seed) for r, beta, *_ in points for seed in seeds]
    outputs = options.output or [_own_name(options, *place) for place in places]
    if len(outputs) != len(places):
        raise InputError("--output", " ".join(outputs), f"name {len(places)}, one per point")
    if options.output is None:
        check_outputs(options, outputs)
    remaining = zip(places, outputs, strict=True)
    for _, _, scene, settings in points:
        settings = config.point_settings(settings)
        if options.keep_state:
            settings["keep_state"] = True
        for seed in seeds:
            with Progress(f"{options.experiment}, seed {seed}", scene, settings) as progress:
                point = run_point(scene, settings, config.seed(seed), progress, initial)
            place, output = next(remaining)
            written = write_seed(options, place, settings, output, point)
            if options.json:
                print(_as_line(output, written), flush=True)
            elif options.output is None:
                from roughgas.cli.show import summary

                print(summary(output), flush=True)
            else:
                say_done(output, point)


def initial_in(options: Namespace) -> list[Initial]:
    """Return the states in the file that the run goes on from; none where it starts anew."""
    if options.start_from is None:
        return []
    if isinstance(options.seed, list) and len(options.seed) > 1:
        legal = "be one with --from, which has the random numbers of its own run"
        raise InputError("--seed", " ".join(options.seed), legal)
    return initial_of(read_point(options.start_from))


def points_of(options: Namespace) -> list[tuple[str, str, Scene, dict[str, Any]]]:
    """Return the labels of each r with each beta, its scene, and the settings of its experiment.

    Raises InputError as `point_of` does.
    """
    settings = _settings(options)
    every_r = labels("--r", options.r, config.restitution)
    every_beta = labels("--beta", options.beta, config.roughness)
    places = [(r, beta) for r in every_r for beta in every_beta]
    return [(*one, _scene(options, settings, *one), settings) for one in places]


def point_of(options: Namespace) -> tuple[Scene, dict[str, Any]]:
    """Return the scene of the one point that is named, and the settings of its experiment.

    Raises InputError for illegal values, and for a name that disagrees with --settings.
    """
    settings = _settings(options)
    return _scene(options, settings, options.r, options.beta), settings


def _scene(options: Namespace, settings: dict[str, Any], r: str, beta: str) -> Scene:
    place = config.restitution(r), config.roughness(beta)
    config.check_one_variant(options.experiment, settings)
    variant_attributes(options.experiment, settings)
    return build(settings, *place)


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
        found = changed_by(found, told)
        check_schema(config.point_settings(found), options.experiment, "experiment")
        found = config.fitted(found, options.experiment)
        check_schema(config.point_settings(found), options.experiment, "point")
    if told or watched or not options.checked:
        schedule.check(found)
    return found


def _own_name(options: Namespace, r: str, beta: str, seed: str) -> str:
    """Return the file in the present folder for a point that was given none."""
    scale = [] if options.scale == "paper" else [options.scale]
    name = [options.experiment.replace("/", "_"), *as_label(options.changes), *scale]
    return "_".join([*name, f"r{r}", f"beta{beta}", f"seed{seed}.nc"])


def write_seed(
    options: Namespace, place: tuple[str, str, str], settings: Any, output: str, point: Point
) -> Point:
    """Write the dataset of a seed, and return it with the attributes that say how to make it again.

    `place` are the labels of r, beta and the seed.
    """
    start = getattr(options, "start_from", None)
    told = [] if start is None else ["--from", start]
    about = provenance(options.experiment, settings, place, options.scale, output, told=told)
    written = point._replace(attributes=about | point.attributes)
    write_point(output, written)
    return written


def _as_line(output: str, point: Point) -> str:
    """Return a line of JSON: what names a point, and all its single numbers."""
    about = {name: point.attributes[name] for name in IDENTITY if name in point.attributes}
    found = {name: one for name, one in point.variables.items() if np.ndim(one) == 0}
    return as_json({"file": output} | about | found, indent=None)


def say_done(output: str, point: Point) -> None:
    """Print the result of a point, and what it took."""
    found = point.variables
    name = "R" if "R" in found else "E_trans"
    value = f"{Estimate(float(found[name]), float(found[f'{name}_stderr']))}"
    if "R_collisional" in found:
        errors = float(found["R_collisional"]), float(found["R_collisional_stderr"])
        value += f" over time, {Estimate(*errors)} over collisions"
    if "target_met" in found:
        value += f", target {REACHED[int(found['target_met'])]}"
    took = f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    print(f"{output}: {name} = {value}, {took}", file=sys.stderr)
