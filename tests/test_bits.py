"""Points have the bits that they have always had: see bits.py."""

from pathlib import Path

import pytest
from raw import build, run_point
from tests.bits import FOUR_PHASES, digest, recorded_hashes
from tests.configurations import EXPERIMENTS as CONFIG

from roughgas import config
from roughgas.data.point import write_point

# whose kernels others compile, too
USUAL = ("small/cooling/", "small/sheared/", "four_phases/small/vibrated/")
POINTS = [
    pytest.param(name, marks=() if name.startswith(USUAL) else pytest.mark.slow)
    for name in recorded_hashes()
]


def point_of_path(name):
    """The folders in a path, a variant and its experiment being one."""
    *folders, r, beta, seed = Path(name).with_suffix("").parts
    k = 2 if folders[0] == FOUR_PHASES else 1
    return [*folders[:k], "/".join(folders[k:]), r, beta, seed]


@pytest.mark.parametrize("name", POINTS)
def test_a_point_has_the_same_bits(name, tmp_path):
    *sampling, scale, folders, r, beta, seed = point_of_path(name)
    settings = config.load(CONFIG).experiment(folders, scale).raw
    if sampling == [FOUR_PHASES]:
        settings["schedule"]["sample_every"] = 0.25
    scene = build(settings, float(r.removeprefix("r")), float(beta.removeprefix("beta")))
    point = run_point(scene, settings, int(seed.removeprefix("seed")))
    attributes = {"experiment": folders.partition("/")[0], "scale": scale}
    write_point(tmp_path / "point.nc", point._replace(attributes=attributes | point.attributes))
    assert digest(tmp_path / "point.nc") == recorded_hashes()[name]
