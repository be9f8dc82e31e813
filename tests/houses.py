"""The studies of this clone, as tests take them: statements, judges and figures."""

from pathlib import Path

from roughgas.base.files import module_of
from roughgas.claims import OPEN_QUESTIONS, PAPER
from roughgas.claims.statements import read_study

ROOT = Path(__file__).parent.parent
EXPERIMENTS = ROOT / "tests" / "experiments.yaml"
"""Experiments of all studies by their own names, as they were once."""
FOLDERS = sorted(path.parent for path in (ROOT / "studies").glob("*/config.yaml"))


def part(study, module):
    """The module of a study, such as part("friction", "judges")."""
    return module_of(ROOT / "studies" / study, module)


def statements():
    """Every statement by its name, on experiments by their own names."""
    subjects = [read_study(folder, folder.name, ()) for folder in FOLDERS]
    return {one.name: one for of in (PAPER, OPEN_QUESTIONS, *subjects) for one in of.statements}
