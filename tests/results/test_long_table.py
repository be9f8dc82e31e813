"""Tables of long simulations: what is written is what is read."""

import pytest

from roughgas.base import InputError
from roughgas.results.long_table import LongRow, read_long_rows, write_long_rows
from roughgas.statistics.estimates import Estimate

ROWS = [
    LongRow("viscosity", {"kind": "spheres", "q": 0.4}, Estimate(1.05, 0.002, 79.0), 0.25),
    LongRow("R", {"r": 0.9, "beta": -0.5}, Estimate(0.3, 1e-4), 1.5),
]


def test_rows_are_read_as_written(tmp_path):
    write_long_rows(ROWS, tmp_path / "long.csv")
    assert read_long_rows(tmp_path / "long.csv") == ROWS


def test_no_table_has_no_rows(tmp_path):
    assert read_long_rows(tmp_path / "long.csv") == []


def test_other_tables_are_refused(tmp_path):
    path = tmp_path / "long.csv"
    path.write_text("quantity,value\nR,0.3\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"columns of .*long\.csv"):
        read_long_rows(path)
