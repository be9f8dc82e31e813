"""Tables of results: a CSV of all points, and a Markdown table of run times."""

import csv
import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import NamedValues, in_csv, markdown
from roughgas.base.files import atomic_write, write_text
from roughgas.data.reduced import GRID_DIMS, particles_of, read_reduced
from roughgas.data.variables import third_axis
from roughgas.statistics.errors import half_width
from roughgas.theory.prediction import predicted_ratio

if TYPE_CHECKING:
    import xarray

EXPERIMENT_COLUMNS = (
    "experiment",
    "scale",
    "particles",
    "dimension",
    "inertia",
    "parameter",
    "value",
)
VARIABLE_COLUMNS = (
    *("n_seeds", "R", "R_stderr", "R_dof", "R_ci95", "R_ci95_trusted"),
    *("R_stderr_over_seeds", "R_stderr_within", "R_ratio_of_means", "R_corrected"),
    *("R_collisional", "R_collisional_stderr"),
    *("R_unsubtracted", "R_unsubtracted_stderr", "E_trans", "E_trans_stderr", "E_rot"),
    *("input_spin_share", "equilibrated", "measured_from", "measured_for"),
    *("collisions", "contact_time_fraction"),
)
THEORY_COLUMNS = ("theory", "R_theory", "residual")
FEW_DEGREES_OF_FREEDOM = 5.0
"""Degrees of freedom of an error; with fewer its interval is noticeably wider."""
ALL_COLUMNS = (*EXPERIMENT_COLUMNS, *GRID_DIMS, *VARIABLE_COLUMNS, *THEORY_COLUMNS)
RUN_TIMES_HEADER = """\
# Run times

What the simulations of each experiment took, all points and seeds together: CPU seconds in the
kernel, without starting processes and compiling.

"""
RUN_TIME_COLUMNS = (
    "experiment | particles | points | seeds | collisions | CPU seconds | collisions a second"
)


def write_table(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Write a CSV with a row for each point of each experiment."""
    with atomic_write(output) as draft, open(draft, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(ALL_COLUMNS)
        for path in inputs:
            for row in rows(read_reduced(path)):
                table.writerow(map(_in_csv, row.values()))


def rows(dataset: "xarray.Dataset", head: Sequence[str] = ALL_COLUMNS) -> Iterator[NamedValues]:
    """Yield the rows of a reduced dataset by column, ascending in the third axis, r and beta.

    The columns in `head` are names in ALL_COLUMNS, of variables over the grid, or of attributes. A
    value is "" for a column that the dataset lacks, NaN for an unknown number.
    """
    swept, variants = third_axis(dataset.attrs), [dataset]
    if swept is not None:
        values = enumerate(dataset[swept].values)
        changed_attributes = {
            index: {swept: value, "parameter": swept, "value": value} for index, value in values
        }
        variants = [
            dataset.isel({swept: index}, drop=True).assign_attrs(attributes)
            for index, attributes in changed_attributes.items()
        ]
    for variant in variants:
        flat = variant.drop_dims("seed").stack(point=GRID_DIMS)
        prediction = predicted_ratio(variant.attrs, flat.r.values, flat.beta.values)
        for index in np.flatnonzero(flat["n_seeds"].values):
            row = {name: flat[name].values[index] for name in head if name in flat}
            residual = row.get("R", math.nan) - prediction[index]
            row |= {"R_theory": prediction[index], "residual": residual}
            yield {name: row.get(name, variant.attrs.get(name, "")) for name in head}


def wide_note(dataset: "xarray.Dataset") -> str:
    """Return a sentence on intervals of R that are wide since errors of few seeds are uncertain.

    It is "" if a reduced dataset has none.
    """
    freedom = np.atleast_1d(dataset["R_dof"] if "R_dof" in dataset else math.inf).ravel()
    # NaN without a point
    small = freedom[np.isfinite(freedom) & (freedom < FEW_DEGREES_OF_FREEDOM)]
    if not small.size:
        return ""
    points, seeds = int((dataset.n_seeds > 0).sum()), int(dataset.n_seeds.max())
    fewest, n_seeds = max(1.0, float(small.min())), f"{seeds} seed{'s' * (seeds > 1)}"
    wide = half_width(1.0, fewest, 0.95)
    return (
        f"\nWide intervals: {small.size} of {points}, since errors from {n_seeds} are uncertain: "
        f"known with {fewest:.2g}\ndegrees of freedom, 95 % are {wide:.1f} standard errors to each "
        "side, not 2.0. More seeds narrow them."
    )


def _in_csv(value: Any) -> str:
    """Return the text of a cell in CSV: a number with ten digits, "" for NaN, text escaped."""
    if isinstance(value, str):
        return in_csv(value)
    return "" if math.isnan(value) else format(value, ".10g")


def write_times(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Write a Markdown table of the kernel's CPU seconds, summed over the points of each reduced
    dataset, and over all datasets."""
    rows, counts = [], []
    for data in map(read_reduced, inputs):
        seeds, collisions, seconds = data.n_seeds, data.collisions.sum(), data.kernel_seconds.sum()
        counts.append((int((seeds > 0).sum()), int(seeds.sum()), int(collisions), float(seconds)))
        rows.append([data.attrs["experiment"], particles_of(data), *_sums(*counts[-1])])
    rows.append(["together", "", *_sums(*map(sum, zip(*counts, strict=True)))])
    write_text(output, RUN_TIMES_HEADER + markdown(RUN_TIME_COLUMNS.split(" | "), rows))


def _sums(points: int, seeds: int, collisions: int, seconds: float) -> list[str]:
    """Return the cells of sums in a table of run times; `seconds` are CPU seconds."""
    counts = [f"{count:,}" for count in (points, seeds, collisions)]
    return [*counts, f"{seconds:,.1f}", f"{collisions / seconds:,.0f}" if seconds > 0 else ""]
