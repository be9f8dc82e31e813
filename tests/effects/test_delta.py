"""The Delta model of a shaken monolayer: its contacts, its accounts, and its stationary state."""

import math

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from tests.theory.collisions import maxwellian_pairs, sigmas

from roughgas import theory
from roughgas.kernel.state import LAST_FIRST, LAST_SECOND
from roughgas.scene import conserves_momentum
from roughgas.simulation.energies import energies
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.statistics.errors import blocking_stderr

DELTA, SIDE = 0.5, 25.0
ACCOUNT, CONTACTS = 1, -1  # of the ledger; account 0 is of spin


def monolayer(particles=40, side=SIDE, mu=1e9):
    """Settings of disks in the Delta model; by default their contacts never slide."""
    return settings("monolayer", particles, [side, side], friction={"mu": mu})


@pytest.mark.parametrize("beta", [-1.0, 0.3])
def test_a_contact_gains_the_speed_and_books_its_energy_apart(beta):
    """Of 200 contacts: the normal speed of parting, and the energies of both accounts.

    The drive's account gains (m/4) (4 r Delta g + 4 Delta^2); the contacts lose (m/4) (1 - r^2) g^2
    and, where they are rough, m q/[4 (1 + q)] (1 - beta^2) of the squared slip velocity.
    """
    r, q = 0.8, 0.5
    scene, state = begin(monolayer(), r, beta, 1)
    for _ in range(200):
        before, ledger = snapshot(state, scene), state.ledger[0].copy()
        run(state, scene, 1, collisions=1)
        after, booked = snapshot(state, scene), state.ledger[0] - ledger
        i, j = state.counts[[LAST_FIRST, LAST_SECOND]]
        x = after.position[i] - after.position[j]
        n = x - SIDE * np.round(x / SIDE)
        n /= np.linalg.norm(n)
        gap, parting = (shot.velocity[i] - shot.velocity[j] for shot in (before, after))
        speed, w = -gap @ n, before.spin[[i, j], 0].sum()
        slip = gap + speed * n - w * np.array([-n[1], n[0]])
        lost = (1.0 - r**2) * speed**2 / 4.0 + q * (1.0 - beta**2) * (slip @ slip) / 4.0 / (1.0 + q)
        assert parting @ n == pytest.approx(r * speed + 2.0 * DELTA, rel=1e-9)
        assert booked[ACCOUNT] == pytest.approx([r * DELTA * speed + DELTA**2, 0.0], rel=1e-8)
        assert booked[CONTACTS].sum() == pytest.approx(-lost, rel=1e-7, abs=1e-12)


def test_energy_balance_and_momenta_are_kept():
    """After thousands of contacts, with friction that slides; the drive supplies all energy."""
    scene, state = begin(monolayer(mu=0.2), 0.8, 0.5, 2)
    before, shot = balance(state, scene), snapshot(state, scene)
    run(state, scene, 1, collisions=4000)
    after, now = balance(state, scene), snapshot(state, scene)
    booked = after.ledger - before.ledger
    assert imbalance(booked, after.energy - before.energy) < 1e-12
    assert booked[ACCOUNT, 0] > 0.0 > booked[CONTACTS].sum() and booked[ACCOUNT, 1] == 0.0
    assert conserves_momentum(scene)
    change = now.velocity.sum(axis=0) - shot.velocity.sum(axis=0)
    assert np.abs(change).max() < 1e-11 * np.abs(now.velocity).sum()


@pytest.mark.parametrize(("r", "beta"), [(0.8, -1.0), (0.9, 0.2)])
def test_a_dilute_gas_settles_at_the_temperatures_of_theory(r, beta):
    """Both temperatures, to 2 % for velocities that are not quite Maxwellian and 4 sigma."""
    scene, state = begin(monolayer(160, 120.0), r, beta, 3)
    expected = theory.delta_temperatures(r, beta, DELTA)
    run(state, scene, 1, collisions=160 * 60)
    series = energies(run(state, scene, 1500, collisions=80), 160, 0.5)
    measured = [2.0 * series.translational, 2.0 * series.rotational][: 1 if beta == -1.0 else 2]
    for values, temperature in zip(measured, expected, strict=False):
        error = blocking_stderr(values)
        assert error < 0.02 * temperature
        assert abs(values.mean() - temperature) < 4.0 * error + 0.02 * temperature


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("r", "beta"), [(0.5, -1.0), (0.9, 0.2)])
def test_sampled_contacts_at_the_temperatures_of_theory_balance(r, beta, dimension):
    """The mean gain of pairs drawn from the Maxwellian state is zero, within 4 sigma."""
    T_tr, T_rot = theory.delta_temperatures(r, beta, DELTA, dimension)
    q, rng = theory.moment_of_inertia(dimension), np.random.default_rng(dimension)
    pairs = maxwellian_pairs(rng, 100_000, dimension, T_rot / T_tr / q)
    push = DELTA / math.sqrt(T_tr) * pairs.n
    after = pairs.after(r, beta, q)
    after = after._replace(v1=after.v1 + push, v2=after.v2 - push)
    for gain in after.energies(q) - pairs.energies(q):
        assert sigmas(gain, pairs.approach(), 0.0) < 4.0


def test_the_closed_form_of_smooth_particles():
    """sqrt(T/m) = sqrt(pi) r Delta/[2 (1 - r^2)] {1 + sqrt[1 + 4 (1 - r^2)/(pi r^2)]}, any D."""
    r = np.array([0.1, 0.5, 0.8, 0.99])
    root = 1.0 + np.sqrt(1.0 + 4.0 * (1.0 - r**2) / (math.pi * r**2))
    speed = math.sqrt(math.pi) * r * DELTA / (2.0 * (1.0 - r**2)) * root
    for dimension in (2, 3):
        T_tr, T_rot = theory.delta_temperatures(r, -1.0, DELTA, dimension)
        assert T_tr == pytest.approx(speed**2, rel=1e-12)
        assert np.array_equal(T_rot, np.zeros(4))
    assert theory.delta_temperatures(0.8, -1.0, 1.0)[0] == pytest.approx(20.7, abs=0.01)
    assert theory.delta_temperatures(1.0, 1.0, DELTA) == (math.inf, math.inf)
