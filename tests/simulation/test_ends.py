"""Initial and final states: a run of 2T is a run of T and its continuation by T, bit for bit."""

import numpy as np
import pytest
import schemes
import xarray as xr
from brute_force import KERNELS, kernels, settings
from raw import build, run_point
from schedules import COOLING

from roughgas.base import InputError
from roughgas.data.point import as_dataset
from roughgas.simulation.saved_states import initial_states_of

R, BETA, SEED = 0.9, 0.3, 3
DRIVEN = ("sheared", "bed", "walled", "rubbed bed", "shaken", "heated")
DRIVEN += ("heated, smooth", "heated spheres")
BOXES = {"bed": [10, "open"], "walled": [10, "open"], "rubbed bed": [10, "open"]}
POINT_ATTRIBUTES = {"experiment": "x", "scale": "small", "r": R, "beta": BETA, "seed": SEED}


def steady(measure, equilibrate=0):
    """A steady schedule."""
    lengths = {"equilibrate": equilibrate, "measure": measure}
    return {"kind": "steady", "sample_every": 0.25, "period": 1} | lengths


def cooling(plateau):
    """A cooling schedule without relaxation."""
    return COOLING | {"relaxation_times": 0, "plateau": plateau}


def experiment_of(name, number=16):
    """Settings of a kernel in a small box, which keep the final state."""
    box = BOXES.get(name) or [12] * len(KERNELS[name]["box"])
    return settings(name, number, box) | {"keep_state": True}


def run(experiment, schedule, initial=None, r=R):
    """A point as a dataset."""
    beta = BETA if "spin" in experiment["effects"] else -1.0
    experiment = experiment | {"schedule": schedule}
    states = [] if initial is None else initial_states_of(initial)
    point = run_point(build(experiment, r, beta), experiment, SEED, states)
    return as_dataset(point._replace(attributes=POINT_ATTRIBUTES | point.attributes))


def assert_same_end(first, second):
    """Assert that two runs have the same final state."""
    names = [name for name in first.data_vars if name.startswith("last_")]
    assert {"last_time", "last_position", "last_velocity", "last_memory"} <= set(names)
    for name in names:
        assert np.array_equal(first[name].values, second[name].values), name


@pytest.mark.parametrize("name", kernels(*DRIVEN))
def test_a_driven_gas_goes_on_as_if_it_had_not_stopped(name):
    experiment = experiment_of(name)
    uninterrupted = run(experiment, steady(40, 40))
    first_half = run(experiment, steady(40))
    second_half = run(experiment, steady(40), first_half)
    assert_same_end(uninterrupted, second_half)
    assert (
        second_half.initial_exact == 1
        and uninterrupted.collisions == first_half.collisions + second_half.collisions
    )
    if "R" in uninterrupted and uninterrupted.measured_from == second_half.measured_from:
        for variable in ("R", "R_stderr", "R_collisional", "contact_correlation", "R_series"):
            if variable in uninterrupted:
                assert np.array_equal(
                    uninterrupted[variable].values, second_half[variable].values
                ), variable
    assert second_half.time.values.min() >= 40.0


@pytest.mark.parametrize("name", ["gas", "spheres"])
@pytest.mark.parametrize("first", [14, 16, 17])
def test_a_cooling_gas_goes_on_wherever_it_was_last_refreshed(name, first):
    experiment = experiment_of(name, 20)
    uninterrupted, begun = run(experiment, cooling(50)), run(experiment, cooling(first))
    assert_same_end(uninterrupted, run(experiment, cooling(50 - first - 10), begun))


SLOW_KERNELS = [pytest.param(name, marks=pytest.mark.slow) for name in ("gas", "walled", "spheres")]


@pytest.mark.parametrize("name", ["sheared", *SLOW_KERNELS])
def test_many_particles_go_on_in_their_cells(name, monkeypatch):
    """Here of few particles; a bed keeps the cells of its initial state."""
    schemes.use_smallest_cells(monkeypatch)
    box = {"walled": [20, "open"], "spheres": [17, 17, 17]}.get(name, [17, 19])
    experiment = settings(name, 40, box) | {"keep_state": True}
    length = cooling if name in ("gas", "spheres") else steady
    first_half = run(experiment, length(20))
    second_half = run(experiment, length(20), first_half)
    assert_same_end(run(experiment, length(50 if length is cooling else 40)), second_half)


@pytest.mark.parametrize("name", kernels("sheared", "bed", "shaken"))
def test_a_run_continues_to_rounding_without_the_memory(name):
    """As in another version of the kernel, which does not use the memory."""
    experiment = experiment_of(name)
    half = run(experiment, steady(40))
    exact = run(experiment, steady(40), half)
    without_memory = run(experiment, steady(40), half.assign_attrs(memory_of="another kernel"))
    assert without_memory.initial_exact == 0 and not np.array_equal(
        exact.last_memory, without_memory.last_memory
    )
    early_samples = slice(0, 8)  # two T; later, chaos amplifies roundings
    assert without_memory.time.values == pytest.approx(exact.time.values, rel=1e-12)
    for series in ("E_trans_series", "E_rot_series"):
        assert without_memory[series][early_samples].values == pytest.approx(
            exact[series][early_samples].values, rel=1e-6
        )


def test_a_run_starts_from_a_state_of_the_user():
    experiment = settings("gas", 2, [12, 12]) | {"schedule": cooling(5)}
    vectors = {"position": [[2.0, 6.0], [9.0, 6.0]], "velocity": [[1.0, 0.0], [-1.0, 0.0]]}
    (state,) = initial_states_of(
        xr.Dataset({k: (("particle", "axis"), v) for k, v in vectors.items()})
    )
    assert state.time == 0.0 and state.spin is None
    states = [state._replace(position=state.position + shift) for shift in (0.0, 0.5, 1.0)]
    point = run_point(build(experiment, 1.0, 1.0), experiment, SEED, states).variables
    assert point["E_trans_series"] == pytest.approx(np.ones_like(point["E_trans_series"]))


def test_datasets_that_hold_no_state_are_refused():
    with pytest.raises(InputError, match="initial = without position: must be in the dataset"):
        initial_states_of(run(experiment_of("gas", 20) | {"keep_state": False}, cooling(5)))
    frames = ("frame", "particle", "axis"), np.zeros((2, 3, 2))
    places = {"position": frames, "velocity": frames}
    with pytest.raises(InputError, match=r"choose one, as by initial.isel\(frame=-1\)"):
        initial_states_of(xr.Dataset(places))
    half = run(experiment_of("gas", 20), cooling(5))
    with pytest.raises(InputError, match="number of initial states = 2: must be 3"):
        run(experiment_of("gas", 20), cooling(5), half.isel(replica=[0, 1]))


def test_a_changed_memory_or_one_of_another_state_is_not_used():
    """Its numbers are indices of arrays: the kernel might read and write anywhere."""
    half = run(experiment_of("gas", 20), cooling(5))
    assert run(experiment_of("gas", 20), cooling(5), half).initial_exact == 1
    flipped, moved = half.copy(deep=True), half.copy(deep=True)
    flipped.last_memory[:, 1000] ^= 1
    moved.last_velocity[...] *= 1.001
    for changed in (flipped, moved, half.isel(byte=slice(0, 800))):
        assert run(experiment_of("gas", 20), cooling(5), changed).initial_exact == 0


def test_spins_may_have_a_temperature_at_the_start():
    experiment = settings("gas", 900, [80, 80]) | {"spin_temperature": 4.0}
    gas = build(experiment, R, BETA)
    from raw import initial_state

    state = initial_state(gas, experiment, np.random.default_rng(SEED))
    cold = initial_state(gas, experiment | {"spin_temperature": 0.0}, np.random.default_rng(SEED))
    assert np.array_equal(state.trajectory, cold.trajectory) and np.all(cold.spin == 0.0)
    assert 0.5 * np.mean(state.spin**2) == pytest.approx(4.0, rel=0.2)  # 2/sqrt(900) = 0.07
