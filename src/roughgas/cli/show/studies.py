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
    from roughgas.studies.accuracy.files import read_studies

    return read_studies(path)


def record(studies: dict[str, "xarray.Dataset"]) -> dict[str, Any]:
    """Return attributes, sizes and single numbers of each study."""
    return {"studies": {name: task.record(data) for name, data in studies.items()}}


def text(studies: dict[str, "xarray.Dataset"]) -> str:
    """Return what `roughgas tables` writes."""
    from roughgas.studies.accuracy.tables import TABLES

    scales = {data.attrs["scale"] for data in studies.values()}
    parts = [TABLES[name](data).strip() for name, data in studies.items()]
    return "\n\n".join([f"scale {', '.join(sorted(scales))}", *parts])
