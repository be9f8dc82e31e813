"""`roughgas run` simulates a point of an experiment; `roughgas compile` prepares its kernel."""

import argparse
import sys
from typing import TYPE_CHECKING, Any

from roughgas.cli.settings import add_settings
from roughgas.errors import InputError

if TYPE_CHECKING:
    from roughgas.dataset import Point

RUN_EXAMPLE = "example: roughgas run cooling --r 0.9 --beta -0.5 --seed 1 -o point.nc"
COMPILE_EXAMPLE = "example: roughgas compile cooling --r 0.9"


def add_commands(commands: Any) -> None:
    """Add the two subcommands to argparse's `commands`."""
    parser = commands.add_parser(
        "run",
        help="simulate a point and write its dataset",
        description="Simulate a point of an experiment, for one seed or for several one after the "
        "other, and write a dataset for each.",
        epilog=RUN_EXAMPLE,
    )
    add_point(parser)
    parser.add_argument(
        "--seed", required=True, nargs="+", help="seeds of the random generator, 0, 1, ..."
    )
    parser.add_argument(
        "-o", "--output", required=True, nargs="+", metavar="FILE", help="datasets, one a seed"
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
    parser.add_argument("--beta", required=True, help="roughness, in [-1, 1]")


def _add_experiment(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "experiment",
        metavar="EXPERIMENT",
        help="its name in the configuration, or that of a variant: EXPERIMENT/VARIANT",
    )
    add_settings(parser)
    parser.add_argument("--r", required=True, help="normal restitution, in [0, 1]")


def run(options: argparse.Namespace) -> None:
    """Simulate the point that `options` name, and write a dataset as soon as its seed is done."""
    from roughgas import config
    from roughgas.cli.progress import Progress

    seeds = [config.seed(label) for label in options.seed]
    r, beta, settings = point_of(options)
    if len(options.output) != len(seeds):
        raise InputError("--output", " ".join(options.output), f"name {len(seeds)}, one a seed")

    from roughgas.planning.reach import complete
    from roughgas.point import run_point

    settings = complete(config.point_settings(settings), r, beta)
    for label, seed, output in zip(options.seed, seeds, options.output, strict=True):
        with Progress(options.experiment, settings["schedule"]) as progress:
            point = run_point(settings, r, beta, seed, progress)
        write_seed(options, settings, label, output, point)


def compile_kernel(options: argparse.Namespace) -> None:
    """Compile what the points of an experiment run at some r, whatever their variant, beta and
    seed."""
    from roughgas import config

    r, settings = config.restitution(options.r), _settings(options)

    from roughgas.point import compile_kernels

    every = config.every_variant(options.experiment, settings).values()
    compile_kernels([one | {"sweep": {"r": [r]}} for one in every])


def point_of(options: argparse.Namespace) -> tuple[float, float, dict[str, Any]]:
    """r, beta and the settings of the experiment, or of its variant."""
    from roughgas import config
    from roughgas.provenance import variant_attributes

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
    from roughgas.dataset import write_point
    from roughgas.provenance import provenance

    labels = options.r, options.beta, seed
    about = provenance(options.experiment, settings, labels, options.scale, output)
    write_point(output, point._replace(attributes=about | point.attributes))
    print(_closing_line(output, point), file=sys.stderr)


def _closing_line(output: str, point: "Point") -> str:
    found = point.variables
    name = "R" if "R" in found else "E_trans"
    return (
        f"{output}: {name} = {float(found[name]):.4f} +- {float(found[f'{name}_stderr']):.4f}, "
        f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    )
