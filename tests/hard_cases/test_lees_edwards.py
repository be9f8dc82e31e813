"""Lees-Edwards boundaries."""

import itertools
from decimal import Decimal

import numpy as np
import pytest
from brute_force import run, scene_of, settings
from compiled import from_python
from exact import exactly, segment

from roughgas.effects import drives
from roughgas.effects.drives import Shear
from roughgas.kernel import memory
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BASE

# As in test_exact_arithmetic.py, where these limits come from
SMALL, ROUNDINGS = 1e-6, 10.0
phase = from_python(drives.offset)


@pytest.fixture(params=["swept", "in cells"])
def scheme(request, monkeypatch):
    """By which of the two schemes contacts are found, however few the particles are."""
    monkeypatch.setattr(memory, "FEW", 0 if request.param == "in cells" else 700)
    monkeypatch.setattr(memory, "PER_CELL", {2: 0.0, 3: 0.0})
    return request.param


def measure(margins, what, segments):
    """Whether the kernel is off by more than roundings, and from where on its pairs are others."""
    tried = {"tried": sum(len(one.separation) for one in segments), "unit": "collisions"}
    ratio = max(one.ratio(SMALL) for one in segments)
    parted = min(one.parted for one in segments)
    margins.at_least(f"{what}: separation from which pairs differ", parted, SMALL, **tried)
    name = f"{what}: separation, over what roundings make of themselves"
    margins.at_most(name, ratio, ROUNDINGS, **tried)


GAS = settings("sheared", 12, [32, 20], shear={"velocity": 4.0})
LENGTH, HEIGHT, U, PERIOD = 32.0, 20.0, 4.0, 8.0
GRID = 2.0**-24  # all numbers of a start are its multiples, so that no sum of them is rounded


def scattered(rng, number, box, gap):
    """Places in a box that are at least a diameter and a gap apart, by any image."""
    places = []
    while len(places) < number:
        one = rng.uniform(0, box)
        d = np.abs(np.array(places).reshape(-1, 2) - one)
        if np.all(np.hypot(*np.minimum(d, box - d).T) > 2.0 + gap):
            places.append(one)
    return np.array(places)


def on_grid(numbers):
    return np.round(numbers / GRID) * GRID


def started(scene, position, velocity, base=0.0):
    state = new_state(scene, position, velocity, np.zeros((len(position), 1)))
    state.clock[BASE] = base
    run(state, scene, 0)
    return state


class View:
    """How one gas is seen from another frame, of other images, or at another time."""

    def __init__(self, boost=(0.0, 0.0), images=0, later=0.0):
        self.boost, self.images, self.later = np.array(boost), images, later

    def of_start(self, position, velocity, slid, rng):
        shape = (len(position), 2)
        along, up = rng.integers(-self.images, self.images, shape, endpoint=True).T[..., None]
        shift = np.hstack([along * LENGTH + up * slid, up * HEIGHT])
        return position + shift, velocity + self.boost + np.hstack([up * U, 0.0 * up])

    def of_exact(self, one, start):
        seen, elapsed = one.copy(), one.time - start
        boost = [Decimal(c) for c in (*self.boost, 0.0)]
        seen.time += Decimal(self.later)
        seen.x = [tuple(a + c * elapsed for a, c in zip(x, boost, strict=True)) for x in seen.x]
        seen.v = [tuple(a + c for a, c in zip(v, boost, strict=True)) for v in seen.v]
        return seen


VIEWS = {
    "in motion along the flow": lambda rng: View(boost=(speed(rng), 0.0)),
    "in motion across the flow": lambda rng: View(boost=(0.0, speed(rng))),
    "by other images": lambda rng: View(images=int(rng.choice([1, 30, 1000]))),
    "later by whole periods of the slide": lambda rng: View(
        later=PERIOD * float(2 ** rng.integers(10, 26))
    ),
}


def speed(rng):
    return float(rng.choice([-1, 1]) * on_grid(2.0 ** rng.uniform(-2, 10)))


@pytest.mark.parametrize("name", VIEWS)
def test_the_gas_is_the_same_however_it_is_seen(name, scheme, margins):
    """The kernel runs what is seen, the exact simulation the gas at rest in its first images."""
    rng = np.random.default_rng(1)
    scene, world = scene_of(GAS, 0.9, 0.2)
    segments = []
    for _ in range(margins.size(quick=2, full=20)):
        view, time = VIEWS[name](rng), float(on_grid(rng.uniform(0, PERIOD)))
        position = on_grid(scattered(rng, 12, (LENGTH, HEIGHT), 0.1))
        velocity = on_grid(rng.standard_normal((12, 2)))
        velocity[:, 0] += on_grid(U * (position[:, 1] / HEIGHT - 0.5))
        gas = exactly(started(scene, position, velocity, time), scene, world)
        seen = started(scene, *view.of_start(position, velocity, U * time, rng), time + view.later)
        begin = gas.time
        segments.append(
            segment(seen, scene, world, 40, gas, lambda one, v=view, t=begin: v.of_exact(one, t))
        )
    measure(margins, f"{name}, {scheme}", segments)


def test_the_slide_is_where_it_should_be(margins):
    """U t mod L from U and the period L/U, which are rounded once each: 2 U t 2^-53 and L 2^-52."""
    rng = np.random.default_rng(2)
    tried = margins.size(quick=1000, full=100_000)
    largest = 0.0
    for _ in range(tried):
        length, velocity, time = 10.0 ** rng.uniform((0.7, -3, 0), (3, 4, 12))
        found = Decimal(phase(Shear(velocity, length), 4, time))
        true = Decimal(velocity) * Decimal(time)
        off = (found - true) / Decimal(length)
        off = abs(off - round(off)) * Decimal(length)
        largest = max(largest, float(off / (true + Decimal(length))))
    what = "offset of the images, off by, over U t + L"
    margins.at_most(what, largest, 2.0**-52, tried, "instants")


OFFSETS = (0.0, 2.0**-52, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3)
ANGLES = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)


def touching_on_the_boundary(offset, angle, box, rng):
    """Two particles that touch after a time 1/4, one of them `offset` from a corner then."""
    n = np.array([np.cos(angle), np.sin(angle)])
    corner = np.array(box) * rng.integers(0, 2, 2) * (1.0 + offset) + offset
    while True:
        velocity = rng.standard_normal((2, 2))
        position = np.array([corner, corner + 2.0 * n]) - 0.25 * velocity
        d = position[0] - position[1]
        if np.hypot(*(d - np.round(d / box) * box)) > 2.0:  # not even by an image
            return position, velocity


@pytest.mark.parametrize("box", [[11.0, 9.0], [4.01, 4.01]])
def test_contacts_coincide_with_crossings(box, margins):
    """On a grid of angles and of distances from the boundary, from none and one rounding up; also
    in the smallest box, in which a particle has several images around it."""
    rng = np.random.default_rng(3)
    scene, world = scene_of(settings("sheared", 2, box, shear={"velocity": 3.0}), 0.9, 0.2)
    angles = ANGLES[:: margins.size(quick=4, full=1)]
    repeats = range(margins.size(quick=1, full=4))
    segments = []
    for offset, sign, angle, _ in itertools.product(OFFSETS, (-1.0, 1.0), angles, repeats):
        pair = touching_on_the_boundary(sign * offset, angle, box, rng)
        segments.append(segment(started(scene, *pair), scene, world, most=2))
    measure(margins, f"two particles in a box of {box[0]:g} by {box[1]:g}", segments)


def test_fast_shear_makes_the_same_collisions(scheme, margins):
    """Box of 25, U up to 10^4; the particles begin on either side of the boundary, with the mean
    flow or nearly at rest."""
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
        segments.append(segment(started(scene, position, speeds), scene, world, most=3))
    measure(margins, scheme, segments)
