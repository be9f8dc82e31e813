"""The faults that `python -m tests.mutants` makes are still those of the source."""

import json

from tests import mutants


def test_the_text_of_each_fault_stands_once_in_the_source():
    faults = json.loads((mutants.ROOT / "tests" / "mutants.json").read_text())
    assert faults
    for fault in faults:
        mutants.place(mutants.ROOT, fault["old"])  # exits where it does not
