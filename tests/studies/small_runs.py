"""The small tasks of each study, run once in a process: results, progress and random numbers."""

import functools
import inspect
import tempfile
from pathlib import Path
from typing import NamedTuple
from unittest import mock

import numpy as np
import xarray as xr
from tests.studies.small_studies import SMALL_STUDIES
from tests.study_modules import FOLDERS, ROOT, module_of_study

from roughgas.base.reading import read_yaml
from roughgas.config import TaskSettings
from roughgas.tasks.running import (
    COMBINE_MODULE,
    RUN_MODULE,
    Checkpoint,
    Experiments,
    combined_dataset,
)


class TaskRun(NamedTuple):
    """A task that was run."""

    result: xr.Dataset
    progress: list[tuple[int, int]]
    """Work done, and its total, at each report."""
    seeds: list[tuple[int, tuple[int, ...]]]
    """Entropy and key of all random numbers that it drew, except for the constant seed 0."""


def names_of_studies():
    """Names of the studies with tasks: STUDY, or STUDY.MODULE for each of its modules."""
    names = []
    for folder in FOLDERS:
        if (folder / f"{RUN_MODULE}.py").exists():
            names.append(folder.name)
        modules = read_yaml(folder / "config.yaml").get("modules", ())
        names += [f"{folder.name}.{module}" for module in modules]
    return names


STUDIES = names_of_studies()


def folder_and_module(name):
    """The folder of a study, and its module or None."""
    study, _, module = name.partition(".")
    return ROOT / "studies" / study, module or None


def modules_of(name):
    """The modules that run and that combine the tasks of a study."""
    folder, module = folder_and_module(name)
    return tuple(
        module_of_study(folder.name, module or role) for role in (RUN_MODULE, COMBINE_MODULE)
    )


def dataset_name(name):
    """The name of the combined data of a study: its own, or the name of its module."""
    return name.rpartition(".")[2]


def task_names(name):
    return modules_of(name)[0].tasks(SMALL_STUDIES[name].settings)


def run_anew(name, task):
    """Run a small task of a study."""
    runs, small = modules_of(name)[0], SMALL_STUDIES[name]
    reports, seeds, new_generator = [], [], np.random.default_rng

    def recorded(seed=None):
        assert seed is not None, f"{task} draws random numbers without a seed"
        if isinstance(seed, int):
            seed = np.random.SeedSequence(seed)
        if isinstance(seed, np.random.SeedSequence) and seed.entropy != 0:
            seeds.append((seed.entropy, seed.spawn_key))
        return new_generator(seed)

    arguments = [task, small.settings, Experiments(small.experiments), lambda *x: reports.append(x)]
    with tempfile.TemporaryDirectory() as folder:
        if "checkpoint" in inspect.signature(runs.run).parameters:
            arguments.append(Checkpoint(Path(folder, "checkpoint.npz"), task))
        with mock.patch("numpy.random.default_rng", recorded):
            return TaskRun(runs.run(*arguments), reports, seeds)


task_run = functools.cache(run_anew)
"""Function that returns the run of a task of a study, both by name; it runs once."""


def task_results(name):
    """The results of all small tasks of a study, by name."""
    return {task: task_run(name, task).result for task in task_names(name)}


@functools.cache
def combined(name):
    """The combined data of a study as the workflow makes them."""
    runs, results = modules_of(name)
    small = SMALL_STUDIES[name]
    text = TaskSettings(small.settings, small.experiments).text
    attributes = {"scale": "small", "settings_json": text}
    by_task = {task: result.assign_attrs(attributes) for task, result in task_results(name).items()}
    return combined_dataset(dataset_name(name), by_task, runs.tasks, results.combine)
