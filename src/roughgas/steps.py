"""Steps of the workflow: `python -m roughgas.steps NAME ...`. Its rules run them.

`fix_criteria` alone is run by hand.

Each function in STEPS is a step: its positional parameters are arguments, its keyword-only
parameters options; an iterable takes several values, a bool none, and a parameter with a default is
optional. Settings are JSON, as passed by the rules. Errors are one line, and exit statuses are the
same as of `roughgas`.
"""

import inspect
from collections.abc import Sequence
from importlib import import_module

from roughgas import cli, config
from roughgas.base import NamedValues, from_json
from roughgas.base.labels import restitution
from roughgas.cli.parser import Function, Parser, add_arguments


def compile_kernels(experiment: str, *, settings: str, r: str, studies: Sequence[str] = ()) -> None:
    """Compile the kernels of an experiment, in all its variants, at some r.

    `studies` are the folders of studies whose effects it has.
    """
    from roughgas.config import study_code
    from roughgas.simulation.point import compile_kernels

    study_code.use(studies)
    written = config.WrittenExperiment.from_text(settings, "--settings")
    written.check_third_axis("--settings")
    variants = written.every_variant(experiment).values()
    compile_kernels((variant.experiment("--settings") for variant in variants), restitution(r))


def claims(
    folder: str,
    inputs: list[str],
    *,
    title: str,
    json: str,
    markdown: str,
    experiments: Sequence[str] = (),
    reservation: str = "",
) -> None:
    """Judge the statements in claims.yaml of the study in a folder, on its experiments.

    The reservation says why its criteria were not fixed before these data, if they were not.
    """
    from roughgas.claims import judge, read_study

    judge(inputs, json, markdown, read_study(folder, title, experiments, reservation))


def fix_criteria(input: str, studies: list[str]) -> None:
    """Fix the criteria of studies, before their data: write findings.yaml of each."""
    from roughgas.config import findings

    configuration = config.load(input)
    for name in studies:
        print(f"{name}: {findings.write(configuration, name)}")


def effective_config(input: str, *, scale: str, output: str, changes: str = "{}") -> None:
    """Write the complete configuration of a scale, after changes to it in JSON."""
    from roughgas.config.study_folders import write_effective

    write_effective(config.load(input, from_json(changes, "--changes")), scale, output)


STEPS: dict[str, str | Function] = {
    "article": "results.article:write_article",
    "codemeta": "results.crate:write_codemeta",
    "claims": claims,
    "combine": "tasks.running:combine",
    "compile_kernels": compile_kernels,
    "document": "show.pages:write_document",
    "effective_config": effective_config,
    "evidence": "results.row_verdicts:combine",
    "evidence_page": "results.evidence_page:write_page",
    "evidence_figure": "show.gallery:draw_evidence",
    "explore": "show.explore:write_page",
    "figure": "show.gallery:draw",
    "fix_criteria": fix_criteria,
    "front": "show.report:write_front",
    "long_table": "claims.published:write_long",
    "living": "show.living:write_living",
    "numbers": "claims.numbers:write",
    "papers": "results.papers:write",
    "run_times": "results.tables:write_times",
    "study_evidence": "claims.published:write",
    "study_movie": "show.gallery:movie_of_study",
    "study_page": "show.report:write_study",
    "study_slides": "show.slides:write_slides",
    "task": "tasks.running:run_task",
    "table": "results.tables:write_table",
    "verdicts": "show.report:write_verdicts",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the step given by `arguments`, by default the process's, and return its exit status."""
    return cli.status_of(_call_of, arguments)


def _call_of(arguments: Sequence[str]) -> tuple[Function, NamedValues]:
    """Return the function of the step in a command line, and its arguments by name.

    Only the parser of this step gets its arguments: others need not be imported.
    """
    epilog = f"steps: {' '.join(STEPS)}; `STEP --help` explains one"
    parser = Parser(prog="python -m roughgas.steps", description=__doc__, epilog=epilog)
    parsers = parser.add_subparsers(metavar="STEP", required=True)
    for name, step in STEPS.items():
        subparser = parsers.add_parser(name)
        if arguments[:1] == [name]:
            if isinstance(step, str):
                module, _, function = step.partition(":")
                step = getattr(import_module(f"roughgas.{module}"), function)
            subparser.description = inspect.getdoc(step)
            add_arguments(subparser, step)
    return parser.call_of(arguments)


if __name__ == "__main__":
    cli.process(main)
