"""Studies: folders that are found by being there, and one that is broken, which keeps nothing else
from being made."""

import ast
import re
import shutil
import sys
from pathlib import Path

import pytest
import yaml
from tests.houses import EXPERIMENTS, FOLDERS, ROOT

from roughgas import config
from roughgas.base import InputError
from roughgas.base.files import module_of

ROOMS = ("gas", "plotting", "judging", "tasks", "tasks.dsmc", "tasks.free_cooling", "theory")
PUBLIC = {f"roughgas.{one}" for one in ROOMS}
LEAST = "experiments:\n  bed: {extends: vibrated, particles: 80}\n"
BROKEN = {
    "out_of_range": ("experiments: {x: {extends: vibrated, particles: -3}}", "particles = -3"),
    "no_yaml": ("experiments: [", "must be YAML"),
    "no_mapping": ("7", "must be a mapping"),
    "unknown_key": ("experimets: {}", "key = 'experimets'"),
    "unknown_parent": ("experiments: {x: {extends: bed}}", "x.extends = 'bed': must be one of"),
    "papers_name": ("experiments: {cooling: {extends: vibrated}}", "= cooling: must be no name"),
    "of_no_scale": (LEAST + "scales: {smal: {bed: {particles: 3}}}", "scale = 'smal': must be one"),
    "of_another": ("experiments: {x: {extends: absent.y}}", "extends = 'absent.y': must be one of"),
    "circle": ("experiments: {x: {extends: other.y}}", "must not extend a study that itself"),
    "other": ("experiments: {y: {extends: circle.x}}", "must not extend a study that itself"),
    "figures": (LEAST, "figures: must have another name: the workflow has a rule"),
    "cooling": (LEAST, "cooling: must have another name"),
    "named": (LEAST + "figures: {mine: [bed]}", "= mine: must be named or begin with named_"),
    "claiming": (LEAST, "claims.yaml: x.quote = (nothing): must be given"),
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with the configuration of the paper, and a function that adds studies to it."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)

    def add(name, text):
        Path("studies", name).mkdir(parents=True)
        Path("studies", name, "config.yaml").write_text(text)

    return add


def test_a_study_is_there_by_its_folder(here):
    here("mine", LEAST + "scales: {small: {bed: {particles: 20}}}\nmovies: {mine: bed --r=0.9}\n")
    whole = config.load("config.yaml")
    assert whole["broken"] == {} and [*whole["folders"]] == ["mine"]
    about = whole["folders"]["mine"]
    assert about["title"] == "Mine" and about["experiments"] == ["mine.bed"]
    assert about["figures"] == {} and about["movies"] == {"mine": ["mine.bed", "--r=0.9"]}
    found = config.experiment(whole, "mine.bed", "small")
    parent = config.experiment(whole, "vibrated", "small")
    without = {key: one for key, one in parent.items() if key != "description"}
    assert found == without | {"particles": 20}
    assert config.load_experiment("config.yaml", "mine.bed", "small") == found


def test_a_study_may_extend_another_and_fall_with_it(here):
    here("first", LEAST)
    here("second", "experiments: {wide: {extends: first.bed, box: [100, open]}}")
    whole = config.load("config.yaml")
    assert config.experiment(whole, "second.wide", "paper")["particles"] == 80
    assert config.load_experiment("config.yaml", "second.wide", "paper")["box"] == [100, "open"]
    shutil.rmtree("studies/first")
    whole = config.load("config.yaml")
    assert whole["folders"] == {} and [*whole["broken"]] == ["second"]


def test_the_configuration_may_change_an_experiment_of_a_study(here):
    here("mine", LEAST)
    change = {"experiments": {"mine.bed": {"particles": 81}}, "scales": {"paper": {}}}
    whole = config.load("config.yaml", change)
    assert config.experiment(whole, "mine.bed", "paper")["particles"] == 81
    with pytest.raises(InputError, match=r"'mine\.bad': must be STUDY\.EXPERIMENT"):
        config.load("config.yaml", {"experiments": {"mine.bad": {"particles": 81}}})


def test_the_configuration_may_remove_what_a_study_has(here):
    cases = "{one: {particles: 20}, two: {particles: 30}}"
    here("mine", f"experiments: {{bed: {{extends: vibrated, sweep: {{case: {cases}}}}}}}")
    for part in (("experiments",), ("scales", "small")):
        root = within = yaml.safe_load((ROOT / "config.yaml").read_text())
        for key in part:
            within = within[key]
        within["mine.bed"] = {"sweep": {"case": {"one": None}}}
        Path("config.yaml").write_text(yaml.safe_dump(root))
        found = config.experiment(config.load("config.yaml"), "mine.bed", "small")
        assert [*found["sweep"]["case"]] == ["two"]


def test_a_broken_study_is_left_out_in_one_line_and_all_others_stand(here):
    here("mine", LEAST)
    for name, (text, _) in BROKEN.items():
        here(name, text)
    Path("studies/claiming/claims.yaml").write_text("x: {experiments: [bed]}")
    whole = config.load("config.yaml")
    assert [*whole["folders"]] == ["mine"] and whole["broken"].keys() == BROKEN.keys()
    for name, (_, message) in BROKEN.items():
        line = str(InputError(*whole["broken"][name]))
        assert message in line and "\n" not in line and (name in line or name == "other")
        with pytest.raises(InputError, match=re.escape(line)):
            config.experiment(whole, f"{name}.x", "paper")


def test_without_studies_the_paper_stands(here):
    whole = config.load("config.yaml")
    assert len(whole["experiments"]) == 6 and whole["folders"] == whole["broken"] == {}


def test_no_study_needs_another():
    """So that all others stand where one is deleted."""
    names = {folder.name for folder in FOLDERS}
    for folder in FOLDERS:
        text = (folder / "config.yaml").read_text()
        assert not (names - {folder.name}) & {*re.findall(r"\b(\w+)\.\w", text)}, folder


def test_modules_of_a_study_import_each_other_and_are_read_anew(here, tmp_path):
    here("mine", LEAST)
    folder = tmp_path / "studies" / "mine"
    (folder / "figure.py").write_text("from .other import NUMBER\n")
    (folder / "other.py").write_text("NUMBER = 1\n")
    assert module_of(folder, "figure").NUMBER == 1
    (folder / "judges.py").write_text("def broken(:\n")
    with pytest.raises(InputError, match=r"studies/mine/judges\.py = SyntaxError"):
        module_of(folder, "judges")
    with pytest.raises(InputError, match=r"studies/mine/tasks\.py = \(nothing\)"):
        module_of(folder, "tasks")


def is_module(name):
    path = ROOT / "src" / name.replace(".", "/")
    return path.is_dir() or path.with_suffix(".py").exists()


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda one: one.name)
def test_a_study_uses_the_public_modules_alone(folder):
    for path in folder.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                named = [f"{node.module}.{one.name}" for one in node.names]
                modules = [node.module, *filter(is_module, named)]
            elif isinstance(node, ast.Import):
                modules = [one.name for one in node.names]
            else:
                continue
            used = {one for one in modules if one.startswith("roughgas.")}
            assert used <= PUBLIC, path
            others = {one.partition(".")[0] for one in modules} - sys.stdlib_module_names
            assert others <= {"roughgas", "numpy", "xarray", "matplotlib", "mpl_toolkits"}, path


def test_nothing_of_a_study_is_named_outside_its_folder():
    names = {name for name in config.load(ROOT / "config.yaml")["experiments"] if "." in name}
    for folder in FOLDERS:
        names.add(f"studies/{folder.name}")
        claims = folder / "claims.yaml"
        names |= set(yaml.safe_load(claims.read_text())) if claims.exists() else set()
    files = [ROOT / "config.yaml", ROOT / "Snakefile", *(ROOT / "rules").rglob("*.*")]
    files += [path for path in (ROOT / "src").rglob("*.*") if path.suffix in (".py", ".yaml")]
    any_of_them = re.compile(rf"\b({'|'.join(map(re.escape, names))})\b")
    for path in files:
        assert not any_of_them.findall(path.read_text(encoding="utf-8")), path


@pytest.mark.parametrize("scale", ["paper", "small"])
def test_the_settings_of_the_paper_are_those_that_tests_use(scale):
    own, frozen = config.load(ROOT / "config.yaml"), config.load(EXPERIMENTS)
    for name in (one for one in own["experiments"] if "." not in one):
        assert config.experiment(own, name, scale) == config.experiment(frozen, name, scale)
