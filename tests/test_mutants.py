"""The texts that `python -m tests.mutants` replaces are in the source."""

import json

from tests import mutants


def test_the_text_of_each_fault_stands_once_in_the_source():
    faults = json.loads((mutants.ROOT / "tests" / "mutants.json").read_text())
    assert faults
    for fault in faults:
        mutants.file_to_change(mutants.ROOT, fault["old"])  # exits where it does not
