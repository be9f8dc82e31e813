"""Roughness that falls with the speed of impact, an effect of the study `impact_roughness`."""

import math

import numpy as np
import pytest
from brute_force import Comparison, begin, run, scene_of
from brute_force.scenes import PLAIN
from study_code import booked_energies, study_in_use

from roughgas.base import InputError, NeedsError
from roughgas.kernel.state import EXPONENT

LAW = {"speed": 1.5, "exponent": 0.75}
WALLS = {"walls": {"restitution": 0.9, "roughness": -0.3}}


@pytest.fixture(autouse=True)
def study():
    yield from study_in_use("impact_roughness")


def rough(law, particles=10, side=14.0, **effects):
    """Settings of viscoelastic disks with this law of roughness, and more effects."""
    effects |= {"spin": {"inertia": 0.5}, "viscoelastic": {"speed": 1.0}}
    effects |= {} if law is None else {"roughness_law": law}
    return {"particles": particles, "box": [side, side], "effects": effects}


def test_a_law_that_is_constant_is_the_roughness_of_the_material():
    """To the bit, as plain Python, for values of beta whose 1 - beta is rounded."""
    for beta in (-0.8, 0.1):
        states = []
        for law in (None, LAW | {"exponent": 0.0}):
            scene, state = begin(rough(law, **WALLS), 0.9, beta, 1)
            run(state, scene, 1, collisions=6, kernel=PLAIN)
            states.append(state)
        for name in ("trajectory", "spin", "clock", "counts"):
            assert getattr(states[0], name).tobytes() == getattr(states[1], name).tobytes(), name


def test_illegal_settings_are_refused():
    with pytest.raises(InputError, match=r"roughness_law.exponent = 0.2: must be a multiple"):
        begin(rough(LAW | {"exponent": 0.2}), 0.9, 0.2)
    experiment = rough(LAW)
    del experiment["effects"]["spin"]
    with pytest.raises(NeedsError, match="roughness_law needs spin"):
        begin(experiment, 0.9, -1.0)


@pytest.mark.slow  # compiles the kernel of the law
def test_brute_force_makes_the_same_collisions():
    """With walls, whose roughness follows the law from their own."""
    experiment = rough(LAW, **WALLS)
    scene, world = scene_of(experiment, 0.95, -0.4)
    _, state = begin(experiment, 0.95, -0.4, 3)
    comparison = Comparison(state, scene, world)
    comparison.assert_same(25, 10)
    assert comparison.events["left"] > 5 and comparison.events["right"] > 5


@pytest.mark.slow  # the same kernel
def test_the_law_is_of_speeds_in_fixed_units():
    """The same bits with velocities in units of 2^20 a/T and of 1 a/T."""
    ends = []
    for power in (0, 20):
        unit = math.ldexp(1.0, power)
        scene, state = begin(rough(LAW, 40, 30.0, **WALLS), 0.8, 0.2, 4)
        state.trajectory[:, 2:4] /= unit
        state.counts[EXPONENT] = power
        run(state, scene, 1, collisions=1000)
        ends.append((state.trajectory[:, :4] * [1.0, 1.0, unit, unit], state.spin * unit))
    for plain, rescaled in zip(*ends, strict=True):
        assert np.array_equal(plain, rescaled)


@pytest.mark.slow  # the same kernel
def test_energy_balance_is_kept():
    scene, state = begin(rough(LAW, 40, 30.0, **WALLS), 0.9, 0.2, 2)
    assert (booked_energies(scene, state, 2000)[-1] < 0.0).any()
