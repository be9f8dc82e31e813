"""Every scene, collision by collision, against the brute-force simulation."""

import pytest
from brute_force import (
    KERNELS,
    BruteForce,
    Comparison,
    begin,
    compare,
    scene_of,
    settings,
    snapshot,
)
from brute_force import run as run_kernel
from slow_cases import slow_but

from roughgas.kernel.state import ALTERED_RESTITUTIONS

WAVES = ("reversed_sawtooth", "triangle", "sine")
ROUGH = {"restitution": 0.9, "roughness": 0.5}
SHAKEN = {"amplitude": 1.0, "period": 1.7}
FLOORS = {
    "elastic": ({}, 0.8, 0.2),
    "inelastic and rough": ({"restitution": 0.8, "roughness": 0.5}, 0.9, -0.5),
    "small strokes": ({"amplitude": 0.3, "period": 0.2}, 0.7, 0.2),
}
THREE_SPECIES = [
    {"name": "small", "fraction": 0.5, "radius": 0.7, "restitution": 0.95},
    {"name": "large", "fraction": 0.25, "radius": 1.5, "mass": 7.0, "roughness": 0.6},
    {"fraction": 0.25, "mass": 0.01, "inertia": 0.2},
]
PAIRS = [{"between": ["small", 2], "restitution": 0.8, "roughness": -0.3}]
THREE_WITH_FRICTION = [kind | {"mu": 0.1 * (k + 1)} for k, kind in enumerate(THREE_SPECIES)]
SMOOTH_SPECIES = [{"fraction": 0.5, "radius": 0.5}, {"fraction": 0.5, "radius": 1.5}]
TWO_SPECIES = [
    {"fraction": 0.5},
    {"fraction": 0.5, "radius": 1.5, "mass": 5.0, "inertia": 0.25, "roughness": -0.5},
]
PISTONS = {
    "spin": {"inertia": 0.5},
    "bottom_wall": SHAKEN | {"restitution": 0.9},
    "lid": SHAKEN | {"wave": "triangle", "period": 1.0},
}
SPIN_DRAG = {"interval": 5.0, "drag": 0.0, "temperature": 0.0, "spin_drag": 0.2}
SLOW = {"speed": 0.2, "restitution": 1.0}
MONOLAYER = {"delta": {"speed": 0.3}, "threshold": SLOW}
DRAG = {"interval": 10.0, "drag": 0.001, "spin_drag": 0.002}
SPINNERS = {"interval": 2.0, "drag": 0.01, "spin_drag": 0.1, "spin_velocity": 3.0}
AGITATED = SPINNERS | {"temperature": 1.0, "spin_temperature": 0.5, "spin_axis": "x"}
FLOWING = {
    "spin": {"inertia": 0.5},
    "shear": {"velocity": 2.0},
    "langevin": {"interval": 0.5, "drag": 0.2, "temperature": 1.0, "spin_drag": 0.3},
}
SWIFT = {"shear": {"velocity": 50.0}, "langevin": {"interval": 0.1, "drag": 0.5, "spin_drag": 0.3}}
COUNTER_ROTATING = [
    kind | {"spin_velocity": velocity}
    for kind, velocity in zip(THREE_SPECIES[:2], (-2.0, 5.0), strict=True)
] + THREE_SPECIES[2:]
BED = {name: KERNELS["bed"]["effects"][name] for name in ("spin", "gravity")} | {
    "floor": {"amplitude": 1.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0}
}
UNDER_A_LID = BED | {
    "lid": {"temperature": 3.0},
    "left_wall": {"velocity": 2.0, "roughness": 0.4},
    "right_wall": {"shaken": "along", "wave": "triangle", "roughness": 0.4} | SHAKEN,
}


def of_species(kernel, particles, box, species=THREE_SPECIES, pairs=PAIRS, **effects):
    """Settings of a kernel with particles of several species."""
    mixture = {"species": species, "species_pairs": pairs}
    return settings(kernel, particles, box, **effects) | mixture


def heated(kernel, particles, box, **thermostat):
    """Settings of a kernel with other parameters of its thermostat."""
    return settings(kernel, particles, box, thermostat=thermostat)


def bed(particles, width, **floor):
    """Settings of a bed with other parameters of its floor."""
    return settings("bed", particles, [width, "open"], floor=floor)


def closed(effects, box):
    """Settings of 12 particles with these effects."""
    return {"particles": 12, "box": box, "effects": effects}


def between_walls(kernel, walls, **effects):
    """Settings of 16 particles on a rough floor, between side walls."""
    return settings(kernel, 16, [12, "open"], walls=walls, floor=ROUGH, **effects)


SLOW_CONTACTS = {"viscoelastic": {"speed": 50.0}, "threshold": {"speed": 0.2}}
CONTACT_TIME = {"contact_time": {"duration": 0.05}}
TILTED = BED | {"gravity": {"acceleration": 1.0, "direction": [-0.5, -1.0]}}
WALLS = {"walls": {"restitution": 0.8, "roughness": 0.3}}
SIDES = {
    "left_wall": {"restitution": 0.8, "roughness": 0.3},
    "right_wall": {"temperature": 2.0},
}
CHANNEL = {
    "spin": {"inertia": 0.5},
    "gravity": {"acceleration": 0.5, "direction": [1.0, 0.0]},
    "bottom_wall": {"restitution": 0.8, "roughness": 0.5},
    "lid": {"temperature": 2.0},
}
FALLING = {"spin": {"inertia": 0.4}, "gravity": {"acceleration": 0.03, "direction": [1, -2, 2]}}
CASES = {  # experiment, r, beta, seed
    "gas": (settings("gas", 8, [12, 12]), 0.98, 0.2, 1),
    "smallest box": (settings("gas", 3, [4.01, 8.0]), 0.99, 0.5, 2),
    "dense gas": (settings("gas", 12, [8.5, 8.5]), 0.98, -0.6, 3),
    "dilute gas": (settings("gas", 16, [90, 110]), 1.0, 1.0, 4),
    "smooth gas": (settings("smooth", 8, [12, 12]), 0.98, -1.0, 5),
    "sheared": (settings("sheared", 8, [12, 12]), 0.9, 0.2, 6),
    "fast shear": (settings("sheared", 6, [9, 11], shear={"velocity": 50.0}), 0.9, 0.2, 7),
    "slow gas, fast shear": (settings("sheared", 5, [9, 7], shear={"velocity": 2e3}), 0.5, 1.0, 8),
    "sawtooth, elastic": (bed(16, 10), 0.8, 0.2, 9),
    "sawtooth, inelastic and rough": (
        bed(16, 10, **FLOORS["inelastic and rough"][0]),
        0.9,
        -0.5,
        10,
    ),
    "sawtooth, small strokes": (bed(12, 9, amplitude=0.3, period=0.2), 0.7, 0.2, 11),
    **{
        f"{wave}, {name}": (bed(16, 10, wave=wave, **floor), r, beta, 9)
        for name, (floor, r, beta) in FLOORS.items()
        for wave in WAVES
    },
    "bed between rough walls": (settings("walled", 16, [12, "open"]), 0.8, 0.2, 12),
    "bed between walls, contact time": (
        between_walls("walled", {"restitution": 0.7, "roughness": -0.4}, **CONTACT_TIME),
        *(0.7, 0.2, 13),
    ),
    "gas between shaken walls": (
        settings("shaken", 12, [12, 12], shaken_walls={"restitution": 0.9, "amplitude": 0.5}),
        *(0.95, 0.2, 16),
    ),
    "viscoelastic gas": (settings("viscoelastic", 8, [12, 12]), 0.9, 0.2, 19),
    "slow viscoelastic gas": (settings("viscoelastic", 8, [12, 12], **SLOW_CONTACTS), 0.6, 0.2, 20),
    "tabulated bed": (settings("tabulated bed", 16, [10, "open"], floor=ROUGH), 0.85, 0.2, 21),
    "layer": (settings("layer", 24, [8, 9, "open"]), 0.7, 0.35, 22),
    "layer, another power": (
        settings("layer", 24, [8, 9, "open"], power_law={"speed": 8.0, "exponent": 1.75}),
        *(0.8, 0.35, 23),
    ),
    "spheres": (settings("spheres", 8, [7, 7, 7]), 0.98, 0.2, 14),
    "sheared spheres": (settings("sheared", 8, [8, 7, 9], spin={"inertia": 0.4}), 0.9, 0.2, 17),
    "bed of spheres": (settings("bed", 16, [7, 8, "open"], spin={"inertia": 0.4}), 0.8, 0.2, 18),
    "spheres, contact time": (
        settings("spheres", 12, [7, 8, 6.5], contact_time={"duration": 0.1}),
        *(0.9, -0.7, 15),
    ),
    "friction": (settings("friction", 8, [12, 12], friction={"mu": 0.3}), 0.98, 0.8, 1),
    "hardly any friction": (settings("friction", 8, [12, 12], friction={"mu": 0.02}), 0.9, 1, 2),
    "friction of spheres": (
        settings("heated spheres", 8, [7, 7, 7], friction={"mu": 0.2}),
        *(0.98, 0.5, 3),
    ),
    "friction of floor and walls": (
        between_walls("rubbed bed", {"restitution": 0.8, "roughness": 0.4}, friction={"mu": 0.25}),
        *(0.85, 0.6, 4),
    ),
    "kicks": (heated("heated", 8, [12, 12]), 0.9, 0.4, 1),
    "kicks of translation": (heated("heated", 8, [12, 12], spin_share=0.0), 0.98, -0.5, 2),
    "kicks of spins": (heated("heated", 8, [12, 12], spin_share=1.0, interval=0.3), 0.9, 1.0, 3),
    "hard kicks": (heated("heated", 6, [9, 11], power=1e4, interval=2.0), 0.8, 0.2, 4),
    "kicks of a pair": (heated("heated", 2, [9, 9]), 0.9, 0.2, 5),
    "kicks, no spin": (heated("heated, smooth", 8, [12, 12]), 0.95, -1.0, 6),
    "kicks of spheres": (heated("heated spheres", 8, [7, 7, 7], spin_share=0.3), 0.9, 0.5, 7),
    "bath": (settings("bath", 8, [12, 12]), 0.9, 0.4, 1),
    "bath of spins": (
        settings("bath", 8, [12, 12], langevin=SPIN_DRAG),
        *(0.98, -0.5, 2),
    ),
    "species, bath": (of_species("bath", 12, [16, 16]), 0.9, 0.2, 17),
    "monolayer": (settings("monolayer", 8, [12, 12]), 0.9, 0.4, 1),
    "species, monolayer": (of_species("monolayer", 12, [16, 16]), 0.9, 0.2, 17),
    "monolayer of smooth spheres": (closed(MONOLAYER, [8, 7, 9]), 0.8, -1.0, 3),
    "drag": (closed({"spin": {"inertia": 0.5}, "langevin": DRAG}, [14, 16]), 1.0, 0.9, 1),
    "spinners": (closed({"spin": {"inertia": 0.5}, "langevin": SPINNERS}, [14, 16]), 0.98, 0.2, 1),
    "spheres that spin about x": (
        closed({"spin": {"inertia": 0.4}, "langevin": AGITATED}, [8, 7, 9]),
        *(0.98, 0.2, 1),
    ),
    "species, spinners": (
        closed({"spin": {"inertia": 0.5}, "langevin": SPINNERS}, [16, 16])
        | {"species": COUNTER_ROTATING, "species_pairs": PAIRS},
        *(0.98, 0.2, 2),
    ),
    "bath that flows": (closed(FLOWING, [12, 12]), 0.9, 0.2, 6),
    "spheres, bath that flows": (closed(FLOWING, [8, 7, 9]), 0.9, 0.2, 17),
    "drag by a fast flow": (closed(FLOWING | SWIFT, [9, 11]), 0.9, 0.2, 7),
    "species, bath that flows": (
        closed(FLOWING, [16, 16]) | {"species": COUNTER_ROTATING, "species_pairs": PAIRS},
        *(0.9, 0.2, 6),
    ),
    "species": (of_species("gas", 8, [14, 14]), 0.98, 0.2, 1),
    "species, smallest box": (of_species("gas", 3, [6.02, 9.0]), 0.99, 0.5, 2),
    "species, smooth": (of_species("smooth", 8, [14, 14], SMOOTH_SPECIES, []), 0.98, -1.0, 5),
    "species, sheared": (of_species("sheared", 8, [14, 14]), 0.9, 0.2, 6),
    "species, bed": (of_species("bed", 16, [12, "open"]), 0.8, 0.2, 9),
    "species, bed between walls, friction": (
        of_species(
            "rubbed bed",
            16,
            [14, "open"],
            THREE_WITH_FRICTION,
            [*PAIRS, {"between": [0, 1], "mu": 0.4}],
        ),
        *(0.8, 0.2, 12),
    ),
    "species, shaken walls": (of_species("shaken", 12, [14, 14]), 0.95, 0.2, 17),
    "species, kicks": (of_species("heated", 12, [16, 16]), 0.9, 0.2, 17),
    "species, spheres": (of_species("spheres", 12, [9, 9, 9], **CONTACT_TIME), 0.95, 0.2, 14),
    "container": (settings("container", 12, [12, 14]), 0.95, 0.2, 1),
    "pistons": (closed(PISTONS, [14, 16]), 0.95, 0.2, 1),
    "under a thermal lid": (closed(UNDER_A_LID, [14, 16]), 0.95, 0.2, 1),
    "under an inelastic lid": (
        closed(BED | {"lid": {"restitution": 0.8, "roughness": 0.3}}, [14, 12]),
        *(0.95, 0.2, 1),
    ),
    "species, container": (
        settings("container", 12, [14, 16]) | {"species": TWO_SPECIES},
        0.95,
        0.2,
        1,
    ),
    "chute": (settings("chute", 12, [12, "open"]), 0.9, 0.2, 1),
    "species, chute": (of_species("chute", 12, [14, "open"]), 0.9, 0.2, 2),
    "tilted bed": (closed(TILTED | SIDES, [12, "open"]), 0.9, 0.2, 1),
    "tilted bed between equal walls": (closed(TILTED | WALLS, [12, "open"]), 0.9, 0.2, 1),
    "channel": (closed(CHANNEL, [12, 14]), 0.95, 0.2, 1),
    "falling spheres": (closed(FALLING, [8, 9, 10]), 0.95, 0.2, 1),
    "closed spheres": (settings("closed spheres", 12, [8, 9, 10]), 0.95, 0.2, 1),
}
RARE = {"sheared spheres", "bed of spheres", "tabulated bed", "friction of spheres"}
RARE |= {"friction of floor and walls", "kicks, no spin", "kicks of spheres", "pistons"}
RARE |= {"layer, another power", "friction", "hardly any friction", "gas between shaken walls"}
RARE |= {"viscoelastic gas", "slow viscoelastic gas"}
RARE |= {"under a thermal lid", "under an inelastic lid", "species, container", "closed spheres"}
RARE |= {"species, bed", "species, smallest box", "species, smooth", "species, sheared"}
RARE |= {"species, shaken walls", "species, spheres", "species, bath", "species, kicks", "drag"}
RARE |= {"species, monolayer", "monolayer of smooth spheres", "species, chute", "tilted bed"}
RARE |= {"tilted bed between equal walls", "channel", "falling spheres"}
RARE |= {"spinners", "spheres that spin about x", "species, spinners"}
RARE |= {"bath that flows", "drag by a fast flow", "species, bath that flows"}
RARE |= {"spheres, bath that flows"}
RARE |= {
    "species, bed between walls, friction",
    *(f"{wave}, {floor}" for floor in FLOORS for wave in WAVES),
}
"""Cases whose kernels no other test compiles, and cases of a law with other constants."""
SEGMENTS = 25


@pytest.mark.parametrize("case", slow_but(CASES.keys() - RARE, CASES))
def test_the_kernel_makes_the_same_collisions(case):
    """The same 250 pairs in the same order, from a common state every ten collisions, with the same
    kicks and random numbers between them; each boundary is hit."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    comparison = Comparison(state, scene, world)
    collisions = 10 if len(state.changes) > 2 else 2  # chaos grows faster in small gases
    comparison.assert_same(SEGMENTS, collisions)
    required_events = {"floor"} if world.floor else set()
    required_events |= ({"left", "right"} if world.walls else set()) | {
        side.name for side in world.sides
    }
    required_events |= {"kick"} if world.thermostat or world.bath else set()
    assert all(comparison.events[name] > 5 for name in required_events), comparison.events
    if world.contact_time > 1e-3:
        assert 0 < state.counts[ALTERED_RESTITUTIONS] < 0.9 * SEGMENTS * collisions


@pytest.mark.parametrize("case", ["gas", "sheared", "bed between rough walls", "spheres"])
def test_states_between_collisions_are_those_of_brute_force(case):
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    shot = snapshot(state, scene)
    brute = BruteForce(world, shot.position, shot.velocity, shot.spin)
    for k in range(1, 9):
        row = run_kernel(state, scene, 1, interval=0.125)
        brute.run_until(0.125 * k)
        assert row["time"] == pytest.approx(0.125 * k, abs=1e-15)
        assert compare(snapshot(state, scene), brute) < 1e-9
        middle = scene.middle
        assert row["y"] == pytest.approx((brute.x[:, 1] - middle).sum(), rel=1e-9, abs=1e-9)
        assert row["yy"] == pytest.approx(((brute.x[:, 1] - middle) ** 2).sum(), rel=1e-9)
        shear_flow = ((brute.x[:, 1] - middle) * brute.v[:, 0]).sum()
        assert row["yv_x"] == pytest.approx(shear_flow, rel=1e-9, abs=1e-8)
        for axis, name in enumerate("xyz"[: len(scene.box)]):
            assert row[f"vv_{name}"] == pytest.approx((brute.v[:, axis] ** 2).sum(), rel=1e-9)
            assert row[f"p_{name}"] == pytest.approx(brute.v[:, axis].sum(), abs=1e-8)
        assert row["ww"] == pytest.approx((brute.w**2).sum(), rel=1e-9, abs=1e-12)
