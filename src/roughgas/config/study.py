"""A study: its folder, experiments, figures, movies and tasks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from roughgas.base import from_json, sorted_json
from roughgas.base.fields import OwnSettings, RawSettings

BEYOND = "beyond"
"""Default heading of the report for a study."""
PAPERS = "papers"
"""Heading of the report for a study of another group's paper."""
LONG = "long"
"""Scale of simulations that take hours; their results are committed as long.csv of a study."""


@dataclass(frozen=True)
class StudyTasks:
    """Settings of the tasks of a study, and the experiments that they may run."""

    settings: Mapping[str, OwnSettings]
    """Settings of the tasks at each scale, by module in a study with modules."""
    experiments: Mapping[str, str] | None
    """Full names of the experiments that tasks may run, by the names that tasks use; None for all
    experiments of the configuration."""


@dataclass(frozen=True)
class Study:
    """A study; its experiments have full names, such as STUDY.EXPERIMENT."""

    folder: str
    title: str
    experiments: Sequence[str] = ()
    """Swept experiments; in a study of the root's experiments, all that its figures show."""
    figures: Mapping[str, Sequence[str]] | None = None
    """Experiments that each figure shows; `tasks`, or the name of a module, stands for the data of
    the tasks."""
    movies: Mapping[str, Sequence[str]] | None = None
    """Experiment, or variant, of each movie, and options of `roughgas movie`."""
    evidence: Sequence[str] = ()
    """Experiments that are compared with published numbers."""
    long: Sequence[str] = ()
    """Experiments, or `tasks`, whose datasets at the scale LONG its table long.csv is made of."""
    tasks: StudyTasks | None = None
    heading: str = BEYOND
    """Heading of the report that lists the study: paper, beyond, papers or accuracy."""
    paper: str = ""
    """The paper of another group that the study reproduces, as a reference."""
    documents: Sequence[str] = ()
    """Tables that the report shows as separate pages, in place of one page of the study."""
    modules: Sequence[str] = ()
    """Modules of its folder that define tasks; by default tasks.py does."""


class TaskSettings(NamedTuple):
    """Settings of one task: of its study, and of the experiments that it may run, by name."""

    study: OwnSettings
    experiments: Mapping[str, RawSettings]

    @property
    def text(self) -> str:
        """The settings as JSON with sorted keys; equal settings have equal texts."""
        return sorted_json(self._asdict())

    @classmethod
    def from_text(cls, text: str, source: str = "--settings") -> "TaskSettings":
        """Return the settings of a task from JSON `text`; its `study` remains to be checked.

        Raises InputError, whose key begins with `source`, for other illegal settings.
        """
        from roughgas.config.forms import PointForm
        from roughgas.config.json_schema import check_schema

        raw = from_json(text, source)
        check_schema(raw, source, "study_task")
        for name, experiment in raw["experiments"].items():
            PointForm.check(experiment, f"{source}: experiments.{name}")
        return cls(**raw)
