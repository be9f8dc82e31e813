"""The scenes that the kernel's tests run: few, since each is compiled on its own.

What a scene does without can be had by its numbers: a contact time of 1e-300 never acts.
"""

import functools

import numpy as np
import pytest

from brute_force.company import Contents
from brute_force.sides import sides_of
from brute_force.world import World
from roughgas.kernel.loop import REACHED
from roughgas.kernel.record import Sampling, columns, record
from roughgas.scene import build
from roughgas.scene.initial import initial_state

NEVER = 1e-300  # a contact time
UNLIMITED = 2**60

_SUMS = {"contact_averages": {}}
_ALL_SUMS = _SUMS | {"contact_stress": {}}
_DISKS = {"spin": {"inertia": 0.5}}
_BED = _DISKS | {
    "gravity": {"acceleration": 1.0},
    "floor": {"amplitude": 5.0, "period": 1.0, "restitution": 1.0, "roughness": -1.0},
}
_FRICTION = {"friction": {"mu": 0.5}}
_HEAT = {"thermostat": {"power": 1.0, "spin_share": 0.5, "interval": 0.5}}
_TABLE = {"speed": [0.0, 0.5, 2.0, 5.0], "restitution": [1.0, 0.9, 0.8, 0.5], "reference": 1.0}
KERNELS = {
    "gas": {"particles": 160, "box": [100, 100], "effects": _DISKS},
    "smooth": {"particles": 160, "box": [100, 100], "effects": {}},
    "sheared": {
        "particles": 160,
        "box": [50, 50],
        "effects": _DISKS | _SUMS | {"shear": {"velocity": 2.0}},
    },
    "bed": {"particles": 160, "box": [50, "open"], "effects": _BED | _SUMS},
    "walled": {
        "particles": 160,
        "box": [50, "open"],
        "effects": _BED
        | {"walls": {"restitution": 1.0, "roughness": 1.0}, "contact_time": {"duration": NEVER}},
    },
    "spheres": {
        "particles": 64,
        "box": [12, 12, 12],
        "effects": {"spin": {"inertia": 0.4}, "contact_time": {"duration": NEVER}} | _ALL_SUMS,
    },
    "friction": {"particles": 160, "box": [100, 100], "effects": _DISKS | _FRICTION},
    "rubbed bed": {
        "particles": 160,
        "box": [50, "open"],
        "effects": _BED | {"walls": {"restitution": 1.0, "roughness": 1.0}} | _FRICTION,
    },
    "shaken": {
        "particles": 160,
        "box": [50, 50],
        "effects": _DISKS
        | _SUMS
        | {"shaken_walls": {"amplitude": 1, "period": 2, "restitution": 1, "roughness": 0.5}},
    },
    "heated": {"particles": 160, "box": [100, 100], "effects": _DISKS | _HEAT | _SUMS},
    "heated, smooth": {
        "particles": 160,
        "box": [100, 100],
        "effects": {"thermostat": _HEAT["thermostat"] | {"spin_share": 0.0}},
    },
    "heated spheres": {
        "particles": 64,
        "box": [12, 12, 12],
        "effects": {"spin": {"inertia": 0.4}} | _HEAT | _FRICTION | _ALL_SUMS,
    },
    "viscoelastic": {
        "particles": 160,
        "box": [100, 100],
        "effects": _DISKS
        | {"viscoelastic": {"speed": 1.0}, "threshold": {"speed": 1e-3, "restitution": 1.0}},
    },
    "container": {
        "particles": 160,
        "box": [50, 50],
        "effects": _DISKS
        | {
            "left_wall": {"temperature": 2.0, "velocity": 0.7},
            "right_wall": {"restitution": 0.9, "roughness": 0.5},
            "bottom_wall": {"velocity": -1.0, "roughness": 0.8},
            "lid": {"amplitude": 1.0, "period": 2.0, "wave": "sine", "roughness": 0.3},
        },
    },
    "closed spheres": {
        "particles": 64,
        "box": [12, 12, 12],
        "effects": {
            "spin": {"inertia": 0.4},
            "front_wall": {"temperature": 2.0, "velocity": -0.5},
            "back_wall": {"velocity": 1.0, "roughness": 0.5},
            "bottom_wall": {"restitution": 0.9},
            "lid": {
                "amplitude": 1.0,
                "period": 2.0,
                "wave": "sine",
                "shaken": "along",
                "roughness": 0.4,
            },
        },
    },
    "tabulated bed": {
        "particles": 160,
        "box": [50, "open"],
        "effects": _BED | {"restitution_table": _TABLE},
    },
}


RARE = ("rubbed bed", "heated, smooth", "heated spheres", "tabulated bed", "closed spheres")
"""Kernels that only tests marked as slow compile: in others, each effect of theirs acts as well."""


def kernels(*names):
    """Names of kernels, by default of all, as parameters of a test; rare ones are slow."""
    names = names or KERNELS
    return [pytest.param(n, marks=[pytest.mark.slow] * (n in RARE)) for n in names]


def settings(kernel, particles=None, box=None, **effects):
    """Settings of one of KERNELS with other numbers, such as floor={"amplitude": 2}."""
    chosen = KERNELS[kernel]
    changed = {name: own | effects.get(name, {}) for name, own in chosen["effects"].items()}
    return {
        "particles": particles or chosen["particles"],
        "box": box or chosen["box"],
        "effects": changed,
    }


def scene_of(experiment, r, beta):
    """(kernel's scene, brute force's world) of the same experiment."""
    effects = experiment["effects"]
    periods = [None if side == "open" else float(side) for side in experiment["box"]]
    floor, heat, shaken = (effects.get(name) for name in ("floor", "thermostat", "shaken_walls"))
    table, threshold = (effects.get(name) for name in ("restitution_table", "threshold"))
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
        thermostat=heat and (heat["power"], heat["spin_share"], heat["interval"]),
        gravity=effects.get("gravity", {}).get("acceleration", 0.0),
        floor=floor
        and (floor["amplitude"], floor["period"], floor["restitution"], floor["roughness"]),
        walls=walls and (width, walls["restitution"], walls["roughness"]),
        shaken=shaken and (shaken["amplitude"], shaken["period"]),
        shear=effects.get("shear", {}).get("velocity", 0.0),
        contact_time=effects.get("contact_time", {}).get("duration", 0.0),
        wave=(floor or {}).get("wave", "sawtooth"),
        contents=Contents(experiment["species"], experiment.get("species_pairs", []))
        if "species" in experiment
        else None,
        sides=sides,
        viscous=effects.get("viscoelastic", {}).get("speed", 0.0),
        table=table and (table["speed"], table["restitution"], table["reference"]),
        threshold=threshold and (threshold["speed"], threshold["restitution"]),
    )
    return build(experiment, r, beta), world


def begin(experiment, r, beta, seed=0):
    """A scene and its initial state."""
    scene = build(experiment, r, beta)
    return scene, initial_state(scene, experiment, np.random.default_rng(seed))


def run(state, scene, samples, interval=np.inf, collisions=UNLIMITED, refresh=0):
    """Advance the kernel; columns by name. Fails where the gas collapses."""
    names = _columns(scene)
    rows = np.empty((samples, len(names)))
    ended = record(state, scene, Sampling(float(interval), collisions, refresh), rows)
    assert ended == (REACHED, samples)
    return dict(zip(names, rows.T, strict=True))


@functools.cache
def _columns(scene):
    return columns(scene)
