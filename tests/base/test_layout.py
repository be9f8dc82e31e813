"""Tables, and JSON, as people and scripts read them."""

import json
import math

import numpy as np

from roughgas.base.formatting import as_json, columns, markdown


def test_columns_are_aligned():
    rows = [["r", "R"], ["0.99", "1"], ["1", "0.25"]]
    assert columns(rows) == "r     R\n0.99  1\n1     0.25"
    assert columns(rows, numbers=True) == "r        R\n0.99     1\n1     0.25"


def test_markdown_has_a_rule_below_its_head():
    head, rows = ["scene", "N"], [["bed", 160], ["shear", 10240]]
    plain = "| scene | N |\n| --- | ---: |\n| bed | 160 |\n| shear | 10240 |\n"
    assert markdown(head, rows, "<>") == plain
    padded = "| scene |     N |\n| ----- | ----: |\n| bed   |   160 |\n| shear | 10240 |\n"
    assert markdown(head, rows, "<>", padded=True) == padded


def test_json_is_strict():
    answer = {
        "a": np.float64(math.inf),
        "b": [math.nan, np.int8(1)],
        3: np.array([[True]]),
        "c": "β",
    }
    assert json.loads(as_json(answer)) == {"a": None, "b": [None, 1], "3": [[True]], "c": "β"}
