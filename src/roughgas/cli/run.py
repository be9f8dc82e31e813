"""`roughgas run` simulates a point of an experiment; `roughgas compile` prepares its kernel."""

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from roughgas.base.errors import InputError
from roughgas.cli.layout import as_json, with_error
from roughgas.cli.parser import examples
from roughgas.cli.settings import add_experiments, add_settings

if TYPE_CHECKING:
    from roughgas.data.point import Point

RUN_EXAMPLES = examples(
    "roughgas run cooling --r 0.9 --beta -0.5",
    "roughgas run vibrated --r 0.87 --beta 0.5 --seed 1 2 3 --scale small --json",
    "roughgas run vibrated_inertia/inertia0.3 --r 0.9 --beta 1 -o hollow.nc",
)
BETA = "roughness, in [-1, 1]: -1 is smooth, 1 perfectly rough"
COMPILE_EXAMPLE = examples("roughgas compile cooling --r 0.9")


def add_commands(commands: Any) -> None:
    """Add the two subcommands to argparse's `commands`."""
    parser = commands.add_parser(
        "run",
        help="simulate a point, and write its dataset",
        description="Simulate a point of an experiment, for one seed or for several one after the "
        "other, and write a dataset for each. Without -o it goes into the present folder, under a "
        "name made from the point's, and its summary is printed, which `roughgas show` does too. "
        "--beta may be given several times: each seed is then run at each beta.",
        epilog=RUN_EXAMPLES,
    )
    _add_experiment(parser)
    parser.add_argument("--beta", required=True, action="append", help=BETA)
    parser.add_argument(
        "--seed", nargs="+", default=["1"], help="of the random generator, 0, 1, ... (default: 1)"
    )
    parser.add_argument("-o", "--output", nargs="+", metavar="FILE", help="datasets, one a seed")
    parser.add_argument(
        "--json", action="store_true", help="print a line of JSON for each seed, as it is done"
    )
    parser.set_defaults(command=run)

    parser = commands.add_parser(
        "compile",
        help="compile the kernel of a point ahead of it",
        description="Compile the machine code that a point of an experiment runs, into its cache.",
        epilog=COMPILE_EXAMPLE,
    )
    _add_experiment(parser)
    parser.set_defaults(command=compile_kernel)


def add_point(parser: argparse.ArgumentParser) -> None:
    """Add what names a point, but for its seed."""
    _add_experiment(parser)
    parser.add_argument("--beta", required=True, help=BETA)


def _add_experiment(parser: argparse.ArgumentParser) -> None:
    name = "its name in the configuration, or that of a variant: EXPERIMENT/VARIANT"
    add_experiments(parser, dest="experiment", help=name)
    add_settings(parser)
    parser.add_argument("--r", required=True, help="normal restitution, in [0, 1]: 1 is elastic")


def run(options: argparse.Namespace) -> None:
    """Simulate the points that `options` name, and write a dataset as soon as its seed is done."""
    from roughgas import config

    seeds = [config.seed(label) for label in options.seed]
    each = [argparse.Namespace(**vars(options) | {"beta": beta}) for beta in options.beta]
    points = [point_of(one) for one in each]
    outputs = options.output or [_own_name(one, seed) for one in each for seed in options.seed]
    if len(outputs) != len(points) * len(seeds):
        legal = f"name {len(points) * len(seeds)}, one a seed"
        raise InputError("--output", " ".join(outputs), legal)
    remaining = iter(outputs)
    for one, (r, beta, settings) in zip(each, points, strict=True):
        _run_seeds(one, r, beta, settings, seeds, [next(remaining) for _ in seeds])


def _run_seeds(
    options: argparse.Namespace,
    r: float,
    beta: float,
    settings: dict[str, Any],
    seeds: Sequence[int],
    outputs: Sequence[str],
) -> None:
    """Simulate a point, for each seed an output."""
    from roughgas import config
    from roughgas.planning.reach import complete
    from roughgas.scene import build
    from roughgas.simulation.point import run_point
    from roughgas.simulation.progress import Progress

    scene = build(settings, r, beta)
    settings = complete(scene, config.point_settings(settings))
    for label, seed, output in zip(options.seed, seeds, outputs, strict=True):
        with Progress(f"{options.experiment}, seed {label}", scene, settings) as progress:
            point = run_point(scene, settings, seed, progress)
        written = _write(options, settings, label, output, point)
        if options.json:
            print(as_json(_record(output, written), indent=None), flush=True)
        elif options.output is None:
            from roughgas.cli.show import summary

            print(summary(output), flush=True)
        else:
            _say_done(output, point)


def compile_kernel(options: argparse.Namespace) -> None:
    """Compile what the points of an experiment run at some r, whatever their variant, beta and
    seed."""
    from roughgas import config

    r, settings = config.restitution(options.r), _settings(options)

    from roughgas.simulation.point import compile_kernels

    every = config.every_variant(options.experiment, settings).values()
    compile_kernels([one | {"sweep": {"r": [r]}} for one in every])


def point_of(options: argparse.Namespace) -> tuple[float, float, dict[str, Any]]:
    """r, beta and the settings of the experiment, or of its variant."""
    from roughgas import config
    from roughgas.config.provenance import variant_attributes

    r, beta = config.restitution(options.r), config.roughness(options.beta)
    settings = _settings(options)
    config.check_one_variant(options.experiment, settings)
    variant_attributes(options.experiment, settings)  # which refuses a name that is not theirs
    return r, beta, settings


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    from roughgas import config

    if options.settings is not None:
        return config.from_text(options.settings, "--settings", options.checked)
    return config.experiment(config.load(options.config), options.experiment, options.scale)


def write_seed(
    options: argparse.Namespace, settings: dict[str, Any], seed: str, output: str, point: "Point"
) -> None:
    """Write the dataset of a seed, which says how to make it again, and say that it is done."""
    _write(options, settings, seed, output, point)
    _say_done(output, point)


def _write(
    options: argparse.Namespace, settings: dict[str, Any], seed: str, output: str, point: "Point"
) -> "Point":
    from roughgas.config.provenance import provenance
    from roughgas.data.point import write_point

    labels = options.r, options.beta, seed
    about = provenance(options.experiment, settings, labels, options.scale, output)
    written = point._replace(attributes=about | point.attributes)
    write_point(output, written)
    return written


def _own_name(options: argparse.Namespace, seed: str) -> str:
    """The file of a point that was not given a name, in the present folder."""
    parts = [options.experiment.replace("/", "_"), f"r{options.r}", f"beta{options.beta}"]
    if options.scale != "paper":
        parts.insert(1, options.scale)
    return "_".join([*parts, f"seed{seed}.nc"])


def _record(output: str, point: "Point") -> dict[str, Any]:
    """What a script reads of a point: what names it, and all its variables that are one number."""
    names = ("experiment", "variant", "scale", "r", "beta", "seed")
    about = {name: point.attributes[name] for name in names if name in point.attributes}
    found = {name: value for name, value in point.variables.items() if not _has_axes(value)}
    return {"file": output} | about | found


def _has_axes(value: Any) -> bool:
    return getattr(value, "ndim", 0) > 0 or isinstance(value, list | tuple)


def _say_done(output: str, point: "Point") -> None:
    found = point.variables
    name = "R" if "R" in found else "E_trans"
    value = with_error(float(found[name]), float(found[f"{name}_stderr"]))
    took = f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    print(f"{output}: {name} = {value}, {took}", file=sys.stderr)
