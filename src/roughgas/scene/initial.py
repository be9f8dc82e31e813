"""Where a simulation starts: no overlap, Maxwellian velocities and spins, no total momentum."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas.base import InputError
from roughgas.effects import Effects, inertia_of_spin
from roughgas.kernel import hooks
from roughgas.kernel.hooks import displacement
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import State
from roughgas.scene.random_packing import random_positions
from roughgas.scene.scene import (
    DIAMETER,
    NARROWEST_CHANNEL,
    Scene,
    build,
    shear_rate,
    strokes,
)
from roughgas.scene.species import draw_bodies

TEMPERATURE = 1.0  # m a^2/T^2
GRAZE = 1e-6  # a: overlaps as small as this are roundings, such as those of single precision
VACANCIES = 1.3  # lattice sites per particle, if there is room
LOOSE_PACKING = 0.2  # volume fraction of a gas with an open top
MOST_SITES = 200_000_000
FITTING = 10.0  # volume of the largest particle, over the mean, that a bed's lattice is laid for
LEAST = DIAMETER * (1.0 + 1e-9)  # distance of two sites, in a
# Where the sites are in a cell of the closer lattice: in space a cube with centred faces
CENTRED = {
    2: [(0.25, 0.25), (0.75, 0.75)],
    3: [(0.25, 0.25, 0.25), (0.25, 0.75, 0.75), (0.75, 0.25, 0.75), (0.75, 0.75, 0.25)],
}


def check(experiment: Mapping[str, Any]) -> Scene:
    """Return the scene of some point. Raises InputError if no point could be simulated."""
    scene = build(experiment, 0.5, 0.0 if "spin" in experiment["effects"] else -1.0)
    rng = np.random.default_rng(0)
    bodies = draw_bodies(scene, experiment, rng)
    if bodies is None:
        lattice(scene, experiment)
    else:
        _places(scene, experiment, bodies, rng)
    if experiment.get("spin_temperature") and scene.effects.spin is None:
        value = experiment["spin_temperature"]
        raise InputError("spin_temperature", value, "not be given where particles do not spin")
    target = experiment.get("schedule", {}).get("target_stderr")
    if target and scene.effects.spin is None:
        raise InputError("schedule.target_stderr", target, "not be given where nothing spins")
    return scene


def initial_state(
    scene: Scene,
    experiment: Mapping[str, Any],
    rng: np.random.Generator,
    precision: type = np.float64,
) -> State:
    """Return a random state of `experiment["particles"]` particles.

    They sit on random sites of a square (cubic) lattice, or of a centred one if only that holds
    them, with Maxwellian velocities at temperature 1 m a^2/T^2 relative to the mean flow. None of
    them spins, unless the experiment has a `spin_temperature`. `precision` is that in which
    trajectories and spins are kept. Raises InputError if they do not fit.
    """
    number = experiment["particles"]
    bodies = draw_bodies(scene, experiment, rng)
    position = _places(scene, experiment, bodies, rng)
    velocity = math.sqrt(TEMPERATURE) * rng.standard_normal(position.shape)
    if bodies is not None:
        velocity /= np.sqrt(bodies.mass)[:, None]
    velocity -= np.average(velocity, axis=0, weights=None if bodies is None else bodies.mass)
    if scene.effects.shear is not None:
        velocity[:, 0] += shear_rate(scene) * (position[:, 1] - scene.middle)
    spin = np.zeros((number, 2 * position.shape[1] - 3))
    temperature = experiment.get("spin_temperature", 0.0)
    if temperature > 0.0:  # of m q (a w)^2 for each component, as of m v^2 above
        q = inertia_of_spin(scene.effects) if bodies is None else bodies.mass * bodies.inertia
        spin = rng.standard_normal(spin.shape) * np.sqrt(temperature / np.reshape(q, (-1, 1)))
    return new_state(scene, position, velocity, spin, precision, rng, bodies)


def _places(scene, experiment, bodies, rng):
    """Return places (N, D) on random sites of a lattice; where the largest are much larger than the
    others, or too large for it, wherever there is room."""
    number, largest = experiment["particles"], 1.0 if bodies is None else float(bodies.largest[0])
    if bodies is None or _fits_lattice(scene, experiment, bodies.radius):
        sites = lattice(scene, experiment, largest)
        return sites[np.sort(rng.permutation(len(sites))[:number])]
    lengths, begins = _room(
        scene, experiment, largest, float(np.sum(bodies.radius ** len(scene.box)))
    )
    periodic = [side is not None for side in scene.box]
    while (found := random_positions(bodies.radius, lengths, periodic, rng)) is None:
        if experiment["box"][-1] != "open":
            legal = "be fewer or smaller: no positions without overlap were found"
            raise InputError("particles", number, legal)
        lengths[-1] *= 2.0
    return found + begins


def _fits_lattice(scene, experiment, radius):
    """Return whether a lattice for the largest particles has room for all, not too high up."""
    if experiment["box"][-1] == "open":
        return radius.max() ** len(scene.box) <= FITTING * np.mean(radius ** len(scene.box))
    try:
        lattice(scene, experiment, float(radius.max()))
    except InputError:
        return False
    return True


def check_places(
    scene: Scene, position: np.ndarray, time: float, radius: np.ndarray | None = None
) -> None:
    """Raise InputError where particles at these positions (N, D) overlap, or are in a wall or in
    the floor at `time` (T), by more than GRAZE. Their radii (N,) are 1 if not given."""
    effects, radius = scene.effects, np.ones(len(position)) if radius is None else radius
    for places, (low, high) in zip(
        position.T, bounds(effects, position.shape[1], time), strict=True
    ):
        outside = np.flatnonzero((places < low + radius - GRAZE) | (places > high - radius + GRAZE))
        if len(outside):
            first = outside[0]
            key, own = f"initial position of particle {first}", radius[first]
            raise InputError(key, places[first], f"lie in [{low + own:g}, {high - own:g}]")
    pair = _overlapping(scene, position, time, radius)
    if pair is not None:
        i, j, distance = pair
        legal = f"be {radius[i] + radius[j]:g} or more, or the particles overlap"
        raise InputError(f"distance of particles {i} and {j}", f"{distance:.9g}", legal)


def bounds(effects: Effects, dimension: int, time: float) -> list[tuple[float, float]]:
    """Return between which planes the gas is at `time` (T) along each axis, in a; inf: no wall."""
    found = [[-math.inf, math.inf] for _ in range(dimension)]
    closed = effects.walls or effects.shaken_walls
    if closed is not None:
        found[0] = [0.0, closed.width]
    if effects.floor is not None:
        found[-1][0] = displacement(effects.floor, time)
    walls: list[Any] = [effects[part.place] for part in hooks.present(effects, "closes")]
    for wall in walls:
        if hasattr(wall, "place"):
            _, inwards, at, _ = wall.place
            moved = displacement(wall, time) if hasattr(wall, "motion") else 0.0
            found[wall.axis][int(inwards < 0.0)] = at + inwards * moved
    return [(low, high) for low, high in found]


def _overlapping(scene, position, time, radius):
    """Return the numbers of two particles that overlap, and their distance; or None.

    Particles and their images near the box are sorted along the first axis, and each is compared
    with those that follow it within the largest diameter.
    """
    diameter = DIAMETER * radius.max()
    inside = position.copy()
    for axis, length in enumerate(scene.box):
        if length is not None:
            inside[:, axis] %= length
    owner, places = np.arange(len(inside)), inside
    # the second axis last, so that images along the first have slid as a whole
    for axis in sorted(range(len(scene.box)), key=lambda axis: axis == 1):
        length = scene.box[axis]
        if length is None:
            continue
        shift = np.eye(len(scene.box))[axis] * length
        if axis == 1 and scene.effects.shear is not None:
            shift[0] = displacement(scene.effects.shear, time)
        parts = [(owner, places)]
        for side in (-1, 1):
            image = places + side * shift
            near = (image[:, axis] > -diameter) & (image[:, axis] < length + diameter)
            parts.append((owner[near], image[near]))
        owner, places = (np.concatenate(one) for one in zip(*parts, strict=True))
    order = np.argsort(places[:, 0], kind="stable")
    owner, places = owner[order], places[order]
    for step in range(1, len(places)):
        apart = places[step:] - places[:-step]
        if not np.any(apart[:, 0] < diameter):
            return None
        distance = np.sqrt((apart**2).sum(axis=1))
        gap = distance - radius[owner[step:]] - radius[owner[:-step]]
        worst = int(np.argmin(gap))
        if gap[worst] < -GRAZE:
            return *sorted((owner[worst], owner[worst + step])), distance[worst]
    return None


def lattice(scene: Scene, experiment: Mapping[str, Any], radius: float = 1.0) -> np.ndarray:
    """Return sites (M, D) of a lattice that fills the box, M >= the number of particles, in a.

    Particles of this radius do not overlap there.
    """
    number, dimension, least = experiment["particles"], len(scene.box), LEAST * radius
    lengths, begins = _room(scene, experiment, radius)
    spacing = max(least, (math.prod(lengths) / (VACANCIES * number)) ** (1.0 / dimension))
    counts = [max(1, math.floor(length / spacing)) for length in lengths]
    if math.prod(counts) < number:  # too dense for vacancies: as many sites as there is room for
        counts = [math.floor(length / least) for length in lengths]
    if math.prod(counts) > MOST_SITES:
        legal = f"have at most {MOST_SITES:.0e} lattice sites"
        raise InputError("box", experiment["box"], legal)
    sites = _sites(lengths, counts, [(0.5,) * dimension])
    if len(sites) < number and None not in scene.box:  # too dense for one site to a cell
        sites = max(sites, _sites(lengths, _closest(lengths, least), CENTRED[dimension]), key=len)
    if len(sites) < number:
        raise InputError("particles", number, f"be at most {len(sites)} in this box")
    return sites + begins


def _sites(lengths, counts, within):
    """Return the sites of a lattice of `counts` cells, at the places `within` each cell."""
    parts = []
    for place in within:
        axes = [
            (np.arange(count) + share) * (length / count)
            for count, length, share in zip(counts, lengths, place, strict=True)
        ]
        parts.append(np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1))
    return np.concatenate([part.reshape(-1, len(lengths)) for part in parts])


def _closest(lengths, least):
    """Return the cells along each axis of the centred lattice that has the most sites.

    No cell is narrower than `least`, nor a face of it, from corner to corner, than twice that.
    """
    *others, last = lengths
    choices = [np.arange(1, math.floor(length / least) + 1) for length in others]
    counts = np.stack(np.meshgrid(*choices, indexing="ij"), axis=-1).reshape(-1, len(others))
    sides = np.array(others) / counts
    beside = np.sqrt(np.maximum(4.0 * least**2 - sides**2, least**2))
    possible = np.all(sides[:, 1:] >= beside[:, :1], axis=1)
    layers = np.floor(last / beside.max(axis=1)).astype(int) * possible
    best = np.argmax(counts.prod(axis=1) * layers)
    return [*counts[best].tolist(), int(layers[best])]


def _room(scene, experiment, radius, filled=None):
    """Return the lengths of the region to fill, and where it begins along each axis.

    The particles are those of this radius, or no larger; `filled` is then the sum of radius^D.
    """
    number = experiment["particles"]
    lengths = [None if side == "open" else float(side) for side in experiment["box"]]
    taken = strokes(scene.effects, len(lengths))
    if lengths[-1] is not None:
        return list(lengths - taken.sum(axis=1)), taken[:, 0]
    lengths[:-1] = lengths[:-1] - taken[:-1].sum(axis=1)
    volume = math.pi if len(lengths) == 2 else 4.0 * math.pi / 3.0
    base = math.prod(lengths[:-1])
    least = LEAST * radius
    height = number * volume * radius ** len(lengths) / (LOOSE_PACKING * base)
    if filled is not None:
        lengths[-1] = max(filled * volume / (LOOSE_PACKING * base), NARROWEST_CHANNEL * radius)
        return lengths, scene.effects.floor.amplitude
    layers = math.ceil(height / (DIAMETER * radius) + 1.0)
    # there is always room above
    layers = max(layers, -(-number // math.prod(math.floor(side / least) for side in lengths[:-1])))
    lengths[-1] = layers * least
    return lengths, taken[:, 0]
