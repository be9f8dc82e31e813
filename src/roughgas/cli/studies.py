"""`roughgas study` runs a task of a study, `combine` joins tasks, `tables` shows the outcome."""

import argparse
import json
from typing import Any

from roughgas.cli.parser import examples
from roughgas.cli.settings import add_settings

EXAMPLE = examples("roughgas study statistical cooling-reference --scale small -o reference.nc")
COMBINE_EXAMPLE = examples("roughgas combine results/small/accuracy/*/*.nc -o accuracy.nc")
TABLES_EXAMPLE = examples("roughgas tables results/small/accuracy.nc -o accuracy.md")


def add_commands(commands: Any) -> None:
    """Add the three subcommands to argparse's `commands`."""
    parser = commands.add_parser(
        "study",
        help="run one task of a study of accuracy",
        description="Run one of the independent tasks that a study of accuracy consists of.",
        epilog=EXAMPLE,
    )
    parser.add_argument("study", metavar="STUDY", help="statistical, models, ...")
    parser.add_argument("task", metavar="TASK", help="its name")
    add_settings(parser)
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="dataset to write")
    parser.set_defaults(command=study)

    parser = commands.add_parser(
        "combine",
        help="combine the tasks of studies into one dataset",
        description="Combine the tasks of studies into one dataset, with a group for each study.",
        epilog=COMBINE_EXAMPLE,
    )
    parser.add_argument("inputs", nargs="+", metavar="TASK", help="datasets of tasks")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="dataset to write")
    parser.set_defaults(command=combine)

    parser = commands.add_parser(
        "tables",
        help="write what studies have found as tables",
        description="Write what the studies in a combined dataset have found as Markdown.",
        epilog=TABLES_EXAMPLE,
    )
    parser.add_argument("input", metavar="COMBINED", help="dataset of `roughgas combine`")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="Markdown file")
    parser.set_defaults(command=tables)


def study(options: argparse.Namespace) -> None:
    """Run a task."""
    from roughgas.base.errors import InputError
    from roughgas.simulation.progress import Bar
    from roughgas.studies import accuracy

    module, text = accuracy.study(options.study), _settings(options)
    settings = json.loads(text)
    tasks = module.tasks(settings["study"])
    if options.task not in tasks:
        raise InputError("task", options.task, f"be one of {', '.join(tasks)}")

    from roughgas.studies.accuracy.files import write_task

    with Bar(options.task, None) as bar:
        found = module.run(
            options.task,
            settings["study"],
            settings["experiments"],
            lambda done, total: bar.reach(done, total=total),
        )
    about = {"study": options.study, "task": options.task, "scale": options.scale}
    write_task(options.output, found, about | {"settings_json": text})


def combine(options: argparse.Namespace) -> None:
    """Combine tasks."""
    from roughgas.studies.accuracy import files

    files.combine(options.inputs, options.output)


def tables(options: argparse.Namespace) -> None:
    """Write tables."""
    from roughgas.studies.accuracy.files import write_tables

    write_tables(options.input, options.output)


def _settings(options: argparse.Namespace) -> str:
    """The settings of the study and of the experiments that it may run, as JSON."""
    from roughgas import config

    if options.settings is not None:
        return options.settings
    return config.as_text(config.study(config.load(options.config), options.study, options.scale))
