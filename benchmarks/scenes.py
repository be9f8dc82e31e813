"""The scenes that are timed: those of the paper at any number of particles, in a steady state.

Density, shear rate and height of the bed are those of config.yaml. The cooling gas is timed as a
smooth elastic one, which is as dense everywhere at any size: with dissipation a large one would
form clusters. The driven ones have r = 0.9, beta = 0.
"""

import copy
import functools
from pathlib import Path
from typing import NamedTuple

import numpy as np

from roughgas import config
from roughgas.kernel.memory import new_state
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.state import NOW
from roughgas.scene import build
from roughgas.scene.initial import initial_state

ROOT = Path(__file__).parent.parent
CONFIGURATION, DOCS = ROOT / "config.yaml", ROOT / "docs"
SETTLING = 500  # T, a whole number of the floor's strokes, and of boxes that the images slide by
COPIES = {10_000: 5, 100_000: 10, 1_000_000: 50}  # of a smaller box, along each side
KICK = 0.1  # relative change of a velocity that makes the copies go different ways
UNLIMITED = 2**60


class Case(NamedTuple):
    """A scene at any number of particles."""

    title: str
    experiment: str  # of config.yaml
    r: float
    beta: float
    size: float = 1.0  # lengths are those of the experiment times this


CASES = (
    Case("cooling, packing 0.05", "cooling", 1.0, -1.0),
    Case("cooling, packing 0.2", "cooling", 1.0, -1.0, 0.5),
    Case("sheared", "sheared", 0.9, 0.0),
    Case("vibrated", "vibrated", 0.9, 0.0),
)


def settings(case: Case, number: int) -> dict:
    """The experiment's settings with so many particles; a box with an open top grows in width."""
    chosen = copy.deepcopy(config.experiment(_configuration(), case.experiment, "paper"))
    growth = number / chosen["particles"]
    if "open" in chosen["box"]:
        factors = [case.size * growth, None]
    else:
        factors = [case.size * growth ** (1 / len(chosen["box"]))] * len(chosen["box"])
    sides = zip(chosen["box"], factors, strict=True)
    box = [side if factor is None else side * factor for side, factor in sides]
    if "shear" in chosen["effects"]:  # the same shear rate
        chosen["effects"]["shear"]["velocity"] *= factors[1]
    return chosen | {"particles": number, "box": box}


@functools.cache
def _configuration():
    return config.load(CONFIGURATION)


def steady(case: Case, number: int):
    """(scene, state) in the steady state; a large one is made of copies of a smaller one."""
    experiment = settings(case, number)
    scene, rng = build(experiment, case.r, case.beta), np.random.default_rng(1)
    copies = COPIES.get(number)
    if copies is None:
        state = initial_state(scene, experiment, rng)
        advance(scene, state, time=SETTLING)
    else:
        state = new_state(scene, *_copied(*steady(case, number // copies**2), copies, rng))
    return scene, state


def advance(scene, state, time=np.inf, collisions=UNLIMITED):
    """Run for so long, or for so many collisions, whichever comes first."""
    row = np.empty((1, len(columns(scene))))
    record(state, scene, Sampling(float(time), collisions, 0), row)


def _copied(scene, state, copies, rng):
    """Positions, velocities and spins of copies x copies boxes; open ones all stand in a row."""
    position, velocity, spin = present(scene, state)
    across, up = (copies**2, 1) if scene.box[1] is None else (copies, copies)
    place = np.stack(np.meshgrid(np.arange(across), np.arange(up)), axis=-1).reshape(-1, 1, 2)
    position = position + place * np.array([length or 0.0 for length in scene.box])
    velocity = np.broadcast_to(velocity, position.shape).copy()
    if scene.effects.shear is not None:
        velocity[..., 0] += scene.effects.shear.velocity * (place[..., 1] - (up - 1) / 2)
    velocity[..., 1] *= 1 + KICK * rng.standard_normal(velocity.shape[:2])
    return position.reshape(-1, 2), velocity.reshape(-1, 2), np.tile(spin, (across * up, 1))


def present(scene, state):
    """(positions in the box, velocities, spins), all at the present, when no image has slid."""
    since = (state.clock[NOW] - state.trajectory[:, -1])[:, None]
    position, velocity = np.hsplit(state.trajectory[:, :-1], 2)
    fall = np.zeros(len(scene.box))
    fall[-1] = 0.0 if scene.effects.gravity is None else scene.effects.gravity.acceleration
    position = position + velocity * since - 0.5 * fall * since**2
    velocity = velocity - fall * since
    periods = np.array([length or 1.0 for length in scene.box])
    beyond = np.floor(position / periods) * [length is not None for length in scene.box]
    if scene.effects.shear is not None:
        velocity[:, 0] -= scene.effects.shear.velocity * beyond[:, 1]
    return position - beyond * periods, velocity, state.spin.copy()
