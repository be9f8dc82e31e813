"""A Langevin bath: fluctuation and dissipation, drag alone, noise alone, and rate equations."""

import json
import math

import numpy as np
import pytest
from brute_force import begin, refresh, run, settings, snapshot
from raw import check_schedule as check
from schedules import COOLING, STEADY

from roughgas import theory
from roughgas.base import InputError
from roughgas.scene import conserves_momentum
from roughgas.simulation.energies import energies, restored
from roughgas.simulation.energy_balance import balance, imbalance
from roughgas.statistics.errors import blocking_stderr
from roughgas.theory.prediction import predicted_ratio

NO_BATH = {name: 0.0 for name in ("drag", "temperature", "power", "spin_drag", "spin_power")}


def bath(particles=100, box=(50, 50), **langevin):
    """Settings of a gas in a bath; parameters that are not given are 0."""
    return settings("bath", particles, list(box), langevin=NO_BATH | langevin)


def temperatures(experiment, r, beta, time, seed=1, equilibration=100.0):
    """(mean, standard error) of T_tr and of T_rot over `time` T, after an equilibration."""
    scene, state = begin(experiment, r, beta, seed)
    run(state, scene, 1, interval=equilibration)
    E = energies(run(state, scene, int(time), interval=1.0), experiment["particles"], 0.5)
    series = 2.0 * E.translational, 2.0 * E.rotational
    return [(temperature.mean(), blocking_stderr(temperature)) for temperature in series]


@pytest.mark.parametrize("interval", [0.2, 5.0])
def test_an_elastic_gas_takes_the_temperature_of_its_bath(interval):
    """Fluctuation and dissipation: rough contacts mix both motions, R = 1/2, at any step.

    4 sigma: each of four numbers fails once in 16 000.
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
    scaled_components = np.concatenate(shots)  # w of q = 1/2 has the variance T/q = 4
    for power, mean, variance in ((2, 1.0, 2.0), (4, 3.0, 96.0)):
        deviation = (scaled_components**power).mean(axis=0) - mean
        assert np.abs(deviation).max() < 4.0 * math.sqrt(variance / len(scaled_components))


def test_smooth_contacts_leave_spins_to_their_own_bath():
    drags = {"drag": 0.3, "temperature": 1.0, "spin_drag": 0.2, "spin_temperature": 3.0}
    measured = temperatures(bath(interval=0.5, **drags), 0.9, -1.0, 4000)
    (T_tr, _), (T_rot, error) = measured
    assert abs(T_rot - 3.0) < 4.0 * error < 0.3
    assert T_tr < 0.99  # contacts dissipate energy of translation


@pytest.mark.parametrize(("r", "beta"), [(0.9, 0.2), (0.8, -0.5)])
def test_a_dilute_gas_settles_at_the_temperatures_of_the_rate_equations(r, beta):
    """Both temperatures agree with theory to 2 % and 4 standard errors."""
    drags = {"drag": 0.05, "temperature": 1.0, "spin_drag": 0.02, "spin_temperature": 0.4}
    experiment = bath(160, (100, 100), interval=0.5, **drags)
    packing = theory.packing_fraction(160, (100, 100))
    expected = theory.bath_temperatures(r, beta, packing, 0.05, 1.0, 0.02, 0.4)
    measured = temperatures(experiment, r, beta, 4000)
    for (mean, error), T in zip(measured, expected, strict=True):
        assert error < 0.02 * T
        assert abs(mean - T) < 4.0 * error + 0.02 * T
    assert expected[0] < 0.85  # far from the temperature of the bath


@pytest.mark.slow  # compiles a kernel
def test_drag_alone_is_exponential():
    """Two disks that never meet: velocities, spins and the energy balance, to rounding."""
    decay, interval, steps = math.exp(-0.3 * 0.5), 0.5, 7
    experiment = {
        "particles": 2,
        "box": [1000, 1000],
        "effects": {"spin": {"inertia": 0.5}, "langevin": {"drag": 0.3, "interval": 0.5}},
    }
    scene, state = begin(experiment, 0.9, 0.2, 4)
    shot_before, balance_before = snapshot(state, scene), balance(state, scene)
    run(state, scene, 1, interval=interval * steps)  # the last step is at the end
    shot_after, balance_after = snapshot(state, scene), balance(state, scene)
    assert state.random is None
    assert not conserves_momentum(scene)
    assert shot_after.velocity == pytest.approx(shot_before.velocity * decay**steps, rel=1e-14)
    assert shot_after.spin == pytest.approx(shot_before.spin, rel=1e-14)
    assert (
        imbalance(
            balance_after.ledger - balance_before.ledger,
            balance_after.energy - balance_before.energy,
        )
        < 1e-14
    )


@pytest.mark.slow  # compiles a kernel
def test_rescaling_a_cooling_gas_keeps_the_steps_of_its_bath():
    """A gas with drag, rescaled by powers of two as it cools, makes its steps at the same times.

    Smooth elastic contacts conserve the energy: it decays as exp(-2 gamma t), apart from energy
    that contacts transfer to particles whose step is still to come.
    """
    experiment = {
        "particles": 40,
        "box": [40, 40],
        "effects": {"spin": {"inertia": 0.5}, "langevin": {"drag": 0.02, "interval": 0.25}},
        "schedule": COOLING,
    }
    for refreshes in (False, True):
        scene, state = begin(experiment, 1.0, -1.0, 4)
        samples = []
        for _ in range(8):
            samples.append(run(state, scene, 1, interval=10.0))
            if refreshes:
                refresh(state, scene)
        rows = {name: np.concatenate([sample[name] for sample in samples]) for name in samples[0]}
        assert (rows["exponent"][-1] < 0) == refreshes
        E = restored(energies(rows, 40, 0.5), rows["exponent"]).translational
        passed = np.diff(rows["time"])
        assert E[1:] / E[:-1] == pytest.approx(np.exp(-0.04 * passed), rel=2e-3)


def test_noise_alone_supplies_its_power():
    """In translation and rotation, within 4 sigma; smooth elastic contacts redistribute it."""
    scene, state = begin(bath(interval=0.5, power=2.0, spin_power=0.7), 1.0, -1.0, 3)
    before = balance(state, scene)
    run(state, scene, 1, interval=100.0)
    after = balance(state, scene)
    put_in = (after.ledger - before.ledger)[1]
    time = 100.0
    for measured, power, components, start in zip(
        put_in, (2.0, 0.7), (2, 1), before.energy, strict=True
    ):
        # final velocities are Gaussian: their energy has the variance of chi^2
        mean_input = power * time
        scatter = math.sqrt(
            100 * (2.0 * mean_input**2 + 4.0 * mean_input * start / 100) / components
        )
        assert abs(measured - 100 * mean_input) < 4.0 * scatter
        assert scatter < 0.2 * 100 * mean_input
    assert imbalance(after.ledger - before.ledger, after.energy - before.energy) < 1e-12


def test_drag_alone_is_no_drive():
    experiment = bath(interval=0.5, drag=1.0)
    with pytest.raises(InputError, match=r"be cooling or stages where no effect drives the gas"):
        check(experiment | {"schedule": STEADY})


def test_the_stationary_state_has_its_limits():
    """An elastic gas has the temperature of its bath, a gas without collisions has both.

    A gas driven by noise alone has the R of its share; in general collisions balance the bath.
    """
    temperatures_of = theory.bath_temperatures
    assert temperatures_of(1.0, 1.0, 0.2, 0.4, 1.7, 0.1, 1.7) == pytest.approx(
        (1.7, 1.7), rel=1e-12
    )
    assert temperatures_of(0.5, 0.3, 1e-12, 0.4, 1.7, 0.1, 0.2) == pytest.approx(
        (1.7, 0.2), rel=1e-6
    )
    T_tr, T_rot = temperatures_of(0.9, 0.0, 0.1, 0.0, 0.0, power=0.75, spin_power=0.25)
    assert T_rot / (T_tr + T_rot) == pytest.approx(theory.stationary_ratio(0.9, 0.0, 2, None, 0.25))
    for dimension in (2, 3):
        T = temperatures_of(0.8, 0.4, 0.1, 0.3, 2.0, 0.7, 0.5, dimension=dimension)
        nu = theory.collision_frequency(T[0], 0.1, dimension)
        lost = theory.temperature_changes(*T, 0.8, 0.4, dimension, None, nu)
        assert lost == pytest.approx((-0.6 * (2.0 - T[0]), -1.4 * (0.5 - T[1])), rel=1e-9)
    assert temperatures_of(0.9, 0.0, 0.1, 1.0, 0.0) == (0.0, 0.0)


BATH = {"interval": 0.5, "drag": 0.3, "temperature": 2.0, "spin_drag": 0.1}
GAS = {"langevin_json": json.dumps(BATH), "dimension": 2, "inertia": 0.5, "packing": 0.1}


def test_the_prediction_for_a_dataset_solves_the_rate_equations_of_its_bath():
    """The drag is swept in this dataset."""
    swept = GAS | {"swept": "langevin.drag", "drag": np.array([0.3, 0.6])}
    predicted = predicted_ratio(swept | {"theory": "lun"}, np.full(2, 0.9), np.full(2, 0.2))
    for drag, R in zip((0.3, 0.6), predicted, strict=True):
        T_tr, T_rot = theory.bath_temperatures(0.9, 0.2, 0.1, drag, 2.0, 0.1)
        assert pytest.approx(T_rot / (T_tr + T_rot)) == R


@pytest.mark.parametrize(
    "attributes", [{"mu": 0.5}, {"spin_share": 0.2}, {"species_json": "{}"}, {"packing": np.nan}]
)
def test_theory_predicts_nothing_outside_its_rate_equations(attributes):
    assert np.isnan(predicted_ratio(GAS | {"theory": "lun"} | attributes, 0.9, 0.2))


@pytest.mark.parametrize("bath", [{"spin_velocity": 1.0}, {"flows": True}, {"spin_axis": "z"}])
def test_theory_has_no_medium_that_moves(bath):
    """The axis alone changes nothing."""
    attributes = GAS | {"theory": "lun", "langevin_json": json.dumps(BATH | bath)}
    assert np.isnan(predicted_ratio(attributes, 0.9, 0.2)) == ("spin_axis" not in bath)
