"""Physics of small runs, and of those that are compared with another code."""

import math
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from brute_force.scenes import NEVER

from roughgas import config, simulate
from roughgas.cli import parser_of
from roughgas.scene import build
from roughgas.simulation.point import run_point
from roughgas.theory.prediction import predicted_ratio

CONFIG = Path(__file__).with_name("experiments.yaml")
SIGMAS = 4
SEEDS, LONG = range(1, 5), range(101, 229)
BEYOND_THEORY = {
    ("vibrated", 0.99, 0.0): (0.0133, 0.00020),
    ("vibrated", 0.9, 0.5): (0.0230, 0.00020),
    ("vibrated", 0.9, 1.0): (0.0028, 0.00032),
    ("sheared", 0.99, 0.0): (0.0157, 0.00031),
    ("sheared", 0.9, 0.5): (0.0312, 0.00050),
    ("sheared", 0.8, 1.0): (0.0211, 0.00046),
    ("vibrated_smooth_walls", 0.9, 0.5): (0.0144, 0.00022),
    ("vibrated_particle_walls", 0.9, 0.5): (0.0191, 0.00019),
    ("cooling", 0.99, 0.0): (-0.0004, 0.00033),
    ("cooling", 0.99, 1.0): (0.0005, 0.00038),
    ("cooling", 0.9, 0.0): (-0.0023, 0.00045),
    ("cooling", 0.9, 0.5): (-0.0023, 0.00040),
    ("cooling", 0.8, 0.5): (-0.0045, 0.00042),
    ("cooling", 0.8, 1.0): (-0.0004, 0.00035),
    ("vibrated_rough_walls", 0.9, -1.0): (0.0389, 0.00047),
    ("cooling_spheres", 0.9, 0.5): (0.0013, 0.00020),
    ("sheared_spheres", 0.9, 0.5): (0.0175, 0.00042),
    ("vibrated_spheres", 0.9, 0.5): (0.0385, 0.00016),
    ("vibrated_friction/mu0.3", 0.9, 1.0): (0.0231, 0.00020),
    ("cooling_friction/mu1", 0.9, 0.0): (-0.0038, 0.00044),
    ("heated/spin_share0.4", 0.9, 0.0): (0.0073, 0.00032),
    ("heated/spin_share1", 0.9, 1.0): (0.0024, 0.00020),
    ("floor_materials/roughness1", 0.9, 0.0): (0.0297, 0.00023),
    ("wall_materials/roughness0", 0.9, 1.0): (-0.0039, 0.00021),
    ("shaken_walls/roughness1", 0.9, 1.0): (-0.0113, 0.00013),
    ("waves/wavesine", 0.9, 0.0): (0.0316, 0.00024),
    ("waves/wavereversed_sawtooth", 0.9, 1.0): (0.0066, 0.00053),
    ("vibrated_inertia/inertia0.3", 0.9, 0.0): (0.0184, 0.00014),
    ("cooling_inertia/inertia0.05", 0.9, 1.0): (-0.0050, 0.00055),
    ("vibrated_masses/mass4", 0.9, 1.0): (-0.0006, 0.00031),
    ("vibrated_sizes/radius2", 0.9, 1.0): (-0.0020, 0.00025),
    ("cooling_masses/mass4", 0.9, 1.0): (0.0002, 0.00035),
    ("cooling_polydisperse/deviation0.2", 0.9, 0.0): (-0.0012, 0.00051),
}
QUICK = ("vibrated", "sheared", "cooling", "vibrated_smooth_walls", "vibrated_particle_walls")
QUICK += ("vibrated_rough_walls",)  # the others need a kernel each


def points_of(name, r, beta, seeds):
    experiment = config.experiment(config.load(CONFIG), name, "small")
    if "walls" in experiment["effects"]:  # the kernel of other tests, and the same R
        experiment["effects"]["contact_time"] = {"duration": NEVER}
        del experiment["effects"]["contact_averages"]
    return [run_point(build(experiment, r, beta), experiment, seed) for seed in seeds]


def beyond_theory(points, r, beta):
    """The mean of R over points less R of theory, and what each has of it.

    Drives are taken at the share of rotation that their energy books say. Rough walls make smooth
    particles spin, of which theory says nothing: they are compared with equipartition.
    """
    about, variables = points[0].attributes, points[0].variables
    about["theory"] = "K" if "plateau_end" in variables else "lun"
    if "input_spin_share" in variables:
        about["spin_share"] = np.mean([one.variables["input_spin_share"] for one in points])
    theory = 0.5 if beta == -1.0 else predicted_ratio(about, r, beta)
    return np.array([one.variables["R"] for one in points]) - theory


PLACES = [
    pytest.param(*one, marks=[pytest.mark.slow] * (one[0] not in QUICK)) for one in BEYOND_THEORY
]


@pytest.mark.parametrize(("name", "r", "beta"), PLACES)
def test_R_is_as_far_from_theory_as_a_long_run_found(name, r, beta):
    expected, error = BEYOND_THEORY[name, r, beta]
    points = points_of(name, r, beta, SEEDS)
    scatter = error * math.sqrt(len(LONG))
    combined = math.hypot(error, scatter / math.sqrt(len(SEEDS)))
    assert abs(beyond_theory(points, r, beta).mean() - expected) < SIGMAS * combined
    said = [one.variables["R_stderr"] for one in points]
    assert scatter / 1.6 < math.sqrt(np.mean(np.square(said))) < 1.6 * scatter


if __name__ == "__main__":
    for place in BEYOND_THEORY:
        above = beyond_theory(points_of(*place, LONG), *place[1:])
        error = above.std(ddof=1) / math.sqrt(len(LONG))
        print(f"    {place}: ({above.mean():.4f}, {error:.5f}),", flush=True)


PAGE = (Path(__file__).parent.parent / "docs" / "compared.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| .+? \| R = ([\d.]+) \| .+? \| ([\d.]+) % \| `roughgas (.+?)` \|$", re.M)
ROWS = [pytest.param(*row, id=shlex.split(row[2])[1]) for row in ROW.findall(PAGE)]
R, BETA = 0.9, 0.5


def told(command):
    words = shlex.split(command)
    return parser_of(words[0]).parse_args(words)


@pytest.mark.slow
@pytest.mark.parametrize(("number", "within", "command"), ROWS)
def test_they_are_found(number, within, command):
    """At the paper's scale, within what the page says."""
    gas = simulate(told(command).experiment, r=R, beta=BETA, progress=False)
    name = "R_collisional" if "R_collisional" in gas else "R"
    off, error = gas[name].item() - float(number), gas[f"{name}_stderr"].item()
    assert abs(off) < float(within) / 100 * float(number) and error < 0.01
