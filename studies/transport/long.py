"""Table of simulations that take hours: gases without positions, and rough spheres by events."""

from collections.abc import Iterator

import xarray as xr

from roughgas.judging import LongRow

from .dilute import event_rows
from .results import long_table as rows_of_tasks


def long_table(tasks: xr.Dataset, *event_driven: xr.Dataset) -> Iterator[LongRow]:
    """Yield the rows of long.csv from the data of tasks and from event-driven gases."""
    yield from rows_of_tasks(tasks)
    yield from event_rows(*event_driven)
