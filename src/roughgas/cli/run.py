"""`roughgas run` simulates points of an experiment; `roughgas compile` prepares their kernels."""

import sys
from argparse import Namespace
from typing import Any

import numpy as np

from roughgas import config
from roughgas.base.errors import InputError
from roughgas.base.layout import as_json
from roughgas.config.provenance import provenance, variant_attributes
from roughgas.config.schema import check_schema
from roughgas.data.point import Point, read_point, write_point
from roughgas.planning.reach import complete
from roughgas.scene import Scene, build
from roughgas.simulation import schedule
from roughgas.simulation.ends import Initial, initial_of
from roughgas.simulation.point import compile_kernels, run_point
from roughgas.simulation.progress import Bar, Progress
from roughgas.statistics.estimate import Estimate

IDENTITY = ("experiment", "variant", "scale", "r", "beta", "seed")
"""The attributes that name a point."""


def run(options: Namespace) -> None:
    """Simulate the points that `options` name, and write each dataset as soon as it is there."""
    seeds = {label: config.seed(label) for label in options.seed}
    points = [point_of(options, beta) for beta in options.beta]
    initial = initial_in(options)
    places = [(options.r, beta, seed) for beta in options.beta for seed in options.seed]
    outputs = options.output or [_own_name(options, *place) for place in places]
    if len(outputs) != len(places):
        raise InputError("--output", " ".join(outputs), f"name {len(places)}, one per seed")
    remaining = zip(places, outputs, strict=True)
    for scene, settings in points:
        with Bar(f"pilot of {options.experiment}", None, quiet="target_stderr" not in settings):
            settings = complete(scene, config.point_settings(settings))
        if options.keep_state:
            settings["keep_state"] = True
        for seed in options.seed:
            with Progress(f"{options.experiment}, seed {seed}", scene, settings) as progress:
                point = run_point(scene, settings, seeds[seed], progress, initial)
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


def compile_kernel(options: Namespace) -> None:
    """Compile what the points of an experiment run at some r: of all its variants."""
    r, settings = config.restitution(options.r), _settings(options)
    every = config.every_variant(options.experiment, settings).values()
    compile_kernels([one | {"sweep": {"r": [r]}} for one in every])


def point_of(options: Namespace, beta: str) -> tuple[Scene, dict[str, Any]]:
    """Return the scene of a point, and the settings of its experiment or variant.

    Raises InputError for illegal values, and for a name that disagrees with --settings.
    """
    r, roughness = config.restitution(options.r), config.roughness(beta)
    settings = _settings(options)
    config.check_one_variant(options.experiment, settings)
    variant_attributes(options.experiment, settings)
    return build(settings, r, roughness), settings


def _settings(options: Namespace) -> dict[str, Any]:
    if options.settings is not None:
        return config.from_text(options.settings, "--settings", options.checked)
    found = config.load_experiment(options.config, options.experiment, options.scale)
    watched = getattr(options, "observe", None)
    if not watched:
        return found
    found = config.merged(found, {"observables": {name: {} for name in watched}})
    check_schema(found, options.experiment, "experiment")
    schedule.check(found)
    return found


def _own_name(options: Namespace, r: str, beta: str, seed: str) -> str:
    """Return the file in the present folder for a point that was given none."""
    scale = [] if options.scale == "paper" else [options.scale]
    name = [options.experiment.replace("/", "_"), *scale]
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
    value = Estimate(float(found[name]), float(found[f"{name}_stderr"]))
    took = f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    print(f"{output}: {name} = {value}, {took}", file=sys.stderr)
