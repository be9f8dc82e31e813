"""The benchmark's program by hand, and the kernel: the same gas, bit by bit."""

import pytest
from benchmarks import handwritten
from benchmarks.generality import agree, run_kernel, same_gas
from brute_force.scenes import settings

pytestmark = pytest.mark.slow  # of use to the benchmarks alone


@pytest.mark.parametrize(("particles", "box"), [(160, [100, 100]), (40, [50, 30])])
def test_same_bits_as_the_kernel(particles, box):
    """After some twenty collisions of each particle, on the way, and with and without books."""
    scene, state, gases = same_gas(settings("gas", particles, box), r=0.9, beta=0.3)
    for collisions in (1, particles, 10 * particles):
        run_kernel(scene, state, collisions)
        for gas in gases:
            assert handwritten.run(gas, collisions)
            assert agree(state, gas)


def test_other_material_other_bits():
    """So that `agree` can fail."""
    experiment = settings("gas", 40, [50, 30])
    scene, state, _ = same_gas(experiment, r=0.9, beta=0.3)
    _, _, (gas, _) = same_gas(experiment, r=0.9, beta=0.4)
    run_kernel(scene, state, 40)
    handwritten.run(gas, 40)
    assert not agree(state, gas)
