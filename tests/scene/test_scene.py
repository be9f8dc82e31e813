"""Legal scenes are built, and illegal ones are refused."""

import math

import pytest
from raw import build, check

from roughgas.base import InputError
from roughgas.effects.motions import sawtooth

SPIN = {"spin": {"inertia": 0.5}}
GRAVITY = {"gravity": {"acceleration": 1}}
FLOOR = {"floor": {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1}}
WALLS = {"walls": {"restitution": 1, "roughness": 1}}
SHEAR = {"shear": {"velocity": 2}}
CONTACT_TIME = {"contact_time": {"duration": 1e-5}}
FRICTION = {"friction": {"mu": 0.5}}
HEAT = {"thermostat": {"power": 1, "spin_share": 0.5, "interval": 0.5}}
BED = SPIN | GRAVITY | FLOOR


def experiment(box=(50, 50), particles=20, **effects):
    """Settings of an experiment with these effects."""
    return {"particles": particles, "box": list(box), "effects": effects}


def test_a_scene_has_the_settings_of_a_gas():
    scene = build(experiment((50, 60), **SPIN), 0.9, -0.5)
    assert scene.box == (50.0, 60.0) and scene.extent == 50.0 and scene.middle == 30.0
    assert (scene.restitution, scene.roughness) == (0.9, -0.5)
    assert scene.effects.spin.inertia == 0.5
    assert {name for name in scene.effects._fields if getattr(scene.effects, name)} == {"spin"}


def test_a_scene_has_the_settings_of_a_bed_between_walls():
    scene = build(experiment((50, "open"), **BED, **WALLS), 0.9, -0.5)
    assert (
        scene.box == (None, None)
        and scene.extent == 50.0
        and scene.effects.walls.side.position == 50.0
    )
    floor = scene.effects.floor
    assert (*floor[1:3], floor.motion) == (1.0, -1.0, sawtooth(5.0, 1.0))


def test_a_boundary_may_have_the_material_of_the_particles():
    material = {"restitution": "particles", "roughness": "particles"}
    effects = BED | {"floor": FLOOR["floor"] | material, "walls": material}
    scene = build(experiment((50, "open"), **effects), 0.9, -0.5)
    assert scene.effects.floor[1:3] == scene.effects.walls[1:3] == (0.9, -0.5)


@pytest.mark.parametrize(("r", "present"), [(0.74, True), (0.75, False), (0.9, False)])
def test_the_contact_time_model_acts_below_an_r(r, present):
    model = {"contact_time": {"duration": 1e-5, "below_r": 0.75}}
    assert (build(experiment(**SPIN, **model), r, 0.0).effects.contact_time is not None) == present


LEGAL = BED | FRICTION | HEAT | CONTACT_TIME | SHEAR | WALLS
ILLEGAL = {
    "spin.inertia": (0, -1, 1.1, math.nan, "x", True, ...),
    "gravity.acceleration": (0, -1, math.nan, math.inf, None),
    "floor.amplitude": (-1, math.inf, math.nan, 1e300),
    "floor.period": (0, -1, 1e-300),
    "floor.restitution": (-0.1, 1.1, "own", math.nan),
    "floor.roughness": (-1.1, 1.1),
    "walls.restitution": (2,),
    "walls.roughness": (-2,),
    "shear.velocity": (0, -2, math.nan, 1e300),
    "friction.mu": (-0.1, math.inf, "rough"),
    "thermostat.power": (0, -1, math.nan, 1e300),
    "thermostat.spin_share": (-0.1, 1.1, None),
    "thermostat.interval": (0, -1, math.inf, 1e-300),
    "contact_time.duration": (0, -1e-5, math.nan),
    "contact_time.below_r": (1.5,),
}
"""Illegal values of parameters; ... stands for an effect without its parameters."""


@pytest.mark.parametrize("key", ILLEGAL)
def test_illegal_parameters_are_refused(key):
    name, parameter = key.split(".")
    basis = BED if name in ("gravity", "floor") else SPIN
    for value in ILLEGAL[key]:
        parameters = {} if value is ... else LEGAL[name] | {parameter: value}
        assert refusal(basis | {name: parameters}).key == f"effects.{key}", value


def refusal(effects, box=None, beta=0.0, **settings):
    """The InputError on building or checking a scene."""
    box = box or (50, "open" if {"floor", "gravity"} & set(effects) else 50)
    with pytest.raises(InputError) as caught:
        build(experiment(box, **effects), 0.9, beta)
        check(experiment(box, **effects) | settings)
    assert "\n" not in str(caught.value)
    return caught.value


@pytest.mark.parametrize(
    ("box", "effects", "settings"),
    [
        ((50, 50), {}, {}),
        ((50, 50), WALLS | {"walls": {"restitution": 1, "roughness": "particles"}}, {}),
        ((50, 50), {"thermostat": HEAT["thermostat"] | {"spin_share": 0}}, {}),
        ((50, 50), SPIN | HEAT | FRICTION | SHEAR, {}),
        ((50, 50, "open"), BED | SHEAR | HEAT | FRICTION | CONTACT_TIME, {}),
        ((50, "open"), GRAVITY | FLOOR | CONTACT_TIME, {}),
    ],
)
def test_compatible_effects_are_accepted(box, effects, settings):
    check(experiment(box, **effects) | settings)


def test_too_many_particles_for_the_box_are_refused():
    check(experiment((8.1, 8.1), 16, **SPIN))
    with pytest.raises(InputError) as caught:
        check(experiment((8.1, 8.1), 17, **SPIN))
    assert caught.value.key == "particles" and "16" in caught.value.legal
