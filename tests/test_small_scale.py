"""Physics of small runs, and of those that are compared with another code."""

import math
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
import yaml
from brute_force.scenes import NEVER

from roughgas import config, simulate
from roughgas.cli import parser_of
from roughgas.scene import build
from roughgas.simulation.point import run_point
from roughgas.theory.prediction import predicted_ratio

CONFIG = Path(__file__).with_name("experiments.yaml")
SIGMAS = 4
SEEDS, LONG = range(1, 5), range(101, 229)
KNOWN = yaml.safe_load(Path(__file__).with_name("beyond_theory.yaml").read_text("utf-8"))
BEYOND_THEORY = {tuple(row[:3]): tuple(row[3:]) for row in KNOWN}
QUICK = ("vibrated", "sheared", "cooling", "vibrated_smooth_walls", "vibrated_particle_walls")
QUICK += ("vibrated_rough_walls",)  # the others need a kernel each


def points_of(name, r, beta, seeds):
    experiment = config.experiment(config.load(CONFIG), name, "small")
    if "walls" in experiment["effects"]:  # the kernel of other tests, and the same R
        experiment["effects"]["contact_time"] = {"duration": NEVER}
        experiment["effects"]["contact_log"] = {"most": 3000}
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
        print(f"- [{', '.join(map(str, place))}, {above.mean():.4f}, {error:.5f}]", flush=True)


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
