"""Studies of the methods themselves, and of questions that no sweep of an experiment answers.

tasks.py names the independent tasks of each study. A file in runs/ does one of them, a file here
combines what all have found and fits what is to be fitted, variables.yaml describes the outcome,
tables.py shows it in Markdown, and figures/ draws it. Settings are in config.yaml, under `studies`.
dsmc/ and soft_spheres/ are two other methods to compare with.
"""

from collections.abc import Callable, Mapping
from functools import partial
from importlib import import_module
from typing import Any, NamedTuple

from roughgas.base import not_one_of
from roughgas.studies.tasks import STUDIES, TASKS

__all__ = ["STUDIES", "Study", "study"]


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
    """Return the xarray.Dataset of a task: what it finds, and CPU seconds without compiling.

    `progress(done, total)` is called now and then. Raises InputError for illegal settings,
    CollapseError as a simulation does.
    """
    runs = import_module(f"roughgas.studies.runs.{name}")
    return runs.run(task, settings, experiments, progress)
