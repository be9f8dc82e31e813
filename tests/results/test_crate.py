"""A run as an RO-Crate. The crate of a real run is in tests/workflow."""

import hashlib
import json
import shutil
import zipfile
from pathlib import Path

import pytest
from rocrate.rocrate import ROCrate

from roughgas.cli import main
from roughgas.results.crate import project_files

ROOT = Path(__file__).parents[2]
PRODUCTS = ["results/tiny/cooling.nc", "results/tiny/R.csv", "figures/tiny/fig1a.png"]


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A project after a run, as the present folder."""
    for name in project_files(ROOT):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, tmp_path / name)
    for name in PRODUCTS:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_crate_holds_project_products_and_configuration(project):
    assert main(["crate", *PRODUCTS, "-o", "run.zip"]) == 0
    packed = {*project_files(), *PRODUCTS, "configuration.json", "SHA256SUMS"}
    with zipfile.ZipFile("run.zip") as archive:
        assert packed < set(archive.namelist())
        archive.extractall("run")
    for name in (*project_files(), *PRODUCTS):
        assert Path("run", name).read_bytes() == Path(name).read_bytes()
    lines = [line.split("  ") for line in Path("run/SHA256SUMS").read_text().splitlines()]
    assert [name for _, name in lines] == [*project_files(), *PRODUCTS]
    for digest, name in lines:
        assert digest == hashlib.sha256(Path("run", name).read_bytes()).hexdigest()
    crate = ROCrate("run")
    assert crate.get(PRODUCTS[1])["sha256"] == dict(map(reversed, lines))[PRODUCTS[1]]
    assert {file.id.replace("%2B", "+") for file in crate.get_by_type("File")} == packed
    assert crate.mainEntity.id == "Snakefile"
    assert crate.root_dataset["license"].endswith("/MIT")
    assert [product.id for product in crate.dereference("#run")["result"]] == PRODUCTS
    assert json.loads(Path("run/configuration.json").read_text())["scale"] == "paper"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["/etc/hosts", "-o", "x.zip"], "product = /etc/hosts: must be in this folder"),
        (["none.nc", "-o", "x.zip"], "none.nc: No such file"),
        ([PRODUCTS[1], "-o", "new"], "--output = new: must end in .zip"),
    ],
)
def test_illegal_products_and_names_are_refused_in_one_line(project, capsys, arguments, message):
    before = sorted(Path().rglob("*"))
    assert main(["crate", *arguments]) in (1, 2)
    (line,) = capsys.readouterr().err.splitlines()
    assert message in line
    assert sorted(Path().rglob("*")) == before
