"""The studies of this clone, as tests take them: statements, judges and figures."""

from pathlib import Path

from roughgas.base.files import study_module
from roughgas.claims import read_study
from roughgas.tasks import read_variables

ROOT = Path(__file__).parent.parent
FOLDERS = sorted(path.parent for path in (ROOT / "studies").glob("*/config.yaml"))


def module_of_study(study, module):
    """The module of a study, such as module_of_study("friction", "judges")."""
    return study_module(ROOT / "studies" / study, module)


def subject(study):
    """The table of statements of a study."""
    return read_study(ROOT / "studies" / study, study, ())


def quietly(done, total):
    """Report no progress of a task."""


def check_variables(study, data):
    """Whether the data of a study's tasks hold all that its variables.yaml describes, and nothing
    else."""
    documented = read_variables(ROOT / "studies" / study / "variables.yaml")
    expected = {name: (variable.dims, variable.long_name) for name, variable in documented.items()}
    present = {
        name: (variable.dims, variable.attrs["long_name"])
        for name, variable in data.variables.items()
    }
    assert present == expected


def statements():
    """Every statement by its name, on experiments by their own names."""
    judged = [folder.name for folder in FOLDERS if (folder / "claims.yaml").exists()]
    return {
        statement.name: statement for study in judged for statement in subject(study).statements
    }
