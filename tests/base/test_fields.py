"""Settings read into structs: messages of refusals, plain numbers, and JSON schemas."""

from types import MappingProxyType
from typing import Annotated, Literal

import msgspec
import numpy as np
import pytest

from roughgas.base import InputError
from roughgas.base.fields import (
    Settings,
    described,
    fields_of,
    number,
    numbers,
    read,
    required_by,
    schema_of,
    whole,
)


class Pause(Settings, frozen=True, kw_only=True, tag_field="kind", tag="pause"):
    """A stage without a change."""

    duration: Annotated[float, number("(0, inf)", "Duration, in T.")]


class Ramp(Settings, frozen=True, kw_only=True, tag_field="kind", tag="ramp"):
    """The drive grows."""

    rate: Annotated[float, number("[0, 1)", "Growth per T.")]


class Drive(Settings, frozen=True, kw_only=True):
    """A drive of the tests, with each type of field."""

    power: Annotated[float, number("[0, 1e+06]", "Power, in m a^2/T^3.")]
    roughness: (
        Annotated[float, number("[-1, 1]", "Roughness of the wall.")] | Literal["particles"]
    ) = "particles"
    period: Annotated[float, number("(0, 1e+09]", "Period, in T.")] | None = None
    bins: Annotated[int, whole(1, 64, "Bins.")] = 8
    radii: Annotated[
        tuple[Annotated[float, number("(0, inf)")], ...], numbers(1, 3, "Radii, in a.")
    ] = (1.0,)
    wave: Annotated[Literal["sine", "triangle"], described("Form of the motion.")] = "sine"
    shaken: bool = False
    label: Annotated[str, msgspec.Meta(min_length=1)] = "drive"
    steps: tuple[Pause | Ramp, ...] = ()


KEY = "effects.drive"
REFUSALS = {
    f"{KEY} = 3: must be a mapping of keys to values": 3,
    f"{KEY}.power = (nothing): must be a number in [0, 1e+06]": {},
    f"{KEY}.power = -1: must be a number in [0, 1e+06]": {"power": -1},
    f"{KEY}.power = inf: must be a number in [0, 1e+06]": {"power": np.inf},
    f"{KEY}.power = nan: must be a number in [0, 1e+06]": {"power": np.nan},
    f"{KEY}.power = True: must be a number in [0, 1e+06]": {"power": True},
    f"{KEY}.power = '2': must be a number in [0, 1e+06]": {"power": "2"},
    f"{KEY}.roughness = 2: must be a number in [-1, 1] or be particles": {
        "power": 1,
        "roughness": 2,
    },
    f"{KEY}.period = 0: must be a number in (0, 1e+09]": {"power": 1, "period": 0},
    f"{KEY}.bins = 1.5: must be a whole number in [1, 64]": {"power": 1, "bins": 1.5},
    f"{KEY}.radii = []: must be a list of 1 to 3 entries": {"power": 1, "radii": []},
    f"{KEY}.radii[1] = 0: must be a number > 0": {"power": 1, "radii": [1, 0]},
    f"{KEY}.wave = 'saw': must be one of sine, triangle": {"power": 1, "wave": "saw"},
    f"{KEY}.shaken = 'yes': must be true or false": {"power": 1, "shaken": "yes"},
    f"{KEY}.label = '': must be text that is not empty": {"power": 1, "label": ""},
    f"{KEY}.steps[1].rate = 1: must be a number in [0, 1)": {
        "power": 1,
        "steps": [{"kind": "pause", "duration": 2}, {"kind": "ramp", "rate": 1}],
    },
    f"{KEY}.steps[0].kind = 'jump': must be one of pause, ramp": {
        "power": 1,
        "steps": [{"kind": "jump"}],
    },
    f"{KEY}.steps[0].kind = (nothing): must be one of pause, ramp": {
        "power": 1,
        "steps": [{"rate": 0.5}],
    },
    f"{KEY}: key = 'powr': must be one of bins, label, period, power, radii, roughness, shaken, "
    "steps, wave; did you mean power?": {"powr": 1},
}


@pytest.mark.parametrize(("message", "raw"), REFUSALS.items(), ids=list(REFUSALS))
def test_refusals_name_key_value_and_legal_values(message, raw):
    with pytest.raises(InputError) as refusal:
        read(Drive, raw, KEY)
    assert str(refusal.value) == message


def test_fields_of_every_type_are_listed():
    fields = {field.name: field[1:] for field in fields_of(Drive)}
    assert len(fields) == 9
    assert fields["power"] == ("be a number in [0, 1e+06]", None, True, "Power, in m a^2/T^3.")
    legal = "be a number in [-1, 1] or be particles"
    assert fields["roughness"] == (legal, "particles", False, "Roughness of the wall.")
    assert fields["period"] == ("be a number in (0, 1e+09]", None, False, "Period, in T.")
    assert fields["shaken"] == ("be true or false", False, False, "")
    assert fields["label"] == ("be text that is not empty", "drive", False, "")
    assert fields["steps"] == ("be a list", (), False, "")


def test_numpy_numbers_become_plain_numbers():
    raw = {"power": np.int32(2), "bins": np.int64(3), "radii": (1, np.float64(0.5))}
    drive = read(Drive, MappingProxyType(raw), KEY)
    assert (drive.power, drive.bins, drive.radii) == (2.0, 3, (1.0, 0.5))
    assert [type(value) for value in (drive.power, drive.bins, drive.radii[1])] == [
        float,
        int,
        float,
    ]


def test_structs_are_frozen():
    with pytest.raises(AttributeError):
        read(Drive, {"power": 1}, KEY).power = 2.0


class Plain(Settings, frozen=True, kw_only=True):
    """Fields whose schemas are compared."""

    power: Annotated[float, number("(0, 1)", "Power.")]
    roughness: Annotated[float, number("[-1, 1]", "Roughness.")] | Literal["particles"]
    bins: Annotated[int, whole(1, 64, "Bins.")] = 8
    radii: Annotated[tuple[Annotated[float, number("[1, inf)")], ...], numbers(1, 3, "Radii.")] = (
        1.0,
    )
    wave: Annotated[Literal["sine", "triangle"], described("Form.")] = "sine"


def test_schemas_have_the_bounds_of_the_annotations():
    unit = {"exclusiveMinimum": 0, "exclusiveMaximum": 1}
    alternatives = [{"type": "number", "minimum": -1, "maximum": 1}, {"const": "particles"}]
    entries = {"type": "array", "minItems": 1, "maxItems": 3}
    assert schema_of(Plain) == {
        "type": ["object", "null"],
        "additionalProperties": False,
        "properties": {
            "power": {"description": "Power.", "type": "number"} | unit,
            "roughness": {"description": "Roughness.", "anyOf": alternatives},
            "bins": {"description": "Bins.", "type": "integer", "minimum": 1, "maximum": 64},
            "radii": {"description": "Radii.", "items": {"type": "number", "minimum": 1}} | entries,
            "wave": {"description": "Form.", "enum": ["sine", "triangle"]},
        },
    }
    assert required_by(Plain) == ["power", "roughness"]
