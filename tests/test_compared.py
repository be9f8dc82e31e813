"""The numbers of other origin in docs/compared.md: they are what theory says, and are found."""

import re
import shlex
from pathlib import Path

import pytest

from roughgas import simulate, theory
from roughgas.cli import parser_of

PAGE = (Path(__file__).parent.parent / "docs" / "compared.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| .+? \| R = ([\d.]+) \| .+? \| ([\d.]+) % \| `roughgas (.+?)` \|$", re.M)
ROWS = [pytest.param(*row, id=shlex.split(row[2])[1]) for row in ROW.findall(PAGE)]
R, BETA = 0.9, 0.5
EXPECTED = {
    "cooling": theory.cooling_ratio(R, BETA),
    "spheres.cooling_spheres": theory.cooling_ratio(R, BETA, 3, 0.4),
    "friction.cooling_friction/mu1": theory.friction_ratio(R, BETA, 1.0, 2, 0.5, None),
    "spheres.vibrated_spheres": theory.lun_ratio(BETA, 0.4),
    "inertia.vibrated_inertia/inertia0.1": theory.lun_ratio(BETA, 0.1),
    "friction.vibrated_friction/mu0.3": theory.friction_ratio(R, BETA, 0.3, 2, 0.5, 0.0),
    "drives.heated/spin_share1": theory.stationary_ratio(R, BETA, 2, 0.5, 1.0),
}
LUN = theory.lun_ratio(BETA, 0.5)  # of all other disks


def told(command):
    """What a command of the page says."""
    words = shlex.split(command)
    return parser_of(words[0]).parse_args(words)


@pytest.mark.parametrize(("number", "within", "command"), ROWS)
def test_numbers_are_those_of_theory(number, within, command):
    options = told(command)
    assert (options.r, options.beta) == ([str(R)], [str(BETA)])
    assert number == f"{EXPECTED.get(options.experiment, LUN):.4f}"


def test_every_kind_of_scene_has_one():
    assert len(ROWS) > 9 and {
        row.id.split("/")[0].split(".")[-1].split("_")[0] for row in ROWS
    } == {
        "cooling",
        "heated",
        "sheared",
        "vibrated",
    }


@pytest.mark.slow
@pytest.mark.parametrize(("number", "within", "command"), ROWS)
def test_they_are_found(number, within, command):
    """At the paper's scale, within what the page says."""
    gas = simulate(told(command).experiment, r=R, beta=BETA, progress=False)
    name = "R_collisional" if "R_collisional" in gas else "R"
    off, error = gas[name].item() - float(number), gas[f"{name}_stderr"].item()
    assert abs(off) < float(within) / 100 * float(number) and error < 0.01
