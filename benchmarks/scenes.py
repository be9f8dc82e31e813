"""Scenes of the benchmarks: the scenes of the paper at any number of particles, in a steady state.

Density, shear rate and height of the bed are as in config.yaml. The cooling gas is smooth and
elastic, so that it stays homogeneous at any size: with dissipation large gases form clusters. The
driven gases have r = 0.9, beta = 0.
"""

import copy
import functools
from pathlib import Path
from typing import NamedTuple

import numpy as np

from roughgas import config
from roughgas.kernel.layout import new_state
from roughgas.kernel.record import Sampling, allocate_frames, columns, record
from roughgas.kernel.state import NOW
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import SceneSettings, scene_settings

ROOT = Path(__file__).parent.parent
CONFIGURATION, DOCS = ROOT / "config.yaml", ROOT / "docs"
SETTLING = 500  # T, whole periods of the floor, and of the sliding of images
COPIES = {10_000: 5, 100_000: 10, 1_000_000: 50}  # of a smaller box along each side
KICK = 0.1  # relative change of velocities, so that copies take different paths
UNLIMITED = 2**60


class Case(NamedTuple):
    """A scene at any number of particles."""

    title: str
    experiment: str  # of config.yaml
    r: float
    beta: float
    size: float = 1.0  # of lengths, relative to the experiment


CASES = (
    Case("cooling, packing 0.05", "cooling", 1.0, -1.0),
    Case("cooling, packing 0.2", "cooling", 1.0, -1.0, 0.5),
    Case("sheared", "sheared", 0.9, 0.0),
    Case("vibrated", "vibrated", 0.9, 0.0),
)


def settings(case: Case, number: int) -> SceneSettings:
    """Return the settings of a case with `number` particles; boxes with open tops grow in width."""
    raw = copy.deepcopy(_configuration().experiment(case.experiment, "paper").raw)
    growth = number / raw["particles"]
    if "open" in raw["box"]:
        factors = [case.size * growth, None]
    else:
        factors = [case.size * growth ** (1 / len(raw["box"]))] * len(raw["box"])
    sides = zip(raw["box"], factors, strict=True)
    box = [side if factor is None else side * factor for side, factor in sides]
    if "shear" in raw["effects"]:  # the same shear rate
        raw["effects"]["shear"]["velocity"] *= factors[1]
    return scene_settings(raw | {"particles": number, "box": box})


@functools.cache
def _configuration():
    return config.load(CONFIGURATION)


def steady(case: Case, number: int):
    """Return scene and state in the steady state; large states are copies of a smaller one."""
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
    """Run for a time (T), or for a number of collisions, whichever ends first."""
    row = np.empty((1, len(columns(scene))))
    sampling = Sampling(float(time), collisions, 0)
    record(state, scene, sampling, row, allocate_frames(state, 0))


def _copied(scene, state, copies, rng):
    """Return positions, velocities and spins of copies x copies boxes, kicked; boxes with open tops
    form a row."""
    position, velocity, spin = present(scene, state)
    boxes_across, boxes_up = (copies**2, 1) if scene.box[1] is None else (copies, copies)
    cell_indices = np.stack(
        np.meshgrid(np.arange(boxes_across), np.arange(boxes_up)), axis=-1
    ).reshape(-1, 1, 2)
    position = position + cell_indices * np.array([length or 0.0 for length in scene.box])
    velocity = np.broadcast_to(velocity, position.shape).copy()
    if scene.effects.shear is not None:
        velocity[..., 0] += scene.effects.shear.velocity * (
            cell_indices[..., 1] - (boxes_up - 1) / 2
        )
    velocity[..., 1] *= 1 + KICK * rng.standard_normal(velocity.shape[:2])
    return (
        position.reshape(-1, 2),
        velocity.reshape(-1, 2),
        np.tile(spin, (boxes_across * boxes_up, 1)),
    )


def present(scene, state):
    """Return positions in the box, velocities and spins, at the present.

    The sliding of images must be a whole number of boxes.
    """
    elapsed = (state.clock[NOW] - state.trajectory[:, -1])[:, None]
    position, velocity = np.hsplit(state.trajectory[:, :-1], 2)
    gravity = np.zeros(len(scene.box))
    gravity[-1] = 0.0 if scene.effects.gravity is None else scene.effects.gravity.acceleration
    position = position + velocity * elapsed - 0.5 * gravity * elapsed**2
    velocity = velocity - gravity * elapsed
    periods = np.array([length or 1.0 for length in scene.box])
    periods_out = np.floor(position / periods) * [length is not None for length in scene.box]
    if scene.effects.shear is not None:
        velocity[:, 0] -= scene.effects.shear.velocity * periods_out[:, 1]
    spin = None if state.spin is None else state.spin.copy()
    return position - periods_out * periods, velocity, spin
