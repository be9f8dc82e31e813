"""The steps of the workflow that only its rules give: `python -m roughgas.steps NAME ...`.

Each function in STEPS is a step: its positional parameters are arguments, those after `*` options;
what is iterable takes several values, a bool none, and what has a default may be left out. Settings
are JSON, as the rules hand them on; `checked` says that they need no check. Errors are one line,
and exit statuses those of `roughgas`.
"""

import argparse
import inspect
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from importlib import import_module
from typing import Any, get_origin

from roughgas import cli, config
from roughgas.cli.parser import Parser


def compile_kernels(experiment: str, *, settings: str, r: str, checked: bool = False) -> None:
    """Compile what the points of an experiment run at some r: of all its variants."""
    from roughgas.simulation.point import compile_kernels

    found = config.from_text(settings, "--settings", checked)
    every = config.every_variant(experiment, found).values()
    compile_kernels(every, config.restitution(r))


def study_claims(
    folder: str,
    inputs: list[str],
    *,
    title: str,
    json: str,
    markdown: str,
    experiments: Sequence[str] = (),
) -> None:
    """Judge the statements in claims.yaml of the study in a folder, which has these experiments."""
    from roughgas.claims import judge, read_study

    judge(inputs, json, markdown, read_study(folder, title, experiments))


def claims(inputs: list[str], *, json: str, markdown: str) -> None:
    """Judge the claims of the paper."""
    from roughgas.claims import PAPER, judge

    judge(inputs, json, markdown, PAPER)


def effective_config(input: str, *, scale: str, output: str, changes: str = "{}") -> None:
    """Write the complete configuration of a scale, with changes to it in JSON."""
    from roughgas.config.study_folders import write_effective

    changed = config.from_text(changes, "--changes", checked=True)
    write_effective(config.load(input, changed), scale, output)


STEPS: dict[str, str | Callable[..., None]] = {
    "accuracy_data": "accuracy.running:combine",
    "accuracy_figure": "accuracy.running:draw",
    "accuracy_table": "accuracy.running:write_tables",
    "accuracy_task": "accuracy.running:run_task",
    "article": "results.article:write_article",
    "codemeta": "results.products:write_codemeta",
    "compile_kernels": compile_kernels,
    "claims": claims,
    "document": "show.pages:write_document",
    "effective_config": effective_config,
    "evidence": "results.evidence:combine",
    "evidence_page": "results.evidence:write_page",
    "evidence_figure": "show.gallery:draw_evidence",
    "explore": "show.explore:write_page",
    "figure": "show.gallery:draw",
    "front": "show.pages:write_front",
    "living": "show.living:write_living",
    "numbers": "claims.numbers:write",
    "run_times": "results.products:write_times",
    "study_claims": study_claims,
    "study_evidence": "claims.published:write",
    "study_data": "tasks.running:combine",
    "study_figure": "show.gallery:draw_of_study",
    "study_movie": "show.gallery:movie_of_study",
    "study_page": "show.pages:write_study",
    "study_slides": "show.slides:write_slides",
    "study_task": "tasks.running:run_task",
    "table": "results.products:write_table",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a step (by default that of the process's own arguments) and return its exit status."""
    return cli.status_of(_options, arguments)


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    epilog = f"steps: {' '.join(STEPS)}; `STEP --help` explains one"
    parser = Parser(prog="python -m roughgas.steps", description=__doc__, epilog=epilog)
    parsers = parser.add_subparsers(metavar="STEP", required=True)
    for name, step in STEPS.items():
        one = parsers.add_parser(name)
        if arguments[:1] == [name]:
            if isinstance(step, str):
                module, _, function = step.partition(":")
                step = getattr(import_module(f"roughgas.{module}"), function)
            one.description = inspect.getdoc(step)
            for parameter in inspect.signature(step).parameters.values():
                _add(one, parameter)
            one.set_defaults(command=partial(_call, step))
    return parser.parse_args(arguments)


def _add(parser: argparse.ArgumentParser, parameter: inspect.Parameter) -> None:
    """Add a parameter of a step to its parser."""
    name, kind, default = parameter.name, parameter.annotation, parameter.default
    many = "+" if get_origin(kind) in (list, Iterable, Sequence) else None
    if parameter.kind is not parameter.KEYWORD_ONLY:
        parser.add_argument(name, nargs=many)
        return
    names = [*(["-o"] if name == "output" else []), f"--{name.replace('_', '-')}"]
    if kind is bool:
        parser.add_argument(*names, action="store_true")
    elif default is parameter.empty:
        parser.add_argument(*names, nargs=many, required=True)
    else:
        parser.add_argument(*names, nargs=many, default=default)


def _call(step: Callable[..., Any], options: argparse.Namespace) -> None:
    step(**{name: one for name, one in vars(options).items() if name != "command"})


if __name__ == "__main__":
    cli.process(main)
