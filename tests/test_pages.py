"""The documentation's tables follow from the code, and its examples of additions work."""

import importlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from shutil import copytree, ignore_patterns

import numpy as np
import pytest
import xarray
import yaml
from jsonschema import Draft202012Validator
from raw import build
from tests import pages
from tests.configurations import EXPERIMENTS
from tests.pages import EDITORS

import roughgas
from roughgas import config, theory
from roughgas.base import InputError
from roughgas.base.labels import grid_points
from roughgas.base.reading import read_yaml
from roughgas.claims import verdicts
from roughgas.config import WrittenExperiment, json_schema, study_code
from roughgas.data.point import as_dataset, read_point
from roughgas.effects import EFFECTS as EFFECT_CLASSES
from roughgas.simulation import protocols
from roughgas.simulation.checkpoint import Checkpoint
from roughgas.simulation.experiment_reader import read_experiment
from roughgas.simulation.gas import Gas
from roughgas.simulation.run_points import simulate_points

ROOT, PACKAGE = Path(__file__).parents[1], Path(roughgas.__file__).parent
TABLES = pages.tables()
EFFECTS, OBSERVABLES, DEVELOPMENT, LIBRARY = (
    (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
    for page in ("effects", "observables", "development", "library")
)
BEFORE_EXPERIMENTS = "\nexperiments:\n"  # in config.yaml


@pytest.mark.parametrize("name", TABLES, ids="-".join)
def test_the_tables_of_the_page_are_those_of_the_code(name):
    assert pages.written(*name) == TABLES[name], "write it anew: python -m tests.pages"


def test_no_tolerance_is_left_out():
    """Each number that a judge is in these files is in the page's table, or decides nothing."""
    for module in (verdicts, pages.JUDGES):
        documented = pages.constant_docstrings(module)
        numbers = {name for name in documented if isinstance(getattr(module, name), float)}
        left = {name for name in numbers if pages.DECIDES.get(name) is not module}
        assert left <= {"NEAR_COOLING"}, "a tolerance without its reason"


def section(heading):
    return EFFECTS.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def block(text, language):
    (code,) = re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return code


def rows(text):
    """Return the cells of every row of the tables in a text, without heads."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in line[1:-1].split(" | ")] for line in lines]
    return [row for row in cells if row[0] != "---"][1:]


def config_with(experiment, folder):
    """A copy of config.yaml in a folder, with one experiment more; its path."""
    text = (ROOT / "config.yaml").read_text(encoding="utf-8")
    assert text.count(BEFORE_EXPERIMENTS) == 1
    changed = text.replace(BEFORE_EXPERIMENTS, f"{BEFORE_EXPERIMENTS}{experiment}\n")
    (folder / "config.yaml").write_text(changed, encoding="utf-8")
    return folder / "config.yaml"


def test_what_the_page_of_effects_says_is_refused():
    refused = [[cell.strip("`") for cell in row] for row in rows(section("Refusals"))]
    assert len(refused) > 5
    for settings, answer in refused:
        experiment = {"particles": 20} | yaml.safe_load(f"{{{settings}}}")
        with pytest.raises(InputError) as caught:
            build(experiment, 0.9, 0.0 if "spin" in experiment["effects"] else -1.0)
        assert str(caught.value) == answer


def test_the_experiment_at_the_top_is_legal(tmp_path):
    file = config_with(block(EFFECTS.split("\n## ")[0], "yaml"), tmp_path)
    settings = config.load(file).experiment("tilted_bed", "paper").raw
    present = {name for name, effect in settings["effects"].items() if effect is not None}
    chosen = {"spin", "gravity", "floor", "walls", "friction"}
    assert present == chosen | {"contact_averages"} <= set(EFFECT_CLASSES)
    assert len(WrittenExperiment(settings).every_variant("tilted_bed")) == 3


def test_the_schema_for_editors_is_of_the_structs_and_takes_what_the_code_takes():
    schema = json.loads(EDITORS.read_text(encoding="utf-8"), parse_constant=pytest.fail)
    assert EDITORS.read_text(encoding="utf-8") == json_schema.text()
    validator = Draft202012Validator(schema)
    Draft202012Validator.check_schema(schema)
    for path in (ROOT / "config.yaml", EXPERIMENTS):
        configuration = read_yaml(path)
        assert not [*validator.iter_errors(configuration)]
        configuration["experiments"]["cooling"]["effects"]["spin"]["inertia"] = "half"
        (error,) = validator.iter_errors(configuration)
        assert [*error.absolute_path][-2:] == ["spin", "inertia"]
    for path in sorted(ROOT.glob("studies/*/config.yaml")):
        study_code.use([path.parent])  # the schema has its effects and observables, too
        definitions = {"$ref": "#/$defs/experiments", "$defs": json_schema.schema()["$defs"]}
        folder = Draft202012Validator(definitions)
        assert not [*folder.iter_errors(read_yaml(path).get("experiments", {}))], path
    study_code.use(())


def check_result(series):
    """R is first theory's at the gas's r, and in the end theory's at r = 1.

    Velocities are correlated, which theory neglects: 4 % at most.
    """
    (result,) = section("A worked example").split("**The result.**")[1:]
    shown, beta = rows(result), -0.8
    assert len(shown) == 2
    for passed, ratio, expected, r in (map(float, row) for row in shown):
        assert series[passed] == pytest.approx(ratio, abs=1e-4)
        assert theory.cooling_ratio(r, beta, 2, 0.5) == pytest.approx(expected, abs=1e-4)
        assert ratio == pytest.approx(expected, rel=0.04)


def run_script(folder, name, page):
    """Run a page's file and its script, which registers the file's definitions; return the output.

    The script is in the folder of the file, and the file alone is there beside it.
    """
    file, script = files_of(page)
    (folder / f"{name}.py").write_text(file, encoding="utf-8")
    (folder / "script.py").write_text(script + ENDING, encoding="utf-8")
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, check=True, timeout=300)
    return done.stdout.decode()


ENDING = "gas.to_netcdf('gas.nc')\n"


def files_of(page):
    """Return the Python examples of a page or section that are files, and the scripts that
    register their definitions."""
    examples = re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    return [text for text in examples if text.startswith('"""') or "roughgas.register_" in text]


@pytest.mark.slow
def test_the_worked_example_is_one_file_and_one_line(tmp_path):
    run_script(tmp_path, "plasticity", section("A worked example"))
    with xarray.open_dataset(tmp_path / "gas.nc") as gas:
        passed = gas.collisions_per_particle.values.tolist()
        check_result(dict(zip(passed, gas.R_series.values, strict=True)))


@pytest.mark.slow
def test_the_worked_example_in_the_package_is_one_file_and_one_line(tmp_path):
    example, package = section("A worked example"), tmp_path / "roughgas"
    copytree(PACKAGE, package, ignore=ignore_patterns("__pycache__"))
    (package / "effects/plasticity.py").write_text(files_of(example)[0], encoding="utf-8")
    listed, before = package / "effects/__init__.py", None
    text = listed.read_text(encoding="utf-8")
    for line in block(example, "diff").splitlines(keepends=True):
        if line.startswith("+"):
            assert text.count(before) == 1, before
            text = text.replace(before, before + line[1:])
        before = line[1:]
    listed.write_text(text, encoding="utf-8")
    environ = {"PYTHONPATH": str(tmp_path), "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
    file, (command,) = config_with(block(example, "yaml"), tmp_path), set(COMMAND.findall(example))
    command = [sys.executable, "-m", *command.split(), f"--config={file}"]
    subprocess.run(command, cwd=tmp_path, env=os.environ | environ, check=True, timeout=300)
    point = read_point(tmp_path / "plastic.nc")
    passed = point.collisions_per_particle.values.tolist()
    check_result(dict(zip(passed, point.R_series.values, strict=True)))


COMMAND = re.compile("`(roughgas run .*?)`")


def test_the_example_of_an_observable_prints_what_the_page_says(tmp_path):
    """Images slide along x, so that this temperature is the larger one."""
    page = OBSERVABLES.split("\n## Add an observable\n")[1]
    assert run_script(tmp_path, "anisotropy", page) == block(page, "text")
    with xarray.open_dataset(tmp_path / "gas.nc") as gas:
        assert float(gas.anisotropy) > 1.0 + 2.0 * float(gas.anisotropy_stderr)
        assert gas.anisotropy_trusted == -1


def test_the_example_of_a_tracker_prints_what_the_page_says(tmp_path):
    page = LIBRARY.split("\n## Trackers\n")[1].split("\n## ")[0]
    (tmp_path / "script.py").write_text(block(page, "python"), encoding="utf-8")
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=tmp_path, stdout=subprocess.PIPE, check=True, timeout=300)
    assert done.stdout.decode() == block(page, "text")


@pytest.fixture
def ensemble(tmp_path, monkeypatch):
    """The example of a kind of schedule as a module, listed as the page says."""
    page = DEVELOPMENT.split("\n## A kind of schedule\n")[1].split("\n## ")[0]
    (file,), line = files_of(page), block(page, "diff").splitlines()
    (tmp_path / "ensemble.py").write_text(file, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    module = importlib.import_module("ensemble")
    listed = (PACKAGE / "simulation/protocols.py").read_text(encoding="utf-8")
    assert listed.count(f"\n{line[0][1:]}\n") == 1
    names = vars(protocols) | {"ensemble": module}
    exec(compile(line[1][1:], "the line", "exec"), names)
    for name, kind in names["PROTOCOLS"].items():
        monkeypatch.setitem(protocols.PROTOCOLS, name, kind)
    yield module
    del sys.modules["ensemble"]


SETTINGS = {
    "particles": 20,
    "box": [25, 25],
    "effects": {"spin": {"inertia": 0.5}},
    "schedule": {"kind": "ensemble", "measure": 20, "sample_every": 0.5, "replicas": 3},
}


def test_the_example_of_a_schedule_is_one_file_and_one_line(ensemble):
    """The means equal the means of gases that are run one by one."""
    kinds = {name for name in dir(protocols.RunProtocol) if not name.startswith("_")}
    assert kinds | {*protocols.RunProtocol.__annotations__} <= set(vars(ensemble))
    experiment = read_experiment(SETTINGS)
    protocols.check_experiment(experiment)
    (point,) = simulate_points(
        "scene", experiment, grid_points([0.9], [0.5], [1]), "paper", ["a"], quiet=True
    )
    dataset = as_dataset(point)
    series = []
    for stream in np.random.SeedSequence(1).spawn(3):
        gas = Gas.start(build(SETTINGS, 0.9, 0.5), experiment, np.random.default_rng(stream))
        series.append(gas.energies(gas.in_time(0.5, 40)).translational)
    np.testing.assert_array_equal(dataset.E_trans_series, np.mean(series, axis=0))
    assert dataset.E_trans == pytest.approx(np.mean(series), rel=1e-12)
    gas_means = np.mean(series, axis=1)
    assert dataset.E_trans_stderr == pytest.approx(gas_means.std(ddof=1) / np.sqrt(3), rel=1e-9)
    assert dataset.equilibrated == dataset.R_ci95_trusted == -1


def test_the_example_of_a_schedule_goes_on_where_it_was_killed(ensemble, tmp_path, monkeypatch):
    """In the second of three gases."""
    experiment, grid = read_experiment(SETTINGS), grid_points([0.9], [0.5], [1])
    monkeypatch.setattr(Checkpoint, "due", lambda _: True)
    written, write = [], Checkpoint.write

    def stopped(self, content):
        write(self, content)
        written.append(int(content["position"][0]))
        if written[-1] == 1:
            raise KeyboardInterrupt

    def run():
        path = str(tmp_path / "kept.npz")
        (point,) = simulate_points(
            "scene", experiment, grid, "paper", ["a"], quiet=True, checkpoints=[path]
        )
        return as_dataset(point)

    monkeypatch.setattr(Checkpoint, "write", stopped)
    with pytest.raises(KeyboardInterrupt, match="goes on"):
        run()
    monkeypatch.setattr(Checkpoint, "write", write)
    resumed, uninterrupted = run(), run()
    for name in uninterrupted.data_vars.keys() - {"kernel_seconds"}:
        np.testing.assert_array_equal(resumed[name], uninterrupted[name])
    assert not [*tmp_path.glob("kept*")]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"kind": "ensembles"}, "schedule.kind = 'ensembles': must be one of steady, cooling, st"),
        ({"replicas": 1}, "schedule.replicas = 1: must be a whole number in [2, 1000]"),
        ({"measure": 0.75}, "schedule.measure = 0.75: must be a whole multiple of schedule.sam"),
    ],
)
def test_settings_of_the_schedule_are_checked(ensemble, changes, message):
    with pytest.raises(InputError) as caught:
        protocols.check_experiment(
            read_experiment(SETTINGS | {"schedule": SETTINGS["schedule"] | changes})
        )
    assert str(caught.value).startswith(message)
