"""Titles of figures state a conclusion only where its statement holds in the data drawn."""

import re
import shutil

import numpy as np
import pytest
from synthetic import reduced
from tests.claims.gases import FRICTION, constant, swept, walls
from tests.study_modules import FOLDERS, ROOT, module_of_study, statements

from roughgas.base import InputError
from roughgas.claims import titles
from roughgas.claims.verdicts import HOLDS, Finding
from roughgas.plotting import judged_title

STATEMENTS = statements()
FRICTION_FIGURE = ROOT / "studies" / "friction" / "figure.py"
BED = "vibrated_friction_follows_rates"


def rough(shift, error=1e-3):
    return swept("vibrated_friction", FRICTION, constant(shift), error=error)


def title(*gases, path=FRICTION_FIGURE, statement=BED):
    return judged_title(path, statement, gases, "drawn")


def test_a_conclusion_is_stated_only_where_it_holds():
    """It is neither where it fails, nor holds with a qualification, nor where data cannot tell."""
    conclusion = "A bed follows the rate equations"
    assert title(rough(0.0)) == conclusion == STATEMENTS[BED].conclusion
    for gas in (rough(0.2), rough(0.03), rough(0.2, error=1.0), swept("other", FRICTION)):
        assert title(gas) == "drawn"


@pytest.mark.slow
def test_points_that_are_set_aside_are_drawn_too():
    """Of 21 points two that are not steady are a few, three are not."""
    gas = rough(0.0)
    for number, stated in ((2, STATEMENTS[BED].conclusion), (3, "drawn")):
        steady = gas.equilibrated.copy()
        steady[:number, 0, 0] = 0.0
        assert title(gas.assign(equilibrated=steady, R=gas.R.where(steady > 0, 0.9))) == stated


def test_gases_through_stages_need_no_steady_state(monkeypatch):
    """Of a statement that holds; they are drawn over time."""
    monkeypatch.setattr(titles, "examine", lambda *_: Finding(HOLDS, ""))
    gas = rough(0.0).assign(equilibrated=0.0 * rough(0.0).equilibrated)
    assert title(gas) == "drawn"
    assert title(gas.assign_attrs(stages=2)) == STATEMENTS[BED].conclusion


def test_the_experiments_of_a_study_have_its_name(tmp_path):
    """A copied study has experiments of its own name, and judges them by its own table."""
    copied = tmp_path / "mine"
    shutil.copytree(ROOT / "studies" / "friction", copied)
    gas = rough(0.0).assign_attrs(experiment="mine.vibrated_friction")
    assert title(gas, path=copied / "figure.py") == STATEMENTS[BED].conclusion
    gas = rough(0.2).assign_attrs(experiment="mine.vibrated_friction")
    assert title(gas, path=copied / "figure.py") == "drawn"
    (copied / "claims.yaml").unlink()
    assert title(gas, path=copied / "figure.py") == "drawn"


def test_unknown_statements_and_absent_conclusions_are_refused():
    with pytest.raises(InputError, match="statement of a title = 'it_does': must be one of"):
        title(rough(0.0), statement="it_does")
    with pytest.raises(InputError, match=r"weak_friction_keeps_spin\.conclusion = \(nothing\)"):
        title(rough(0.0), statement="weak_friction_keeps_spin")


@pytest.mark.slow
def test_figures_write_the_titles():
    """Fig. 1b has one title where only rough walls matter, another where smooth ones do, too."""
    paper = module_of_study("paper", "figure")

    def texts(*gases):
        main = paper.fig1b(*gases).axes[0]
        return [text.get_text() for text in main.texts]

    conclusion = STATEMENTS["only_rough_walls_matter"].conclusion
    assert conclusion in texts(*walls())
    shifted = texts(*walls(smooth=0.1))
    assert conclusion not in shifted and "R of a vibrated bed between side walls" in shifted


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_every_conclusion_is_the_title_of_a_figure(folder):
    """Modules that draw name each statement with a conclusion, and no other statement."""
    if not (folder / "claims.yaml").exists():
        pytest.skip("no statements")
    code = "".join(path.read_text() for path in folder.glob("*.py") if path.name != "judges.py")
    of_study = {name for name in STATEMENTS if re.search(rf"^ *{name}:$", claims(folder), re.M)}
    titled = {name for name in of_study if STATEMENTS[name].conclusion}
    assert titled == {name for name in of_study if f'"{name}"' in code}


def claims(folder):
    return (folder / "claims.yaml").read_text()


def test_a_direction_is_stated_only_where_it_is_seen():
    """R on theory lies nowhere above it; R that rises with dissipation does."""
    gas = reduced("vibrated")
    path, statement = ROOT / "studies" / "paper" / "figure.py", "theory_underestimates"
    assert title(gas, path=path, statement=statement) == "drawn"
    above = gas.assign(R=gas.R + 0.2 * (1 - gas.r) * (1 - np.square(gas.beta)))
    assert title(above, path=path, statement=statement) == STATEMENTS[statement].conclusion
