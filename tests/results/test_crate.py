"""A run as an RO-Crate: made, made again, spoiled. That of a real run is in tests/workflow."""

import hashlib
import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from rocrate.rocrate import ROCrate
from tests.files import point

from roughgas.cli import main
from roughgas.data.point import write_point
from roughgas.results.crate import digest, project_files
from roughgas.results.origin import agent

ROOT = Path(__file__).parents[2]
PRODUCTS = ["results/tiny/cooling.nc", "results/tiny/R.csv", "figures/tiny/fig1a.png"]
POINT = "results/tiny/cooling/r0.9/beta0/seed1.nc"


def written(path, **others):
    made = point()
    attributes = made.attributes | {"command": "roughgas run cooling"}
    write_point(path, made._replace(variables=made.variables | others, attributes=attributes))
    return path


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project after a run, as the present folder."""
    for name in project_files(ROOT):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, tmp_path / name)
    for name in PRODUCTS:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    written(tmp_path / POINT)
    (tmp_path / "made").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def files_of(crate):
    return {file.id.replace("%2B", "+"): file for file in ROCrate(crate).get_by_type("File")}


def test_a_crate_holds_the_project_its_products_and_their_checksums(project):
    assert main(["crate", *PRODUCTS, "-o", "made/run"]) == 0
    files = files_of("made/run")
    made = {"configuration.json", "environment.json", "points.csv"}
    assert set(files) == {*project_files(), *PRODUCTS, *made}
    for name, file in files.items():
        assert file["sha256"] == hashlib.sha256(Path("made/run", name).read_bytes()).hexdigest()
    crate = ROCrate("made/run")
    assert crate.mainEntity.id == "Snakefile" and crate.license.id.endswith("/MIT")
    assert crate.root_dataset["citation"][0]["name"].startswith("Energy nonequipartition")
    assert [one.id for one in crate.dereference("#run")["result"]] == PRODUCTS
    packages = json.loads(Path("made/run/environment.json").read_text())["packages"]
    assert packages["numpy"] and packages["snakemake"]
    assert main(["crate", "--verify", "made/run"]) == 0


def test_the_same_files_give_the_same_bytes(project, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    assert main(["crate", *PRODUCTS, "-o", "one.zip"]) == 0
    for name in PRODUCTS:
        os.utime(name, (1e9, 1e9))
    assert main(["crate", *PRODUCTS, "-o", "other.zip"]) == 0
    assert Path("one.zip").read_bytes() == Path("other.zip").read_bytes()
    assert main(["crate", *PRODUCTS, "--points", "-o", "whole.zip"]) == 0
    assert set(files_of("whole.zip")) - set(files_of("one.zip")) == {POINT}


def test_a_point_is_known_by_its_numbers_whatever_time_they_took(project, capsys):
    assert main(["crate", *PRODUCTS, "-o", "run.zip"]) == 0
    again, other = written("again.nc", kernel_seconds=9.0), written("other.nc", E_rot=1.1)
    assert digest(again) == digest(POINT) != digest(other)
    assert main(["crate", "--verify", "run.zip", again]) == 0
    capsys.readouterr()
    assert main(["crate", "--verify", "run.zip", again, other]) == 2
    assert "other.nc: no point of the crate\n" in capsys.readouterr().err


def test_what_has_changed_since_is_named(project, capsys):
    assert main(["crate", *PRODUCTS, "-o", "run"]) == 0
    Path("run/config.yaml").write_text("scale: other\n")
    Path("run", PRODUCTS[1]).unlink()
    capsys.readouterr()
    assert main(["crate", "--verify", "run"]) == 2
    *lines, last = capsys.readouterr().err.splitlines()
    assert lines == ["config.yaml: has changed", "results/tiny/R.csv: is missing"]
    assert last == "roughgas: error: crate = run: must be as it was packed"


@pytest.mark.skipif(shutil.which("git") is None, reason="no git")
def test_the_version_of_the_code_is_the_commit_of_the_checkout(project):
    for command in (["init", "-q"], ["add", "."], ["commit", "-qm", "all"]):
        who = ["-c", "user.name=somebody", "-c", "user.email=s@example.org"]
        subprocess.run(["git", *who, *command], check=True)
    commit = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, text=True).stdout
    assert main(["crate", *PRODUCTS, "-o", "clean"]) == 0
    assert ROCrate("clean").mainEntity["version"] == f"0.1.0, commit {commit.strip()}"
    with open("config.yaml", "a") as file:
        file.write("# edited\n")
    assert main(["crate", *PRODUCTS, "-o", "edited"]) == 0
    assert ROCrate("edited").mainEntity["version"].endswith(f"{commit.strip()}-dirty")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-o", "x.zip"], "number of files to pack = 0: must be at least 1"),
        (["/etc/hosts", "-o", "x.zip"], "product = /etc/hosts: must be in this folder"),
        (["none.nc", "-o", "x.zip"], "none.nc: No such file"),
        ([PRODUCTS[1], "-o", "src"], "--output = src: must be a new folder, or end in .zip"),
        (["--verify", "README.md"], "crate = README.md: must be an RO-Crate that"),
        (["--verify", "src"], "crate = src: must be an RO-Crate that roughgas wrote, whole"),
    ],
)
def test_what_cannot_be_packed_or_checked_is_refused_in_one_line(
    project, capsys, arguments, message
):
    before = sorted(Path().rglob("*"))
    assert main(["crate", *arguments]) in (1, 2)
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert sorted(Path().rglob("*")) == before


@pytest.mark.parametrize(("name", "expected"), [("Ada Lovelace", ["Ada Lovelace"]), ("", [])])
def test_the_agent_is_whoever_ran_it_or_left_out(project, monkeypatch, name, expected):
    monkeypatch.setenv("ROUGHGAS_AGENT", name)
    assert main(["crate", *PRODUCTS, "-o", "made/run"]) == 0
    crate = ROCrate("made/run")
    agents = crate.dereference("#run").get("agent", [])
    found = agents if isinstance(agents, list) else [agents]
    assert [one["name"] for one in found] == expected
    assert crate.root_dataset["author"][0]["name"] == "The roughgas developers"


def test_without_a_name_in_the_environment_git_is_asked(monkeypatch, tmp_path):
    monkeypatch.delenv("ROUGHGAS_AGENT", raising=False)
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(tmp_path / "config"))
    monkeypatch.setenv("GIT_CONFIG_SYSTEM", os.devnull)
    monkeypatch.chdir(tmp_path)
    assert agent() is None
    (tmp_path / "config").write_text("[user]\n\tname = Emmy Noether\n")
    assert agent() == "Emmy Noether"
