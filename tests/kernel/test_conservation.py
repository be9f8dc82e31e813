"""What collisions conserve, and that the books balance."""

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot

from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS, EXPONENT

GAS = settings("gas", 40, [25, 25])
SPHERES = settings("spheres", 64, [12, 12, 12])
SHEARED = settings("sheared", 40, [25, 25])
BED = settings("bed", 40, [12.5, "open"], floor={"restitution": 0.95, "roughness": 0.3})
WALLED = settings("walled", 40, [12.5, "open"])


def energy(shot, q):
    """Translational and rotational kinetic energy."""
    rotational = 0.0 if shot.spin is None else 0.5 * q * (shot.spin**2).sum()
    return 0.5 * (shot.velocity**2).sum(), rotational


def test_momentum_of_dissipative_gases():
    """Of the sheared gas, relative to the mean flow; of the bed, along the smooth floor."""
    scene, state = begin(settings("gas", 40, [25, 25]), 0.9, 0.3, 3)
    row = run(state, scene, 20, collisions=400)
    assert np.abs([row["p_x"], row["p_y"]]).max() < 1e-12

    scene, state = begin(SHEARED, 0.9, 0.3, 3)
    row = run(state, scene, 100, interval=1.0)
    rate = 2.0 / 25.0
    assert np.abs(row["p_y"]).max() < 1e-11
    assert np.abs(row["p_x"] - rate * row["y"]).max() < 1e-10

    scene, state = begin(settings("bed", 40, [12.5, "open"]), 0.9, 0.3, 3)
    assert np.abs(run(state, scene, 100, interval=1.0)["p_x"]).max() < 1e-11


@pytest.mark.parametrize(
    "experiment",
    [GAS, SHEARED, BED, WALLED, SPHERES],
    ids=["gas", "sheared", "bed", "walled", "spheres"],
)
def test_the_ledger_explains_every_change_of_energy(experiment):
    """Kinetic energy gained = what contacts, floor, walls and shear booked, and the weight's work.

    Of velocities as they are in the images that the particles last collided in.
    """
    q = experiment["effects"]["spin"]["inertia"]
    scene, state = begin(experiment, 0.9, 0.3, 4)
    state.spin[:] = np.random.default_rng(1).standard_normal(state.spin.shape)
    gravity = scene.effects.gravity
    exchanged = 0.0
    last = snapshot(state, scene)
    for _ in range(50):
        run(state, scene, 1, interval=0.5)
        shot = snapshot(state, scene)
        booked = state.ledger.sum(axis=(0, 1))
        state.ledger[:] = 0.0
        # no axis along which gravity pulls is periodic, so that heights need no unfolding
        fallen = 0.0 if gravity is None else (last.position - shot.position)[:, -1].sum()
        gained = np.subtract(energy(shot, q), energy(last, q))
        exchanged += np.abs(booked).sum()
        assert gained == pytest.approx(booked + np.array([fallen, 0.0]), abs=1e-10)
        last = shot
    assert exchanged > 1.0
    if scene.effects.floor is not None:
        assert state.counts[BOUNDARY_HITS] > 40


def test_a_pair_without_restitution_parts():
    """At r = 0 what is left of the normal velocity is rounding, which must bring no pair together

    again and again: here 100 pairs, one contact each.
    """
    scene, _ = begin(settings("gas", 2, [14, 14]), 0.0, 0.0)
    rng = np.random.default_rng(0)
    for _ in range(100):
        n = rng.standard_normal(2)
        n /= np.linalg.norm(n)
        position = np.array([[7.0, 7.0], 7.0 + 2.5 * n])
        velocity = (
            np.array([0.0 * n, -n]) + 0.1 * rng.standard_normal((2, 2)) + rng.standard_normal(2)
        )
        state = new_state(scene, position, velocity, np.zeros((2, 1)))
        run(state, scene, 1, interval=1.0, collisions=20)
        assert state.counts[COLLISIONS] < 5


@pytest.mark.parametrize("experiment", [GAS, SPHERES], ids=["disks", "spheres"])
def test_refreshing_takes_out_the_momentum_and_keeps_everything_else(experiment):
    scene, state = begin(experiment, 0.6, 0.2, 9)
    refreshed = run(state, scene, 400, collisions=len(state.changes), refresh=4)
    assert state.counts[EXPONENT] < -10  # so many halvings of the velocities
    unit = np.ldexp(1.0, refreshed["exponent"].astype(int))
    assert np.all(np.diff(refreshed["time"]) > 0.0)
    speeds = np.sqrt(refreshed["vv_x"] + refreshed["vv_y"])
    assert np.all((speeds > 0.1) & (speeds < 100.0))  # in the units of the moment
    assert np.max(np.abs(refreshed["p_x"]) / speeds) < 1e-13
    # Haff's law: the energy falls like t^-2 in the end; 30 seeds scatter by .0015 about -.9998
    t, v = refreshed["time"], speeds * unit
    slope = np.log(v[-1] / v[100]) / np.log(t[-1] / t[100])
    assert slope == pytest.approx(-1.0, abs=4 * 0.0015)


def test_refreshing_alone_changes_no_collision():
    """Momentum apart, which is taken out beforehand: the same pairs at the same times."""
    plain, refreshed = [], []
    for times, refresh in ((plain, 0), (refreshed, 1)):
        scene, state = begin(GAS, 0.8, 0.2, 10)
        for _ in range(8):
            times += list(run(state, scene, 1, collisions=20, refresh=refresh)["time"])
    assert refreshed == pytest.approx(plain, rel=1e-9)
