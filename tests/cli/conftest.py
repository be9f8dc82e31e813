"""A small gas, and its points and reduced dataset."""

import json
import shutil
from pathlib import Path

import pytest
from schedules import COOLING, TINY

from roughgas.cli import main

ROOT = Path(__file__).parents[2]
GAS = TINY | {"particles": 20, "schedule": COOLING | {"replicas": 4, "thermalise": 2}}


@pytest.fixture(scope="package")
def product(tmp_path_factory):
    """A folder with points of a cooling gas, and with their reduced dataset."""
    folder = tmp_path_factory.mktemp("products")
    shutil.copy(ROOT / "config.yaml", folder)
    settings = f"--settings={json.dumps(GAS)}"
    for beta in ("-0.5", "0.5"):
        files = [str(folder / f"beta{beta}_{seed}.nc") for seed in (1, 2)]
        options = ["--r=0.9", f"--beta={beta}"]
        run = ["run", "cooling", settings, *options, "--seed", "1", "2", "-o", *files]
        assert main(run) == 0
    points = sorted(map(str, folder.glob("beta*.nc")))
    assert main(["reduce", *points, "-o", str(folder / "reduced.nc")]) == 0
    return folder
