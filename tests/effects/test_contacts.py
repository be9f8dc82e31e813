"""Sums and averages over contacts, and the contact-time model."""

import numpy as np
import pytest
from brute_force import begin, refresh, run, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from slow_cases import slow_but

from roughgas import theory
from roughgas.effects import contacts
from roughgas.kernel.layout import new_state
from roughgas.kernel.record import Sampling, allocate_frames, columns, record
from roughgas.kernel.state import ALTERED_RESTITUTIONS, EXPONENT
from roughgas.simulation.energies import CONTACT_SUMS
from roughgas.simulation.energy_averages import contact_averages
from roughgas.simulation.energy_balance import balance

KERNELS_WITH_AVERAGES = ("bed", "sheared", "shaken", "heated", "spheres")
TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "inertia": 0.3}]


def last_sums(rows, names=CONTACT_SUMS):
    """The last running sums, by default of v_t^2, v_r^2 and v_t.v_r."""
    return np.array([rows[name][-1] for name in names])


@pytest.mark.parametrize(
    ("kernel", "species"),
    slow_but(
        [("bed", {}), ("sheared", {}), ("heated", {}), ("spheres", {})],  # whose kernels are shared
        [
            *((kernel, {}) for kernel in KERNELS_WITH_AVERAGES),
            *((kernel, {"species": TWO}) for kernel in ("heated", "spheres")),
        ],
    ),
)
def test_contact_sums_are_those_of_the_brute_force(kernel, species):
    """Collision by collision, to rounding, in segments that start from the kernel's state."""
    experiment = settings(kernel, 40) | species
    scene, world = scene_of(experiment, 0.9, 0.3)
    _, state = begin(experiment, 0.9, 0.3, 4)
    run(state, scene, 1, collisions=200)
    kinds = len(species.get("species", [{}]))
    names = contacts.STRESSES, contacts.HEAT
    flux = (
        [contacts.columns_of_pairs(components, kinds) for components in names]
        if kernel == "spheres"
        else []
    )
    for _ in range(10):
        rows = run(state, scene, 1, collisions=0)
        before, carried = last_sums(rows), [last_sums(rows, flux_columns) for flux_columns in flux]
        brute = brute_force_from(world, snapshot(state, scene))
        for _ in range(5):
            brute.run(1)
            rows = run(state, scene, 1, collisions=1)
            rounding = 1e-11 * (brute.contact_sums[:2].max() + before.max())
            assert last_sums(rows) - before == pytest.approx(brute.contact_sums, abs=rounding)
            for flux_columns, begun, expected in zip(
                flux, carried, (brute.carried_momentum, brute.carried_energy), strict=False
            ):
                measured = (last_sums(rows, flux_columns) - begun).reshape(kinds**2, -1).sum(axis=0)
                assert measured == pytest.approx(expected.ravel(), abs=1e-11 * abs(begun).max())


def test_contact_sums_explain_the_rotational_energy_of_a_cooling_gas():
    """At each refresh the sums give the energy booked by contacts, in any unit of velocity."""
    scene, state = begin(settings("spheres", 40), 0.8, 0.2, 6)
    q, before = scene.effects.spin.inertia, np.zeros(2)
    for _ in range(100):
        A, B, C = last_sums(run(state, scene, 1, collisions=40, refresh=1))
        booked = balance(state, scene).ledger[-1, 1]
        assert theory.rotational_energy_change(A, C, B, 0.2, q) == pytest.approx(booked, rel=1e-9)
        assert A >= before[0] and B >= before[1]
        before = A, B
    assert state.counts[EXPONENT] < -8
    assert np.all(state.sums.contact_averages[:2, 0] == [0.0, A])


def test_contact_averages_leave_out_samples_before_the_start():
    """Two periods of two samples after the first two samples; an odd sample is left out."""
    steps = {"v_t^2": [9, 9, 2, 2, 3, 5, 7], "v_r^2": [9, 9, 1, 2, 3, 2, 7]}
    steps["v_t.v_r"] = [9, 9, -1, 0, 1, -2, 7]
    rows = {name: np.cumsum(values, dtype=float) for name, values in steps.items()}
    averages = contact_averages(rows, 2, 2, 0.5)
    assert averages["R_collisional"] == pytest.approx(4.0 / (12.0 + 4.0), rel=1e-14)
    assert averages["contact_correlation"] == pytest.approx(-2.0 / np.sqrt(12.0 * 8.0), rel=1e-14)
    assert contact_averages({}, 2, 2, 0.5) == {}


def test_a_gas_without_spin_energy_has_no_average():
    rows = {"v_t^2": np.arange(9.0), "v_r^2": np.zeros(9), "v_t.v_r": np.zeros(9)}
    averages = contact_averages(rows, 1, 1, 0.5)
    assert all(np.isnan(value) for name, value in averages.items() if not name.endswith("_dof"))


def test_stated_errors_are_the_scatter_of_independent_series():
    """The scatter of 400 synthetic series agrees with their stated errors to 10 % (2.8 sigma)."""
    rng, averages = np.random.default_rng(8), []
    for _ in range(400):
        v_t = rng.gamma(2.0, 1.0, 500)
        v_r = 0.5 * v_t + rng.gamma(1.0, 0.5, 500)
        product = -0.2 * v_t + 0.1 * rng.standard_normal(500)
        steps = zip(CONTACT_SUMS, (v_t, v_r, product), strict=True)
        averages.append(contact_averages({n: np.cumsum(x) for n, x in steps}, 0, 1, 0.5))
    for name in ("R_collisional", "contact_correlation"):
        scatter = np.std([series_averages[name] for series_averages in averages], ddof=1)
        stated = np.sqrt(
            np.mean([series_averages[f"{name}_stderr"] ** 2 for series_averages in averages])
        )
        assert stated == pytest.approx(scatter, rel=0.1), name


def spheres_in_a_row(spacing, number=3):
    """Positions, velocities and spins of spheres on a line at rest; the first flies at speed 1."""
    position = np.full((number, 3), 6.0)
    position[:, 0] = 2.0 + (2.0 + spacing) * np.arange(number)
    velocity = np.zeros((number, 3))
    velocity[0, 0] = 1.0
    return position, velocity, np.zeros((number, 3))


@pytest.mark.parametrize(("duration", "second"), [(0.4, 0.5), (0.6, 1.0)])
def test_a_contact_soon_after_another_is_elastic(duration, second):
    """The middle sphere is hit at speed 1 and moves on at (1 + r)/2 = 0.75 over a gap of 0.375.

    0.5 T later it hits the third sphere, elastically if t_c > 0.5 T.
    """
    experiment = settings("spheres", 3, [40, 12, 12], contact_time={"duration": duration})
    scene, _ = begin(experiment, 0.5, 0.0)
    position, velocity, spin = spheres_in_a_row(0.375)
    state = new_state(scene, position, velocity, spin)
    run(state, scene, 2, collisions=1)
    restitution = 2.0 * state.trajectory[2, 3] / 0.75 - 1.0
    assert restitution == pytest.approx(second, rel=1e-12)
    assert state.counts[ALTERED_RESTITUTIONS] == (second == 1.0)


def test_the_contact_time_model_keeps_the_roughness():
    """Two contacts in quick succession, the second with spin, both of beta = 0.4."""
    experiment = settings("spheres", 3, [40, 12, 12], contact_time={"duration": 10.0})
    scene, _ = begin(experiment, 0.5, 0.4)
    position, velocity, spin = spheres_in_a_row(0.375)
    spin[2] = [0.0, 0.0, 1.0]
    state = new_state(scene, position, velocity, spin)
    run(state, scene, 2, collisions=1)
    assert state.counts[ALTERED_RESTITUTIONS] == 1
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
        position, velocity, spin = spheres_in_a_row(0.375, 4)
        # the fourth, far off, keeps the total momentum zero
        position[3], velocity[3] = [30.0, 2.0, 2.0], -velocity[0]
        state = new_state(scene, position, slow * velocity, spin)
        run(state, scene, 1, interval=2.0**-10)
        refresh(state, scene)
        assert state.counts[EXPONENT] < -16
        rows = np.empty((2, len(columns(scene))))
        record(state, scene, Sampling(np.inf, 1, 0), rows, allocate_frames(state, 0))
        assert state.counts[ALTERED_RESTITUTIONS] == touched, duration
