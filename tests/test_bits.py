"""Points have the bits that they have always had: see bits.py."""

from pathlib import Path

import pytest
from tests.bits import FOUR_PHASES, digest, known

from roughgas import config
from roughgas.data.point import write_point
from roughgas.scene import build
from roughgas.simulation.point import run_point

CONFIG = Path(__file__).with_name("experiments.yaml")
# whose kernels others compile, too
USUAL = ("small/cooling/", "small/sheared/", "four_phases/small/vibrated/")
POINTS = [
    pytest.param(name, marks=() if name.startswith(USUAL) else pytest.mark.slow) for name in known()
]


def parts(name):
    """The folders in a path, a variant and its experiment being one."""
    *others, r, beta, seed = Path(name).with_suffix("").parts
    k = 2 if others[0] == FOUR_PHASES else 1
    return [*others[:k], "/".join(others[k:]), r, beta, seed]


@pytest.mark.parametrize("name", POINTS)
def test_a_point_has_the_same_bits(name, tmp_path):
    *sampling, scale, folders, r, beta, seed = parts(name)
    settings = config.experiment(config.load(CONFIG), folders, scale)
    if sampling == [FOUR_PHASES]:
        settings["schedule"]["sample_every"] = 0.25
    scene = build(settings, float(r.removeprefix("r")), float(beta.removeprefix("beta")))
    point = run_point(scene, settings, int(seed.removeprefix("seed")))
    about = {"experiment": folders.partition("/")[0], "scale": scale}
    write_point(tmp_path / "point.nc", point._replace(attributes=about | point.attributes))
    assert digest(tmp_path / "point.nc") == known()[name]
