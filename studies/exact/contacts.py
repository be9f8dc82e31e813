"""Single contacts of Walton's model: changes of velocities and spins against closed forms.

A few particles fly between two walls that move along themselves, and are sampled at intervals with
at most one contact each. n points from particle 2 to particle 1, or from a wall into the gas; v, v'
and w, w' are velocities and spins (a = m = 1) before and after, J = v' - v is the impulse on
particle 1, and g = v1 - v2 - (w1 + w2) x n is the velocity of the contact, at a wall v - V - w x n.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas import theory
from roughgas.gas import Gas, build, scene_settings

HEIGHT, WIDTH = 12.0, 10.0  # of the box, in a
SAMPLING_INTERVAL = 0.1  # T
WALL_SPEED = 1.0  # of the lower wall, in a/T; the upper one moves the other way
SLIDING_TOLERANCE = 1e-9  # relative; a contact slides whose impulses have the ratio mu within it
ROLLING_WIDTH = 4000.0  # a: width of a box whose two particles roll and do not meet
ROLLING_TIME = 400.0  # T until all of them roll


class Contact(NamedTuple):
    """Measured vectors of one contact, each of shape (3,)."""

    wall: bool
    n: np.ndarray
    impulse: np.ndarray
    turn: np.ndarray  # w' - w of particle 1
    before: np.ndarray  # g
    after: np.ndarray  # g'


def measure(settings, dimension, seed) -> dict[str, np.ndarray]:
    """Return quantities that have a closed form by name, one value for each contact.

    `threshold` is mu over (J_t/J_n)/(g_t/g_n) of contacts that stick: the g_t/g_n beyond which they
    would slide. `misplaced` is 1 for a contact on the wrong side of the closed form.
    """
    contacts = _observed_contacts(settings, dimension, seed)
    values = {"rolling": _rolling_speed(settings, dimension, seed.spawn(1)[0])}
    for wall, kind in ((False, "pair"), (True, "wall")):
        selected = [contact for contact in contacts if contact.wall == wall]
        values |= {
            f"{name}_{kind}": x
            for name, x in _closed_form_ratios(selected, settings, dimension).items()
        }
    return values


def threshold(settings, dimension) -> float:
    """Return tan(theta) = g_t/g_n, beyond which contacts slide."""
    q = theory.moment_of_inertia(dimension)
    r, beta = settings["restitution"], settings["roughness"]
    return (1.0 + 1.0 / q) * settings["mu"] * (1.0 + r) / (1.0 + beta)


def _closed_form_ratios(contacts, settings, dimension):
    columns = list(zip(*contacts, strict=True))[1:]
    n, impulse, turn, before, after = (np.array(column) for column in columns)
    normal, slip, slip_after = (
        _component_along(before, n),
        _normal_to(before, n),
        _normal_to(after, n),
    )
    pushed, dragged = _component_along(impulse, n), _normal_to(impulse, n)
    friction = _norm(dragged) / np.abs(pushed)
    tangent = _norm(slip) / np.abs(normal)
    sticks = friction < settings["mu"] * (1.0 - SLIDING_TOLERANCE)
    torque = -np.cross(n, impulse)
    q = theory.moment_of_inertia(dimension)
    return {
        "restitution": -_component_along(after, n) / normal,
        "roughness": (-_component_along(slip_after, slip) / _component_along(slip, slip))[sticks],
        "friction": friction[~sticks],
        "threshold": settings["mu"] * (tangent / friction)[sticks],
        "turn": q * _component_along(turn, torque) / _component_along(torque, torque),
        "misplaced": (sticks != (tangent < threshold(settings, dimension))).astype(float),
    }


def _observed_contacts(settings, dimension, seed) -> list[Contact]:
    """Return contacts, at least settings["contacts"] both of pairs and of walls."""
    wall = {name: settings[name] for name in ("restitution", "roughness")}
    walls = {
        "bottom_wall": {**wall, "velocity": WALL_SPEED},
        "lid": {**wall, "velocity": -WALL_SPEED},
    }
    box = [WIDTH] * (dimension - 1) + [HEIGHT]
    gas = _gas(settings, dimension, 12, box, walls, seed)
    contacts: list[Contact] = []
    counts = {True: 0, False: 0}
    while min(counts.values()) < settings["contacts"]:
        velocity, spin = _motion(gas)
        height, start = gas.positions_and_velocities()[0][:, -1], gas.time
        paired = gas.step(gas.time + SAMPLING_INTERVAL, 1)
        new_velocity, new_spin = _motion(gas)
        flown = height + velocity[:, dimension - 1] * (gas.time - start)
        met_wall = (flown < 1.0) | (flown > HEIGHT - 1.0)
        moved = np.flatnonzero(np.any(new_spin != spin, axis=1))
        if paired and len(moved) == 2 and not met_wall[moved].any():
            i, j, position = gas.last_contact()
            away = position[0] - position[1]
            away[:-1] -= WIDTH * np.rint(away[:-1] / WIDTH)
            n = 0.5 * _vector(away[None])[0]
        elif not paired and len(moved) == 1:
            i = j = int(moved[0])
            n = np.eye(3)[dimension - 1] * math.copysign(1.0, new_velocity[i, dimension - 1])
        else:
            continue
        before, after = (
            _slip(v, w, i, j, n) for v, w in ((velocity, spin), (new_velocity, new_spin))
        )
        impulse, turn = new_velocity[i] - velocity[i], new_spin[i] - spin[i]
        contacts.append(Contact(i == j, n, impulse, turn, before, after))
        counts[i == j] += 1
    return contacts


def _slip(velocity, spin, i, j, n):
    """Return the velocity of the contact of two particles, or of a particle and a wall (i = j)."""
    if i == j:
        wall = np.array([math.copysign(WALL_SPEED, n.sum()), 0.0, 0.0])
        return velocity[i] - wall - np.cross(spin[i], n)
    return velocity[i] - velocity[j] - np.cross(spin[i] + spin[j], n)


def _rolling_speed(settings, dimension, seed) -> np.ndarray:
    """Return v over v_0 of two particles that bounce on a floor. They have no spin at first, and
    slide until they roll, since contacts that stick take all slip."""
    floor = {"amplitude": 0.0, "period": 1.0, "restitution": 1.0, "roughness": 0.0}
    effects = {"gravity": {"acceleration": 1.0}, "floor": floor}
    gas = _gas(settings, dimension, 2, [ROLLING_WIDTH] * (dimension - 1) + ["open"], effects, seed)
    gas.state.spin[:] = 0.0
    first_velocity = _motion(gas)[0][:, : dimension - 1]
    gas.in_time(ROLLING_TIME, 1)
    if gas.collisions:
        raise ValueError("particles that should roll have met")
    last_velocity = _motion(gas)[0][:, : dimension - 1]
    return _norm(last_velocity) / _norm(first_velocity)


def _gas(settings, dimension, particles, box, effects, seed):
    q = theory.moment_of_inertia(dimension)
    common_effects = {"spin": {"inertia": q}, "friction": {"mu": settings["mu"]}}
    raw = {"particles": particles, "box": box, "effects": common_effects | effects}
    experiment = scene_settings(raw)
    scene = build(experiment, r=settings["restitution"], beta=settings["roughness"])
    return Gas.start(scene, experiment, np.random.default_rng(seed))


def _motion(gas):
    """Return velocities and spins as vectors (N, 3)."""
    spin = gas.spins()
    if spin.shape[1] == 1:
        spin = np.pad(spin, ((0, 0), (2, 0)))
    return _vector(gas.positions_and_velocities()[1]), spin


def _vector(rows):
    return np.pad(rows, ((0, 0), (0, 3 - rows.shape[1])))


def _component_along(rows, n):
    return np.einsum("ij,ij->i", rows, n)


def _normal_to(rows, n):
    return rows - _component_along(rows, n)[:, None] * n


def _norm(rows):
    return np.sqrt(_component_along(rows, rows))
