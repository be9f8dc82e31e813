"""The tasks of a study, run one at a time and combined.

tasks.py in its folder has `tasks(settings)`, the names, the longest task first, and
`run(task, settings, experiments, progress)`, which returns a dataset; with a further parameter
`checkpoint` it may be continued after a kill. results.py has `combine(parts, settings)`, which
makes one dataset of those of all tasks by name, and `table(data)`, which shows it in Markdown.
"""

import hashlib
import inspect
import json
import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from roughgas.base import InputError, not_one_of, shown
from roughgas.base.files import code_in, module_of, write_text
from roughgas.config import PAPER, task_from_text
from roughgas.config.study_folders import check_tasks
from roughgas.data.netcdf import TASK, Content, content_of, read_groups, read_netcdf, write_netcdf
from roughgas.simulation.progress import Bar
from roughgas.simulation.restart import discard

NAME = re.compile(r"[\w+.-]+", re.ASCII)  # a part of a path, and of a command


class Checkpoint(NamedTuple):
    """Where a task keeps how far it is, and which task of which code and settings that is.

    `gas.save(*checkpoint, record)` and `gas.restore(*checkpoint)` take both.
    """

    path: Path
    owner: str


def names(folder: str | Path, settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the tasks of the study in `folder`, the longest first.

    Raises InputError where tasks.py cannot name them.
    """
    module, source = module_of(folder, "tasks"), f"studies/{Path(folder).name}/tasks.py"
    try:
        found = [str(name) for name in module.tasks(settings)]
    except InputError:
        raise
    except Exception as error:
        raise InputError(source, f"{type(error).__name__}: {error}", "name its tasks") from error
    for name in found:
        if not NAME.fullmatch(name) or found.count(name) > 1:
            legal = "be of letters, digits and _+.- alone, and each another one"
            raise InputError(f"{source}: name of a task", shown(name), legal)
    return found


def run_task(
    folder: str, task: str, *, scale: str = PAPER, settings: str, output: str | Path
) -> None:
    """Run a task of the study in a folder; the same command goes on from the checkpoint of one that
    was killed, if it has left one beside the output."""
    found = task_from_text(settings, partial(check_tasks, folder))
    run = module_of(folder, "tasks").run
    digest = hashlib.sha256(f"{code_in(folder, 'tasks')} {task} {settings}".encode())
    checkpoint = Checkpoint(Path(f"{output}.checkpoint.npz"), digest.hexdigest())
    if "checkpoint" in inspect.signature(run).parameters:
        run = partial(run, checkpoint=checkpoint)
    about = {"study": Path(folder).name, "task": task, "scale": scale, "settings_json": settings}
    try:
        write_found(run, names(folder, found["study"]), found, about, output)
    except KeyboardInterrupt:
        if checkpoint.path.exists():
            legal = f"the same command goes on from {checkpoint.path}"
            raise KeyboardInterrupt(legal) from None
        raise
    discard(checkpoint.path)


def write_found(
    run: Callable[..., xr.Dataset],
    known: Iterable[str],
    settings: Mapping[str, Any],
    about: Mapping[str, Any],
    output: str | Path,
) -> None:
    """Run the task that the attributes `about` name, one of the `known` ones, and write what it
    finds. Raises InputError for an unknown one."""
    if (task := about["task"]) not in known:
        raise not_one_of("task", task, known)
    with Bar(task, None) as bar:
        parts = settings["study"], settings["experiments"]
        data = run(task, *parts, lambda done, total: bar.reach(done, total=total))
    write_netcdf(output, content_of(data.assign_attrs(about)))


def combine(
    folder: str, inputs: Iterable[str | Path], *, output: str | Path, table: str | Path
) -> None:
    """Combine what the tasks of the study in a folder have found: a dataset, and a table in
    Markdown.

    Raises InputError where tasks are missing, or come from another study or different settings.
    """
    parts, name = {}, Path(folder).name
    for path in inputs:
        data = read_netcdf(path, TASK)
        if data.attrs["study"] != name:
            raise InputError(f"study of {path}", data.attrs["study"], f"be {name}")
        parts[data.attrs["task"]] = data
    results = module_of(folder, "results")
    data = combined(name, parts, partial(names, folder), results.combine)
    write_netcdf(output, Content({}, {"title": "Studies"}), {name: content_of(data)})
    write_text(table, results.table(read_groups(output)[name]))


def combined(
    name: str,
    parts: Mapping[str, xr.Dataset],
    tasks: Callable[[Mapping[str, Any]], Iterable[str]],
    combine: Callable[..., xr.Dataset],
) -> xr.Dataset:
    """Return what `combine` makes of what all tasks of a study have found, by name.

    Raises InputError where some of the `tasks` are missing or come from different settings.
    """
    texts = {data.attrs["settings_json"] for data in parts.values()}
    if len(texts) > 1:
        raise InputError(f"settings of {name}", f"{len(texts)} different ones", "be the same")
    settings: dict[str, Any] = json.loads(texts.pop())["study"]
    missing = set(tasks(settings)) - set(parts)
    if missing:
        raise InputError(f"tasks of {name}", f"without {sorted(missing)[0]}", "be complete")
    scales = {data.attrs["scale"] for data in parts.values()}
    found = combine(parts, settings)
    return found.assign_attrs(title=name, scale=", ".join(sorted(scales)))
