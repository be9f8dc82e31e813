"""An effect that only looks: the gap that each pair has when it collides.

A scene is made of the effects that it lists, so a test may list one of its own. The product carries
no instruction of it.
"""

import math
from collections import namedtuple
from typing import NamedTuple

import numpy as np

from roughgas.effects import Effects
from roughgas.effects.settings import register
from roughgas.kernel import hooks
from roughgas.kernel.jit import entry, jit
from roughgas.kernel.loop import REACHED
from roughgas.kernel.particles import image_numbers, position_in_box, shifted, slid
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.vectors import dot, subtract
from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state

_NAMES = [*Effects._fields, "probe"]
Probed = namedtuple("Probed", _NAMES, defaults=[None] * len(_NAMES))
_record = entry(record.py_func)  # not that of the product, whose cache must not know of probes


class Probe(NamedTuple):
    """Looks at every contact of a scene."""

    scene: Scene
    gaps: np.ndarray  # (2,) smallest and largest gap so far, in a


@jit
def restitution(probe, index, r, state, i, j, time, speed):
    if j >= 0:
        scene = probe.scene
        position_i, velocity_i = position_in_box(state, scene, i, time)
        position_j, velocity_j = position_in_box(state, scene, j, time)
        slide = slid(hooks.sliding(scene.effects, None, state), time)
        x, v = subtract(position_i, position_j), subtract(velocity_i, velocity_j)
        x, v = shifted(x, v, image_numbers(x, scene.box, slide), scene.box, slide)
        gap = math.sqrt(dot(x, x)) - 2.0
        probe.gaps[0] = min(probe.gaps[0], gap)
        probe.gaps[1] = max(probe.gaps[1], gap)
    return r


register(Probe, {}, restitution=restitution)


def gaps_at_contacts(experiment, r, beta, collisions, seed=1):
    """(smallest, largest) gap over so many collisions, each in a."""
    plain = build(experiment, r, beta)
    probe = Probe(plain, np.zeros(2))
    scene = plain._replace(effects=Probed(*plain.effects, probe))
    state = initial_state(scene, experiment, np.random.default_rng(seed))
    each = experiment["particles"] // 2
    rows = np.empty((collisions // each, len(columns(scene))))
    refresh = 0 if hooks.present(scene.effects, "drives") else 4  # a cooling gas would lose digits
    assert _record(state, scene, Sampling(np.inf, each, refresh), rows) == (REACHED, len(rows))
    assert probe.gaps.any()  # else it has not looked
    return probe.gaps
