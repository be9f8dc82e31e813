"""The files of studies: one a task, and one with a group for each study that is combined."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.data.cf import COMMON_ATTRIBUTES, check_schema, completed
from roughgas.data.point import whole_netcdf
from roughgas.studies.accuracy import STUDIES, study, tables


def write_task(path: str | Path, data: xr.Dataset, about: Mapping[str, Any]) -> None:
    """Write what a task has found; `about` names study, task and settings (JSON)."""
    with whole_netcdf(path) as draft:
        whole = completed(data).assign_attrs(COMMON_ATTRIBUTES | dict(about))
        whole.to_netcdf(draft, engine="netcdf4")


def combine(paths: Iterable[str | Path], output: str | Path) -> None:
    """Combine the files of tasks into one file, with a group for each study among them.

    Raises InputError where a study's tasks are not all there, or come from different settings.
    """
    found: dict[str, dict[str, xr.Dataset]] = {}
    for path in paths:
        data = xr.load_dataset(path, engine="netcdf4")
        check_schema(data.attrs, path)
        found.setdefault(data.attrs["study"], {})[data.attrs["task"]] = data
    groups = {f"/{name}": _combined(name, parts) for name, parts in found.items()}
    groups["/"] = xr.Dataset(attrs=COMMON_ATTRIBUTES | {"title": "Studies of accuracy"})
    with whole_netcdf(output) as draft:
        xr.DataTree.from_dict(groups).to_netcdf(draft, engine="netcdf4")


def read_study(path: str | Path, name: str) -> xr.Dataset:
    """The group of a study in the file at `path`, in memory, the file closed.

    Raises InputError where it is of a newer schema.
    """
    check_schema(xr.load_dataset(path, engine="netcdf4").attrs, path)
    return xr.load_dataset(path, group=name, engine="netcdf4")


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
    return completed(data).assign_attrs(title=name, scale=", ".join(sorted(scales)))
