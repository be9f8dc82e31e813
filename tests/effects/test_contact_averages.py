"""The effect that only looks: sums over the contacts of pairs."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings, snapshot
from brute_force.beside import brute_force_from
from schedules import STEADY

from roughgas import theory
from roughgas.base import InputError
from roughgas.kernel.state import EXPONENT
from roughgas.scene import build
from roughgas.simulation.books import books
from roughgas.simulation.contacts import SUMS, contact_averages
from roughgas.simulation.point import run_point

ENDS = ("", "_stderr", "_dof", "_ci95")
LOOKED_AT = ("bed", "sheared", "shaken", "heated", "spheres")

TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "inertia": 0.3}]


def sums(rows):
    """The last running sums of v_t^2, v_r^2 and v_t.v_r."""
    return np.array([rows[name][-1] for name in SUMS])


@pytest.mark.parametrize(
    ("kernel", "species"),
    [
        *((kernel, {}) for kernel in LOOKED_AT),
        ("heated", {"species": TWO}),
    ],
)
def test_each_contact_counts_as_brute_force_has_it(kernel, species):
    """Collision by collision, to roundings; each piece starts where the kernel stands."""
    experiment = settings(kernel, 40) | species
    scene, world = scene_of(experiment, 0.9, 0.3)
    _, state = begin(experiment, 0.9, 0.3, 4)
    run(state, scene, 1, collisions=200)
    for _ in range(10):
        before = sums(run(state, scene, 1, collisions=0))
        brute = brute_force_from(world, snapshot(state, scene))
        for _ in range(5):
            brute.run(1)
            found = sums(run(state, scene, 1, collisions=1)) - before
            rounding = 1e-11 * (brute.seen[:2].max() + before.max())
            assert found == pytest.approx(brute.seen, abs=rounding)


def test_a_gas_that_cools_by_many_powers_of_two():
    """At each instant the sums are the account of contacts, in whichever unit velocities are."""
    scene, state = begin(settings("spheres", 40), 0.8, 0.2, 6)
    q, before = scene.effects.spin.inertia, np.zeros(2)
    for _ in range(100):
        A, B, C = sums(run(state, scene, 1, collisions=40, refresh=1))
        booked = books(state, scene).ledger[-1, 1]
        assert theory.rotational_energy_change(A, C, B, 0.2, q) == pytest.approx(booked, rel=1e-9)
        assert A >= before[0] and B >= before[1]
        before = A, B
    assert state.counts[EXPONENT] < -8
    assert np.all(state.sums.contact_averages[:2, 0] == [0.0, A])


@pytest.mark.slow  # two kernels more; tests/test_bits.py has bits from before there was the effect
@pytest.mark.parametrize("kernel", ["bed", "heated"])
def test_looking_changes_no_bit(kernel):
    seen, plain = settings(kernel, 40), settings(kernel, 40)
    del plain["effects"]["contact_averages"]
    points = []
    for experiment in (seen, plain):
        settled = experiment | {"schedule": STEADY}
        points.append(run_point(build(settled, 0.9, 0.2), settled, 7).variables)
    with_it, without = points
    added = {f"{name}{end}" for name in ("R_collisional", "contact_correlation") for end in ENDS}
    assert set(with_it) - set(without) == added and set(without) <= set(with_it)
    for name in set(without) - {"kernel_seconds"}:
        assert np.array_equal(with_it[name], without[name]), name


def test_without_spin_it_is_refused():
    with pytest.raises(InputError, match="contact_averages needs spin"):
        build(settings("smooth") | {"effects": {"contact_averages": {}}}, 0.9, -1.0)


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
