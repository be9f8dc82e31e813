"""The studies of this clone, as tests take them: statements, judges and figures."""

from pathlib import Path

from roughgas.base.files import module_of
from roughgas.claims import PAPER, read_study
from roughgas.tasks import variables

ROOT = Path(__file__).parent.parent
EXPERIMENTS = ROOT / "tests" / "experiments.yaml"
"""Experiments of all studies by their own names, as they were once."""
FOLDERS = sorted(path.parent for path in (ROOT / "studies").glob("*/config.yaml"))


def part(study, module):
    """The module of a study, such as part("friction", "judges")."""
    return module_of(ROOT / "studies" / study, module)


def quietly(done, total):
    """Report no progress of a task."""


def check_variables(study, data):
    """Whether the data of a study's tasks hold all that its variables.yaml describes, and nothing
    else."""
    known = variables(ROOT / "studies" / study / "variables.yaml")
    expected = {name: (one.dims, one.long_name) for name, one in known.items()}
    found = {name: (one.dims, one.attrs["long_name"]) for name, one in data.variables.items()}
    assert found == expected


def statements():
    """Every statement by its name, on experiments by their own names."""
    judged = [folder for folder in FOLDERS if (folder / "claims.yaml").exists()]
    subjects = [read_study(folder, folder.name, ()) for folder in judged]
    return {one.name: one for of in (PAPER, *subjects) for one in of.statements}
