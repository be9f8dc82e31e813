"""Averages over contacts, the contact-time model, and contacts of a sheared gas."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings, snapshot
from brute_force.beside import brute_force_from

from roughgas import theory
from roughgas.effects import contacts
from roughgas.kernel.memory import new_state
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.state import EXPONENT, TOUCHED
from roughgas.simulation.energies import SUMS, balance, contact_averages

LOOKED_AT = ("bed", "sheared", "shaken", "heated", "spheres")
TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "inertia": 0.3}]


def sums(rows, names=SUMS):
    """The last running sums, of v_t^2, v_r^2 and v_t.v_r."""
    return np.array([rows[name][-1] for name in names])


@pytest.mark.parametrize(
    ("kernel", "species"),
    [
        *((kernel, {}) for kernel in LOOKED_AT),
        *(
            pytest.param(kernel, {"species": TWO}, marks=pytest.mark.slow)  # compiles a kernel
            for kernel in ("heated", "spheres")
        ),
    ],
)
def test_each_contact_counts_as_brute_force_has_it(kernel, species):
    """Collision by collision, to roundings; each piece starts where the kernel stands."""
    experiment = settings(kernel, 40) | species
    scene, world = scene_of(experiment, 0.9, 0.3)
    _, state = begin(experiment, 0.9, 0.3, 4)
    run(state, scene, 1, collisions=200)
    kinds = len(species.get("species", [{}]))
    names = contacts.STRESSES, contacts.HEAT
    flux = [contacts.columns_of_pairs(one, kinds) for one in names] if kernel == "spheres" else []
    for _ in range(10):
        rows = run(state, scene, 1, collisions=0)
        before, carried = sums(rows), [sums(rows, one) for one in flux]
        brute = brute_force_from(world, snapshot(state, scene))
        for _ in range(5):
            brute.run(1)
            rows = run(state, scene, 1, collisions=1)
            rounding = 1e-11 * (brute.seen[:2].max() + before.max())
            assert sums(rows) - before == pytest.approx(brute.seen, abs=rounding)
            for one, begun, expected in zip(
                flux, carried, (brute.carried, brute.heat), strict=False
            ):
                found = (sums(rows, one) - begun).reshape(kinds**2, -1).sum(axis=0)
                assert found == pytest.approx(expected.ravel(), abs=1e-11 * abs(begun).max())


def test_a_gas_that_cools_by_many_powers_of_two():
    """At each instant the sums are the account of contacts, in whichever unit velocities are."""
    scene, state = begin(settings("spheres", 40), 0.8, 0.2, 6)
    q, before = scene.effects.spin.inertia, np.zeros(2)
    for _ in range(100):
        A, B, C = sums(run(state, scene, 1, collisions=40, refresh=1))
        booked = balance(state, scene).ledger[-1, 1]
        assert theory.rotational_energy_change(A, C, B, 0.2, q) == pytest.approx(booked, rel=1e-9)
        assert A >= before[0] and B >= before[1]
        before = A, B
    assert state.counts[EXPONENT] < -8
    assert np.all(state.sums.contact_averages[:2, 0] == [0.0, A])


def test_averages_of_made_up_contacts():
    """Two periods of two samples after one that does not count; an odd sample is left out."""
    steps = {"v_t^2": [9, 9, 2, 2, 3, 5, 7], "v_r^2": [9, 9, 1, 2, 3, 2, 7]}
    steps["v_t.v_r"] = [9, 9, -1, 0, 1, -2, 7]
    rows = {name: np.cumsum(values, dtype=float) for name, values in steps.items()}
    found = contact_averages(rows, 2, 2, 0.5)
    assert found["R_collisional"] == pytest.approx(4.0 / (12.0 + 4.0), rel=1e-14)
    assert found["contact_correlation"] == pytest.approx(-2.0 / np.sqrt(12.0 * 8.0), rel=1e-14)
    assert contact_averages({}, 2, 2, 0.5) == {}


def test_a_gas_without_spin_energy_has_no_average():
    rows = {"v_t^2": np.arange(9.0), "v_r^2": np.zeros(9), "v_t.v_r": np.zeros(9)}
    found = contact_averages(rows, 1, 1, 0.5)
    assert all(np.isnan(value) for name, value in found.items() if not name.endswith("_dof"))


def test_errors_are_those_of_independent_repetitions():
    """The scatter of 400 made-up series is within 10 % (2.8 sigma) of the errors they state."""
    rng, found = np.random.default_rng(8), []
    for _ in range(400):
        v_t = rng.gamma(2.0, 1.0, 500)
        v_r = 0.5 * v_t + rng.gamma(1.0, 0.5, 500)
        both = -0.2 * v_t + 0.1 * rng.standard_normal(500)
        steps = zip(SUMS, (v_t, v_r, both), strict=True)
        found.append(contact_averages({n: np.cumsum(x) for n, x in steps}, 0, 1, 0.5))
    for name in ("R_collisional", "contact_correlation"):
        scatter = np.std([one[name] for one in found], ddof=1)
        stated = np.sqrt(np.mean([one[f"{name}_stderr"] ** 2 for one in found]))
        assert stated == pytest.approx(scatter, rel=0.1), name


def in_a_row(spacing, number=3):
    """Spheres on a line at rest; the first comes flying at speed 1."""
    position = np.full((number, 3), 6.0)
    position[:, 0] = 2.0 + (2.0 + spacing) * np.arange(number)
    velocity = np.zeros((number, 3))
    velocity[0, 0] = 1.0
    return position, velocity, np.zeros((number, 3))


@pytest.mark.parametrize(("duration", "second"), [(0.4, 0.5), (0.6, 1.0)])
def test_a_contact_soon_after_another_is_elastic(duration, second):
    """The middle sphere is hit at speed 1 and moves on at (1 + r)/2 = 0.75 over a gap of 0.375.

    0.5 T later it hits the third, which is elastic if t_c is longer than that.
    """
    experiment = settings("spheres", 3, [40, 12, 12], contact_time={"duration": duration})
    scene, _ = begin(experiment, 0.5, 0.0)
    position, velocity, spin = in_a_row(0.375)
    state = new_state(scene, position, velocity, spin)
    run(state, scene, 2, collisions=1)
    restitution = 2.0 * state.trajectory[2, 3] / 0.75 - 1.0
    assert restitution == pytest.approx(second, rel=1e-12)
    assert state.counts[TOUCHED] == (second == 1.0)


def test_roughness_is_left_as_it_is():
    """Two oblique contacts of a pair in quick succession, by beta = 0.4 both."""
    experiment = settings("spheres", 3, [40, 12, 12], contact_time={"duration": 10.0})
    scene, _ = begin(experiment, 0.5, 0.4)
    position, velocity, spin = in_a_row(0.375)
    spin[2] = [0.0, 0.0, 1.0]
    state = new_state(scene, position, velocity, spin)
    run(state, scene, 2, collisions=1)
    assert state.counts[TOUCHED] == 1
    # g_t = -(w x n): turned by (1 + beta)/(2 + 2q) n x g_t, q = 2/5
    assert state.spin[2, 2] == pytest.approx(1.0 - 1.4 / 2.8, rel=1e-12)


def test_t_c_is_a_time_however_slow_the_gas_has_become():
    """A cooling gas is refreshed: its velocities are doubled, its clock is not the user's.

    The contact that follows the previous one by 0.5 T is beyond t_c = 0.4 T and within 0.6 T,
    whatever power of two the velocities have been divided by. Here the gas is 2^-20 as fast, after
    which the contacts are 2^20 T/2 apart: t_c touches none of them.
    """
    slow = 2.0**-20
    for duration, touched in ((0.4, 0), (0.6, 0), (0.4 / slow, 0), (0.6 / slow, 1)):
        experiment = settings("spheres", 4, [40, 12, 12], contact_time={"duration": duration})
        scene, _ = begin(experiment, 0.5, 0.0)
        position, velocity, spin = in_a_row(0.375, 4)
        # the fourth, far off, keeps the total momentum zero
        position[3], velocity[3] = [30.0, 2.0, 2.0], -velocity[0]
        state = new_state(scene, position, slow * velocity, spin)
        run(state, scene, 1, interval=2.0**-10, refresh=1)
        rows = np.empty((2, len(columns(scene))))
        record(state, scene, Sampling(np.inf, 1, 0), rows)
        assert state.counts[TOUCHED] == touched, duration
