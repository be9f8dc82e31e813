"""Single contacts of Walton's model: what each does to velocities and spins.

A few particles fly between two walls that move along themselves, and are looked at so often that
one contact at most has happened in between. n points from particle 2 to particle 1, or from a wall
into the gas; v, v' and w, w' are velocities and spins (a = m = 1) before and after, J = v' - v the
impulse on the first one, and g = v1 - v2 - (w1 + w2) x n the velocity of the contact, at a wall
v - V - w x n.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas import theory
from roughgas.gas import Gas, build

HEIGHT, WIDTH = 12.0, 10.0  # of the box, in a
LOOK = 0.1  # T between two looks
SPEED = 1.0  # of the lower wall, in a/T; the upper one moves the other way
SLIDES = 1e-9  # a contact whose impulses are that near to the ratio mu, slides
FAR = 4000.0  # width of the box in which two particles roll and do not meet
ROLLED = 400.0  # T until all of them roll


class Contact(NamedTuple):
    """What was seen of one contact."""

    wall: bool
    n: np.ndarray  # (3,), as all vectors
    impulse: np.ndarray
    turn: np.ndarray  # w' - w of the first particle
    before: np.ndarray  # g
    after: np.ndarray  # g'


def find(about, dimension, seed) -> dict[str, np.ndarray]:
    """Return numbers that have a closed form by name, one for each contact.

    `threshold` is mu over (J_t/J_n)/(g_t/g_n) of contacts that stick: the g_t/g_n from which on
    they would slide. `misplaced` is 1 for a contact on the wrong side of the closed form.
    """
    contacts = _seen(about, dimension, seed)
    found = {"rolling": _rolling(about, dimension, seed.spawn(1)[0])}
    for wall, place in ((False, "pair"), (True, "wall")):
        these = [one for one in contacts if one.wall == wall]
        found |= {f"{name}_{place}": x for name, x in _numbers(these, about, dimension).items()}
    return found


def threshold(about, dimension) -> float:
    """Return tan(theta) = g_t/g_n from which on contacts slide."""
    q = theory.moment_of_inertia(dimension)
    r, beta = about["restitution"], about["roughness"]
    return (1.0 + 1.0 / q) * about["mu"] * (1.0 + r) / (1.0 + beta)


def _numbers(contacts, about, dimension):
    columns = list(zip(*contacts, strict=True))[1:]
    n, impulse, turn, before, after = (np.array(column) for column in columns)
    normal, slip, slip_after = _along(before, n), _across(before, n), _across(after, n)
    pushed, dragged = _along(impulse, n), _across(impulse, n)
    friction = _size(dragged) / np.abs(pushed)
    tangent = _size(slip) / np.abs(normal)
    sticks = friction < about["mu"] * (1.0 - SLIDES)
    torque = -np.cross(n, impulse)
    q = theory.moment_of_inertia(dimension)
    return {
        "restitution": -_along(after, n) / normal,
        "roughness": (-_along(slip_after, slip) / _along(slip, slip))[sticks],
        "friction": friction[~sticks],
        "threshold": about["mu"] * (tangent / friction)[sticks],
        "turn": q * _along(turn, torque) / _along(torque, torque),
        "misplaced": (sticks != (tangent < threshold(about, dimension))).astype(float),
    }


def _seen(about, dimension, seed) -> list[Contact]:
    """Return contacts, at least as many as asked for both of pairs and of walls."""
    wall = {name: about[name] for name in ("restitution", "roughness")}
    walls = {
        "bottom_wall": {**wall, "velocity": SPEED},
        "lid": {**wall, "velocity": -SPEED},
    }
    box = [WIDTH] * (dimension - 1) + [HEIGHT]
    gas = _gas(about, dimension, 12, box, walls, seed)
    contacts: list[Contact] = []
    seen = {True: 0, False: 0}
    while min(seen.values()) < about["contacts"]:
        velocity, spin = _motion(gas)
        height, since = gas.positions_and_velocities()[0][:, -1], gas.time
        paired = gas.step(gas.time + LOOK, 1)
        now, spun = _motion(gas)
        flown = height + velocity[:, dimension - 1] * (gas.time - since)
        met_wall = (flown < 1.0) | (flown > HEIGHT - 1.0)
        moved = np.flatnonzero(np.any(spun != spin, axis=1))
        if paired and len(moved) == 2 and not met_wall[moved].any():
            i, j, position = gas.last_contact()
            away = position[0] - position[1]
            away[:-1] -= WIDTH * np.rint(away[:-1] / WIDTH)
            n = 0.5 * _vector(away[None])[0]
        elif not paired and len(moved) == 1:
            i = j = int(moved[0])
            n = np.eye(3)[dimension - 1] * math.copysign(1.0, now[i, dimension - 1])
        else:
            continue
        before, after = (_slip(v, w, i, j, n) for v, w in ((velocity, spin), (now, spun)))
        impulse, turn = now[i] - velocity[i], spun[i] - spin[i]
        contacts.append(Contact(i == j, n, impulse, turn, before, after))
        seen[i == j] += 1
    return contacts


def _slip(velocity, spin, i, j, n):
    """Return the velocity of the contact of two particles, or of one with a wall (i = j)."""
    if i == j:
        wall = np.array([math.copysign(SPEED, n.sum()), 0.0, 0.0])
        return velocity[i] - wall - np.cross(spin[i], n)
    return velocity[i] - velocity[j] - np.cross(spin[i] + spin[j], n)


def _rolling(about, dimension, seed) -> np.ndarray:
    """Return v over v_0 of two particles that bounce on a floor, without spin at first, and slide
    until they roll, since contacts that stick take all slip."""
    floor = {"amplitude": 0.0, "period": 1.0, "restitution": 1.0, "roughness": 0.0}
    effects = {"gravity": {"acceleration": 1.0}, "floor": floor}
    gas = _gas(about, dimension, 2, [FAR] * (dimension - 1) + ["open"], effects, seed)
    gas.state.spin[:] = 0.0
    begun = _motion(gas)[0][:, : dimension - 1]
    gas.in_time(ROLLED, 1)
    if gas.collisions:
        raise ValueError("particles that should roll have met")
    ended = _motion(gas)[0][:, : dimension - 1]
    return _size(ended) / _size(begun)


def _gas(about, dimension, particles, box, effects, seed):
    q = theory.moment_of_inertia(dimension)
    always = {"spin": {"inertia": q}, "friction": {"mu": about["mu"]}}
    experiment = {"particles": particles, "box": box, "effects": always | effects}
    scene = build(experiment, r=about["restitution"], beta=about["roughness"])
    return Gas.start(scene, experiment, np.random.default_rng(seed))


def _motion(gas):
    """Return velocities and spins as vectors (N, 3)."""
    spin = gas.spins()
    if spin.shape[1] == 1:
        spin = np.pad(spin, ((0, 0), (2, 0)))
    return _vector(gas.positions_and_velocities()[1]), spin


def _vector(rows):
    return np.pad(rows, ((0, 0), (0, 3 - rows.shape[1])))


def _along(rows, n):
    return np.einsum("ij,ij->i", rows, n)


def _across(rows, n):
    return rows - _along(rows, n)[:, None] * n


def _size(rows):
    return np.sqrt(_along(rows, rows))
