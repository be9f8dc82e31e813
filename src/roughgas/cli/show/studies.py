"""Studies of accuracy, combined in one file: their tables."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.cli.show import task
from roughgas.studies.accuracy import STUDIES

if TYPE_CHECKING:
    import xarray

__all__ = ["STUDIES", "read", "record", "text"]


def read(path: str | Path) -> dict[str, "xarray.Dataset"]:
    """Return the datasets of all studies in a file."""
    import netCDF4

    from roughgas.studies.accuracy.files import read_study

    with netCDF4.Dataset(path) as file:
        names = [name for name in STUDIES if name in file.groups]
    return {name: read_study(path, name) for name in names}


def record(studies: dict[str, "xarray.Dataset"]) -> dict[str, Any]:
    """Return attributes, sizes and single numbers of each study."""
    return {"studies": {name: task.record(data) for name, data in studies.items()}}


def text(studies: dict[str, "xarray.Dataset"]) -> str:
    """Return what `roughgas tables` writes."""
    from roughgas.studies.accuracy import tables

    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [getattr(tables, name)(data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])
