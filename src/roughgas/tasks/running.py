"""Execution and combination of the tasks of a study.

tasks.py in the folder of a study has `tasks(settings)`, which returns the names, the longest task
first, and `run(task, settings, experiments, progress)`, which returns a dataset; with a further
parameter `checkpoint` it may resume after a kill. results.py has `combine(parts, settings)`, which
combines the datasets of all tasks, by name, into one, and `table(data)`, which shows it in
Markdown. In a study with modules each module has these four functions, separate settings and a
separate dataset.
"""

import hashlib
import inspect
import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from roughgas.base import Attributes, InputError, check_one_of, short_repr, unknown_name_error
from roughgas.base.fields import OwnSettings, RawSettings
from roughgas.base.files import code_in, study_module, write_text
from roughgas.config import PAPER, TaskSettings, study_code
from roughgas.config.packaged import STUDIES_FOLDER
from roughgas.config.study_folders import check_tasks
from roughgas.data.netcdf import TASK, Content, content_of, read_groups, read_netcdf, write_netcdf
from roughgas.scene.settings import SceneSettings, scene_settings
from roughgas.simulation.checkpoint import advising_to_resume, checkpoint_path, discard
from roughgas.simulation.experiment_reader import read_experiment
from roughgas.simulation.progress import ProgressBar

RUN_MODULE, COMBINE_MODULE = "tasks", "results"
"""Files that run and combine the tasks of a study without modules."""
TASK_NAME = re.compile(r"[\w+.-]+", re.ASCII)  # used in paths and commands


class Checkpoint(NamedTuple):
    """Path of the checkpoint of a task, and the owner: a key of the task, its code and settings.

    `gas.save(*checkpoint, record)` and `gas.restore(*checkpoint)` take both.
    """

    path: Path
    owner: str


class Experiments(Mapping[str, SceneSettings]):
    """Experiments that a task may run, by name; each is read at its first use.

    An experiment without a schedule has the settings of its scene only. Raises InputError for an
    unknown experiment, and for settings that are missing or illegal.
    """

    def __init__(self, raw: Mapping[str, RawSettings]) -> None:
        """Store the settings `raw` of experiments, by name, which are read at their first use."""
        self._raw = raw

    def __getitem__(self, name: str) -> SceneSettings:
        """Return the settings of the experiment `name`, read and checked."""
        if name not in self._raw:
            raise unknown_name_error("experiment", name, self._raw)
        raw = self._raw[name]
        return read_experiment(raw) if "schedule" in raw else scene_settings(raw)

    def __iter__(self) -> Iterator[str]:
        return iter(self._raw)

    def __len__(self) -> int:
        return len(self._raw)


def task_names(folder: str | Path, settings: OwnSettings, module: str | None = None) -> list[str]:
    """Return the names of the tasks of the study in `folder`, or of its `module`, longest first.

    `settings` are the settings of the study or the module. Raises InputError if tasks.py, or the
    module, cannot name them, and for illegal or equal names.
    """
    module_name = module or RUN_MODULE
    code, source = (
        study_module(folder, module_name),
        f"{STUDIES_FOLDER}/{Path(folder).name}/{module_name}.py",
    )
    try:
        tasks = [str(task) for task in code.tasks(settings)]
    except InputError:
        raise
    except Exception as error:
        raise InputError(source, f"{type(error).__name__}: {error}", "name its tasks") from error
    for task in tasks:
        if not TASK_NAME.fullmatch(task) or tasks.count(task) > 1:
            legal = "be of letters, digits and _+.- alone, and each another one"
            raise InputError(f"{source}: name of a task", short_repr(task), legal)
    return tasks


def run_task(
    folder: str,
    task: str,
    *,
    module: str | None = None,
    scale: str = PAPER,
    settings: str,
    studies: Sequence[str] = (),
    output: str | Path,
) -> None:
    """Run a task of the study in a folder, or of a `module` of it.

    Its experiments may have effects and observables of the `studies`, given by their folders.

    A task that was killed resumes from the checkpoint beside `output`, if it has written one.
    `settings` has the settings of the `study`, or of the module, and of `experiments`, as JSON.
    Raises InputError for an unknown module or task and for illegal settings, CollapseError as a
    simulation does, OSError.
    """
    study_code.use(studies)
    module_name = module or RUN_MODULE
    run = _study_function(folder, module_name, "run")
    task_settings = TaskSettings.from_text(settings)
    check_tasks(folder, {"--settings: study": task_settings.study}, module)
    digest = hashlib.sha256(f"{code_in(folder, module_name)} {task} {settings}".encode())
    checkpoint = Checkpoint(Path(checkpoint_path(output)), digest.hexdigest())
    if "checkpoint" in inspect.signature(run).parameters:
        run = partial(run, checkpoint=checkpoint)
    study = module or Path(folder).name
    attributes = {"study": study, "task": task, "scale": scale, "settings_json": settings}
    with advising_to_resume(checkpoint.path):
        write_task_result(
            run, task_names(folder, task_settings.study, module), task_settings, attributes, output
        )
    discard(checkpoint.path)


def write_task_result(
    run: Callable[..., xr.Dataset],
    legal_tasks: Iterable[str],
    settings: TaskSettings,
    attributes: Attributes,
    output: str | Path,
) -> None:
    """Run the task named in `attributes`, and write its dataset with these attributes.

    `run(task, settings, experiments, progress)` computes the dataset; `output` is the path of its
    file. Raises InputError for a task that is not among `legal_tasks`.
    """
    if (task := attributes["task"]) not in legal_tasks:
        raise unknown_name_error("task", task, legal_tasks)
    with ProgressBar(task, None) as bar:
        arguments = settings.study, Experiments(settings.experiments)
        data = run(task, *arguments, lambda done, total: bar.reach(done, total=total))
    write_netcdf(output, content_of(data.assign_attrs(attributes)))


def combine(
    folder: str,
    inputs: Iterable[str | Path],
    *,
    modules: Sequence[str] = (),
    output: str | Path,
    table: str | Path,
) -> None:
    """Combine the datasets of all tasks of the study in a folder, and write tables in Markdown.

    `output` has a dataset, or a dataset for each of `modules`. Raises InputError if tasks are
    missing, or come from another study or different settings.
    """
    groups = modules or [Path(folder).name]
    results: dict[str, dict[str, xr.Dataset]] = {group: {} for group in groups}
    for path in inputs:
        data = read_netcdf(path, TASK)
        check_one_of(f"study of {path}", data.attrs["study"], groups)
        results[data.attrs["study"]][data.attrs["task"]] = data
    files = {group: group if modules else COMBINE_MODULE for group in groups}
    datasets = {}
    for group, module_name in files.items():
        tasks_of_group = partial(task_names, folder, module=group if modules else None)
        combine_group = _study_function(folder, module_name, "combine")
        datasets[group] = content_of(
            combined_dataset(group, results[group], tasks_of_group, combine_group)
        )
    write_netcdf(output, Content({}, {"title": "Studies"}), datasets)
    written = read_groups(output)
    tables = (
        _study_function(folder, module_name, "table")(written[group])
        for group, module_name in files.items()
    )
    write_text(table, "\n".join(tables))


def _study_function(folder: str | Path, module_name: str, function_name: str) -> Callable[..., Any]:
    """Return the function `function_name` of the module `module_name` of the study in `folder`.

    Raises InputError if it is missing.
    """
    function: Callable[..., Any] | None = getattr(
        study_module(folder, module_name), function_name, None
    )
    if function is None:
        raise InputError(
            f"{STUDIES_FOLDER}/{Path(folder).name}/{module_name}.py",
            "it",
            f"have {function_name}()",
        )
    return function


def combined_dataset(
    study: str,
    results: Mapping[str, xr.Dataset],
    tasks: Callable[[OwnSettings], Iterable[str]],
    combine: Callable[..., xr.Dataset],
) -> xr.Dataset:
    """Return the dataset that `combine` makes of the results of all tasks of a study.

    `results` are the datasets of the tasks by name, `tasks(settings)` the names of all tasks,
    `combine(results, settings)` a function of the study. Raises InputError if some of the `tasks`
    are missing or come from different settings.
    """
    if not results:
        raise InputError(f"tasks of {study}", "(nothing)", "be given")
    texts = {data.attrs["settings_json"] for data in results.values()}
    if len(texts) > 1:
        raise InputError(f"settings of {study}", f"{len(texts)} different ones", "be the same")
    settings: dict[str, Any] = json.loads(texts.pop())["study"]
    missing = set(tasks(settings)) - set(results)
    if missing:
        raise InputError(f"tasks of {study}", f"without {sorted(missing)[0]}", "be complete")
    scales = {data.attrs["scale"] for data in results.values()}
    combined = combine(results, settings)
    return combined.assign_attrs(title=study, scale=", ".join(sorted(scales)))
