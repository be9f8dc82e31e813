"""Soft spheres: rough disks or spheres with contact forces, integrated with time steps.

Molecular dynamics with contact forces (Cundall & Strack, Geotechnique 29, 47 (1979)): a contact is
a spring and a dashpot along the normal and a spring along the tangent, set so that it takes the
time t_c and gives the restitution r and the roughness beta; as t_c goes to 0 it becomes the contact
of the event-driven kernel. Units: particle radius a = mass m = time unit T = 1.

A step is a flight of half its length, the action of the springs, and another half flight. A pair
overlaps for a time tau within the step, found on the straight line on which it flies; the springs
act for the time tau, in the middle of the overlap. So a contact begins and ends within a step to
second order. If the springs were on or off for whole steps, a contact's change of velocity would be
off by its share of a step, since neither dashpot nor tangential spring starts or ends at zero
force. Within tau the damping and the springs are integrated exactly, whatever tau is.

Pairs that may touch soon are in a list (Verlet, Phys. Rev. 159, 98 (1967)) made from cells. It is
valid until a particle may have travelled half the skin.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np

from roughgas.base import ROUGHNESS, InputError, Interval
from roughgas.compiling.jit import compiled, entry, jit
from roughgas.kernel.mathematics import (
    add_scaled,
    cross_to_spin,
    dot,
    read,
    scale,
    spin_cross,
    subtract,
    write,
)
from roughgas.kernel.particles import change_spin, periods, spin_of

DIAMETER = 2.0
# Entries of SoftGas.reach
TRAVELLED, FASTEST = range(2)
# Entries of SoftGas.counts
PAIRS, CONTACTS, BUILDS = range(3)
LIST_ROOM = 2.0  # capacity for neighbours, over the number that fits without overlap
NO_PARTICLE = -1
SOFT_RESTITUTION = Interval("(0, 1]")
"""Restitution of soft spheres: at r = 0 a contact would never end."""
POSITIVE = Interval("(0, inf)")


class Springs(NamedTuple):
    """Frequencies and damping of the forces in a contact, per reduced mass; all in 1/T but q.

    The overlap x obeys x'' + 2 gamma x' + (w^2 + gamma^2) x = 0, and the tangential surface
    velocity is g_t(t) = g_t(0) cos(w_t t) while the normal stands still.
    """

    frequency: float  # w
    damping: float  # gamma
    tangential_frequency: float  # w_t
    inertia: float  # q


class SoftScene(NamedTuple):
    """Constants of a simulation: the box (a), its cells, the range of the list and the forces."""

    box: tuple[float, ...]
    cells: tuple[int, ...]  # along each axis; none narrower than the neighbourhood
    skin: float  # pairs are listed up to DIAMETER + skin, in a
    springs: Springs


class SoftGas(NamedTuple):
    """Arrays of N particles in D dimensions, and the list of pairs that may touch soon."""

    position: np.ndarray  # (N, D) in a, wrapped into the box whenever the list is made
    velocity: np.ndarray  # (N, D) in a/T
    spin: np.ndarray  # (N, 2 D - 3) surface velocity a w, in a/T
    pair: np.ndarray  # (room, 2) the first particle has the smaller number
    image: np.ndarray  # (room, D) what to subtract from their separation, in a
    stretch: np.ndarray  # (room, D) of the tangential spring, in a
    touching: np.ndarray  # (room,) whether the pair was in contact at the last step
    old_pair: np.ndarray  # (N, 2) pairs in contact, saved while the list is made anew
    old_stretch: np.ndarray  # (N, D)
    first: np.ndarray  # (cells,) first particle of each cell's list
    following: np.ndarray  # (N,) the next particle of the same list
    home: np.ndarray  # (N,) cell of each particle
    neighbour_cells: np.ndarray  # (cells, 3^D or fewer) each cell and its neighbours
    reach: np.ndarray  # (2,) upper bounds: path since the last list, and present speed
    counts: np.ndarray  # (3,) pairs listed, contacts begun, lists made


def springs(r: float, beta: float, inertia: float, duration: float) -> Springs:
    """Return the forces of a contact of `duration` (T) with restitution r and roughness beta.

    Normal: the overlap is zero again after t_c = pi/sqrt(w0^2 - gamma^2), at exp(-gamma t_c) = r
    times the speed of approach (Luding, Granular Matter 10, 235 (2008), Eqs. 5 and 6). The force
    becomes attractive towards the end; this is not cut off. Tangential: an undamped spring turns
    g_t into cos(w_t t_c) g_t = -beta g_t, for every beta in [-1, 1]; the energy left in it when the
    contact ends is lost. A dashpot would give beta < 0 only, where g_t does not change its sign.
    Raises InputError for illegal values.
    """
    SOFT_RESTITUTION.check("restitution r of a soft sphere", r)
    ROUGHNESS.check("roughness beta", beta)
    POSITIVE.check("duration of a contact", duration)
    return Springs(
        frequency=math.pi / duration,
        damping=-math.log(r) / duration,
        tangential_frequency=math.acos(-beta) / duration,
        inertia=POSITIVE.check("inertia", inertia),
    )


def new_gas(position, velocity, spin, box, springs, skin=2.0) -> tuple[SoftGas, SoftScene]:
    """Return a gas from positions (N, D) in a, velocities (N, D) and spins (N, 2 D - 3) in a/T.

    Raises InputError where the box is so narrow that a particle would have two images of another
    within the range of the list, DIAMETER + skin.
    """
    number, dimension = position.shape
    range_of_list = DIAMETER + skin
    for axis, length in enumerate(box):
        if not 2.0 * range_of_list <= length < math.inf:
            raise InputError(
                f"box[{axis}]", length, f"be at least {2.0 * range_of_list:g} for soft spheres"
            )
    cells = tuple(math.floor(length / range_of_list) for length in box)
    room = number * math.ceil(LIST_ROOM * (range_of_list + 1.0) ** dimension / 2.0)
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
        first=np.full(math.prod(cells), NO_PARTICLE, np.int32),
        following=np.full(number, NO_PARTICLE, np.int32),
        home=np.zeros(number, np.int32),
        neighbour_cells=_neighbour_cells(cells),
        reach=np.array([math.inf, 0.0]),
        counts=np.zeros(3, np.int64),
    )
    return gas, SoftScene(tuple(map(float, box)), cells, float(skin), springs)


def _neighbour_cells(counts):
    """Return the numbers of each cell and its neighbours, the last axis running fastest."""
    numbers = np.arange(math.prod(counts), dtype=np.int32).reshape(counts)
    steps = itertools.product(*[range(-1, 2) if count > 2 else range(count) for count in counts])
    axes = tuple(range(len(counts)))
    return np.stack([np.roll(numbers, step, axes).ravel() for step in steps], axis=1)


COLUMNS = ("vv", "ww", "contacts")
"""Columns of the rows of `step`: sums of v^2 and (a w)^2 over the particles, and contacts begun so
far."""


@entry(cache=True)
def step(gas, spheres, dt, steps, temperature, rows):
    """Make `steps` steps of dt (T) for each row, and fill the rows (see COLUMNS).

    After each row momentum is removed and all velocities are scaled so that m <v^2>/D is
    `temperature` (m a^2/T^2); 0 leaves the gas as it is. Returns the number of rows filled: fewer
    if the list of neighbours was full.
    """
    for k in range(len(rows)):
        if not _advance(gas, spheres, dt, steps):
            return k
        rows[k, 0], rows[k, 1] = squares(gas.velocity), squares(gas.spin)
        rows[k, 2] = gas.counts[CONTACTS]
        if temperature > 0.0:
            _rescale(gas, temperature)
    return len(rows)


@jit
def _advance(gas, spheres, dt, steps):
    """Make steps of flights and the springs' action in turn, half a flight first and last; second
    order. Returns False if the list of neighbours is full."""
    half = 0.5 * dt
    for k in range(steps):
        _fly(gas, dt if k > 0 else half)
        if not update_list(gas, spheres, half):
            return False
        _apply_all_springs(gas, spheres, half)
    _fly(gas, half)
    return True


@jit
def _fly(gas, time):
    position, velocity = gas.position.reshape(-1), gas.velocity.reshape(-1)
    for k in range(len(position)):
        position[k] += velocity[k] * time
    gas.reach[TRAVELLED] += gas.reach[FASTEST] * time


@jit
def _apply_all_springs(gas, spheres, half):
    """Apply the springs of all pairs that may overlap within +-half."""
    box = spheres.box
    near = (DIAMETER + 2.0 * gas.reach[FASTEST] * half) ** 2
    for p in range(gas.counts[PAIRS]):
        x = subtract(
            read(gas.position, gas.pair[p, 0], 0, box), read(gas.position, gas.pair[p, 1], 0, box)
        )
        x = subtract(x, read(gas.image, p, 0, box))
        if dot(x, x) < near or gas.touching[p]:
            apply_springs(gas, spheres, p, x, half)


@compiled
def _rescale(gas, temperature):
    """Remove the momentum and scale to `temperature`; contacts under way are scaled with the rest,
    except for their overlap."""
    for component in gas.velocity.T:
        component -= component.mean()
    factor = math.sqrt(gas.velocity.size * temperature / squares(gas.velocity))
    for scaled in (gas.velocity, gas.spin, gas.stretch[: gas.counts[PAIRS]]):
        scaled *= factor
    note_fastest(gas)


@jit
def update_list(gas, spheres, half):
    """Make the list anew if a pair that overlaps within +-half of now could be missing.

    Returns False if the list is full.
    """
    if gas.reach[TRAVELLED] + gas.reach[FASTEST] * half <= 0.5 * spheres.skin:
        return True
    return _list_pairs(gas, spheres)


@jit
def note_fastest(gas):
    """Set the upper bound of speeds to the present largest speed."""
    fastest = 0.0
    for velocity in gas.velocity:
        fastest = max(fastest, squares(velocity))
    gas.reach[FASTEST] = math.sqrt(fastest)


@jit
def squares(array):
    """Return the sum of the squares of all elements, in their order."""
    total = 0.0
    for x in array.flat:
        total += x**2
    return total


@compiled
def _list_pairs(gas, spheres):
    saved = _save_contacts(gas, spheres)
    _sort_into_cells(gas, spheres)
    note_fastest(gas)
    gas.reach[TRAVELLED] = 0.0
    gas.counts[BUILDS] += 1
    gas.counts[PAIRS] = 0
    for i in range(len(gas.following)):
        if not _list_neighbours(gas, spheres, i):
            return False
    for p in range(gas.counts[PAIRS]):
        for k in range(saved):
            if gas.pair[p, 0] == gas.old_pair[k, 0] and gas.pair[p, 1] == gas.old_pair[k, 1]:
                gas.touching[p] = True
                write(gas.stretch, p, 0, read(gas.old_stretch, k, 0, spheres.box))
    return True


@jit
def _save_contacts(gas, spheres):
    """Copy the contacts under way, which are few, and return their number."""
    saved = 0
    for p in range(gas.counts[PAIRS]):
        if gas.touching[p]:
            write(gas.old_pair, saved, 0, (gas.pair[p, 0], gas.pair[p, 1]))
            write(gas.old_stretch, saved, 0, read(gas.stretch, p, 0, spheres.box))
            saved += 1
    return saved


@jit
def _sort_into_cells(gas, spheres):
    """Wrap particles into the box, and put each onto the list of its cell."""
    gas.first[:] = NO_PARTICLE
    for i in range(len(gas.following)):
        cell = 0
        for k in range(len(spheres.box)):
            length, count = spheres.box[k], spheres.cells[k]
            inside = gas.position[i, k] - length * math.floor(gas.position[i, k] / length)
            gas.position[i, k] = inside
            cell = cell * count + min(int(inside / length * count), count - 1)
        gas.home[i] = cell
        gas.following[i] = gas.first[cell]
        gas.first[cell] = i


@jit
def _list_neighbours(gas, spheres, i):
    """Add the neighbours of particle i with greater numbers; return False if the list is full."""
    near = (DIAMETER + spheres.skin) ** 2
    home = gas.home[i]
    for k in range(gas.neighbour_cells.shape[1]):
        j = gas.first[gas.neighbour_cells[home, k]]
        while j != NO_PARTICLE:
            p = gas.counts[PAIRS]
            if j > i and _separation(gas, spheres, i, j, p) <= near:
                if p + 1 >= len(gas.touching):
                    return False
                write(gas.pair, p, 0, (i, j))
                end_contact(gas, spheres.box, p)
                gas.counts[PAIRS] += 1
            j = gas.following[j]
    return True


@jit
def _separation(gas, spheres, i, j, p):
    """Return the squared distance of the nearest images; their shift goes to gas.image[p]."""
    square = 0.0
    for k in range(len(spheres.box)):
        x = gas.position[i, k] - gas.position[j, k]
        gas.image[p, k] = periods(x, spheres.box[k]) * spheres.box[k]
        square += (x - gas.image[p, k]) ** 2
    return square


@jit
def apply_springs(gas, spheres, p, x, half):
    """Apply the springs of pair p, at separation x in the middle of a step of twice `half`."""
    box = spheres.box
    i, j = gas.pair[p, 0], gas.pair[p, 1]
    v_i, v_j = read(gas.velocity, i, 0, box), read(gas.velocity, j, 0, box)
    u = subtract(v_i, v_j)
    begin, end = overlap_interval(x, u, half)
    if end <= begin:
        if gas.touching[p]:
            end_contact(gas, box, p)
        return
    if not gas.touching[p]:
        gas.touching[p] = True
        gas.counts[CONTACTS] += 1
    middle = 0.5 * (begin + end)
    w_i, w_j = spin_of(gas.spin, box, i), spin_of(gas.spin, box, j)
    spins = add_scaled(w_i, w_j, 1.0)
    x = add_scaled(x, u, middle)
    stretch = read(gas.stretch, p, 0, box)
    push, turn, stretch = spring_response(spheres.springs, x, u, spins, stretch, end - begin)
    write(gas.stretch, p, 0, stretch)
    # as if the velocities had changed at `middle`: so angular momentum is conserved
    _change(gas, box, i, v_i, push, middle)
    _change(gas, box, j, v_j, scale(push, -1.0), middle)
    change_spin(gas.spin, i, w_i, turn)
    change_spin(gas.spin, j, w_j, turn)


@jit
def overlap_interval(x, u, half):
    """Return begin and end of the overlap, within +-half, of a pair at separation x and relative
    velocity u."""
    b, uu = dot(x, u), dot(u, u)
    square = b * b - uu * (dot(x, x) - DIAMETER * DIAMETER)
    if square <= 0.0:
        return 0.0, 0.0
    root = math.sqrt(square)
    return max(-half, (-b - root) / uu), min(half, (-b + root) / uu)


@jit
def spring_response(springs, x, u, spins, stretch, time):
    """Return the change of the first velocity and of both spins a w, and the stretch at the end.

    x and u are separation and relative velocity in the middle of `time`, during which the springs
    act. Both arms reach to the middle between the centres, and the forces on the two are opposite:
    momentum and angular momentum are conserved.
    """
    distance = math.sqrt(dot(x, x))
    n = scale(x, 1.0 / distance)
    arm = 0.5 * distance
    speed = dot(u, n)
    slip = subtract(add_scaled(u, n, -speed), scale(spin_cross(spins, n), arm))
    normal = 0.5 * _normal_change(springs, DIAMETER - distance, speed, time)
    slowed, stretch = _tangential_motion(springs, slip, _turned_into_plane(stretch, n), time)
    q = springs.inertia
    sheared = scale(subtract(slowed, slip), 0.5 * q / (1.0 + q))
    turn = scale(cross_to_spin(n, sheared), -arm / q)
    return add_scaled(sheared, n, normal), turn, stretch


@jit
def _normal_change(springs, overlap, speed, time):
    """Return the change of the normal velocity, halfway through a flight of `time`.

    The linear map flight-change-flight is given the eigenvalues exp(-gamma t +- i w t) of the
    damped oscillator itself, so that neither its frequency nor its damping depends on the step.
    """
    damped = springs.damping * time
    sine = math.sin(0.5 * springs.frequency * time)
    rigid = (math.expm1(-damped) ** 2 + 4.0 * math.exp(-damped) * sine * sine) / time
    return rigid * overlap + math.expm1(-2.0 * damped) * speed


@jit
def _tangential_motion(springs, slip, stretch, time):
    """Return tangential velocity and stretch after `time` on an undamped spring, exactly."""
    angle = springs.tangential_frequency * time
    cosine, sine = math.cos(angle), math.sin(angle)
    per_turning = time if angle == 0.0 else sine / springs.tangential_frequency
    return (
        add_scaled(scale(slip, cosine), stretch, -springs.tangential_frequency * sine),
        add_scaled(scale(stretch, cosine), slip, per_turning),
    )


@jit
def _turned_into_plane(stretch, n):
    """Return the stretch turned into the plane normal to n, with its length unchanged."""
    flat = add_scaled(stretch, n, -dot(stretch, n))
    square = dot(flat, flat)
    if square == 0.0:
        return flat
    return scale(flat, math.sqrt(dot(stretch, stretch) / square))


@jit
def _change(gas, box, i, velocity, push, when):
    velocity = add_scaled(velocity, push, 1.0)
    write(gas.velocity, i, 0, velocity)
    write(gas.position, i, 0, add_scaled(read(gas.position, i, 0, box), push, -when))
    gas.reach[FASTEST] = max(gas.reach[FASTEST], math.sqrt(dot(velocity, velocity)))


@jit
def end_contact(gas, box, p):
    """Mark pair p as not touching, and relax its spring."""
    gas.touching[p] = False
    write(gas.stretch, p, 0, scale(box, 0.0))
