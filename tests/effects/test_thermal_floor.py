"""A thermal floor under an open bed, an effect of the study `thermal_floor`."""

import pytest
from brute_force import Comparison, begin, run, scene_of
from study_code import booked_energies, study_in_use

from roughgas.base import InputError, NeedsError
from roughgas.statistics.errors import blocking_stderr

FLOOR = {"amplitude": 0.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0}
ACCOUNT = 2  # of the ledger; accounts before are of spin and of gravity


@pytest.fixture(autouse=True)
def study():
    yield from study_in_use("thermal_floor")


def bed(particles, width, temperature=3.0, **floor):
    """Settings of a bed of disks above a thermal floor."""
    effects = {
        "spin": {"inertia": 0.5},
        "gravity": {"acceleration": 1.0},
        "floor": FLOOR | floor,
        "thermal_floor": {"temperature": temperature},
    }
    return {"particles": particles, "box": [width, "open"], "effects": effects}


@pytest.mark.parametrize(
    ("floor", "line"),
    [({"amplitude": 1.0}, "floor.amplitude = 1.0: must be 0"), ({"wave": "sine"}, "floor.wave")],
)
def test_a_floor_that_moves_is_refused(floor, line):
    with pytest.raises(InputError, match=line):
        begin(bed(12, 12.0, **floor), 0.9, 0.2)


def test_a_floor_is_needed():
    experiment = bed(12, 12.0) | {"box": [12.0, 12.0]}
    for name in ("gravity", "floor"):
        del experiment["effects"][name]
    with pytest.raises(NeedsError, match="thermal_floor needs a floor"):
        begin(experiment, 0.9, 0.2)


@pytest.mark.slow  # compiles the kernel of a bed above a thermal floor
def test_brute_force_makes_the_same_collisions():
    """And draws the same random numbers; the floor at rest below is never met."""
    experiment = bed(12, 12.0)
    scene, world = scene_of(experiment, 0.9, 0.2)
    _, state = begin(experiment, 0.9, 0.2, 1)
    comparison = Comparison(state, scene, world)
    comparison.assert_same(25, 10)
    assert comparison.events["thermal_floor"] > 20


@pytest.mark.slow  # the same kernel
def test_energy_balance_is_kept():
    """The floor supplies energy to translation and to rotation; its material, none."""
    scene, state = begin(bed(40, 30.0), 0.9, 0.2, 2)
    booked = booked_energies(scene, state, 4000)
    assert booked[ACCOUNT].sum() > 0.0 > booked[-1].sum()
    assert (booked[ACCOUNT + 1] == 0.0).all()


@pytest.mark.slow  # the same kernel
def test_elastic_disks_are_in_equilibrium_with_the_floor():
    """Energies, exactly at any density, and the height of a dilute gas, to 4 sigma.

    The mean height of the centres is 1 + (T/m g) <Z>, where <Z> = 1 + phi at the floor, to first
    order in the packing fraction phi.
    """
    number, width, T = 30, 400.0, 20.0
    scene, state = begin(bed(number, width, T), 1.0, 1.0, 5)
    run(state, scene, 1, interval=1000.0)
    rows = run(state, scene, 4000, interval=5.0)
    packing = 3.141592653589793 * number / (width * T)
    expected = {"vv_x": T, "vv_y": T, "ww": T / 0.5, "y": 1.0 + T * (1.0 + packing)}
    for name, value in expected.items():
        mean = rows[name] / number
        error = blocking_stderr(mean)
        assert error < 0.02 * value, name
        assert abs(mean.mean() - value) < 4.0 * error, name
