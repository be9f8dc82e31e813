"""Lees-Edwards boundaries."""

import itertools
from decimal import Decimal

import numpy as np
import pytest
import schemes
from brute_force import run, scene_of, settings
from compiled import from_python
from exact import exactly, segment
from slow_cases import slow_but

from roughgas.effects import drives
from roughgas.effects.drives import Shear
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import BASE

# As in test_exact_arithmetic.py, where these limits come from
SMALL_SEPARATION, ROUNDINGS = 1e-6, 10.0
phase = from_python(drives.offset)


@pytest.fixture(params=["swept", "in cells"])
def scheme(request, monkeypatch):
    """Find contacts by either of the two schemes, however few the particles are."""
    schemes.use(monkeypatch, "cells" if request.param == "in cells" else "sweep", per_cell=0.0)
    return request.param


def measure(margins, label, segments):
    """Measure the separation from exact arithmetic, in roundings and at the first other pair."""
    tried = {"tried": sum(len(shared.separation) for shared in segments), "unit": "collisions"}
    ratio = max(shared.ratio(SMALL_SEPARATION) for shared in segments)
    parted = min(shared.parted for shared in segments)
    margins.at_least(
        f"{label}: separation from which pairs differ", parted, SMALL_SEPARATION, **tried
    )
    quantity = f"{label}: separation, over what roundings make of themselves"
    margins.at_most(quantity, ratio, ROUNDINGS, **tried)


GAS = settings("sheared", 12, [32, 20], shear={"velocity": 4.0})
LENGTH, HEIGHT, U, PERIOD = 32.0, 20.0, 4.0, 8.0
GRID = 2.0**-24  # initial numbers are multiples of it, so that their sums are exact


def scattered(rng, number, box, gap):
    """Random positions in a box, at least a diameter and a gap apart, between all images."""
    positions = []
    while len(positions) < number:
        candidate = rng.uniform(0, box)
        distances = np.abs(np.array(positions).reshape(-1, 2) - candidate)
        if np.all(np.hypot(*np.minimum(distances, box - distances).T) > 2.0 + gap):
            positions.append(candidate)
    return np.array(positions)


def on_grid(numbers):
    """Numbers rounded to the grid."""
    return np.round(numbers / GRID) * GRID


def started_state(scene, position, velocity, base=0.0):
    """A state without spin whose clock starts at `base`."""
    state = new_state(scene, position, velocity, np.zeros((len(position), 1)))
    state.clock[BASE] = base
    run(state, scene, 0)
    return state


class View:
    """A gas seen from a moving frame, in other images, or at a later time."""

    def __init__(self, boost=(0.0, 0.0), images=0, later=0.0):
        self.boost, self.images, self.later = np.array(boost), images, later

    def of_start(self, position, velocity, offset, rng):
        """Initial positions and velocities as seen."""
        shape = (len(position), 2)
        columns, rows = rng.integers(-self.images, self.images, shape, endpoint=True).T[..., None]
        shift = np.hstack([columns * LENGTH + rows * offset, rows * HEIGHT])
        return position + shift, velocity + self.boost + np.hstack([rows * U, 0.0 * rows])

    def of_exact(self, gas, start):
        """The exact gas as seen, at its present time."""
        view, elapsed = gas.copy(), gas.time - start
        boost = [Decimal(c) for c in (*self.boost, 0.0)]
        view.time += Decimal(self.later)
        view.x = [tuple(a + c * elapsed for a, c in zip(x, boost, strict=True)) for x in view.x]
        view.v = [tuple(a + c for a, c in zip(v, boost, strict=True)) for v in view.v]
        return view


VIEWS = {
    "in motion along the flow": lambda rng: View(boost=(random_speed(rng), 0.0)),
    "in motion across the flow": lambda rng: View(boost=(0.0, random_speed(rng))),
    "by other images": lambda rng: View(images=int(rng.choice([1, 30, 1000]))),
    "later by whole periods of the slide": lambda rng: View(
        later=PERIOD * float(2 ** rng.integers(10, 26))
    ),
}


def random_speed(rng):
    """A random speed of either sign, on the grid."""
    return float(rng.choice([-1, 1]) * on_grid(2.0 ** rng.uniform(-2, 10)))


@pytest.mark.parametrize(
    "name", slow_but({"in motion across the flow", "later by whole periods of the slide"}, VIEWS)
)
def test_the_gas_is_the_same_however_it_is_seen(name, scheme, margins):
    """The kernel runs the gas as seen, the exact simulation runs it at rest in its first images."""
    rng = np.random.default_rng(1)
    scene, world = scene_of(GAS, 0.9, 0.2)
    segments = []
    for _ in range(margins.size(quick=2, full=20)):
        view, time = VIEWS[name](rng), float(on_grid(rng.uniform(0, PERIOD)))
        position = on_grid(scattered(rng, 12, (LENGTH, HEIGHT), 0.1))
        velocity = on_grid(rng.standard_normal((12, 2)))
        velocity[:, 0] += on_grid(U * (position[:, 1] / HEIGHT - 0.5))
        gas = exactly(started_state(scene, position, velocity, time), scene, world)
        viewed_state = started_state(
            scene, *view.of_start(position, velocity, U * time, rng), time + view.later
        )
        start = gas.time
        segments.append(
            segment(
                viewed_state,
                scene,
                world,
                40,
                gas,
                lambda exact_gas, v=view, t=start: v.of_exact(exact_gas, t),
            )
        )
    measure(margins, f"{name}, {scheme}", segments)


def test_the_offset_of_images_is_accurate(margins):
    """U t mod L from U and the period L/U, each rounded once: errors of 2 U t 2^-53 and L 2^-52."""
    rng = np.random.default_rng(2)
    tried = margins.size(quick=1000, full=100_000)
    largest = 0.0
    for _ in range(tried):
        length, velocity, time = 10.0 ** rng.uniform((0.7, -3, 0), (3, 4, 12))
        computed = Decimal(phase(Shear(velocity, length), 4, time))
        true = Decimal(velocity) * Decimal(time)
        error = (computed - true) / Decimal(length)
        error = abs(error - round(error)) * Decimal(length)
        largest = max(largest, float(error / (true + Decimal(length))))
    quantity = "offset of the images, off by, over U t + L"
    margins.at_most(quantity, largest, 2.0**-52, tried, "instants")


OFFSETS = (0.0, 2.0**-52, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


def pair_touching_on_the_boundary(offset, angle, box, rng):
    """Two particles that touch after a time 1/4, the first at a distance `offset` from a corner."""
    n = np.array([np.cos(angle), np.sin(angle)])
    corner = np.array(box) * rng.integers(0, 2, 2) * (1.0 + offset) + offset
    while True:
        velocity = rng.standard_normal((2, 2))
        position = np.array([corner, corner + 2.0 * n]) - 0.25 * velocity
        d = position[0] - position[1]
        if np.hypot(*(d - np.round(d / box) * box)) > 2.0:  # not even by an image
            return position, velocity


@pytest.mark.parametrize("box", [[11.0, 9.0], [4.01, 4.01]])
def test_contacts_may_coincide_with_crossings(box, margins):
    """On a grid of angles and of distances from the boundary, from 0 and a rounding upwards.

    Also in the smallest box, where several images of a particle are near.
    """
    rng = np.random.default_rng(3)
    scene, world = scene_of(settings("sheared", 2, box, shear={"velocity": 3.0}), 0.9, 0.2)
    angles = ANGLES[:: margins.size(quick=4, full=1)]
    repeats = range(margins.size(quick=1, full=4))
    segments = []
    for offset, sign, angle, _ in itertools.product(OFFSETS, (-1.0, 1.0), angles, repeats):
        pair = pair_touching_on_the_boundary(sign * offset, angle, box, rng)
        segments.append(segment(started_state(scene, *pair), scene, world, max_collisions=2))
    measure(margins, f"two particles in a box of {box[0]:g} by {box[1]:g}", segments)


@pytest.mark.slow
def test_fast_shear_makes_the_same_collisions(scheme, margins):
    """In a box of 25 with U up to 10^4.

    Particles start on both sides of the boundary, with the mean flow or nearly at rest.
    """
    rng = np.random.default_rng(4)
    segments = []
    for k in range(margins.size(quick=40, full=600)):
        velocity = float(10.0 ** rng.uniform(0, 4))
        scene, world = scene_of(
            settings("sheared", 8, [25, 25], shear={"velocity": velocity}), 0.9, 0.2
        )
        position = (scattered(rng, 8, (25.0, 12.0), 0.01) - [0.0, 6.0]) % 25.0
        speeds = rng.standard_normal(position.shape)
        speeds[:, 0] += k % 2 * velocity * (position[:, 1] / 25 - 0.5)
        segments.append(
            segment(started_state(scene, position, speeds), scene, world, max_collisions=3)
        )
    measure(margins, scheme, segments)
