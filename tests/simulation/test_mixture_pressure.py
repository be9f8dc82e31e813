"""The pressure of an elastic mixture, from the momentum that contacts transfer, beside its equation
of state; and how often species meet."""

from collections import namedtuple
from typing import NamedTuple

import numpy as np
import pytest

from roughgas import theory
from roughgas.effects import Effects
from roughgas.effects.settings import register
from roughgas.kernel.jit import entry, jit
from roughgas.kernel.loop import REACHED
from roughgas.kernel.record import Sampling, columns, record
from roughgas.kernel.vectors import dot
from roughgas.scene import build, packing
from roughgas.scene.initial import initial_state

_NAMES = [*Effects._fields, "virial"]
Registered = namedtuple("Registered", _NAMES, defaults=[None] * len(_NAMES))
_record = entry(record.py_func)  # not that of the product, whose cache must not know of this effect
COLLISIONS = 100_000


class Virial(NamedTuple):
    """Looks at the contacts of each pair of species."""

    sums: np.ndarray  # (species, species, 2): their number, and momentum times distance


@jit
def observe_contact(virial, index, none, state, i, j, n, v, w, push):
    bodies = state.bodies
    k, other = bodies.species[i], bodies.species[j]
    virial.sums[k, other, 0] += 1.0
    virial.sums[k, other, 1] += abs(dot(push, n)) * (bodies.radius[i] + bodies.radius[j])


register(Virial, {}, observe_contact=observe_contact)


def watched(experiment, seed=1):
    """The sums over COLLISIONS contacts, the time (T) that they took, and the kinetic energy."""
    plain = build(experiment, 1.0, -1.0)
    virial = Virial(np.zeros((2, 2, 2)))
    scene = plain._replace(effects=Registered(*plain.effects, virial))
    state = initial_state(scene, experiment, np.random.default_rng(seed))
    names = columns(scene)
    rows = np.empty((1, len(names)))
    assert _record(state, scene, Sampling(np.inf, COLLISIONS // 10, 0), rows) == (REACHED, 1)
    begun = dict(zip(names, rows[0], strict=True))["time"]
    virial.sums[:] = 0.0
    assert _record(state, scene, Sampling(np.inf, COLLISIONS, 0), rows) == (REACHED, 1)
    found = dict(zip(names, rows[0], strict=True))
    energy = sum(found[name] for name in names if name.startswith("vv_") and "[" not in name) / 2
    return virial.sums + virial.sums.transpose(1, 0, 2), found["time"] - begun, energy


@pytest.mark.slow  # two kernels of its own
@pytest.mark.parametrize(
    ("box", "large"), [([75, 75], {"radius": 2, "mass": 3}), ([23, 23, 23], {"radius": 1.8})]
)
def test_pressure_and_frequencies_are_those_of_theory(box, large):
    species = [{"fraction": 0.6, "mass": 1}, {"fraction": 0.4, **large}]
    experiment = {"particles": 300, "box": box, "effects": {}, "species": species}
    gas, filled = theory.mixture(species, 1.0, -1.0, len(box)), packing(experiment)
    assert 0.25 < filled < 0.4
    sums, time, energy = watched(experiment)
    D = len(box)
    # each pair of unlike species stands in the sums twice, each of like ones as two particles
    T = 2 * energy / (300 * D)
    Z = 1 + sums[..., 1].sum() / 2 / (2 * energy * time)
    assert pytest.approx(theory.compressibility(gas, filled), rel=0.01) == Z
    nu = sums[..., 0] / (time * 300 * gas.fraction[:, None])
    expected = theory.mixture_frequency(gas, T, filled)
    assert nu == pytest.approx(expected, rel=0.03)
