"""Cumulants of a cooling gas are those of the direct simulation Monte Carlo, which has no space."""

import numpy as np
import pytest

from roughgas import simulate
from roughgas.tasks import dsmc

NAMES = ("a20", "a02", "a11")


def by_dsmc(r, beta, dimension, names):
    """Cumulants once they have settled, means over 100 samples."""
    rng = np.random.default_rng(8)
    gas = dsmc.new_gas(4000, 1.0, rng, dimension)
    found = dsmc.run(gas, dsmc.material(r, beta, dimension), rng, 2.0, 250)
    return {name: getattr(found, name)[-200:].mean() for name in names}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("experiment", "box", "names"),
    [
        ("cooling", (400, 400), NAMES),
        ("spheres.cooling_spheres", (75, 75, 75), (*NAMES, "alignment")),
    ],
)
def test_cumulants_are_those_of_dsmc(experiment, box, names):
    schedule = {"replicas": 10, "relaxation_times": 10, "plateau": 300}
    gas = simulate(
        experiment,
        r=0.8,
        beta=0.3,
        particles=500,
        box=box,
        schedule=schedule,
        observe=["cumulants", "spin_correlation"],
        progress=False,
    )
    expected = by_dsmc(0.8, 0.3, len(box), names)
    for name in names:
        found, error = float(gas[name]), float(gas[f"{name}_stderr"])
        assert abs(found - expected[name]) < 4 * error + 0.005, name  # 2/(D N), 2 % of density
    assert max(abs(expected[name] / gas[f"{name}_stderr"]) for name in names) > 8
