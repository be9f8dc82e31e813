"""What accuracy costs in time, and whether error bars are true: studies of the methods themselves.

tasks.py names the independent tasks of each study. A file in runs/ does one of them, a file here
combines what all have found and fits what is to be fitted, variables.yaml describes the outcome,
and tables.py shows it in Markdown. Settings are in config.yaml, under `accuracy`.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

from roughgas.base.errors import not_one_of
from roughgas.studies.accuracy.tasks import PANELS, STUDIES, TASKS

__all__ = ["PANELS", "STUDIES", "Study", "study"]


class Study(NamedTuple):
    """The names of a study's tasks, the longest first, and how to run one: see `_run`."""

    tasks: Callable[[Mapping[str, Any]], list[str]]
    run: Callable[..., Any]


def study(name: str) -> Study:
    """Return a study by its name. Raises InputError for an unknown one."""
    if name not in STUDIES:
        raise not_one_of("study", name, STUDIES)
    return Study(TASKS[name], partial(_run, name))


def _run(name, task, settings, experiments, progress=lambda done, total: None):
    """Return the xarray.Dataset of a task: values of R, and CPU seconds without compiling.

    `progress(done, total)` is called now and then. Raises InputError for illegal settings,
    CollapseError as a simulation does.
    """
    from roughgas.studies.accuracy.runs import coverage, discretisation, models, statistical

    runs = dict(zip(STUDIES, (statistical, models, discretisation, coverage), strict=True))
    return runs[name].run(task, settings, experiments, progress)
