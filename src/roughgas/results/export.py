"""Datasets as CSV files that any program reads: a table for each set of dimensions, and one that
says what the columns mean; for programs a data package (Frictionless) says the same.

Numbers are written so that the same bits are read back; missing ones are empty cells.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pandas import DataFrame, read_csv
from xarray import Dataset

from roughgas.base.files import whole_file
from roughgas.base.layout import in_csv
from roughgas.data.netcdf import read_netcdf, unit_of
from roughgas.data.opening import opened
from roughgas.results import table
from roughgas.results.datapackage import Field, field, write_package

MAIN = ("sample",), ("frame",)
"""The dimensions of the main table of a point, or of a film; it gets the plain name."""
UNREADABLE = ("last_memory",)
"""Variables that mean nothing to anyone but the kernel."""
ABOUT = ("name", "file", "value", "units", "meaning")


def export(path: str | Path, output: str | Path) -> list[Path]:
    """Write the dataset at `path`, of whatever kind, to `output` and to files beside it.

    `output` (`bed.csv`) gets the time series of a point, the frames of a film, or the grid of a
    reduced dataset; variables of other dimensions go to files such as `bed.replica.csv`; scalars,
    attributes and the meaning of all columns to `bed.about.csv`, and for programs to
    `bed.datapackage.json`. Each group of a file of studies
    becomes such a set of files, `bed.GROUP.about.csv` and so on. Returns the paths.

    Raises InputError if the pipeline has not written the file, or a newer version has.
    """
    with opened(path) as file:
        groups = list(file.groups)
    if not groups:
        return _export(read_netcdf(path), Path(output))
    written = (_export(read_netcdf(path, group=one), _beside(Path(output), one)) for one in groups)
    return [file for files in written for file in files]


def _export(dataset: Dataset, output: Path) -> list[Path]:
    """Write one dataset; return the paths of its files, the one that describes it last."""
    files: list[Path] = []
    found_in: dict[str, str] = {}
    for dims, names in _columns(dataset).items():
        is_grid = "n_seeds" in dataset and dims == dataset["n_seeds"].dims
        file = output if is_grid or dims in MAIN else _beside(output, "-".join(dims))
        if is_grid:
            head = (*table.HEAD, *(name for name in names if name not in table.HEAD))
            _write(file, DataFrame(table.rows(dataset, head), columns=head))
        else:
            _write(file, _frame(dataset, dims, names))
        files.append(file)
        axes = () if is_grid else dims  # there the third axis is a column `value`
        found_in = dict.fromkeys(axes, file.name) | found_in | dict.fromkeys(names, file.name)
    about = _beside(output, "about")
    _write(about, DataFrame(_descriptions(dataset, found_in), columns=ABOUT, dtype=object))
    tables = [(file, _fields(dataset, file)) for file in (*files, about)]
    package = write_package(output, str(dataset.attrs.get("title", "")), tables)
    return [*files, about, package]


def _fields(dataset: Dataset, file: Path) -> list[Field]:
    """Return the columns of a table that has been written."""
    head = read_csv(file, dtype=object, keep_default_na=False, nrows=0).columns
    return [_field(dataset, str(name)) for name in head]


def _field(dataset: Dataset, name: str) -> Field:
    if name not in dataset.variables:
        return field(name, "i" if name in dataset.dims else "")
    one = dataset[name]
    return field(name, one.dtype.kind, one.attrs.get("long_name", ""), unit_of(one.attrs))


def _columns(dataset: Dataset) -> dict[tuple[str, ...], list[str]]:
    """Return names of variables by their dimensions, coordinates first; no scalars, no axes."""
    found: dict[tuple[str, ...], list[str]] = {}
    for name in (*dataset.coords, *dataset.data_vars):
        if dataset[name].dims and name not in (*dataset.dims, *UNREADABLE):
            found.setdefault(dataset[name].dims, []).append(name)
    return found


def _frame(dataset: Dataset, dims: Sequence[str], names: Sequence[str]) -> DataFrame:
    """Return variables of the same dimensions: their places along these, then their values.

    The disks of a film come with the number of their frame.
    """
    data = dataset.reset_coords()[list(names)]
    columns = data.to_dataframe(dim_order=list(dims)).reset_index()[[*dims, *names]]
    if dims == ("disk",):
        counts = dataset["disks"].values
        columns.insert(0, "frame", np.repeat(np.arange(len(counts)), counts))
    return columns


def _descriptions(dataset: Dataset, found_in: Mapping[str, str]) -> Iterator[tuple[Any, ...]]:
    """Yield a row for each variable, with the value of a scalar, and for each attribute.

    Names of attributes begin with a colon, as in ncdump.
    """
    for name, variable in dataset.variables.items():
        about = variable.attrs
        value = "" if variable.dims else variable.values.item()
        yield name, found_in.get(str(name), ""), value, unit_of(about), about.get("long_name", "")
    for name, value in dataset.attrs.items():
        yield f":{name}", "", value, "", "attribute"


def _write(file: Path, frame: DataFrame) -> None:
    with whole_file(file) as draft:  # NaN is an empty cell
        frame.map(in_csv).rename(columns=in_csv).to_csv(draft, index=False, lineterminator="\n")


def _beside(output: Path, part: str) -> Path:
    """Return `bed.PART.csv` for `bed.csv`."""
    return output.with_name(f"{output.stem}.{part}{output.suffix}")
