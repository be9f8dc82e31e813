"""Where a simulation starts: no overlap, Maxwellian velocities and spins, no total momentum.

Particles too unlike for one lattice are sorted into classes of similar size, the large ones first.
Each class has a lattice of its own, and takes sites of it at random where no larger particle is.
Those that find no site are put anywhere, and all that overlap then push each other apart until none
do, which takes long only close to where the gas would jam. Lengths are in a; `periodic` says of
each axis whether it repeats.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.base import InputError
from roughgas.effects import Effects, inertia_of_spin
from roughgas.kernel.hooks import displacement
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import State
from roughgas.scene import (
    DIAMETER,
    NARROWEST_CHANNEL,
    Scene,
    build,
    draw_bodies,
    shear_rate,
    strokes,
    walls_of,
)

SIMILAR = 1.5  # ratio of radii within a class
ROOM = 1.0 + 1e-9  # distances, over those at contact
AT_ONCE = 1_000_000  # sites that are looked at together
MOST_OF_A_CLASS = 10_000_000  # sites of its lattice
SKIN = 0.3  # of the mean radius: pairs as near as this may come to overlap
DENSEST = 0.95  # share of the box; above it places are not looked for
MOST_STEPS = 10_000
GROWN = 1.0 + 1e-6  # radii while particles push each other, to part in finitely many steps


def random_positions(
    radius: np.ndarray, lengths: Sequence[float], periodic: Sequence[bool], rng: np.random.Generator
) -> np.ndarray | None:
    """Return places (N, D) for particles of these radii (N,) in a box from 0 to these lengths.

    None where they were not found.
    """
    volume = np.sum(radius ** len(lengths)) * (np.pi if len(lengths) == 2 else 4.0 * np.pi / 3.0)
    if volume > DENSEST * math.prod(lengths):
        return None
    placed = np.full((len(radius), len(lengths)), np.nan)
    for members in _classes(radius):
        free = _free_sites(radius[members].max(), placed, radius, lengths, periodic)
        chosen = rng.permutation(free)[: len(members)]
        placed[members[: len(chosen)]] = chosen
    homeless = np.isnan(placed[:, 0])
    if not homeless.any():
        return placed
    anywhere = rng.uniform(size=placed.shape) * np.array(lengths)
    return _pushed_apart(np.where(homeless[:, None], anywhere, placed), radius, lengths, periodic)


def _classes(radius):
    """Yield the particles of each class, that of the largest first."""
    order = np.argsort(-radius, kind="stable")
    first = 0
    while first < len(order):
        end = np.searchsorted(-radius[order], -radius[order[first]] / SIMILAR, "right")
        yield order[first:end]
        first = end


def _free_sites(own, placed, radius, lengths, periodic):
    """Return the sites (M, D) of a lattice at which a particle of radius `own` meets nobody."""
    # of a lattice of the smallest, a coarser one: it has many more sites than it needs
    least = (math.prod(lengths) / max(MOST_OF_A_CLASS, 4 * len(radius))) ** (1.0 / len(lengths))
    least = max(2.0 * own * ROOM, least)
    counts = np.array([max(1, math.floor(length / least)) for length in lengths])
    widths = np.array(lengths) / counts
    taken = np.zeros(counts, bool)
    here = np.flatnonzero(~np.isnan(placed[:, 0]))
    for members in _classes(radius[here]) if len(here) else ():
        members = here[members]
        reach = np.ceil((own + radius[members[0]]) / widths).astype(int)
        ranges = [np.arange(-min(n, c), min(n, c) + 1) for n, c in zip(reach, counts, strict=True)]
        around = _grid(ranges)
        together = max(1, AT_ONCE // len(around))
        for first in range(0, len(members), together):
            some = members[first : first + together]
            site = np.floor(placed[some] / widths).astype(int)[:, None] + around
            apart = (site + 0.5) * widths - placed[some][:, None]
            near = (apart**2).sum(-1) < (ROOM * (own + radius[some]))[:, None] ** 2
            inside = np.all(np.array(periodic) | ((site >= 0) & (site < counts)), axis=-1)
            taken[tuple((site % counts)[near & inside].T)] = True
    return (np.argwhere(~taken) + 0.5) * widths


def _pushed_apart(position, radius, lengths, periodic):
    """Return places nearby at which no particles overlap; None where they were not found."""
    radius = radius * GROWN
    low, high = radius[:, None], np.array(lengths) - radius[:, None]
    skin, moved, pairs = SKIN * radius.mean(), math.inf, None
    for _ in range(MOST_STEPS):
        if moved > 0.5 * skin:
            pairs, moved = _near(position, radius, lengths, periodic, skin), 0.0
        i, j = pairs
        apart = _apart(position, i, j, lengths, periodic)
        distance = np.maximum(np.sqrt((apart**2).sum(-1)), 1e-9)
        lacking = radius[i] + radius[j] - distance
        if lacking.max(initial=0.0) < (1.0 - 1.0 / GROWN) * radius.min():
            return position
        push = (np.maximum(lacking, 0.0) / distance)[:, None] * apart
        # the lighter one yields
        share = (radius[j] / (radius[i] + radius[j]))[:, None]
        step = np.zeros_like(position)
        np.add.at(step, i, push * share)
        np.add.at(step, j, -push * (1.0 - share))
        step = np.clip(step, -0.5 * skin, 0.5 * skin)
        position = position + step
        position = np.where(periodic, position % lengths, np.clip(position, low, high))
        moved += float(np.abs(step).max()) * math.sqrt(len(lengths))
    return None


def _apart(position, i, j, lengths, periodic):
    """Return the separations (pairs, D) of nearest images."""
    apart = position[i] - position[j]
    return apart - np.where(periodic, lengths * np.round(apart / lengths), 0.0)


def _near(position, radius, lengths, periodic, skin):
    """Return all pairs (i, j) that overlap or are apart by less than `skin`."""
    reach = 2.0 * radius.max() + skin
    counts = np.array([max(1, math.floor(length / reach)) for length in lengths])
    cell = np.minimum((position / lengths * counts).astype(int), counts - 1)
    number = np.ravel_multi_index(tuple(cell.T), counts)
    order = np.argsort(number, kind="stable")
    starts = np.searchsorted(number[order], np.arange(counts.prod() + 1))
    found = []
    # as few cells as two repeat: each is looked at once
    steps = [range(-1, 2) if count > 2 else range(count) for count in counts]
    for step in itertools.product(*steps):
        other = cell + step
        inside = np.all((other >= 0) & (other < counts) | (np.array(periodic) | (counts < 3)), -1)
        beside = np.ravel_multi_index(tuple((other % counts).T), counts)
        many = np.where(inside, starts[beside + 1] - starts[beside], 0)
        i = np.repeat(np.arange(len(position)), many)
        within = np.arange(len(i)) - np.repeat(np.cumsum(many) - many, many)
        j = order[np.repeat(starts[beside], many) + within]
        keep = i < j
        found.append((i[keep], j[keep]))
    i, j = (np.concatenate(part) for part in zip(*found, strict=True))
    apart = _apart(position, i, j, lengths, periodic)
    close = (apart**2).sum(-1) < (radius[i] + radius[j] + skin) ** 2
    return i[close], j[close]


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
    filled = float(np.sum(bodies.radius ** len(scene.box)))
    lengths, begins = _room(scene, experiment, largest, filled)
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
    radius = np.ones(len(position)) if radius is None else radius
    planes = bounds(scene.effects, position.shape[1], time)
    for places, (low, high) in zip(position.T, planes, strict=True):
        outside = np.flatnonzero((places < low + radius - GRAZE) | (places > high - radius + GRAZE))
        if len(outside):
            first = outside[0]
            key, own = f"initial position of particle {first}", radius[first]
            raise InputError(key, places[first], f"lie in [{low + own:g}, {high - own:g}]")
    if (pair := _overlapping(scene, position, time, radius)) is not None:
        i, j, distance = pair
        legal = f"be {radius[i] + radius[j]:g} or more, or the particles overlap"
        raise InputError(f"distance of particles {i} and {j}", f"{distance:.9g}", legal)


def bounds(effects: Effects, dimension: int, time: float) -> list[tuple[float, float]]:
    """Return between which planes the gas is at `time` (T) along each axis, in a; inf: no wall."""
    found = [[-math.inf, math.inf] for _ in range(dimension)]
    for wall in walls_of(effects).values():
        moved = 0.0 if wall.motion is None else displacement(wall, time)
        for end in wall.ends:
            found[wall.axis][end] = wall.place.at * end + (1.0 - 2.0 * end) * moved
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
        parts.append(_grid(axes))
    return np.concatenate(parts)


def _grid(axes):
    """Return all points with these coordinates along each axis, (points, axes)."""
    points = np.empty((*map(len, axes), len(axes)), np.result_type(*axes))
    for k, places in enumerate(np.ix_(*axes)):
        points[..., k] = places
    return points.reshape(-1, len(axes))


def _closest(lengths, least):
    """Return the cells along each axis of the centred lattice that has the most sites.

    No cell is narrower than `least`, nor a face of it, from corner to corner, than twice that.
    """
    *others, last = lengths
    choices = [np.arange(1, math.floor(length / least) + 1) for length in others]
    counts = _grid(choices)
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
