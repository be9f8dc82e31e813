"""Physics of small runs, and of the runs in the table of other codes."""

import math
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
import yaml
from brute_force.scenes import VANISHING_CONTACT_TIME
from raw import build, run_point
from slow_cases import slow_but
from tests.configurations import EXPERIMENTS as CONFIG

from roughgas import config, simulate
from roughgas.cli import parser_of
from roughgas.theory.prediction import predicted_ratio

SIGMAS = 4
SEEDS, LONG = range(1, 5), range(101, 229)
RECORDED = yaml.safe_load(Path(__file__).with_name("beyond_theory.yaml").read_text("utf-8"))
DEPARTURES = {tuple(row[:3]): tuple(row[3:]) for row in RECORDED}
QUICK = ("vibrated", "sheared", "cooling", "vibrated_smooth_walls", "vibrated_particle_walls")
QUICK += ("vibrated_rough_walls",)  # the others need a kernel each


def points_of(name, r, beta, seeds):
    experiment = config.load(CONFIG).experiment(name, "small").raw
    if "walls" in experiment["effects"]:  # the kernel of other tests, and the same R
        experiment["effects"]["contact_time"] = {"duration": VANISHING_CONTACT_TIME}
        experiment["effects"]["contact_log"] = {"most": 3000}
        del experiment["effects"]["contact_averages"]
    return [run_point(build(experiment, r, beta), experiment, seed) for seed in seeds]


def beyond_theory(points, r, beta):
    """Return R of each point minus R of theory.

    Theory takes a drive's share of rotation from the energy balance. Rough walls make smooth
    particles spin, which no theory describes: they are compared with equipartition.
    """
    attributes, variables = points[0].attributes, points[0].variables
    attributes["theory"] = "K" if "plateau_end" in variables else "lun"
    if "input_spin_share" in variables:
        attributes["spin_share"] = np.mean(
            [point.variables["input_spin_share"] for point in points]
        )
    theory = 0.5 if beta == -1.0 else predicted_ratio(attributes, r, beta)
    return np.array([point.variables["R"] for point in points]) - theory


QUICK_DEPARTURES = [departure for departure in DEPARTURES if departure[0] in QUICK][::2]


@pytest.mark.parametrize(("name", "r", "beta"), slow_but(QUICK_DEPARTURES, DEPARTURES))
def test_R_is_as_far_from_theory_as_a_long_run_found(name, r, beta):
    expected, error = DEPARTURES[name, r, beta]
    points = points_of(name, r, beta, SEEDS)
    scatter = error * math.sqrt(len(LONG))
    combined = math.hypot(error, scatter / math.sqrt(len(SEEDS)))
    assert abs(beyond_theory(points, r, beta).mean() - expected) < SIGMAS * combined
    stderrs = [point.variables["R_stderr"] for point in points]
    assert scatter / 1.6 < math.sqrt(np.mean(np.square(stderrs))) < 1.6 * scatter


if __name__ == "__main__":
    for place in DEPARTURES:
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
    """At the paper's scale, within the page's percentage."""
    gas = simulate(told(command).experiment, r=R, beta=BETA, progress=False)
    name = "R_collisional" if "R_collisional" in gas else "R"
    off, error = gas[name].item() - float(number), gas[f"{name}_stderr"].item()
    assert abs(off) < float(within) / 100 * float(number) and error < 0.01
