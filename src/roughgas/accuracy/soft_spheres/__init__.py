"""The classical way: rough disks or spheres that deform, stepped through time.

Molecular dynamics with contact forces (Cundall & Strack, Geotechnique 29, 47 (1979)): a contact is
a spring and a dashpot along the normal and a spring along the tangent, set so that it takes the
time t_c and gives the restitution r and the roughness beta; as t_c goes to 0 it becomes the contact
of the event-driven kernel. Units: particle radius a = mass m = time unit T = 1.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np

from roughgas.base import ROUGHNESS, InputError, Interval

DIAMETER = 2.0
# Entries of SoftGas.reach
TRAVELLED, FASTEST = range(2)
# Entries of SoftGas.counts
PAIRS, CONTACTS, BUILDS = range(3)
CROWD = 2.0  # room for neighbours, over how many fit without overlap
NOBODY = -1
SOFT_RESTITUTION = Interval("(0, 1]")
"""Restitution of soft spheres: at r = 0 a contact would never end."""
POSITIVE = Interval("(0, inf)")


class Springs(NamedTuple):
    """What acts in a contact, per reduced mass; all in 1/T but q.

    The overlap x obeys x'' + 2 gamma x' + (w^2 + gamma^2) x = 0, and the tangential surface
    velocity is g_t(t) = g_t(0) cos(w_t t) while the normal stands still.
    """

    frequency: float  # w
    damping: float  # gamma
    turning: float  # w_t
    inertia: float  # q


class SoftScene(NamedTuple):
    """What stays as it is: the box (a), its cells, the neighbourhood and the forces."""

    box: tuple[float, ...]
    cells: tuple[int, ...]  # along each axis; none narrower than the neighbourhood
    skin: float  # pairs are listed up to DIAMETER + skin, in a
    springs: Springs


class SoftGas(NamedTuple):
    """Arrays of N particles in D dimensions, and the list of pairs that may touch soon."""

    position: np.ndarray  # (N, D) in a, outside the box by what was travelled since the last list
    velocity: np.ndarray  # (N, D) in a/T
    spin: np.ndarray  # (N, 2 D - 3) surface velocity a w, in a/T
    pair: np.ndarray  # (room, 2) the first particle has the smaller number
    image: np.ndarray  # (room, D) what to subtract from their separation, in a
    stretch: np.ndarray  # (room, D) of the tangential spring, in a
    touching: np.ndarray  # (room,) whether the pair was in contact when last looked at
    old_pair: np.ndarray  # (N, 2) pairs in contact, while the list is made anew
    old_stretch: np.ndarray  # (N, D)
    first: np.ndarray  # (cells,) first particle of each cell's list
    following: np.ndarray  # (N,) the next particle of the same list
    home: np.ndarray  # (N,) the cell that each is in
    beside: np.ndarray  # (cells, 3^D or fewer) each cell and those around it
    reach: np.ndarray  # (2,) least upper bounds: way since the last list, and present speed
    counts: np.ndarray  # (3,) pairs listed, contacts begun, lists made


def springs(r: float, beta: float, inertia: float, duration: float) -> Springs:
    """Return the forces of a contact of `duration` (T) with restitution r and roughness beta.

    Normal: the overlap is zero again after t_c = pi/sqrt(w0^2 - gamma^2), at exp(-gamma t_c) = r
    times the speed of approach (Luding, Granular Matter 10, 235 (2008), Eqs. 5 and 6). The force is
    attractive towards the end, and is left so. Tangential: an undamped spring turns g_t into
    cos(w_t t_c) g_t = -beta g_t, for every beta in [-1, 1]; the energy left in it when the contact
    ends is lost. A dashpot gives beta < 0 only, where g_t does not change its sign. Raises
    InputError for illegal values.
    """
    SOFT_RESTITUTION.check("restitution r of a soft sphere", r)
    ROUGHNESS.check("roughness beta", beta)
    POSITIVE.check("duration of a contact", duration)
    return Springs(
        frequency=math.pi / duration,
        damping=-math.log(r) / duration,
        turning=math.acos(-beta) / duration,
        inertia=POSITIVE.check("inertia", inertia),
    )


def new_gas(position, velocity, spin, box, springs, skin=2.0) -> tuple[SoftGas, SoftScene]:
    """Return a gas from positions (N, D) in a, velocities (N, D) and spins (N, 2 D - 3) in a/T.

    Raises InputError where the box is so narrow that a particle would have two images of another
    in its neighbourhood, DIAMETER + skin.
    """
    number, dimension = position.shape
    near = DIAMETER + skin
    for axis, length in enumerate(box):
        if not 2.0 * near <= length < math.inf:
            raise InputError(f"box[{axis}]", length, f"be at least {2.0 * near:g} for soft spheres")
    cells = tuple(math.floor(length / near) for length in box)
    room = number * math.ceil(CROWD * (near + 1.0) ** dimension / 2.0)
    gas = SoftGas(
        position=np.array(position, float),
        velocity=np.array(velocity, float),
        spin=np.array(spin, float),
        pair=np.zeros((room, 2), np.int32),
        image=np.zeros((room, dimension)),
        stretch=np.zeros((room, dimension)),
        touching=np.zeros(room, np.bool_),
        old_pair=np.zeros((6 * number, 2), np.int32),
        old_stretch=np.zeros((6 * number, dimension)),
        first=np.full(math.prod(cells), NOBODY, np.int32),
        following=np.full(number, NOBODY, np.int32),
        home=np.zeros(number, np.int32),
        beside=_cells_beside(cells),
        reach=np.array([math.inf, 0.0]),
        counts=np.zeros(3, np.int64),
    )
    return gas, SoftScene(tuple(map(float, box)), cells, float(skin), springs)


def _cells_beside(counts):
    """Return the numbers of each cell and those around it, the last axis running fastest."""
    numbers = np.arange(math.prod(counts), dtype=np.int32).reshape(counts)
    steps = itertools.product(*[range(-1, 2) if count > 2 else range(count) for count in counts])
    axes = tuple(range(len(counts)))
    return np.stack([np.roll(numbers, step, axes).ravel() for step in steps], axis=1)
