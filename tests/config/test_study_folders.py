"""Studies: folders that the workflow discovers, and broken ones, which stop nothing else."""

import ast
import json
import os
import re
import shutil
import sys
from pathlib import Path

import pytest
import yaml
from tests.study_modules import FOLDERS, ROOT

from roughgas import config
from roughgas.base import InputError
from roughgas.base.files import content_of, study_module
from roughgas.base.reading import read_yaml
from roughgas.config.packaged import SHIPPED_STUDIES, STUDIES_OF_ACCURACY
from roughgas.config.study_folders import task_settings, write_effective
from roughgas.effects import EFFECTS

ROOMS = ("gas", "plotting", "judging", "quoting", "tasks", "tasks.dsmc", "tasks.driven_dsmc")
ROOMS += ("tasks.free_cooling", "tasks.transport", "theory")
PUBLIC = {f"roughgas.{room}" for room in ROOMS}
OF_EFFECTS = {"base", "base.fields", "compiling.jit", "effects.settings", "kernel.hooks"}
OF_EFFECTS |= {f"kernel.{name}" for name in ("mathematics", "particles", "state")}
PUBLIC_TO_EFFECTS = PUBLIC | {f"roughgas.{room}" for room in OF_EFFECTS}
"""What effects.py of a study may import: the modules of worked examples, and the list of hooks;
besides, effects of the package."""
MINIMAL_STUDY = "experiments:\n  bed: {extends: vibrated, particles: 80}\n"
BROKEN = {
    "out_of_range": ("experiments: {x: {extends: vibrated, particles: -3}}", "particles = -3"),
    "no_yaml": ("experiments: [", "must be YAML"),
    "no_mapping": ("7", "must be a mapping"),
    "unknown_key": ("experimets: {}", "key = 'experimets'"),
    "unknown_parent": ("experiments: {x: {extends: bed}}", "x.extends = 'bed': must be one of"),
    "papers_name": ("experiments: {cooling: {extends: vibrated}}", "= cooling: must be no name"),
    "of_no_scale": (
        MINIMAL_STUDY + "scales: {smal: {bed: {particles: 3}}}",
        "scale = 'smal': must be one",
    ),
    "of_another": ("experiments: {x: {extends: absent.y}}", "extends = 'absent.y': must be one of"),
    "circle": ("experiments: {x: {extends: other.y}}", "must not extend a study that itself"),
    "other": ("experiments: {y: {extends: circle.x}}", "must not extend a study that itself"),
    "figures": (MINIMAL_STUDY, "figures: must have another name: the workflow has a rule"),
    "cooling": (MINIMAL_STUDY, "cooling: must have another name"),
    "named": (
        MINIMAL_STUDY + "figures: {mine: [bed]}",
        "= mine: must be named or begin with named_",
    ),
    "claiming": (MINIMAL_STUDY, "claims.yaml: x.quote = (nothing): must be given"),
}


def added(configuration):
    """Return the names of a configuration's studies, without the studies of the package."""
    return [name for name in configuration.studies if name not in SHIPPED_STUDIES]


@pytest.fixture
def add_study(tmp_path, monkeypatch):
    """A folder with the configuration of the paper as the present one, and a function that adds
    studies."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)

    def add(name, text):
        Path("studies", name).mkdir(parents=True)
        Path("studies", name, "config.yaml").write_text(text)

    return add


def test_a_folder_is_a_study(add_study):
    add_study(
        "mine",
        MINIMAL_STUDY + "scales: {small: {bed: {particles: 20}}}\nmovies: {mine: bed --r=0.9}\n",
    )
    configuration = config.load("config.yaml")
    assert configuration.refused == {} and added(configuration) == ["mine"]
    study = configuration.studies["mine"]
    assert study.title == "Mine" and study.experiments == ["mine.bed"]
    assert study.figures == {} and study.movies == {"mine": ["mine.bed", "--r=0.9"]}
    experiment = configuration.experiment("mine.bed", "small").raw
    parent = configuration.experiment("vibrated", "small").raw
    without = {key: value for key, value in parent.items() if key != "description"}
    assert experiment == without | {"particles": 20}
    assert config.load_experiment("config.yaml", "mine.bed", "small").raw == experiment


def test_a_study_may_extend_another_and_depends_on_it(add_study):
    add_study("first", MINIMAL_STUDY)
    add_study("second", "experiments: {wide: {extends: first.bed, box: [100, open]}}")
    configuration = config.load("config.yaml")
    assert configuration.experiment("second.wide", "paper").raw["particles"] == 80
    assert config.load_experiment("config.yaml", "second.wide", "paper").raw["box"] == [100, "open"]
    shutil.rmtree("studies/first")
    configuration = config.load("config.yaml")
    assert added(configuration) == [] and [*configuration.refused] == ["second"]


def test_the_configuration_may_change_an_experiment_of_a_study(add_study):
    add_study("mine", MINIMAL_STUDY)
    change = {"experiments": {"mine.bed": {"particles": 81}}, "scales": {"paper": {}}}
    configuration = config.load("config.yaml", change)
    assert configuration.experiment("mine.bed", "paper").raw["particles"] == 81
    with pytest.raises(InputError, match=r"'mine\.bad': must be STUDY\.EXPERIMENT"):
        config.load("config.yaml", {"experiments": {"mine.bad": {"particles": 81}}})


def test_the_configuration_may_remove_what_a_study_has(add_study):
    cases = "{one: {particles: 20}, two: {particles: 30}}"
    add_study("mine", f"experiments: {{bed: {{extends: vibrated, sweep: {{case: {cases}}}}}}}")
    for section in (("experiments",), ("scales", "small")):
        root = within = yaml.safe_load((ROOT / "config.yaml").read_text())
        for key in section:
            within = within[key]
        within["mine.bed"] = {"sweep": {"case": {"one": None}}}
        Path("config.yaml").write_text(yaml.safe_dump(root))
        experiment = config.load("config.yaml").experiment("mine.bed", "small").raw
        assert [*experiment["sweep"]["case"]] == ["two"]


def test_a_broken_study_is_left_out_with_one_line(add_study):
    add_study("mine", MINIMAL_STUDY)
    for name, (text, _) in BROKEN.items():
        add_study(name, text)
    Path("studies/claiming/claims.yaml").write_text("x: {experiments: [bed]}")
    configuration = config.load("config.yaml")
    assert added(configuration) == ["mine"] and configuration.refused.keys() == BROKEN.keys()
    for name, (_, message) in BROKEN.items():
        line = str(InputError(*configuration.refused[name]))
        assert message in line and "\n" not in line and (name in line or name == "other")
        with pytest.raises(InputError, match=re.escape(line)):
            configuration.experiment(f"{name}.x", "paper")


UNREADABLE = {
    "latin": (lambda path: path.write_bytes("# Größe".encode("latin-1")), "(not text)"),
    "pipe": (os.mkfifo, "(no regular file)"),
    "endless": (lambda path: path.symlink_to("/dev/zero"), "(no regular file)"),
    "folder": (Path.mkdir, "(no regular file)"),
    "huge": (lambda path: path.touch() or os.truncate(path, 300_000_000), "300000000 bytes"),
    "secret": (Path.touch, "Permission denied"),
}
NAMES = ("README.md", "config.yaml", "claims.yaml", "schema.yaml", "figure.py", "reference.csv")


@pytest.mark.parametrize("file", NAMES)
@pytest.mark.parametrize("kind", UNREADABLE)
def test_a_study_with_a_file_that_cannot_be_read_is_left_out_in_one_line(
    add_study, monkeypatch, kind, file
):
    """It neither waits for a pipe, nor fills the memory, nor stops commands that need no study."""
    add_study("mine", MINIMAL_STUDY)
    add_study("odd", MINIMAL_STUDY)
    make, reason = UNREADABLE[kind]
    path = Path("studies", "odd", file)
    if kind == "latin" and file in ("schema.yaml", "figure.py", "reference.csv"):
        pytest.skip("decoded where it is used")
    path.unlink(missing_ok=True)
    make(path)
    if kind == "secret":
        deny(monkeypatch, path)
    configuration = config.load("config.yaml")
    assert added(configuration) == ["mine"] and [*configuration.refused] == ["odd"]
    line = str(InputError(*configuration.refused["odd"]))
    assert line.startswith(f"studies/odd/{file} = {reason}: must be") and "\n" not in line


def deny(monkeypatch, path):
    """Refuse to open a file, as permissions do for all users but root."""
    opened = os.open

    def refuse(name, *arguments, **options):
        if Path(name).name == path.name and Path(name).parent.name == path.parent.name:
            raise PermissionError(13, "Permission denied", str(name))
        return opened(name, *arguments, **options)

    monkeypatch.setattr(os, "open", refuse)


def test_a_configuration_that_a_person_names_may_come_through_a_pipe_and_has_a_limit(tmp_path):
    with pytest.raises(InputError, match=r"zero = .* bytes: must be of 1000000 at most"):
        read_yaml("/dev/zero")
    os.mkfifo(tmp_path / "unwritten")
    assert read_yaml(tmp_path / "unwritten") is None
    reader, writer = os.pipe()
    os.write(writer, b"scale: paper\n")
    os.close(writer)
    assert read_yaml(f"/dev/fd/{reader}") == {"scale": "paper"}
    os.close(reader)
    with pytest.raises(InputError, match=r"pipe = .no regular file.: must be a file to read"):
        content_of(tmp_path / "unwritten", "pipe")


def test_a_title_is_no_html_and_has_a_limit(add_study):
    """It becomes a label in a script of Snakemake's report; `{name}` would be a wildcard."""
    add_study("mine", MINIMAL_STUDY)
    readme = Path("studies/mine/README.md")
    readme.write_text("# R < 1 </script><script>alert(1)</script> {study} <!-- \x00\u0085x\n")
    title = config.load("config.yaml").studies["mine"].title
    assert not re.search(r"<[A-Za-z/!?]|\{\w|[\x00-\x1f\x7f-\x9f]", title)
    shown = "R < 1 </script><script>alert(1)</script> {study} <!-- x"
    assert title.replace("\N{WORD JOINER}", "") == shown
    readme.write_text("# " + "x" * 100_000)
    (*_, legal) = config.load("config.yaml").refused["mine"]
    assert legal == "be of 200 characters at most"


def test_without_studies_the_paper_is_complete(add_study):
    configuration = config.load("config.yaml")
    assert (
        len(configuration.experiments) == 6
        and added(configuration) == []
        and configuration.refused == {}
    )
    assert configuration.studies.keys() <= {*SHIPPED_STUDIES} and "paper" in configuration.studies


def test_the_paper_is_a_study_of_the_roots_experiments(add_study):
    """A configuration that lacks some of these experiments is legal, too."""
    paper = config.load(ROOT / "config.yaml").studies["paper"]
    assert paper.heading == "paper" and [*paper.documents] == ["claims", "run_times", "config"]
    assert paper.experiments[0] == "vibrated" and len(paper.experiments) == 6
    assert paper.figures["fig2a"] == ["sheared"] and paper.title == "The paper"
    root = yaml.safe_load((ROOT / "config.yaml").read_text())
    del root["experiments"]["sheared"], root["scales"]["small"]["sheared"]
    for scale in ("lean", "quick"):
        del root["scales"][scale]["sheared"]
    Path("config.yaml").write_text(yaml.safe_dump(root))
    configuration = config.load("config.yaml")
    assert configuration.studies["paper"].figures == paper.figures and configuration.refused == {}
    with pytest.raises(InputError, match="experiment = 'sheared': must be one of"):
        configuration.experiment("sheared", "paper")


def test_studies_of_the_roots_experiments_join_a_complete_configuration(add_study):
    add_study("mine", MINIMAL_STUDY)
    add_study("shown", "figures: {shown: [cooling, vibrated], shown_bed: [vibrated]}")
    add_study("broken", "experiments: [")
    write_effective(config.load("config.yaml"), "small", "complete.yaml")
    configuration = config.load("complete.yaml")
    assert "mine.bed" in configuration.experiments and configuration.refused == {}
    assert added(configuration) == ["shown"] and "paper" in configuration.studies
    assert configuration.studies["shown"].experiments == ["cooling", "vibrated"]


def test_each_module_has_its_tasks_and_its_dataset(add_study):
    text = "modules: [one, two]\ntasks: {one: {size: 3}, two: {}}\nheading: accuracy\n"
    add_study(
        "mine", text + "figures: {mine: [two, cooling]}\nscales: {small: {tasks: {two: {n: 1}}}}\n"
    )
    for module in ("one", "two"):
        Path("studies", "mine", f"{module}.py").touch()
    configuration = config.load("config.yaml")
    study = configuration.studies["mine"]
    assert configuration.refused == {} and [*study.modules] == ["one", "two"]
    assert study.heading == "accuracy" and study.figures == {"mine": ["two", "cooling"]}
    assert study.tasks.settings["small"] == {"one": {"size": 3}, "two": {"n": 1}}
    for change, message in (
        ("tasks: {one: {}}", "tasks.two = (nothing): must be given"),
        ("tasks: {one: {}, two: {}, three: {}}", "key of tasks = 'three': must be one of one, two"),
        ("modules: [one, absent]", "mine/absent.py = (nothing): must be there"),
        ("heading: beyound", "heading = 'beyound': must be one of"),
    ):
        settings = yaml.safe_load(text) | yaml.safe_load(change)
        Path("studies/mine/config.yaml").write_text(yaml.safe_dump(settings))
        assert message in str(InputError(*config.load("config.yaml").refused["mine"]))


def test_settings_of_a_scale_override_the_key_accuracy(add_study):
    change = {"accuracy": {"statistical": {"levels": 5, "seed": 7}}, "scales": {}}
    change["scales"]["small"] = {"accuracy": {"coverage": {"repetitions": 44}}}
    configuration, before = config.load("config.yaml", change), config.load("config.yaml")
    statistical = {
        scale: configuration.accuracy_at(scale)["statistical"] for scale in ("paper", "small")
    }
    assert statistical["paper"]["levels"] == 5 and statistical["small"]["seed"] == 7
    assert statistical["small"]["levels"] == before.accuracy_at("small")["statistical"]["levels"]
    assert configuration.accuracy_at("small")["coverage"]["repetitions"] == 44
    text = task_settings(configuration, "accuracy", "small", "statistical").text
    assert json.loads(text)["study"] == statistical["small"]
    assert {*json.loads(text)["experiments"]} == {*configuration.experiments}


def test_settings_of_accuracy_that_a_configuration_lacks_are_named(add_study):
    root = yaml.safe_load((ROOT / "config.yaml").read_text())
    root["accuracy"] = {"models": {"seed": None}}
    Path("config.yaml").write_text(yaml.safe_dump(root))
    with pytest.raises(InputError, match=r"accuracy\.models\.seed = None: must be a whole number"):
        config.load("config.yaml")
    settings = config.load(ROOT / "config.yaml").accuracy_at("small")
    del settings["models"]["seed"]
    complete = {"complete": True, "experiments": root["experiments"], "accuracy": settings}
    Path("complete.yaml").write_text(yaml.safe_dump(complete))
    message = "complete.yaml: accuracy at scale paper.models.seed = (nothing): must be given"
    with pytest.raises(InputError, match=re.escape(message)):
        config.load("complete.yaml")


def test_claims_may_have_a_head(add_study):
    add_study("mine", MINIMAL_STUDY)
    row = {"quote": "It is.", "experiments": ["bed"], "criterion": "It"}
    row["fixed"] = {"when": "after data", "tries": 3, "note": "It was seen."}
    rows = {"it_is": row | {"judge": "follows", "ours": True}}
    path = Path("studies/mine/claims.yaml")
    for claims in (rows, {"title": "Verdicts", "about": "{reference}", "statements": rows}):
        path.write_text(yaml.safe_dump(claims))
        assert config.load("config.yaml").refused == {}
    for claims, message in (
        (
            {"statements": {"it_is": rows["it_is"] | {"quote": 3}}},
            "yaml: statements.it_is.quote = 3",
        ),
        (
            {"it_is": rows["it_is"] | {"fixed": {"when": "never"}}},
            "it_is.fixed.when = 'never': must be one of before data, partly after data, after data",
        ),
        ({"statements": rows, "tail": "x"}, "key = 'tail': must be one of about, after, quotes"),
    ):
        path.write_text(yaml.safe_dump(claims))
        assert message in str(InputError(*config.load("config.yaml").refused["mine"]))


@pytest.mark.parametrize("key", ["scale", "scales", "experiments"])
@pytest.mark.parametrize("value", [None, ""])
def test_the_command_line_takes_no_key_away_that_is_needed(add_study, key, value):
    with pytest.raises(InputError, match=rf"{key} = \(nothing\): must have a value"):
        config.load("config.yaml", {key: value})


def test_no_study_needs_another():
    """Each can be deleted without harm to the others; friction.mu is a parameter of an effect."""
    names = {folder.name for folder in FOLDERS} - {*EFFECTS}
    for folder in FOLDERS:
        text = (folder / "config.yaml").read_text()
        assert not (names - {folder.name}) & {*re.findall(r"\b(\w+)\.\w", text)}, folder


def test_modules_of_a_study_import_each_other_and_are_read_anew(add_study, tmp_path):
    add_study("mine", MINIMAL_STUDY)
    folder = tmp_path / "studies" / "mine"
    (folder / "figure.py").write_text("from .other import NUMBER\n")
    (folder / "other.py").write_text("NUMBER = 1\n")
    assert study_module(folder, "figure").NUMBER == 1
    (folder / "judges.py").write_text("def broken(:\n")
    with pytest.raises(InputError, match=r"studies/mine/judges\.py = SyntaxError"):
        study_module(folder, "judges")
    with pytest.raises(InputError, match=r"studies/mine/tasks\.py = \(nothing\)"):
        study_module(folder, "tasks")


def is_module(name):
    path = ROOT / "src" / name.replace(".", "/")
    return path.is_dir() or path.with_suffix(".py").exists()


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_a_study_uses_the_public_modules_alone(folder):
    """Studies that measure the package itself are exempt."""
    for path in folder.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level == 0:
                named = [f"{node.module}.{alias.name}" for alias in node.names]
                modules = [node.module, *filter(is_module, named)]
            elif isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            else:
                continue
            used = {module for module in modules if module.startswith("roughgas.")}
            public = PUBLIC
            if path.name == "effects.py":
                public = PUBLIC_TO_EFFECTS
                used = {module for module in used if not module.startswith("roughgas.effects.")}
            assert used <= public or folder.name in STUDIES_OF_ACCURACY, path
            packages = {module.partition(".")[0] for module in modules} - sys.stdlib_module_names
            assert packages <= {"roughgas", "numpy", "xarray", "matplotlib", "mpl_toolkits"}, path


def test_nothing_of_a_study_is_named_outside_its_folder():
    names = {name for name in config.load(ROOT / "config.yaml").experiments if "." in name}
    for folder in FOLDERS:
        if folder.name in SHIPPED_STUDIES:
            continue
        names.add(f"studies/{folder.name}")
        claims = folder / "claims.yaml"
        names |= set(yaml.safe_load(claims.read_text())) if claims.exists() else set()
    files = [ROOT / "config.yaml", ROOT / "Snakefile", *(ROOT / "rules").rglob("*.*")]
    files += [path for path in (ROOT / "src").rglob("*.*") if path.suffix in (".py", ".yaml")]
    any_of_them = re.compile(rf"\b({'|'.join(map(re.escape, names))})\b")
    for path in files:
        assert not any_of_them.findall(path.read_text(encoding="utf-8")), path
