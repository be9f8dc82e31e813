"""Kicks that grow with the speed of the particle, an effect of the study `multiplicative`."""

import numpy as np
import pytest
from brute_force import Comparison, begin, run, scene_of, snapshot
from brute_force.scenes import PLAIN
from study_code import booked_energies, study_in_use

from roughgas.base import InputError

THERMOSTAT = {"power": 1.0, "spin_share": 0.5, "interval": 0.5}
KICKS = THERMOSTAT | {"speed": 2.0, "exponent": 0.75}
ACCOUNT = 1  # of the ledger; account 0 is of spin


@pytest.fixture(autouse=True)
def study():
    yield from study_in_use("multiplicative")


def kicked(effects, particles=12, side=16.0):
    """Settings of disks with these effects."""
    effects = {"spin": {"inertia": 0.5}} | effects
    return {"particles": particles, "box": [side, side], "effects": effects}


def test_kicks_that_do_not_grow_are_those_of_the_thermostat():
    """To the bit, as plain Python, with the same random numbers."""
    states = []
    for effects in ({"thermostat": THERMOSTAT}, {"speed_kicks": KICKS | {"exponent": 0.0}}):
        scene, state = begin(kicked(effects), 0.9, 0.2, 1)
        run(state, scene, 1, collisions=4, kernel=PLAIN)
        states.append(state)
    for name in ("trajectory", "spin", "ledger", "random", "clock"):
        assert getattr(states[0], name).tobytes() == getattr(states[1], name).tobytes(), name
    assert states[0].ledger[0, ACCOUNT].min() > 0.0


def test_a_kick_grows_as_a_power_of_the_speed_of_the_particle_that_starts_it():
    """Beside a kick of the same random numbers that does not grow: velocities and spins of both."""
    kicks = []
    for exponent in (0.0, KICKS["exponent"]):
        scene, state = begin(kicked({"speed_kicks": KICKS | {"exponent": exponent}}), 0.9, 0.2, 1)
        before = state.trajectory[:, 2:4].copy(), state.spin.copy()
        effect = scene.effects.speed_kicks
        with np.errstate(over="ignore"):  # of random integers, in plain Python
            partner = type(effect).hooks.resolve(effect, ACCOUNT, 0, state, scene, 5, 0.0)
        kicks.append((state.trajectory[:, 2:4] - before[0], state.spin - before[1]))
    growth = (np.linalg.norm(before[0][5]) / KICKS["speed"]) ** KICKS["exponent"]
    for plain, grown in zip(*kicks, strict=True):
        assert np.flatnonzero(plain.any(axis=1)).tolist() == sorted([5, partner])
        np.testing.assert_allclose(grown, growth * plain, rtol=1e-12, atol=1e-13)
    assert abs(growth - 1.0) > 0.1


@pytest.mark.parametrize(
    ("changes", "key"),
    [({"exponent": 0.3}, "exponent"), ({"exponent": 5}, "exponent"), ({"speed": 0}, "speed")],
)
def test_illegal_settings_are_refused(changes, key):
    with pytest.raises(InputError, match=f"speed_kicks.{key} = "):
        begin(kicked({"speed_kicks": KICKS | changes}), 0.9, 0.2)


def test_a_single_particle_has_no_partner():
    floor = {"amplitude": 1.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0}
    above_floor = {"gravity": {"acceleration": 1.0}, "floor": floor, "speed_kicks": KICKS}
    with pytest.raises(InputError, match="particles = 1: must be at least 2"):
        begin(kicked(above_floor, 1) | {"box": [16.0, "open"]}, 0.9, 0.2)


def test_a_share_of_spins_is_refused_where_nothing_spins():
    experiment = kicked({"speed_kicks": KICKS})
    del experiment["effects"]["spin"]
    with pytest.raises(InputError, match=r"speed_kicks.spin_share = 0.5: must be 0"):
        begin(experiment, 0.9, -1.0)


@pytest.mark.slow  # compiles the kernel of kicks that grow
def test_brute_force_makes_the_same_collisions_and_kicks():
    experiment = kicked({"speed_kicks": KICKS})
    scene, world = scene_of(experiment, 0.9, 0.2)
    _, state = begin(experiment, 0.9, 0.2, 7)
    comparison = Comparison(state, scene, world)
    comparison.assert_same(25, 10)
    assert comparison.events["kick"] > 100


@pytest.mark.slow  # the same kernel
def test_energy_balance_and_momentum_are_kept():
    scene, state = begin(kicked({"speed_kicks": KICKS}, 40, 25.0), 0.9, 0.2, 2)
    shot = snapshot(state, scene)
    assert booked_energies(scene, state, 4000)[ACCOUNT].min() > 0.0
    now = snapshot(state, scene)
    change = now.velocity.sum(axis=0) - shot.velocity.sum(axis=0)
    assert np.abs(change).max() < 1e-11 * np.abs(now.velocity).sum()
