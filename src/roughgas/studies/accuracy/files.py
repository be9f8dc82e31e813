"""The files of studies: one a task, and one with a group for each study that is combined."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.data.netcdf import Content, content_of, read_netcdf, write_netcdf
from roughgas.studies.accuracy import STUDIES, study, tables


def write_task(path: str | Path, data: xr.Dataset, about: Mapping[str, Any]) -> None:
    """Write what a task has found; `about` names study, task and settings (JSON)."""
    write_netcdf(path, content_of(data.assign_attrs(about)))


def combine(paths: Iterable[str | Path], output: str | Path) -> None:
    """Combine the files of tasks into one file, with a group for each study among them.

    Raises InputError where a study's tasks are not all there, or come from different settings.
    """
    found: dict[str, dict[str, xr.Dataset]] = {}
    for path in paths:
        data = read_netcdf(path)
        found.setdefault(data.attrs["study"], {})[data.attrs["task"]] = data
    groups = {name: content_of(_combined(name, parts)) for name, parts in found.items()}
    write_netcdf(output, Content({}, {"title": "Studies of accuracy"}), groups)


read_study = read_netcdf  # with the name of the study as its group


def write_tables(path: str | Path, output: str | Path) -> None:
    """Write the tables of all studies in a combined file as Markdown."""
    import netCDF4

    with netCDF4.Dataset(path) as file:
        names = [name for name in STUDIES if name in file.groups]
    write_text(output, "\n".join(getattr(tables, name)(read_study(path, name)) for name in names))


def _combined(name: str, parts: Mapping[str, xr.Dataset]) -> xr.Dataset:
    texts = {data.attrs["settings_json"] for data in parts.values()}
    if len(texts) > 1:
        raise InputError(f"settings of {name}", f"{len(texts)} different ones", "be the same")
    settings = json.loads(texts.pop())["study"]
    missing = set(study(name).tasks(settings)) - set(parts)
    if missing:
        raise InputError(f"tasks of {name}", f"without {sorted(missing)[0]}", "be complete")
    scales = {data.attrs["scale"] for data in parts.values()}
    data = study(name).combine(dict(parts), settings)
    return data.assign_attrs(title=name, scale=", ".join(sorted(scales)))
