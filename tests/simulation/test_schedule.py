"""Kinds of schedule, and the scenes that they suit."""

import pytest
from brute_force import KERNELS, settings

from roughgas.base import InputError
from roughgas.simulation import cooling, schedule, steady

STEADY = {"kind": "steady", "equilibrate": 0, "measure": 30, "sample_every": 0.5, "period": 2}
COOLING = {"kind": "cooling", "plateau": 8, "sample_every": 1}


def test_each_kind_is_a_module():
    assert schedule.of({"schedule": COOLING}) is cooling and not cooling.DRIVEN
    assert schedule.of({"schedule": STEADY}) is steady and steady.DRIVEN


@pytest.mark.parametrize("kernel", ["gas", "sheared", "bed", "heated", "shaken"])
def test_a_drive_and_nothing_else_needs_a_steady_schedule(kernel):
    experiment = settings(kernel, 20)
    driven = sorted({"floor", "shaken_walls", "shear", "thermostat"} & set(experiment["effects"]))
    right, wrong = (STEADY, COOLING) if driven else (COOLING, STEADY)
    schedule.check(experiment | {"schedule": right})
    with pytest.raises(InputError) as caught:
        schedule.check(experiment | {"schedule": wrong})
    legal = f"steady where there is a drive: {driven[0]}" if driven else "cooling where no effect"
    assert str(caught.value).startswith(f"schedule.kind = {wrong['kind']}: must be {legal}")


def test_all_drives_are_named():
    experiment = settings("sheared", 20)
    experiment["effects"] |= KERNELS["heated"]["effects"]
    with pytest.raises(InputError, match="where there is a drive: shear, thermostat"):
        schedule.check(experiment | {"schedule": COOLING})
