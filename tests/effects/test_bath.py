"""A Langevin bath: fluctuation and dissipation, its parts alone, and theory of its gases."""

import json
import math

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot

from roughgas import theory
from roughgas.base import InputError
from roughgas.scene import conserves_momentum
from roughgas.simulation.energies import balance, energies, imbalance, restored
from roughgas.simulation.schedule import check
from roughgas.statistics.errors import blocking_stderr
from roughgas.theory.prediction import predicted_ratio

ALONE = {name: 0.0 for name in ("drag", "temperature", "power", "spin_drag", "spin_power")}


def bath(particles=100, box=(50, 50), **langevin):
    return settings("bath", particles, list(box), langevin=ALONE | langevin)


def temperatures(experiment, r, beta, time, seed=1, warm=100.0):
    """(mean, standard error) of T_tr and of T_rot, once `warm` T have passed."""
    scene, state = begin(experiment, r, beta, seed)
    run(state, scene, 1, interval=warm)
    E = energies(run(state, scene, int(time), interval=1.0), experiment["particles"], 0.5)
    series = 2.0 * E.translational, 2.0 * E.rotational
    return [(one.mean(), blocking_stderr(one)) for one in series]


@pytest.mark.parametrize("interval", [0.2, 5.0])
def test_an_elastic_gas_takes_the_temperature_of_its_bath(interval):
    """Fluctuation and dissipation: rough contacts mix both motions, R = 1/2, for any length of

    steps. 4 sigma: each of four numbers fails once in 16 000.
    """
    drags = {"drag": 0.3, "temperature": 1.7, "spin_drag": 0.1, "spin_temperature": 1.7}
    for mean, error in temperatures(bath(interval=interval, **drags), 1.0, 1.0, 4000):
        assert error < 0.02
        assert abs(mean - 1.7) < 4.0 * error


def test_velocities_are_maxwellian_in_a_bath():
    """Fourth moments of 20 000 velocities and spins, some drag times apart, within 4 sigma."""
    drags = {"drag": 1.0, "temperature": 0.5, "spin_drag": 1.0, "spin_temperature": 2.0}
    scene, state = begin(bath(interval=0.7, **drags), 1.0, -1.0, 2)
    shots = []
    for _ in range(200):
        run(state, scene, 1, interval=5.0)
        shot = snapshot(state, scene)
        shots.append(np.column_stack([shot.velocity / 0.5**0.5, shot.spin / 2.0]))
    found = np.concatenate(shots)  # w of q = 1/2 has the variance T/q = 4
    for power, mean, variance in ((2, 1.0, 2.0), (4, 3.0, 96.0)):
        away = (found**power).mean(axis=0) - mean
        assert np.abs(away).max() < 4.0 * math.sqrt(variance / len(found))


def test_smooth_contacts_leave_spins_to_their_own_bath():
    drags = {"drag": 0.3, "temperature": 1.0, "spin_drag": 0.2, "spin_temperature": 3.0}
    found = temperatures(bath(interval=0.5, **drags), 0.9, -1.0, 4000)
    (T_tr, _), (T_rot, error) = found
    assert abs(T_rot - 3.0) < 4.0 * error < 0.3
    assert T_tr < 0.99  # contacts take some away


@pytest.mark.parametrize(("r", "beta"), [(0.9, 0.2), (0.8, -0.5)])
def test_a_dilute_gas_settles_where_the_rate_equations_say(r, beta):
    """Both temperatures within 2 % of theory's and 4 standard errors."""
    drags = {"drag": 0.05, "temperature": 1.0, "spin_drag": 0.02, "spin_temperature": 0.4}
    experiment = bath(160, (100, 100), interval=0.5, **drags)
    packing = theory.packing_fraction(160, (100, 100))
    expected = theory.bath_temperatures(r, beta, packing, 0.05, 1.0, 0.02, 0.4)
    found = temperatures(experiment, r, beta, 4000)
    for (mean, error), T in zip(found, expected, strict=True):
        assert error < 0.02 * T
        assert abs(mean - T) < 4.0 * error + 0.02 * T
    assert expected[0] < 0.85  # the bath's temperature is not that of the gas


@pytest.mark.slow  # compiles a kernel
def test_drag_alone_is_exponential():
    """Two disks that never meet: velocities, places, spins and the books, to rounding."""
    kept, interval, steps = math.exp(-0.3 * 0.5), 0.5, 7
    experiment = {
        "particles": 2,
        "box": [1000, 1000],
        "effects": {"spin": {"inertia": 0.5}, "langevin": {"drag": 0.3, "interval": 0.5}},
    }
    scene, state = begin(experiment, 0.9, 0.2, 4)
    before, booked = snapshot(state, scene), balance(state, scene)
    run(state, scene, 1, interval=interval * steps)  # of the steps the last one is at the end
    after, books = snapshot(state, scene), balance(state, scene)
    assert state.random is None
    assert not conserves_momentum(scene)
    assert after.velocity == pytest.approx(before.velocity * kept**steps, rel=1e-14)
    assert after.spin == pytest.approx(before.spin, rel=1e-14)
    assert imbalance(books.ledger - booked.ledger, books.energy - booked.energy) < 1e-14


@pytest.mark.slow  # compiles a kernel
def test_a_cooling_gas_is_rescaled_with_its_steps():
    """Scaled by powers of two as it cools, a gas with drag makes its steps as often as before.

    Smooth contacts of an elastic gas leave its energy alone: it decays as exp(-2 gamma t), but for
    what contacts hand on to particles that have yet to take their step.
    """
    experiment = {
        "particles": 40,
        "box": [40, 40],
        "effects": {"spin": {"inertia": 0.5}, "langevin": {"drag": 0.02, "interval": 0.25}},
        "schedule": {"kind": "cooling"},
    }
    for refresh in (0, 1):
        scene, state = begin(experiment, 1.0, -1.0, 4)
        rows = run(state, scene, 8, interval=10.0, refresh=refresh)
        assert (rows["exponent"][-1] < 0) == bool(refresh)
        E = restored(energies(rows, 40, 0.5), rows["exponent"]).translational
        passed = np.diff(rows["time"])
        assert E[1:] / E[:-1] == pytest.approx(np.exp(-0.04 * passed), rel=2e-3)


def test_noise_alone_puts_in_its_power():
    """In translation and rotation, within 4 sigma; contacts of smooth, elastic disks only share it
    out."""
    scene, state = begin(bath(interval=0.5, power=2.0, spin_power=0.7), 1.0, -1.0, 3)
    before = balance(state, scene)
    run(state, scene, 1, interval=100.0)
    after = balance(state, scene)
    put_in = (after.ledger - before.ledger)[1]
    time = 100.0
    for found, power, components, start in zip(
        put_in, (2.0, 0.7), (2, 1), before.energy, strict=True
    ):
        # components of velocity end as Gaussian: their energy has the variance of chi^2
        given = power * time
        scatter = math.sqrt(100 * (2.0 * given**2 + 4.0 * given * start / 100) / components)
        assert abs(found - 100 * given) < 4.0 * scatter
        assert scatter < 0.2 * 100 * given
    assert imbalance(after.ledger - before.ledger, after.energy - before.energy) < 1e-12


def test_drag_alone_is_no_drive():
    one = bath(interval=0.5, drag=1.0) | {"schedule": {"kind": "steady", "measure": 10}}
    with pytest.raises(InputError, match=r"be cooling or stages where no effect drives the gas"):
        check(one | {"schedule": {"kind": "steady", "equilibrate": 1, "measure": 10}})


def test_limits_of_the_stationary_state():
    """An elastic gas has its bath's temperature, one that never collides two, and one that only

    noise drives the R of its share; in general collisions and bath balance.
    """
    of = theory.bath_temperatures
    assert of(1.0, 1.0, 0.2, 0.4, 1.7, 0.1, 1.7) == pytest.approx((1.7, 1.7), rel=1e-12)
    assert of(0.5, 0.3, 1e-12, 0.4, 1.7, 0.1, 0.2) == pytest.approx((1.7, 0.2), rel=1e-6)
    T_tr, T_rot = of(0.9, 0.0, 0.1, 0.0, 0.0, power=0.75, spin_power=0.25)
    assert T_rot / (T_tr + T_rot) == pytest.approx(theory.stationary_ratio(0.9, 0.0, 2, None, 0.25))
    for dimension in (2, 3):
        T = of(0.8, 0.4, 0.1, 0.3, 2.0, 0.7, 0.5, dimension=dimension)
        nu = theory.collision_frequency(T[0], 0.1, dimension)
        lost = theory.temperature_changes(*T, 0.8, 0.4, dimension, None, nu)
        assert lost == pytest.approx((-0.6 * (2.0 - T[0]), -1.4 * (0.5 - T[1])), rel=1e-9)
    assert of(0.9, 0.0, 0.1, 1.0, 0.0) == (0.0, 0.0)


BATH = {"interval": 0.5, "drag": 0.3, "temperature": 2.0, "spin_drag": 0.1}
GAS = {"langevin_json": json.dumps(BATH), "dimension": 2, "inertia": 0.5, "packing": 0.1}


def test_a_dataset_is_held_against_the_rate_equations_of_its_bath():
    """Also where a parameter of it is swept."""
    swept = GAS | {"swept": "langevin.drag", "drag": np.array([0.3, 0.6])}
    found = predicted_ratio(swept | {"theory": "lun"}, np.full(2, 0.9), np.full(2, 0.2))
    for drag, R in zip((0.3, 0.6), found, strict=True):
        T_tr, T_rot = theory.bath_temperatures(0.9, 0.2, 0.1, drag, 2.0, 0.1)
        assert pytest.approx(T_rot / (T_tr + T_rot)) == R


@pytest.mark.parametrize(
    "more", [{"mu": 0.5}, {"spin_share": 0.2}, {"species_json": "{}"}, {"packing": np.nan}]
)
def test_theory_says_nothing_of_what_its_rate_equations_leave_out(more):
    assert np.isnan(predicted_ratio(GAS | {"theory": "lun"} | more, 0.9, 0.2))
