"""`roughgas run` simulates points of an experiment; `roughgas compile` prepares their kernels."""

import sys
from argparse import Namespace
from typing import TYPE_CHECKING, Any

from roughgas.base.errors import InputError

if TYPE_CHECKING:
    from roughgas.data.point import Point
    from roughgas.scene import Scene

IDENTITY = ("experiment", "variant", "scale", "r", "beta", "seed")
"""The attributes that name a point."""


def run(options: Namespace) -> None:
    """Simulate the points that `options` name, and write each dataset as soon as it is there."""
    from roughgas import config

    seeds = {label: config.seed(label) for label in options.seed}
    points = [point_of(options, beta) for beta in options.beta]
    outputs = options.output or [
        _own_name(options, beta, seed) for beta in options.beta for seed in options.seed
    ]
    if len(outputs) != len(points) * len(options.seed):
        legal = f"name {len(points) * len(options.seed)}, one a seed"
        raise InputError("--output", " ".join(outputs), legal)
    from roughgas.planning.reach import complete
    from roughgas.simulation.point import run_point
    from roughgas.simulation.progress import Progress

    remaining = iter(outputs)
    for beta, (scene, settings) in zip(options.beta, points, strict=True):
        settings = complete(scene, config.point_settings(settings))
        for seed in options.seed:
            with Progress(f"{options.experiment}, seed {seed}", scene, settings) as progress:
                point = run_point(scene, settings, seeds[seed], progress)
            output = next(remaining)
            written = write_seed(options, (options.r, beta, seed), settings, output, point)
            _report(options, output, written)


def compile_kernel(options: Namespace) -> None:
    """Compile what the points of an experiment run at some r: of all its variants."""
    from roughgas import config

    r, settings = config.restitution(options.r), _settings(options)

    from roughgas.simulation.point import compile_kernels

    every = config.every_variant(options.experiment, settings).values()
    compile_kernels([one | {"sweep": {"r": [r]}} for one in every])


def point_of(options: Namespace, beta: str) -> tuple["Scene", dict[str, Any]]:
    """Return the scene of a point, and the settings of its experiment or variant.

    Raises InputError for illegal values, and for a name that disagrees with --settings.
    """
    from roughgas import config
    from roughgas.config.provenance import variant_attributes

    r, roughness = config.restitution(options.r), config.roughness(beta)
    settings = _settings(options)
    config.check_one_variant(options.experiment, settings)
    variant_attributes(options.experiment, settings)

    from roughgas.scene import build

    return build(settings, r, roughness), settings


def _settings(options: Namespace) -> dict[str, Any]:
    from roughgas import config

    if options.settings is not None:
        return config.from_text(options.settings, "--settings", options.checked)
    return config.experiment(config.load(options.config), options.experiment, options.scale)


def write_seed(
    options: Namespace,
    labels: tuple[str, str, str],
    settings: dict[str, Any],
    output: str,
    point: "Point",
) -> "Point":
    """Write the dataset of a seed, and return it with the attributes that say how to make it again.

    `labels` are those of r, beta and the seed.
    """
    from roughgas.config.provenance import provenance
    from roughgas.data.point import write_point

    about = provenance(options.experiment, settings, labels, options.scale, output)
    written = point._replace(attributes=about | point.attributes)
    write_point(output, written)
    return written


def _own_name(options: Namespace, beta: str, seed: str) -> str:
    """Return the file in the present folder for a point that was given none."""
    scale = [] if options.scale == "paper" else [options.scale]
    parts = [options.experiment.replace("/", "_"), *scale, f"r{options.r}", f"beta{beta}"]
    return "_".join([*parts, f"seed{seed}.nc"])


def _report(options: Namespace, output: str, point: "Point") -> None:
    """Print a line for a script, or a summary where the user has not named the file."""
    if options.json:
        from roughgas.base.layout import as_json

        about = {name: point.attributes[name] for name in IDENTITY if name in point.attributes}
        found = {name: one for name, one in point.variables.items() if not _has_axes(one)}
        print(as_json({"file": output} | about | found, indent=None), flush=True)
    elif options.output is None:
        from roughgas.cli.show import summary

        print(summary(output), flush=True)
    else:
        say_done(output, point)


def _has_axes(value: Any) -> bool:
    return getattr(value, "ndim", 0) > 0 or isinstance(value, list | tuple)


def say_done(output: str, point: "Point") -> None:
    """Print the result of a point, and what it took."""
    from roughgas.statistics.estimate import Estimate

    found = point.variables
    name = "R" if "R" in found else "E_trans"
    value = Estimate(float(found[name]), float(found[f"{name}_stderr"]))
    took = f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    print(f"{output}: {name} = {value}, {took}", file=sys.stderr)
