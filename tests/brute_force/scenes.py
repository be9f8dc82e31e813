"""The scenes that the kernel's tests run: few, since each compiles a kernel.

Tests switch effects off by numbers rather than by another scene: a contact time of 1e-300 never
acts.
"""

import functools

import numpy as np
from raw import build, initial_state
from slow_cases import slow_but

from brute_force.bodies import Mixture
from brute_force.sides import sides_of
from brute_force.world import World
from roughgas.kernel.loop import REACHED
from roughgas.kernel.record import Sampling, allocate_frames, columns, record

NOISE = "temperature", "power"
VANISHING_CONTACT_TIME = 1e-300
UNLIMITED = 2**60
PLAIN = record.py_func

_SUMS = {"contact_averages": {}}
_ALL_SUMS = _SUMS | {"contact_stress": {}, "contact_heat": {}, "contact_pairs": {}}
_IMPULSES = {"wall_impulses": {}}
_LOG = {"contact_log": {"most": 3000}}
_PATHS = {"paths": {}}
_DISKS = {"spin": {"inertia": 0.5}}
_BED = _DISKS | {
    "gravity": {"acceleration": 1.0},
    "floor": {"amplitude": 5.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0},
}
_FRICTION = {"friction": {"mu": 0.5}}
_HEAT = {"thermostat": {"power": 1.0, "spin_share": 0.5, "interval": 0.5}}
_BATH = {"interval": 0.5, "drag": 0.2, "temperature": 1.5, "spin_drag": 0.1, "spin_power": 0.3}
_TABLE = {"speed": [0.0, 0.5, 2.0, 5.0], "restitution": [1.0, 0.9, 0.8, 0.5], "reference": 1.0}
_POWER = {"speed": 2.0**0.5, "exponent": 0.75, "least": 0.7}  # of Bizon et al. (1998)
_RUBBER = {"restitution": 0.8, "roughness": 0.35}
_ROUGH = {"restitution": 1.0, "roughness": 1.0}
_NO_CONTACT_TIME = {"contact_time": {"duration": VANISHING_CONTACT_TIME}}
_SPHERES = {"spin": {"inertia": 0.4}}
_SINE = {"amplitude": 1.0, "period": 2.0, "wave": "sine"}
_SHAKEN = {"amplitude": 1, "period": 2, "restitution": 1, "roughness": 0.5}


def _kernel(box, *groups):
    """Settings of a scene with these groups of effects."""
    merged = {name: parameters for group in groups for name, parameters in group.items()}
    return {"particles": 160 if len(box) == 2 else 64, "box": box, "effects": merged}


KERNELS = {
    "gas": _kernel([100, 100], _DISKS),
    "smooth": _kernel([100, 100]),
    "sheared": _kernel([50, 50], _DISKS, _SUMS, {"shear": {"velocity": 2.0}}),
    "bed": _kernel([50, "open"], _BED, _SUMS),
    "walled": _kernel([50, "open"], _BED, {"walls": _ROUGH}, _NO_CONTACT_TIME, _LOG, _IMPULSES),
    "spheres": _kernel([12, 12, 12], _SPHERES, _NO_CONTACT_TIME, _ALL_SUMS, _LOG, _PATHS),
    "friction": _kernel([100, 100], _DISKS, _FRICTION),
    "rubbed bed": _kernel([50, "open"], _BED, {"walls": _ROUGH}, _FRICTION),
    "shaken": _kernel([50, 50], _DISKS, _SUMS, {"shaken_walls": _SHAKEN}, _PATHS),
    "heated": _kernel([100, 100], _DISKS, _HEAT, _ALL_SUMS, _LOG, _PATHS),
    "heated, smooth": _kernel(
        [100, 100], {"thermostat": _HEAT["thermostat"] | {"spin_share": 0.0}}
    ),
    "heated spheres": _kernel([12, 12, 12], _SPHERES, _HEAT, _FRICTION, _ALL_SUMS),
    "bath": _kernel([100, 100], _DISKS, {"langevin": _BATH}, _PATHS),
    "monolayer": _kernel([100, 100], _DISKS, {"delta": {"speed": 0.5}}, _FRICTION),
    "chute": _kernel(
        [50, "open"],
        _BED,
        {"gravity": {"acceleration": 1.0, "direction": [0.5, -1.0]}},
        {"floor": _SINE | {"restitution": 0.9, "roughness": 0.5}},
    ),
    "viscoelastic": _kernel(
        [100, 100],
        _DISKS,
        {"viscoelastic": {"speed": 1.0}, "threshold": {"speed": 1e-3, "restitution": 1.0}},
    ),
    "container": _kernel(
        [50, 50],
        _DISKS,
        {"left_wall": {"temperature": 2.0, "velocity": 0.7}},
        {"right_wall": {"restitution": 0.9, "roughness": 0.5}},
        {"bottom_wall": {"velocity": -1.0, "roughness": 0.8}, "lid": _SINE | {"roughness": 0.3}},
        _PATHS,
        _IMPULSES,
    ),
    "closed spheres": _kernel(
        [12, 12, 12],
        _SPHERES,
        {"front_wall": {"temperature": 2.0, "velocity": -0.5}},
        {"back_wall": {"velocity": 1.0, "roughness": 0.5}, "bottom_wall": {"restitution": 0.9}},
        {"lid": _SINE | {"shaken": "along", "roughness": 0.4}},
        _IMPULSES,
    ),
    "layer": _kernel(
        [12, 12, "open"],
        _SPHERES,
        {"gravity": {"acceleration": 1.0}, "floor": _SINE | _RUBBER},
        {side: _RUBBER for side in ("left_wall", "right_wall", "front_wall", "back_wall")},
        _FRICTION,
        {"power_law": _POWER},
        _IMPULSES,
    ),
    "tabulated bed": _kernel([50, "open"], _BED, {"restitution_table": _TABLE}),
}


RARE = (
    *("rubbed bed", "heated, smooth", "heated spheres", "tabulated bed", "closed spheres"),
    *("friction", "shaken", "viscoelastic"),
)
"""Kernels that only slow tests compile: their effects act in other kernels as well."""


def kernels(*names):
    """Names of kernels (by default of all) as parameters of a test; RARE ones are marked slow."""
    return slow_but(KERNELS.keys() - RARE, names or KERNELS)


def settings(kernel, particles=None, box=None, **effects):
    """Settings of a kernel of KERNELS with other numbers, such as floor={"amplitude": 2}."""
    kernel_settings = KERNELS[kernel]
    changed_effects = {
        name: parameters | effects.get(name, {})
        for name, parameters in kernel_settings["effects"].items()
    }
    return {
        "particles": particles or kernel_settings["particles"],
        "box": box or kernel_settings["box"],
        "effects": changed_effects,
    }


def scene_of(experiment, r, beta):
    """(Scene of the kernel, World of the brute force) of the same experiment."""
    effects = experiment["effects"]
    periods = [None if side == "open" else float(side) for side in experiment["box"]]
    floor, shaken = effects.get("floor"), effects.get("shaken_walls")
    if "thermal_floor" in effects:  # the floor itself is never met
        floor = None
    bath = effects.get("langevin")
    noisy = bath and any(
        bath.get(f"{prefix}{quantity}") for prefix in ("", "spin_") for quantity in NOISE
    )
    table, power, threshold, roughness = (
        effects.get(name)
        for name in ("restitution_table", "power_law", "threshold", "roughness_law")
    )
    walls = effects.get("walls", shaken)
    if walls:
        width, periods[0] = periods[0], None
    sides = sides_of(effects, experiment["box"])
    for side in sides:
        periods[side.axis] = None
    world = World(
        box=tuple(periods),
        r=r,
        beta=beta,
        q=effects["spin"]["inertia"] if "spin" in effects else None,
        mu=effects.get("friction", {}).get("mu"),
        thermostat=effects.get("thermostat", effects.get("speed_kicks")),
        delta=effects.get("delta", {}).get("speed", 0.0),
        bath=bath and bath | {"noise": noisy} | medium(experiment),
        acceleration=acceleration_of(effects.get("gravity"), len(periods)),
        floor=floor
        and (floor["amplitude"], floor["period"], floor["restitution"], floor["roughness"]),
        walls=walls and (width, walls["restitution"], walls["roughness"]),
        shaken=shaken and (shaken["amplitude"], shaken["period"]),
        shear=effects.get("shear", {}).get("velocity", 0.0),
        contact_time=effects.get("contact_time", {}).get("duration", 0.0),
        wave=(floor or {}).get("wave", "sawtooth"),
        mixture=Mixture(experiment["species"], experiment.get("species_pairs", []))
        if "species" in experiment
        else None,
        sides=sides,
        viscous=effects.get("viscoelastic", {}).get("speed", 0.0),
        table=table and (table["speed"], table["restitution"], table["reference"]),
        power=power and (power["speed"], power["exponent"], power["least"]),
        roughness_power=roughness and (roughness["speed"], roughness["exponent"]),
        threshold=threshold and (threshold["speed"], threshold["restitution"]),
    )
    return build(experiment, r, beta), world


def acceleration_of(gravity, dimension):
    """Acceleration along each axis by the settings of gravity; empty for None."""
    if gravity is None:
        return ()
    direction = np.array(gravity.get("direction", [0.0] * (dimension - 1) + [-1.0]), float)
    return tuple(gravity["acceleration"] * direction / np.sqrt(direction @ direction))


def medium(experiment):
    """Motion of a bath's medium: how fast its top moves over its bottom, its height, its spins."""
    effects, height = experiment["effects"], experiment["box"][1]
    speed = effects.get("shear", {}).get("velocity", 0.0)
    vorticity = -speed / height / 2.0 if speed else 0.0
    common = effects["langevin"].get("spin_velocity", vorticity)
    spins = [kind.get("spin_velocity", common) for kind in experiment.get("species", [{}])]
    return {"shear": speed, "height": height, "spin_velocities": spins}


def begin(experiment, r, beta, seed=0):
    """A scene and its initial state."""
    scene = build(experiment, r, beta)
    return scene, initial_state(scene, experiment, np.random.default_rng(seed))


def run(state, scene, samples, interval=np.inf, collisions=UNLIMITED, refresh=0, kernel=record):
    """Advance the kernel and return the sampled columns by name. Fails if the gas collapses.

    With the kernel `PLAIN`, plain Python, nothing is compiled: for a few events only.
    """
    names = _columns(scene)
    rows = np.empty((samples, len(names)))
    sampling = Sampling(float(interval), collisions, refresh)
    with np.errstate(all="ignore"):  # infinite times, in plain Python
        ended = kernel(state, scene, sampling, rows, allocate_frames(state, 0))
    assert ended == (REACHED, samples)
    return dict(zip(names, rows.T, strict=True))


def refresh(state, scene):
    """Refresh a cooling gas at the present instant: rescale its velocities."""
    run(state, scene, 1, collisions=0, refresh=1)


@functools.cache
def _columns(scene):
    """Names of the sampled columns of a scene."""
    return columns(scene)
