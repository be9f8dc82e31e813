"""The faults of mutants.py can still be made; that tests notice them is shown by running it."""

import json

import pytest
from tests import mutants

MUTANTS = json.loads((mutants.ROOT / "tests/mutants.json").read_text())


@pytest.mark.parametrize("mutant", MUTANTS, ids=range(len(MUTANTS)))
def test_a_fault_has_its_place_and_its_tests(mutant):
    assert mutants.place(mutants.ROOT / "src", mutant["old"])
    assert all((mutants.ROOT / name).exists() for name in mutants.tests_of(mutant["room"]))
    file, _, test = mutant["after"].partition("[")[0].partition("::")
    assert (file == "survived") == mutant.get("survives", False)
    assert file == "survived" or f"def {test}(" in (mutants.ROOT / file).read_text()


def test_there_are_faults_in_every_room():
    assert len(MUTANTS) >= 60
    rooms = {path.name for path in (mutants.ROOT / "src/roughgas").iterdir() if path.is_dir()}
    assert rooms - {"__pycache__"} <= {mutant["room"] for mutant in MUTANTS}
