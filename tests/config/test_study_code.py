"""Effects and observables of a study: legal in its experiments alone, each fault one line."""

import shutil
from pathlib import Path

import pytest
from study_code import EFFECTS, OBSERVABLES, ROOT, add_study

from roughgas import config, effects, observables, register_observable
from roughgas.base import InputError
from roughgas.base.files import study_module
from roughgas.config import study_code
from roughgas.config.study_folders import write_effective
from roughgas.effects.user_code import source_hash

BUILT_IN = [*effects.EFFECTS], [*observables.OBSERVABLES]
OTHERS = "experiments:\n  bed: {extends: vibrated, %s}\n"
FAULTS = {  # what the file holds, and the end of the one line about it
    "effects.py": {
        "no Python": (EFFECTS + "\n1 +\n", " = SyntaxError: invalid syntax (effects.py, line "),
        "error": ("raise ValueError('a\\nb')\n", " = ValueError: a\\nb: must be Python"),
        "end": ("raise SystemExit(3)\n", " = SystemExit: 3: must be Python"),
        "taken": (
            EFFECTS.replace('"plasticity", P', '"threshold", P'),
            ": effect = threshold: must have a name that is free",
        ),
        "no effect": (
            EFFECTS[: EFFECTS.index("register(")] + EFFECTS[EFFECTS.index("roughgas.reg") :],
            ": effect plasticity = Plasticity: must have a struct of settings and hooks",
        ),
        "late": (
            EFFECTS.replace('before="threshold"', 'before="paths"'),
            ": effect plasticity: before = 'paths': must be one of spin, ",
        ),
    },
    "observables.py": {
        "no module": ("import nowhere\n", " = ModuleNotFoundError: No module named 'nowhere'"),
        "taken": (
            OBSERVABLES + "\n\ndef stress(frame):\n    return 1\n",
            ": observable = stress: must have a name that is free",
        ),
        "capitals": (
            OBSERVABLES + "\n\ndef Fast(frame):\n    return 1\n",
            ": observable = 'Fast': must have a name of lower-case letters",
        ),
    },
}


@pytest.fixture(autouse=True)
def project(tmp_path, monkeypatch):
    """An empty project in the present folder; a test leaves no names behind."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)
    yield
    study_code.use(())
    assert ([*effects.EFFECTS], [*observables.OBSERVABLES]) == BUILT_IN


def refused(configuration):
    return {name: str(InputError(*reason)) for name, reason in configuration.refused.items()}


def test_names_are_legal_in_the_experiments_of_the_study_and_in_those_that_extend_them():
    add_study()
    changed = "effects: {plasticity: {yield_speed: 2}}, sweep: {plasticity.yield_speed: null}"
    extending = (
        f"experiments:\n  x: {{extends: mine.metal, {changed}, observables: {{fast: {{}}}}}}\n"
    )
    add_study("extending", None, None, extending)
    for name, of_another in (
        ("plastic", "effects: {plasticity: {}}"),
        ("seen", "observables: {fast: {}}"),
    ):
        add_study(name, None, None, OTHERS % of_another)
    configuration = config.load("config.yaml")
    assert configuration.experiment("extending.x", "paper").raw["effects"]["plasticity"] == {
        "yield_speed": 2
    }
    reasons = refused(configuration)
    assert reasons.keys() == {"plastic", "seen"}
    for name, key, file in (
        ("plastic", "effects", "effects"),
        ("seen", "observables", "observables"),
    ):
        assert reasons[name].startswith(
            f"studies/{name}/config.yaml: experiments.bed.{key}: key = "
        )
        assert reasons[name].endswith(
            f"; studies/mine/{file}.py has one for experiments of mine alone"
        )
        with pytest.raises(InputError, match="for experiments of mine alone"):
            config.load_experiment("config.yaml", f"{name}.bed", "paper")


def test_variants_and_single_experiments_have_them():
    add_study()
    name = "mine.metal/yield_speed0.25"
    variant = config.load_experiment("config.yaml", name, "small")
    assert variant.experiment("").effects["plasticity"].yield_speed == 0.25
    assert (
        config.load_experiment("config.yaml", "mine.observed", "small").experiment("").observables
    )
    assert "plasticity" not in BUILT_IN[0] and "plasticity" in effects.EFFECTS
    config.load_experiment("config.yaml", "vibrated", "small")
    assert "plasticity" not in effects.EFFECTS and "fast" not in observables.OBSERVABLES


@pytest.mark.parametrize(
    ("file", "fault"), [(file, fault) for file, faults in FAULTS.items() for fault in faults]
)
def test_a_broken_file_is_one_line_that_names_it(file, fault):
    """The study is left out; all other experiments are there."""
    text, line = FAULTS[file][fault]
    (add_study() / file).write_text(text)
    configuration = config.load("config.yaml", {"experiments": {"mine.metal": {"particles": 21}}})
    assert "vibrated" in configuration.experiments
    reason = refused(configuration)["mine"]
    assert reason.startswith(f"studies/mine/{file}{line}") and "\n" not in reason
    with pytest.raises(InputError) as error:
        config.load_experiment("config.yaml", "mine.plain", "paper")
    assert str(error.value) == reason


def test_two_studies_may_have_the_same_names():
    add_study("first", config=OTHERS % "observables: {fast: {}}", effects=None)
    second = "def fast(frame):\n    return frame.time\n\n\nfast.long_name = 'another'\n"
    add_study("second", None, second, OTHERS % "observables: {fast: {}}")
    configuration = config.load("config.yaml")
    assert not configuration.refused
    for name, text in (("first", "share of fast particles"), ("second", "another")):
        configuration.experiment(f"{name}.bed", "paper")
        assert observables.OBSERVABLES["fast"].function.long_name == text
    both = "experiments:\n  x: {extends: first.bed}\n  y: {extends: second.bed}\n"
    add_study("third", None, None, both)
    reasons = refused(config.load("config.yaml"))
    assert "observable = fast: must have a name that is free" in reasons["third"]


def test_a_name_of_a_user_is_taken():
    add_study(effects=None, config=OTHERS % "observables: {fast: {}}")
    register_observable("fast", type("Fast", (observables.Observable,), {}))
    try:
        with pytest.raises(
            InputError, match=r"observables\.py: observable = fast: must have a name"
        ):
            config.load_experiment("config.yaml", "mine.bed", "paper")
        assert "fast" in observables.OBSERVABLES
    finally:
        observables.forget_observable("fast")


def test_an_edit_is_read():
    def law():
        """The class of the effect, and the hash of its sources, as an experiment finds them."""
        config.load_experiment("config.yaml", "mine.metal", "paper").experiment("")
        kind = effects.EFFECTS["plasticity"]
        return kind, source_hash("plasticity", kind)

    study, first = add_study(), law()
    assert law() == first
    (study / "effects.py").write_text(EFFECTS.replace("else r\n", "else 0.5 * r\n"))
    assert law()[1] != first[1]
    (study / "effects.py").write_text(EFFECTS)
    assert law()[1] == first[1]


def test_another_file_of_the_study_may_import_its_effects():
    """They are legal in its experiments alone nevertheless."""
    study = add_study()
    (study / "judges.py").write_text("from .effects import Plasticity\n")
    assert study_module(study, "judges").Plasticity(0.5).yield_speed == 0.5
    assert "plasticity" not in effects.EFFECTS
    config.load_experiment("config.yaml", "mine.metal", "paper")
    assert "plasticity" in effects.EFFECTS


CLASS = """
import roughgas
from roughgas.observables import Observable


class Fast(Observable):
    def observe(self, frame):
        return {}


roughgas.register_observable("fast", Fast)
"""


def test_a_study_may_register_a_class_of_observables():
    """As a user does."""
    add_study(effects=None, observables=CLASS, config=OTHERS % "observables: {fast: {}}")
    config.load_experiment("config.yaml", "mine.bed", "paper")
    assert observables.OBSERVABLES["fast"].__name__ == "Fast"


def test_the_configuration_may_change_them_and_extend_them():
    add_study()
    change = {"effects": {"plasticity": {"yield_speed": 3}}}
    cheap = {"extends": "mine.metal", **change, "observables": {"constant": {}}}
    changes = {"experiments": {"mine.metal": change, "cheap": cheap}}
    changes["scales"] = {"small": {"mine.observed": {"observables": {"constant": {"every": 3}}}}}
    configuration = config.load("config.yaml", changes)
    for name in ("mine.metal", "cheap"):
        settings = configuration.experiment(name, "paper").raw["effects"]
        assert settings["plasticity"] == {"yield_speed": 3}
    assert configuration.experiment("mine.observed", "small").raw["observables"]["constant"]
    with pytest.raises(InputError, match=r"'fast'.* for experiments of mine alone"):
        config.load("config.yaml", {"experiments": {"vibrated": {"observables": {"fast": {}}}}})


def test_a_complete_configuration_has_them():
    add_study()
    configuration = config.load("config.yaml")
    write_effective(configuration, "paper", "complete.yaml")
    complete = config.load("complete.yaml")
    assert complete.complete and not complete.refused
    for name in ("mine.metal", "mine.observed"):
        raw = complete.experiment(name, "paper").raw
        assert raw == configuration.experiment(name, "paper").raw
        names = raw["effects"], raw.get("observables", ())
        assert study_code.options(*names) == ["--studies", "studies/mine"]


def test_a_parameter_that_datasets_need_is_not_swept():
    named = EFFECTS.replace("yield_speed", "time")
    swept = "effects: {plasticity: {time: 1}}, sweep: {plasticity.time: ['1']}"
    add_study(effects=named, config=OTHERS % swept)
    reason = refused(config.load("config.yaml"))["mine"]
    assert "must be a parameter of another name: datasets have a time already" in reason


def test_code_of_a_study_may_import_its_neighbours():
    """A folder of another name is another study."""
    study = add_study()
    (study / "plastic.py").write_text(EFFECTS[: EFFECTS.index("roughgas.register_effect")])
    line = 'roughgas.register_effect("plasticity", Plasticity)\n'
    (study / "effects.py").write_text(
        f"import roughgas\n\nfrom .plastic import Plasticity\n\n{line}"
    )
    shutil.copytree(study, "studies/copied")
    configuration = config.load("config.yaml")
    assert not configuration.refused
    modules = []
    for name in ("mine", "copied"):
        configuration.experiment(f"{name}.metal", "paper")
        modules.append(effects.EFFECTS["plasticity"].__module__)
    assert modules == ["roughgas_study_mine.plastic", "roughgas_study_copied.plastic"]
    assert Path("studies/copied").is_dir()
