"""`roughgas show`: a summary of any dataset that the pipeline writes."""

import argparse
from pathlib import Path
from types import ModuleType
from typing import Any

from roughgas.base.errors import InputError
from roughgas.cli.layout import as_json
from roughgas.cli.parser import examples

EXAMPLES = examples(
    "roughgas show results/paper/vibrated/r0.9/beta0.5/seed1.nc",
    "roughgas show results/paper/vibrated.nc",
    "roughgas show results/paper/accuracy.nc",
    "roughgas show results/paper/sheared.nc --json",
)


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "show",
        help="a readable summary of any dataset that the pipeline wrote",
        description="Print what a dataset holds: what was simulated, R with its error, theory, "
        "energies, cost, and how to make it again. It may be that of a point, a reduced one, a "
        "film, a study of accuracy or a task of it, or a pilot.json. 0.3565(30) is 0.3565 with a "
        "standard error of 0.0030.",
        epilog=EXAMPLES,
    )
    parser.add_argument("files", nargs="+", metavar="FILE", help="datasets")
    parser.add_argument(
        "--json",
        action="store_true",
        help="all attributes and single numbers instead, a line of JSON for each file",
    )
    parser.set_defaults(command=show)


def show(options: argparse.Namespace) -> None:
    """Print summaries, an empty line between them."""
    for number, path in enumerate(options.files):
        if options.json:
            kind, module = kind_of(path)
            about = {"file": path, "kind": kind} | module.record(module.read(path))
            print(as_json(about, indent=None))
        else:
            print("\n" * (number > 0) + summary(path))


def summary(path: str | Path) -> str:
    """The text about a dataset. Raises InputError where it is none of the pipeline's."""
    kind, module = kind_of(path)
    return f"{path}: {kind}\n\n{module.text(module.read(path))}"


def kind_of(path: str | Path) -> tuple[str, ModuleType]:
    """What a dataset is, and the module that shows it: its `read`, `text` and `record`."""
    from roughgas.cli.show import film, pilot, point, reduced, studies, task

    if Path(path).suffix == ".json":
        return "pilot of a point", pilot
    names, attributes, groups = _outline(path)
    if groups and groups <= set(studies.STUDIES):
        return "studies of accuracy", studies
    if {"study", "task"} <= attributes:
        return "task of a study of accuracy", task
    if "disk_spin" in names:
        return "film of a cooling gas", film
    if {"n_seeds", "E_trans"} <= names:
        return "reduced dataset", reduced
    if {"experiment", "seed"} <= attributes and "E_trans" in names:
        return "point", point
    raise _not_ours(path)


def _outline(path: str | Path) -> tuple[set[str], set[str], set[str]]:
    """Names of variables, attributes and groups."""
    import netCDF4

    if Path(path).is_dir():
        raise _not_ours(path)
    try:
        with netCDF4.Dataset(path) as file:
            return set(file.variables), set(file.ncattrs()), set(file.groups)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise _not_ours(path) from error


def _not_ours(path: str | Path) -> InputError:
    legal = "be a dataset of roughgas: a point, a reduced one, a film, a study or a pilot.json"
    return InputError("file", str(path), legal)
