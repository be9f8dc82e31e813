"""Initial states: no overlap, Maxwellian velocities and spins, no total momentum.

Particles of sizes too different for one lattice are sorted into classes of similar size, the large
ones first. Each class has a separate lattice, and occupies random sites that no larger particle
covers. Particles without a site get random positions, and overlapping particles then push each
other apart until no overlap remains, which takes long only close to jamming.

Lengths are in particle radii a. Arguments that recur: `position` (N, D), `radius` (N,), `lengths`
(D sides of a box from 0), and `periodic` (a flag for each axis).
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from roughgas.base import InputError
from roughgas.effects import Effects, inertia_of_spin
from roughgas.kernel.hooks import displacement
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import State
from roughgas.scene import (
    DIAMETER,
    MIN_CHANNEL_WIDTH,
    Scene,
    build,
    draw_bodies,
    shear_rate,
    wall_strokes,
    walls_of,
)
from roughgas.scene.settings import OPEN, SceneSettings

SIMILAR = 1.5  # maximum ratio of radii within a class
CLEARANCE = 1.0 + 1e-9  # minimum distance over the contact distance
SITES_AT_ONCE = 1_000_000  # that are examined together
MOST_OF_A_CLASS = 10_000_000  # sites of its lattice
PAIR_SKIN = 0.3  # of the mean radius: pairs within this gap are candidates for overlaps
DENSEST = 0.95  # packing fraction above which no positions are searched for
MAX_STEPS = 10_000
GROWN = 1.0 + 1e-6  # factor of radii during pushing, so that it ends after finitely many steps


def random_positions(
    radius: np.ndarray, lengths: Sequence[float], periodic: Sequence[bool], rng: np.random.Generator
) -> np.ndarray | None:
    """Return positions (N, D) without overlap for these radii in a box; None if the search fails.

    The radii (N,) and the sides `lengths` are in particle radii a, the box runs from 0; `periodic`
    has a flag for each axis. Particles do not overlap the sides of axes that are not periodic.
    """
    volume = np.sum(radius ** len(lengths)) * (np.pi if len(lengths) == 2 else 4.0 * np.pi / 3.0)
    if volume > DENSEST * math.prod(lengths):
        return None
    position = np.full((len(radius), len(lengths)), np.nan)
    for members in _classes(radius):
        free = _free_sites(radius[members].max(), position, radius, lengths, periodic)
        chosen = rng.permutation(free)[: len(members)]
        position[members[: len(chosen)]] = chosen
    siteless = np.isnan(position[:, 0])
    if not siteless.any():
        return position
    anywhere = rng.uniform(size=position.shape) * np.array(lengths)
    return _pushed_apart(np.where(siteless[:, None], anywhere, position), radius, lengths, periodic)


def _classes(radius):
    """Yield the indices of the particles of each size class, in order of decreasing size."""
    order = np.argsort(-radius, kind="stable")
    first = 0
    while first < len(order):
        end = np.searchsorted(-radius[order], -radius[order[first]] / SIMILAR, "right")
        yield order[first:end]
        first = end


def _free_sites(site_radius, position, radius, lengths, periodic):
    """Return the free sites (M, D) of a lattice for particles of `site_radius`.

    A site is free if such a particle would overlap no particle with a position; NaN: without one.
    `position` and `radius` are of all particles.
    """
    # a lattice for very small particles is coarsened: it has many more sites than needed
    spacing = (math.prod(lengths) / max(MOST_OF_A_CLASS, 4 * len(radius))) ** (1.0 / len(lengths))
    spacing = max(2.0 * site_radius * CLEARANCE, spacing)
    counts = np.array([max(1, math.floor(length / spacing)) for length in lengths])
    widths = np.array(lengths) / counts
    taken = np.zeros(counts, bool)
    placed = np.flatnonzero(~np.isnan(position[:, 0]))
    for members in _classes(radius[placed]) if len(placed) else ():
        members = placed[members]
        reach = np.ceil((site_radius + radius[members[0]]) / widths).astype(int)
        ranges = [np.arange(-min(n, c), min(n, c) + 1) for n, c in zip(reach, counts, strict=True)]
        offsets = _grid(ranges)
        batch_size = max(1, SITES_AT_ONCE // len(offsets))
        for first in range(0, len(members), batch_size):
            batch = members[first : first + batch_size]
            site = np.floor(position[batch] / widths).astype(int)[:, None] + offsets
            separation = (site + 0.5) * widths - position[batch][:, None]
            distance = CLEARANCE * (site_radius + radius[batch])
            near = (separation**2).sum(-1) < distance[:, None] ** 2
            inside = np.all(np.array(periodic) | ((site >= 0) & (site < counts)), axis=-1)
            taken[tuple((site % counts)[near & inside].T)] = True
    return (np.argwhere(~taken) + 0.5) * widths


def _pushed_apart(position, radius, lengths, periodic):
    """Return nearby positions without overlap; None if there are overlaps after MAX_STEPS.

    Overlapping particles push each other apart, the smaller one more.
    """
    radius = radius * GROWN
    low, high = radius[:, None], np.array(lengths) - radius[:, None]
    skin, moved, pairs = PAIR_SKIN * radius.mean(), math.inf, None
    for _ in range(MAX_STEPS):
        position = np.where(periodic, position % lengths, np.clip(position, low, high))
        if moved > 0.5 * skin:
            pairs, moved = _near_pairs(position, radius, lengths, periodic, skin), 0.0
        i, j = pairs
        separation = _separations(position, i, j, lengths, periodic)
        distance = np.maximum(np.sqrt((separation**2).sum(-1)), 1e-9)
        overlap = radius[i] + radius[j] - distance
        if overlap.max(initial=0.0) < (1.0 - 1.0 / GROWN) * radius.min():
            return position
        push = (np.maximum(overlap, 0.0) / distance)[:, None] * separation
        # the smaller particle moves more
        share = (radius[j] / (radius[i] + radius[j]))[:, None]
        step = np.zeros_like(position)
        np.add.at(step, i, push * share)
        np.add.at(step, j, -push * (1.0 - share))
        step = np.clip(step, -0.5 * skin, 0.5 * skin)
        position = position + step
        moved += float(np.abs(step).max()) * math.sqrt(len(lengths))
    return None


def _separations(position, i, j, lengths, periodic):
    """Return the separations (pairs, D) of particles i from the nearest images of particles j.

    i and j are arrays of indices, one entry for each pair.
    """
    separation = position[i] - position[j]
    return separation - np.where(periodic, lengths * np.round(separation / lengths), 0.0)


def _near_pairs(position, radius, lengths, periodic, skin):
    """Return all pairs of particles that overlap or have a gap below `skin`, in particle radii a.

    They are two arrays of indices (i, j).
    """
    reach = 2.0 * radius.max() + skin
    counts = np.array([max(1, math.floor(length / reach)) for length in lengths])
    cell = np.minimum((position / lengths * counts).astype(int), counts - 1)
    number = np.ravel_multi_index(tuple(cell.T), counts)
    order = np.argsort(number, kind="stable")
    starts = np.searchsorted(number[order], np.arange(counts.prod() + 1))
    pairs = []
    # with two cells along an axis both neighbours are the same cell: each is visited once
    steps = [range(-1, 2) if count > 2 else range(count) for count in counts]
    for step in itertools.product(*steps):
        neighbour = cell + step
        in_range = (neighbour >= 0) & (neighbour < counts)
        inside = np.all(in_range | (np.array(periodic) | (counts < 3)), -1)
        index = np.ravel_multi_index(tuple((neighbour % counts).T), counts)
        occupants = np.where(inside, starts[index + 1] - starts[index], 0)
        i = np.repeat(np.arange(len(position)), occupants)
        within = np.arange(len(i)) - np.repeat(np.cumsum(occupants) - occupants, occupants)
        j = order[np.repeat(starts[index], occupants) + within]
        once = i < j
        pairs.append((i[once], j[once]))
    i, j = (np.concatenate(indices) for indices in zip(*pairs, strict=True))
    separation = _separations(position, i, j, lengths, periodic)
    close = (separation**2).sum(-1) < (radius[i] + radius[j] + skin) ** 2
    return i[close], j[close]


TEMPERATURE = 1.0  # m a^2/T^2
GRAZE = 1e-6  # a: smaller overlaps are attributed to rounding, such as to single precision
VACANCIES = 1.3  # lattice sites per particle, if there is room
LOOSE_PACKING = 0.2  # volume fraction of a gas with an open top
MAX_SITES = 200_000_000
MAX_VOLUME_RATIO = 10.0  # of the largest particle to the mean, for a lattice in an open box
MIN_SPACING = DIAMETER * (1.0 + 1e-9)  # of sites for particles of radius 1, in a
# Sites in a cell of the denser lattice, centred in the plane and face-centred cubic in space
CENTRED = {
    2: [(0.25, 0.25), (0.75, 0.75)],
    3: [(0.25, 0.25, 0.25), (0.25, 0.75, 0.75), (0.75, 0.25, 0.75), (0.75, 0.75, 0.25)],
}


def check(experiment: SceneSettings) -> Scene:
    """Return the scene of the experiment at some r and beta.

    Raises InputError if no point (r, beta) of the experiment could be simulated.
    """
    scene = build(experiment, 0.5, 0.0 if "spin" in experiment.effects else -1.0)
    rng = np.random.default_rng(0)
    bodies = draw_bodies(scene, experiment, rng)
    if bodies is None:
        lattice(scene, experiment)
    else:
        _positions(scene, experiment, bodies, rng)
    if experiment.spin_temperature and scene.effects.spin is None:
        value = experiment.spin_temperature
        raise InputError("spin_temperature", value, "not be given where particles do not spin")
    return scene


def initial_state(
    scene: Scene,
    experiment: SceneSettings,
    rng: np.random.Generator,
    precision: type = np.float64,
) -> State:
    """Return a random state of `experiment.particles` particles, drawn with `rng`.

    Positions are random sites of a square (cubic) lattice, or of a centred one if only that has
    enough sites. Velocities are Maxwellian at temperature 1 m a^2/T^2 relative to the mean flow.
    Spins are zero, unless the experiment has a `spin_temperature`. `precision` is the type of
    trajectories and spins. Raises InputError if the particles do not fit.
    """
    number = experiment.particles
    bodies = draw_bodies(scene, experiment, rng)
    position = _positions(scene, experiment, bodies, rng)
    velocity = math.sqrt(TEMPERATURE) * rng.standard_normal(position.shape)
    if bodies is not None:
        velocity /= np.sqrt(bodies.mass)[:, None]
    velocity -= np.average(velocity, axis=0, weights=None if bodies is None else bodies.mass)
    if scene.effects.shear is not None:
        velocity[:, 0] += shear_rate(scene) * (position[:, 1] - scene.middle)
    spin = np.zeros((number, 2 * position.shape[1] - 3))
    temperature = experiment.spin_temperature
    if temperature > 0.0:  # of m q (a w)^2 for each component, as of m v^2 above
        if bodies is None:
            inertia = np.full(number, inertia_of_spin(scene.effects))
        else:
            inertia = bodies.mass * bodies.inertia
        spin = random_spins(inertia, spin.shape[1], temperature, rng)
    return new_state(scene, position, velocity, spin, precision, rng, bodies)


def random_spins(
    inertia: np.ndarray, axes: int, temperature: float, rng: np.random.Generator
) -> np.ndarray:
    """Return Maxwellian spins (N, axes), as surface velocities in a/T.

    `inertia` are the moments of inertia over the squared radii, (N,) in m; `axes` is the number of
    components of a spin; the temperature is in m a^2/T^2.
    """
    spin = rng.standard_normal((len(inertia), axes))
    return spin * np.sqrt(temperature / inertia[:, None])


def _positions(scene, experiment, bodies, rng):
    """Return initial positions (N, D) of the particles, in particle radii a.

    They are on random sites of a lattice, or from `random_positions` if the largest particles are
    much larger than the others, or too large for a lattice. `bodies` is None if all particles are
    alike. Raises InputError if the particles do not fit.
    """
    number, largest = experiment.particles, 1.0 if bodies is None else float(bodies.largest[0])
    if bodies is None or _fits_lattice(scene, experiment, bodies.radius):
        sites = lattice(scene, experiment, largest)
        return sites[np.sort(rng.permutation(len(sites))[:number])]
    filled = float(np.sum(bodies.radius ** len(scene.box)))
    lengths, origin = _region(scene, experiment, largest, filled)
    periodic = [side is not None for side in scene.box]
    while (position := random_positions(bodies.radius, lengths, periodic, rng)) is None:
        if experiment.box[-1] != OPEN:
            legal = "be fewer or smaller: no positions without overlap were found"
            raise InputError("particles", number, legal)
        lengths[-1] *= 2.0
    return position + origin


def _fits_lattice(scene, experiment, radius):
    """Return whether a lattice for the largest particles has room for all.

    In an open box, whether its height would be reasonable.
    """
    if experiment.box[-1] == OPEN:
        return radius.max() ** len(scene.box) <= MAX_VOLUME_RATIO * np.mean(
            radius ** len(scene.box)
        )
    try:
        lattice(scene, experiment, float(radius.max()))
    except InputError:
        return False
    return True


def check_positions(
    scene: Scene, position: np.ndarray, time: float, radius: np.ndarray | None = None
) -> None:
    """Raise InputError if particles overlap each other, a wall or the floor by more than GRAZE.

    Positions (N, D) and radii (N,), 1 by default, are in particle radii a; `time` (T) is absolute,
    for shaken walls and sliding images.
    """
    radius = np.ones(len(position)) if radius is None else radius
    planes = bounds(scene.effects, position.shape[1], time)
    for x, (low, high) in zip(position.T, planes, strict=True):
        outside = np.flatnonzero((x < low + radius - GRAZE) | (x > high - radius + GRAZE))
        if len(outside):
            first = outside[0]
            key, margin = f"initial position of particle {first}", radius[first]
            raise InputError(key, x[first], f"lie in [{low + margin:g}, {high - margin:g}]")
    if (pair := _overlapping(scene, position, time, radius)) is not None:
        i, j, distance = pair
        legal = f"be {radius[i] + radius[j]:g} or more, or the particles overlap"
        raise InputError(f"distance of particles {i} and {j}", f"{distance:.9g}", legal)


def bounds(effects: Effects, dimension: int, time: float) -> list[tuple[float, float]]:
    """Return the (low, high) positions of the walls along each axis at absolute `time` (T).

    A list of D pairs, in particle radii a; -inf and inf stand for missing walls.
    """
    planes = [[-math.inf, math.inf] for _ in range(dimension)]
    for wall in walls_of(effects).values():
        moved = 0.0 if wall.motion is None else displacement(wall, time)
        for end in wall.ends:
            planes[wall.axis][end] = wall.side.position * end + (1.0 - 2.0 * end) * moved
    return [(low, high) for low, high in planes]


def _overlapping(scene, position, time, radius):
    """Return the indices of two overlapping particles, and their distance; None without overlaps.

    `time` (T) is absolute, for sliding images. Particles and their images near the box are sorted
    along the first axis, and each is compared with its successors within the largest diameter.
    """
    diameter = DIAMETER * radius.max()
    inside = position.copy()
    for axis, length in enumerate(scene.box):
        if length is not None:
            inside[:, axis] %= length
    owner, points = np.arange(len(inside)), inside
    # the second axis last: its images are shifted along the first axis, with all images there
    for axis in sorted(range(len(scene.box)), key=lambda axis: axis == 1):
        length = scene.box[axis]
        if length is None:
            continue
        shift = np.eye(len(scene.box))[axis] * length
        if axis == 1 and scene.effects.shear is not None:
            shift[0] = displacement(scene.effects.shear, time)
        copies = [(owner, points)]
        for side in (-1, 1):
            image = points + side * shift
            near = (image[:, axis] > -diameter) & (image[:, axis] < length + diameter)
            copies.append((owner[near], image[near]))
        owner, points = (np.concatenate(arrays) for arrays in zip(*copies, strict=True))
    order = np.argsort(points[:, 0], kind="stable")
    owner, points = owner[order], points[order]
    for step in range(1, len(points)):
        separation = points[step:] - points[:-step]
        if not np.any(separation[:, 0] < diameter):
            return None
        distance = np.sqrt((separation**2).sum(axis=1))
        gap = distance - radius[owner[step:]] - radius[owner[:-step]]
        worst = int(np.argmin(gap))
        if gap[worst] < -GRAZE:
            return *sorted((owner[worst], owner[worst + step])), distance[worst]
    return None


def lattice(scene: Scene, experiment: SceneSettings, radius: float = 1.0) -> np.ndarray:
    """Return the sites (M, D) of a lattice that fills the box, in particle radii a.

    M is the number of particles or more. Particles of this radius do not overlap on the sites.
    Raises InputError if the lattice has too few sites, or more than MAX_SITES.
    """
    number, dimension, min_spacing = experiment.particles, len(scene.box), MIN_SPACING * radius
    lengths, origin = _region(scene, experiment, radius)
    spacing = max(min_spacing, (math.prod(lengths) / (VACANCIES * number)) ** (1.0 / dimension))
    counts = [max(1, math.floor(length / spacing)) for length in lengths]
    if math.prod(counts) < number:  # too dense for vacancies: the maximum number of sites
        counts = [math.floor(length / min_spacing) for length in lengths]
    if math.prod(counts) > MAX_SITES:
        legal = f"have at most {MAX_SITES:.0e} lattice sites"
        raise InputError("box", list(experiment.box), legal)
    sites = _sites(lengths, counts, [(0.5,) * dimension])
    if len(sites) < number and None not in scene.box:  # too dense for one site per cell
        cells = _densest_cells(lengths, min_spacing)
        sites = max(sites, _sites(lengths, cells, CENTRED[dimension]), key=len)
    if len(sites) < number:
        raise InputError("particles", number, f"be at most {len(sites)} in this box")
    return sites + origin


def _sites(lengths, counts, within):
    """Return the sites (M, D) of a lattice with `counts` cells along each axis of a box.

    Each cell has a site at every fractional position in `within`, a list of D-tuples.
    """
    sublattices = []
    for fractions in within:
        axes = [
            (np.arange(count) + fraction) * (length / count)
            for count, length, fraction in zip(counts, lengths, fractions, strict=True)
        ]
        sublattices.append(_grid(axes))
    return np.concatenate(sublattices)


def _grid(axes):
    """Return all points with these coordinates along each axis, an array (points, axes).

    `axes` has a one-dimensional array for each axis.
    """
    points = np.empty((*map(len, axes), len(axes)), np.result_type(*axes))
    for k, coordinates in enumerate(np.ix_(*axes)):
        points[..., k] = coordinates
    return points.reshape(-1, len(axes))


def _densest_cells(lengths, spacing):
    """Return the numbers of cells along each axis of the centred lattice with the most sites.

    `lengths` are the sides of the box. No cell is narrower than `spacing`, and no diagonal of a
    face shorter than twice that.
    """
    *lateral, last = lengths
    choices = [np.arange(1, math.floor(length / spacing) + 1) for length in lateral]
    counts = _grid(choices)
    sides = np.array(lateral) / counts
    min_side = np.sqrt(np.maximum(4.0 * spacing**2 - sides**2, spacing**2))
    possible = np.all(sides[:, 1:] >= min_side[:, :1], axis=1)
    layers = np.floor(last / min_side.max(axis=1)).astype(int) * possible
    best = np.argmax(counts.prod(axis=1) * layers)
    return [*counts[best].tolist(), int(layers[best])]


def _region(scene, experiment, radius, filled=None):
    """Return the lengths and the origin of the region to fill with particles, in particle radii a.

    `radius` is the radius of each; or the largest, and `filled` the sum of radius^D. Strokes of
    walls are left free. Under an open top the height follows from LOOSE_PACKING.
    """
    number = experiment.particles
    lengths = list(experiment.lengths)
    strokes = wall_strokes(scene.effects, len(lengths))
    if lengths[-1] is not None:
        return list(lengths - strokes.sum(axis=1)), strokes[:, 0]
    lengths[:-1] = lengths[:-1] - strokes[:-1].sum(axis=1)
    volume = math.pi if len(lengths) == 2 else 4.0 * math.pi / 3.0
    base = math.prod(lengths[:-1])
    spacing = MIN_SPACING * radius
    height = number * volume * radius ** len(lengths) / (LOOSE_PACKING * base)
    if filled is not None:
        lengths[-1] = max(filled * volume / (LOOSE_PACKING * base), MIN_CHANNEL_WIDTH * radius)
        return lengths, strokes[:, 0]
    layers = math.ceil(height / (DIAMETER * radius) + 1.0)
    # more layers if needed: the top is open
    per_layer = math.prod(math.floor(side / spacing) for side in lengths[:-1])
    layers = max(layers, -(-number // per_layer))
    lengths[-1] = layers * spacing
    return lengths, strokes[:, 0]
