"""Points have the bits that they have always had: see bits.py."""

from pathlib import Path

import pytest
from tests.bits import digest, known

from roughgas import config
from roughgas.data.point import write_point
from roughgas.scene import build
from roughgas.simulation.point import run_point

CONFIG = Path(__file__).parents[1] / "config.yaml"
USUAL = ("small/cooling/", "small/sheared/", "small/vibrated/")  # whose kernels others compile, too
POINTS = [
    pytest.param(name, marks=() if name.startswith(USUAL) else pytest.mark.slow) for name in known()
]


@pytest.mark.parametrize("name", POINTS)
def test_a_point_has_the_same_bits(name, tmp_path):
    scale, *folders, r, beta, seed = Path(name).with_suffix("").parts
    settings = config.experiment(config.load(CONFIG), "/".join(folders), scale)
    scene = build(settings, float(r.removeprefix("r")), float(beta.removeprefix("beta")))
    point = run_point(scene, settings, int(seed.removeprefix("seed")))
    about = {"experiment": folders[0], "scale": scale}
    write_point(tmp_path / "point.nc", point._replace(attributes=about | point.attributes))
    assert digest(tmp_path / "point.nc") == known()[name]
