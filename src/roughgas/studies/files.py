"""The files of studies: one a task, and one with a group for each study that is combined."""

import json
from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.base import InputError
from roughgas.data.netcdf import TASK, Content, content_of, read_groups, read_netcdf, write_netcdf
from roughgas.studies.tasks import STUDIES, TASKS


def write_task(path: str | Path, data: xr.Dataset, about: Mapping[str, Any]) -> None:
    """Write what a task has found; `about` names study, task and settings (JSON)."""
    write_netcdf(path, content_of(data.assign_attrs(about)))


def combine(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Combine the files of tasks into one file, with a group for each study among them.

    Raises InputError where tasks of a study are missing or come from different settings.
    """
    found: dict[str, dict[str, xr.Dataset]] = {}
    for path in inputs:
        data = read_netcdf(path, TASK)
        found.setdefault(data.attrs["study"], {})[data.attrs["task"]] = data
    groups = {name: content_of(_combined(name, parts)) for name, parts in found.items()}
    write_netcdf(output, Content({}, {"title": "Studies"}), groups)


def _combined(name: str, parts: Mapping[str, xr.Dataset]) -> xr.Dataset:
    texts = {data.attrs["settings_json"] for data in parts.values()}
    if len(texts) > 1:
        raise InputError(f"settings of {name}", f"{len(texts)} different ones", "be the same")
    settings = json.loads(texts.pop())["study"]
    missing = set(TASKS[name](settings)) - set(parts)
    if missing:
        raise InputError(f"tasks of {name}", f"without {sorted(missing)[0]}", "be complete")
    scales = {data.attrs["scale"] for data in parts.values()}
    data = import_module(f"roughgas.studies.{name}").combine(parts, settings)
    return data.assign_attrs(title=name, scale=", ".join(sorted(scales)))


def read_studies(path: str | Path) -> dict[str, xr.Dataset]:
    """Return the groups of all studies in the combined file at `path`, by name."""
    groups = read_groups(path)
    return {name: groups[name] for name in STUDIES if name in groups}
