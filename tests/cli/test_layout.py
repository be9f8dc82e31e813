"""Numbers as people and scripts read them."""

import json
import math

import numpy as np
import pytest

from roughgas.cli.layout import as_json, columns, with_error


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.35649, 0.00301, "0.3565(30)"),
        (0.35649, 0.000999, "0.3565(10)"),
        (0.35649, 0.0996, "0.36(10)"),
        (-0.002, 0.0131, "-0.002(13)"),
        (17.03, 1.24, "17.0(1.2)"),
        (1234.5, 87.0, "1234(87)"),
        (1234.5, 1870.0, "1200(1900)"),
        (3.3489e-11, 3.2e-12, "3.35(32)e-11"),
        (2.5e7, 1.25e5, "2.500(12)e+07"),
        (0.0, 0.01, "0.000(10)"),
        (0.123456789, math.nan, "0.123457"),
        (0.5, 0.0, "0.5"),
        (math.nan, 0.1, "nan"),
    ],
)
def test_an_error_is_given_in_units_of_the_last_digits(value, error, text):
    assert with_error(value, error) == text


def test_columns_are_aligned():
    rows = [["r", "R"], ["0.99", "1"], ["1", "0.25"]]
    assert columns(rows) == "r     R\n0.99  1\n1     0.25"
    assert columns(rows, numbers=True) == "r        R\n0.99     1\n1     0.25"


def test_json_is_strict():
    answer = {
        "a": np.float64(math.inf),
        "b": [math.nan, np.int8(1)],
        3: np.array([[True]]),
        "c": "β",
    }
    assert json.loads(as_json(answer)) == {"a": None, "b": [None, 1], "3": [[True]], "c": "β"}
