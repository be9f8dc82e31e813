"""What scenes may be made of, and what is said about the others."""

import math

import pytest

from roughgas.base import InputError
from roughgas.scene import build, check

SPIN = {"spin": {"inertia": 0.5}}
GRAVITY = {"gravity": {"acceleration": 1}}
FLOOR = {"floor": {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1}}
WALLS = {"walls": {"restitution": 1, "roughness": 1}}
SHEAR = {"shear": {"velocity": 2}}
TIME = {"contact_time": {"duration": 1e-5}}
FRICTION = {"friction": {"mu": 0.5}}
HEAT = {"thermostat": {"power": 1, "spin_share": 0.5, "interval": 0.5}}
BED = SPIN | GRAVITY | FLOOR


def experiment(box=(50, 50), particles=20, **effects):
    return {"particles": particles, "box": list(box), "effects": effects}


def test_a_gas():
    scene = build(experiment((50, 60), **SPIN), 0.9, -0.5)
    assert scene.box == (50.0, 60.0) and scene.extent == 50.0 and scene.middle == 30.0
    assert (scene.restitution, scene.roughness) == (0.9, -0.5)
    assert scene.effects.spin.inertia == 0.5
    assert {name for name in scene.effects._fields if getattr(scene.effects, name)} == {"spin"}


def test_a_bed_between_walls():
    scene = build(experiment((50, "open"), **BED, **WALLS), 0.9, -0.5)
    assert scene.box == (None, None) and scene.extent == 50.0 and scene.effects.walls.width == 50.0
    assert scene.effects.floor[:4] == (5.0, 1.0, 1.0, -1.0)


def test_the_particles_own_material_at_a_boundary():
    own = {"restitution": "particles", "roughness": "particles"}
    effects = BED | {"floor": FLOOR["floor"] | own, "walls": own}
    scene = build(experiment((50, "open"), **effects), 0.9, -0.5)
    assert scene.effects.floor[2:4] == scene.effects.walls[1:] == (0.9, -0.5)


@pytest.mark.parametrize(("r", "present"), [(0.74, True), (0.75, False), (0.9, False)])
def test_the_contact_time_model_acts_below_an_r(r, present):
    model = {"contact_time": {"duration": 1e-5, "below_r": 0.75}}
    assert (build(experiment(**SPIN, **model), r, 0.0).effects.contact_time is not None) == present


ILLEGAL = {
    "effects.spin.inertia": [{"spin": {"inertia": q}} for q in (0, -1, 1.1, math.nan, "x", True)]
    + [{"spin": {}}],
    "effects.gravity.acceleration": [
        BED | {"gravity": {"acceleration": g}} for g in (0, -1, math.nan, math.inf, None)
    ],
    "effects.floor.amplitude": [
        BED | {"floor": FLOOR["floor"] | {"amplitude": A}} for A in (-1, math.inf, math.nan, 1e300)
    ],
    "effects.floor.period": [
        BED | {"floor": FLOOR["floor"] | {"period": P}} for P in (0, -1, 1e-300)
    ],
    "effects.floor: amplitude/period": [BED | {"floor": FLOOR["floor"] | {"period": 1e-5}}],
    "effects.left_wall: amplitude/period": [
        SPIN | {"left_wall": {"amplitude": 1, "period": 1e-5}, "right_wall": {}}
    ],
    "effects.shaken_walls: amplitude/period": [
        SPIN | {"shaken_walls": FLOOR["floor"] | {"amplitude": 1, "period": 1e-5}}
    ],
    "effects.left_wall.temperature": [SPIN | {"left_wall": {"temperature": 1e12}}],
    "effects.floor.restitution": [
        BED | {"floor": FLOOR["floor"] | {"restitution": r}} for r in (-0.1, 1.1, "own", math.nan)
    ],
    "effects.floor.roughness": [
        BED | {"floor": FLOOR["floor"] | {"roughness": b}} for b in (-1.1, 1.1)
    ],
    "effects.walls.restitution": [BED | {"walls": {"restitution": 2, "roughness": 0}}],
    "effects.walls.roughness": [BED | {"walls": {"restitution": 1, "roughness": -2}}],
    "effects.shear.velocity": [SPIN | {"shear": {"velocity": U}} for U in (0, -2, math.nan, 1e300)],
    "effects.friction.mu": [SPIN | {"friction": {"mu": mu}} for mu in (-0.1, math.inf, "rough")],
    "effects.thermostat.power": [
        SPIN | {"thermostat": HEAT["thermostat"] | {"power": p}} for p in (0, -1, math.nan, 1e300)
    ],
    "effects.thermostat.spin_share": [
        SPIN | {"thermostat": HEAT["thermostat"] | {"spin_share": s}} for s in (-0.1, 1.1, None)
    ],
    "effects.thermostat.interval": [
        SPIN | {"thermostat": HEAT["thermostat"] | {"interval": t}}
        for t in (0, -1, math.inf, 1e-300)
    ],
    "effects.friction: key": [SPIN | {"friction": {"mu": 1, "nu": 1}}],
    "effects.contact_time.duration": [
        SPIN | {"contact_time": {"duration": t}} for t in (0, -1e-5, math.nan)
    ],
    "effects.contact_time.below_r": [SPIN | {"contact_time": {"duration": 1, "below_r": 1.5}}],
    "effect": [SPIN | {"wind": {}}],
}


@pytest.mark.parametrize("key", ILLEGAL)
def test_illegal_effects(key):
    for effects in ILLEGAL[key]:
        box = (50, "open") if "floor" in effects else (50, 50)
        with pytest.raises(InputError) as caught:
            build(experiment(box, **effects), 0.9, 0.0)
        assert caught.value.key == key, effects
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("box", "effects", "key"),
    [
        ((4, 50), SPIN, "box[0]"),
        ((50, 1e300), SPIN, "box[1]"),
        ((50, 4), SPIN, "box[1]"),
        ((50, 50, 3.9), SPIN, "box[2]"),
        ((4.009, 50), SPIN, "box[0]"),
        ((2.009, "open"), BED | WALLS, "box[0]"),
        ((4.009, "open"), BED, "box[0]"),
        ((50, -50), SPIN, "box[1]"),
        ((math.nan, 50), SPIN, "box[0]"),
        ((math.inf, 50), SPIN, "box[0]"),
        (("open", 50), BED, "box"),
        (("open", "open"), BED, "box"),
        ((50, "open"), SPIN, "box"),
        ((50, 50), BED, "box"),
        ((50, "open"), SPIN | GRAVITY, "effects.gravity"),
        ((50, "open"), SPIN | FLOOR, "effects.floor"),
        ((50, 50), SPIN | WALLS | SHEAR, "effects"),
        ((50, "open"), BED | SHEAR, "effects.shear"),
    ],
)
def test_what_does_not_go_together(box, effects, key):
    with pytest.raises(InputError) as caught:
        build(experiment(box, **effects), 0.9, 0.0)
    assert caught.value.key == key and "\n" not in str(caught.value)


MISMATCHES = {
    # what: (box, effects, beta, schedule or target, the whole message)
    "walls and shear": (
        (50, 50),
        SPIN | WALLS | SHEAR,
        0.0,
        {},
        "effects = walls and shear: must not close the axis that is sheared along",
    ),
    "a floor without gravity": ((50, "open"), SPIN | FLOOR, 0.0, {}, "effects.floor needs gravity"),
    "gravity without a floor": (
        (50, "open"),
        SPIN | GRAVITY,
        0.0,
        {},
        "effects.gravity needs a floor",
    ),
    "friction without spin": ((50, 50), FRICTION, -1.0, {}, "effects.friction needs spin"),
    "heat for spins that are not there": (
        (50, 50),
        HEAT,
        -1.0,
        {},
        "effects.thermostat.spin_share = 0.5: must be 0 where nothing spins",
    ),
    "rough walls without spin": (
        (50, 50),
        WALLS,
        -1.0,
        {},
        "effects.walls.roughness = 1: must be -1 where particles do not spin",
    ),
    "a rough floor without spin": (
        (50, "open"),
        GRAVITY | {"floor": FLOOR["floor"] | {"roughness": 0.5}},
        -1.0,
        {},
        "effects.floor.roughness = 0.5: must be -1 where particles do not spin",
    ),
    "rough particles without spin": (
        (50, 50),
        {},
        0.5,
        {},
        "roughness beta = 0.5: must be -1 where particles do not spin",
    ),
    "a target without spin": (
        (50, 50),
        {},
        -1.0,
        {"schedule": {"target_stderr": 0.01}},
        "schedule.target_stderr = 0.01: must not be given where nothing spins",
    ),
}


@pytest.mark.parametrize("what", MISMATCHES)
def test_what_does_not_go_together_is_said_in_one_line(what):
    """By key, value and what is legal; what is built all the same is refused when checked."""
    box, effects, beta, settings, message = MISMATCHES[what]
    with pytest.raises(InputError) as caught:
        build(experiment(box, **effects), 0.9, beta)
        check(experiment(box, **effects) | settings)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("box", "effects", "settings"),
    [
        ((50, 50), {}, {}),
        ((50, 50), WALLS | {"walls": {"restitution": 1, "roughness": "particles"}}, {}),
        ((50, 50), {"thermostat": HEAT["thermostat"] | {"spin_share": 0}}, {}),
        ((50, 50), SPIN | HEAT | FRICTION | SHEAR, {}),
        ((50, 50), SPIN, {"schedule": {"target_stderr": 0.01}}),
        ((50, 50, "open"), BED | SHEAR | HEAT | FRICTION | TIME, {}),
        ((50, "open"), GRAVITY | FLOOR | TIME, {}),
    ],
)
def test_what_goes_together(box, effects, settings):
    check(experiment(box, **effects) | settings)


def test_too_many_particles_for_the_box():
    check(experiment((8.1, 8.1), 16, **SPIN))
    with pytest.raises(InputError) as caught:
        check(experiment((8.1, 8.1), 17, **SPIN))
    assert caught.value.key == "particles" and "16" in caught.value.legal


@pytest.mark.parametrize("effects", [SPIN, SPIN | SHEAR])
def test_one_particle_alone(effects):
    check(experiment((50, "open"), 1, **BED))
    with pytest.raises(InputError) as caught:
        check(experiment((50, 50), 1, **effects))
    assert caught.value.key == "particles" and "\n" not in str(caught.value)


def test_one_particle_has_nobody_to_be_kicked_with():
    check(experiment((50, "open"), 2, **BED, **HEAT))
    with pytest.raises(InputError, match="at least 2 where a thermostat kicks pairs"):
        check(experiment((50, "open"), 1, **BED, **HEAT))
