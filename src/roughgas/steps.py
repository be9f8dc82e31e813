"""The steps of the workflow that only its rules give: `python -m roughgas.steps NAME ...`.

Each function in STEPS is a step: its positional parameters are arguments, those after `*` options;
a list takes several values, a bool none, and what has a default may be left out. Settings are JSON,
as the rules hand them on; `checked` says that they need no check. Errors are one line, and exit
statuses those of `roughgas`.
"""

import argparse
import inspect
import shlex
import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from roughgas import cli, config
from roughgas.base import InputError, not_one_of
from roughgas.cli.options import whole_number
from roughgas.cli.parser import Parser


def compile_kernels(experiment: str, *, settings: str, r: str, checked: bool = False) -> None:
    """Compile what the points of an experiment run at some r: of all its variants."""
    from roughgas.simulation.point import compile_kernels

    found = config.from_text(settings, "--settings", checked)
    every = config.every_variant(experiment, found).values()
    compile_kernels(every, config.restitution(r))


def table(inputs: list[str], *, output: str) -> None:
    """Write reduced datasets as one CSV table."""
    from roughgas.results.table import write_table

    write_table(inputs, output)


def figure(name: str, inputs: list[str], *, output: list[str], slide: bool = False) -> None:
    """Draw a figure from reduced datasets, or from one of studies."""
    from roughgas.show import gallery
    from roughgas.studies import figures as of_studies

    if name not in of_studies.FIGURES:
        gallery.draw(name, inputs, output, slide)
    elif slide:
        raise InputError("--slide", name, "be given for figures of experiments")
    elif len(inputs) > 1:
        raise InputError("number of datasets", len(inputs), "be 1, with all studies")
    else:
        of_studies.draw(name, inputs[0], output)


def study_figure(
    folder: str, figure: str, inputs: list[str], *, shows: list[str], output: list[str]
) -> None:
    """Draw a figure of the study in a folder from the reduced datasets that it shows, in order."""
    from roughgas.show.gallery import draw_of_study

    draw_of_study(folder, figure, shows, inputs, output)


def study_claims(
    folder: str,
    inputs: list[str],
    *,
    title: str,
    experiments: list[str],
    json: str,
    markdown: str,
) -> None:
    """Judge the statements in claims.yaml of the study in a folder, which has these experiments."""
    from roughgas.claims.report import judge
    from roughgas.claims.statements import read_study

    judge(inputs, json, markdown, read_study(folder, title, experiments))


def study_page(
    folder: str, *, title: str, table: str, figures: list[str], output: str, claims: str = ""
) -> None:
    """Write the page of the study in a folder: its README.md, figures, table and verdicts."""
    from roughgas.show.studies import write_page

    write_page(folder, title, figures, table, claims, output)


def claims(inputs: list[str], *, json: str, markdown: str, open_questions: bool = False) -> None:
    """Judge the claims of the paper, or what it leaves open."""
    from roughgas.claims import OPEN_QUESTIONS, PAPER, judge

    judge(inputs, json, markdown, OPEN_QUESTIONS if open_questions else PAPER)


def explore(inputs: list[str], *, points: str, output: str, config: str | None = None) -> None:
    """Write an interactive page of experiments and their points, which lie in a folder."""
    from roughgas.show.explore import write_page

    write_page(inputs, points, output, config)


def front(input: str, *, figures: list[str], captions: list[str], output: str) -> None:
    """Write the report's front page: figures beside their captions, and verdicts in Markdown."""
    from roughgas.show.pages import write_front

    write_front(input, figures, captions, output)


def living(*, config: str, output: str) -> None:
    """Write a page that simulates a gas of disks, with sliders."""
    from roughgas.show.living import write_living

    write_living(config, output)


def document(input: str, *, output: str) -> None:
    """Write a Markdown, YAML, MP4 or GIF file as one page of HTML."""
    from roughgas.show.pages import write_document

    write_document(input, output)


def run_times(inputs: list[str], *, output: str) -> None:
    """Write how long experiments took, in CPU seconds, as Markdown."""
    from roughgas.results.table import write_times

    write_times(inputs, output)


def effective_config(input: str, *, scale: str, output: str, changes: str = "{}") -> None:
    """Write the complete configuration of a scale, with changes to it in JSON."""
    from roughgas.config.provenance import write_effective

    changed = config.from_text(changes, "--changes", checked=True)
    write_effective(config.load(input, changed), scale, output)


def clustering(
    *,
    scale: str = config.PAPER,
    settings: str,
    output: str,
    checkpoint_every: str = "10",
    checked: bool = False,
) -> None:
    """Film a large cooling gas until it forms clusters, from the last checkpoint if there is one.

    The same command goes on after a kill, with the same bits; a checkpoint follows so many frames.
    """
    from roughgas.data.checkpoint import discard
    from roughgas.data.film import write_film
    from roughgas.simulation.clustering import run
    from roughgas.simulation.progress import FilmProgress

    found = config.from_text(settings, "--settings", checked, ("showcase", "filmed"))
    every = whole_number("--checkpoint-every", checkpoint_every, 1, of="of frames ")
    checkpoint = Path(f"{output}.checkpoint.npz")
    with FilmProgress(checkpoint, found["frames"]) as progress:
        try:
            variables, attributes = run(found, checkpoint, every, progress)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(progress.how_to_go_on()) from None
    again = ["python", "-m", "roughgas.steps", "clustering", "--scale", scale]
    again += ["--settings", config.as_text(found), "--output", output]
    about = {"title": f"A cooling gas of {found['particles']} disks", "scale": scale}
    write_film(output, variables, about | {"command": shlex.join(again)} | attributes)
    discard(checkpoint)
    took = f"{variables['collisions']:,} collisions in {variables['kernel_seconds']:.1f} s"
    print(f"{output}: {found['frames']} frames, {took}", file=sys.stderr)


def film(input: str, *, output: list[str]) -> None:
    """Draw the film of a cooling gas as a picture or as a movie."""
    from roughgas.show.figures.clustering import draw

    draw(input, output)


def study(study: str, task: str, *, scale: str = config.PAPER, settings: str, output: str) -> None:
    """Run one of the independent tasks of a study."""
    from roughgas import studies
    from roughgas.simulation.progress import Bar
    from roughgas.studies.files import write_task

    module = studies.study(study)
    found = config.study_from_text(settings, study, "--settings")
    tasks = module.tasks(found["study"])
    if task not in tasks:
        raise not_one_of("task", task, tasks)
    with Bar(task, None) as bar:
        data = module.run(
            task,
            found["study"],
            found["experiments"],
            lambda done, total: bar.reach(done, total=total),
        )
    about = {"study": study, "task": task, "scale": scale}
    write_task(output, data, about | {"settings_json": settings})


def combine(inputs: list[str], *, output: str) -> None:
    """Combine the tasks of studies into one dataset."""
    from roughgas.studies.files import combine

    combine(inputs, output)


def study_tables(input: str, *, output: str) -> None:
    """Write the results of studies as tables in Markdown."""
    from roughgas.studies.tables import write_tables

    write_tables(input, output)


STEPS: dict[str, Callable[..., None]] = {
    step.__name__: step
    for step in (
        *(compile_kernels, table, figure, claims, explore, front, living, document, run_times),
        *(
            study_figure,
            study_claims,
            study_page,
            effective_config,
            clustering,
            film,
            study,
            combine,
            study_tables,
        ),
    )
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a step (by default that of the process's own arguments) and return its exit status."""
    return cli.status_of(_options, arguments)


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    parser = Parser(prog="python -m roughgas.steps", description=__doc__)
    parsers = parser.add_subparsers(metavar="STEP", required=True)
    for name, step in STEPS.items():
        one = parsers.add_parser(name, help=(step.__doc__ or "").partition("\n")[0])
        for parameter in inspect.signature(step).parameters.values():
            _add(one, parameter)
        one.set_defaults(command=partial(_call, step))
    return parser.parse_args(arguments)


def _add(parser: argparse.ArgumentParser, parameter: inspect.Parameter) -> None:
    """Add a parameter of a step to its parser."""
    name, kind, default = parameter.name, parameter.annotation, parameter.default
    if parameter.kind is not parameter.KEYWORD_ONLY:
        parser.add_argument(name, nargs="+" if kind == list[str] else None)
        return
    names = [*(["-o"] if name == "output" else []), f"--{name.replace('_', '-')}"]
    if kind is bool:
        parser.add_argument(*names, action="store_true")
    else:
        settings: dict[str, Any] = {"required": default is parameter.empty}
        settings |= {} if settings["required"] else {"default": default}
        parser.add_argument(*names, nargs="+" if kind == list[str] else None, **settings)


def _call(step: Callable[..., None], options: argparse.Namespace) -> None:
    step(**{name: one for name, one in vars(options).items() if name != "command"})


if __name__ == "__main__":
    cli.process(main)
