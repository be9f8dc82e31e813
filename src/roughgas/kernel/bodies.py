"""What particles are where they differ; where they are alike, radius and mass are 1, at no cost.

The kernel's functions take State.bodies, which is None in a gas of one species. What they compute
for particles that happen to be alike has the same bits as without them: of two equal numbers x,
x/(x + x) is 1/2 exactly. All that belongs to a pair is symmetric in the two, to the last bit.
"""

from typing import NamedTuple

from roughgas.kernel.hooks import either, unless_absent
from roughgas.kernel.jit import jit
from roughgas.kernel.vectors import divide, scale


class Pair(NamedTuple):
    """What decides what a contact does, of two particles or of one with a wall.

    s = m q is a particle's moment of inertia over a^2. The tangential impulse P moves the surfaces
    of a pair past each other by P (1/m_i + 1/s_i + 1/m_j + 1/s_j), and turns i by P/s_i.
    """

    mass: float  # twice the reduced mass; at a wall that of the particle
    inertia: float  # mean q, each weighted with the share of the turning that the particle takes
    bulk: float  # twice the reduced s; at a wall that of the particle
    gives: tuple[float, float]  # twice these shares
    mu: float  # coefficient of friction; NaN without friction


radius_of = either(lambda bodies, i: bodies.radius[i], lambda bodies, i: 1.0)
mass_of = either(lambda bodies, i: bodies.mass[i], lambda bodies, i: 1.0)

reach_of = unless_absent(lambda bodies, i, j: bodies.radius[i] + bodies.radius[j])
"""(bodies, i, j) -> the distance at which a pair touches; None stands for 2."""

widest_of = unless_absent(lambda bodies: 2.0 * bodies.largest[0])
"""(bodies) -> the largest distance at which any pair touches; None stands for 2."""

spin_mass_of = either(
    lambda bodies, spin, i: bodies.mass[i] * bodies.inertia[i],
    lambda bodies, spin, i: spin.inertia,
)
"""(bodies, spin, i) -> s of a particle, which its energy of rotation is s (a w)^2/2 with."""

change_of_velocity = either(  # a product with 1/m would be rounded to the same side each time
    lambda bodies, i, push: divide(push, bodies.mass[i]),
    lambda bodies, i, push: push,
)
"""(bodies, i, push) -> what an impulse changes the particle's velocity by."""

material_of = either(
    lambda bodies, scene, i, j: _of_species(bodies, scene, i, j),
    lambda bodies, scene, i, j: (scene.restitution, scene.roughness),
)
"""(bodies, scene, i, j) -> (r, beta) of a pair's contacts."""


@jit
def _of_species(bodies, scene, i, j):
    if scene.effects.species.alike:
        return scene.restitution, scene.roughness
    of_one, of_other = bodies.species[i], bodies.species[j]
    return bodies.pairs[of_one, of_other, 0], bodies.pairs[of_one, of_other, 1]


@unless_absent
def pair_of(bodies, i, j):
    """Return the Pair of two particles."""
    m_i, m_j = bodies.mass[i], bodies.mass[j]
    q_i, q_j = bodies.inertia[i], bodies.inertia[j]
    s_i, s_j = m_i * q_i, m_j * q_j
    share_i, share_j = s_j / (s_i + s_j), s_i / (s_i + s_j)
    return Pair(
        2.0 * m_i * m_j / (m_i + m_j),
        share_i * q_i + share_j * q_j,
        share_i * s_i + share_j * s_j,
        (2.0 * share_i, 2.0 * share_j),
        bodies.pairs[bodies.species[i], bodies.species[j], 2],
    )


@unless_absent
def pair_with_wall(bodies, i):
    """Return the Pair of a particle and a wall."""
    m, q = bodies.mass[i], bodies.inertia[i]
    return Pair(m, q, m * q, (1.0, 0.0), bodies.pairs[bodies.species[i], -1, 2])


mass_in = either(lambda pair: pair.mass, lambda pair: 1.0)
inertia_in = either(lambda pair, spin: pair.inertia, lambda pair, spin: spin.inertia)
bulk_in = either(lambda pair, spin: pair.bulk, lambda pair, spin: spin.inertia)


@unless_absent
def turn_of(turn, pair, k):
    """Return what the spin of a contact's partner (0 or 1) is changed by; turn is the mean."""
    return _given(pair, turn, k)


_given = either(lambda pair, turn, k: scale(turn, pair.gives[k]), lambda pair, turn, k: turn)
