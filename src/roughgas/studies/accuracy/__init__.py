"""What accuracy costs in time, and whether error bars are true: studies of the methods themselves.

tasks.py names the independent tasks of each study. A file in runs/ does one of them, a file here
combines what all have found and fits what is to be fitted, variables.yaml describes the outcome,
and tables.py shows it in Markdown. Settings are in config.yaml, under `accuracy`.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from roughgas.base.errors import not_one_of
from roughgas.studies.accuracy.tasks import PANELS, STUDIES, TASKS

if TYPE_CHECKING:
    import xarray

__all__ = ["PANELS", "STUDIES", "Study", "study"]


class Study(NamedTuple):
    """What is done for a study: its tasks, in any order and at the same time."""

    tasks: Callable[[Mapping[str, Any]], list[str]]
    """Names of the tasks by the study's settings, the longest first."""
    run: Callable[..., "xarray.Dataset"]
    """What a task finds: `run(task, settings, experiments, progress)`, see `_run`."""


def study(name: str) -> Study:
    """Return a study by its name. Raises InputError for an unknown one."""
    if name not in STUDIES:
        raise not_one_of("study", name, STUDIES)
    return Study(TASKS[name], partial(_run, name))


def _run(
    name: str,
    task: str,
    settings: Mapping[str, Any],
    experiments: Mapping[str, Mapping[str, Any]],
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> "xarray.Dataset":
    """Return what a task finds: values of R, and CPU seconds without those of compiling.

    `progress(done, total)` is called now and then. Raises InputError for illegal settings,
    CollapseError as a simulation does.
    """
    from roughgas.studies.accuracy.runs import coverage, discretisation, models, statistical

    registered = {
        "statistical": statistical.run,
        "models": models.run,
        "discretisation": discretisation.run,
        "coverage": coverage.run,
    }
    return registered[name](task, settings, experiments, progress)
