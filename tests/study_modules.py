"""The studies of this clone, as tests take them: statements, judges and figures."""

from pathlib import Path

from roughgas.base.files import study_module
from roughgas.claims import read_study

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


def statements():
    """Every statement by its name, on experiments by their own names."""
    judged = [folder.name for folder in FOLDERS if (folder / "claims.yaml").exists()]
    return {
        statement.name: statement for study in judged for statement in subject(study).statements
    }
