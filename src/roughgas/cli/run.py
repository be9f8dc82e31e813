"""`roughgas run` simulates a point of an experiment; `roughgas compile` prepares its kernel."""

import argparse
import shlex
import sys
from collections.abc import Iterable, Iterator
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
        "other, and write a dataset for each. With several --beta, do so for each of them.",
        epilog=RUN_EXAMPLE,
    )
    _add_experiment(parser)
    parser.add_argument("--beta", required=True, action="append", help="roughness, in [-1, 1]")
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
    """Simulate the points that `options` name, and write a dataset as soon as its seed is done."""
    from roughgas import config

    seeds = [config.seed(label) for label in options.seed]
    number = len(options.beta) * len(seeds)
    if len(options.output) != number:
        raise InputError("--output", " ".join(options.output), f"name {number}, one a seed")
    each = [argparse.Namespace(**vars(options) | {"beta": beta}) for beta in options.beta]
    points = [point_of(one) for one in each]
    outputs = iter(options.output)
    for one, point in zip(each, points, strict=True):
        _run_seeds(one, *point, seeds, outputs)


def _run_seeds(
    options: argparse.Namespace,
    r: float,
    beta: float,
    settings: dict[str, Any],
    seeds: Iterable[int],
    outputs: Iterator[str],
) -> None:
    """Simulate a point for each seed, whose datasets are the next of `outputs`."""
    from roughgas import config
    from roughgas.cli.progress import Progress
    from roughgas.planning.reach import complete
    from roughgas.point import run_point

    settings = complete(config.point_settings(settings), r, beta)
    for label, seed in zip(options.seed, seeds, strict=True):
        with Progress(options.experiment, settings["schedule"]) as progress:
            point = run_point(settings, r, beta, seed, progress)
        write_seed(options, settings, label, next(outputs), point)


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

    r, beta = config.restitution(options.r), config.roughness(options.beta)
    settings = _settings(options)
    config.check_one_variant(options.experiment, settings)
    _variant(options.experiment, settings)
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

    about = _provenance(options, settings, seed, output)
    write_point(output, point._replace(attributes=about | point.attributes))
    print(_closing_line(output, point), file=sys.stderr)


def _provenance(
    options: argparse.Namespace, settings: dict[str, Any], seed: str, output: str
) -> dict[str, Any]:
    """The attributes of a dataset that say how to make it again, it alone."""
    from roughgas import config

    text = config.as_text(config.point_settings(settings))
    command = ["roughgas", "run", options.experiment, "--scale", options.scale]
    # joined by =, lest a negative number be taken for an option
    command += [f"--r={options.r}", f"--beta={options.beta}", f"--seed={seed}"]
    command += ["--settings", text, "--output", output]
    return {
        "title": f"{options.experiment}: r = {options.r}, beta = {options.beta}",
        **_variant(options.experiment, settings),
        "scale": options.scale,
        "r_label": options.r,
        "beta_label": options.beta,
        "experiment_json": text,
        "command": shlex.join(command),
    }


def _variant(name: str, settings: dict[str, Any]) -> dict[str, Any]:
    """The attributes of a dataset that say which experiment, and which variant of it, it is of.

    Raises InputError where name and settings disagree.
    """
    from roughgas import config

    base, slash, variant = name.partition("/")
    key = settings.get(config.SWEPT)
    if key is None and not slash:
        return {"experiment": base}
    effect, _, parameter = (key or "").partition(".")
    value = settings["effects"].get(effect, {}).get(parameter)
    label = variant.removeprefix(parameter)
    if value is None or label == variant or config.level(label) != value:
        raise InputError("experiment", name, "be the variant that --settings are of")
    return {"experiment": base, "variant": variant, "swept": key, "swept_value": value}


def _closing_line(output: str, point: "Point") -> str:
    found = point.variables
    name = "R" if "R" in found else "E_trans"
    return (
        f"{output}: {name} = {float(found[name]):.4f} +- {float(found[f'{name}_stderr']):.4f}, "
        f"{int(found['collisions']):,} collisions in {float(found['kernel_seconds']):.1f} s"
    )
