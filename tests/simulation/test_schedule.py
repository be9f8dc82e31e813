"""Kinds of schedule, and the scenes that they suit."""

import pytest
from brute_force import settings

from roughgas.base.errors import InputError
from roughgas.simulation import cooling, schedule, steady

HEAT = {"thermostat": {"power": 1.0, "spin_share": 0.5, "interval": 0.5}}


def scheduled(kernel, kind, **effects):
    return settings(kernel, 20, **effects) | {"schedule": {"kind": kind}}


def test_each_kind_is_a_module():
    assert schedule.of(scheduled("gas", "cooling")) is cooling
    assert schedule.of(scheduled("bed", "steady")) is steady


@pytest.mark.parametrize(
    ("kernel", "kind", "effects", "message"),
    [
        ("gas", "cooling", HEAT, "cooling: must be steady where there is a drive: thermostat"),
        (
            "sheared",
            "cooling",
            HEAT,
            "cooling: must be steady where there is a drive: shear, thermostat",
        ),
        ("friction", "steady", {}, "steady: must be cooling where no effect drives the gas"),
    ],
)
def test_a_drive_needs_a_steady_schedule(kernel, kind, effects, message):
    with pytest.raises(InputError) as caught:
        schedule.check(scheduled(kernel, kind, **effects))
    assert str(caught.value) == f"schedule.kind = {message}"


@pytest.mark.parametrize(
    ("kernel", "kind"),
    [("gas", "cooling"), ("smooth", "cooling"), ("heated", "steady"), ("bed", "steady")],
)
def test_what_goes_together(kernel, kind):
    schedule.check(scheduled(kernel, kind))
