"""Places for particles too unlike for one lattice: first the large ones, then what is between them.

Particles are sorted into classes of similar size. Each class has a lattice of its own, and takes
sites of it at random where no larger particle is. Those that find no site are put anywhere, and all
that overlap then push each other apart until none do, which takes long only close to where the gas
would jam. Lengths are in a; `periodic` says of each axis whether it repeats.
"""

import itertools
import math
from collections.abc import Sequence

import numpy as np

SIMILAR = 1.5  # ratio of radii within a class
ROOM = 1.0 + 1e-9  # distances, over those at contact
AT_ONCE = 1_000_000  # sites that are looked at together
MOST_SITES = 10_000_000  # of a lattice
SKIN = 0.3  # of the mean radius: pairs as near as this may come to overlap
DENSEST = 0.95  # share of the box; above it places are not looked for
MOST_STEPS = 10_000
GROWN = (
    1.0 + 1e-6
)  # radii while particles push each other: so that they part in finitely many steps


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
    least = (math.prod(lengths) / max(MOST_SITES, 4 * len(radius))) ** (1.0 / len(lengths))
    least = max(2.0 * own * ROOM, least)
    counts = np.array([max(1, math.floor(length / least)) for length in lengths])
    widths = np.array(lengths) / counts
    taken = np.zeros(counts, bool)
    here = np.flatnonzero(~np.isnan(placed[:, 0]))
    for members in _classes(radius[here]) if len(here) else ():
        members = here[members]
        reach = np.ceil((own + radius[members[0]]) / widths).astype(int)
        ranges = [np.arange(-min(n, c), min(n, c) + 1) for n, c in zip(reach, counts, strict=True)]
        around = np.stack(np.meshgrid(*ranges, indexing="ij"), axis=-1).reshape(-1, len(lengths))
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
        apart = position[i] - position[j]
        apart -= np.where(periodic, lengths * np.round(apart / lengths), 0.0)
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
    apart = position[i] - position[j]
    apart -= np.where(periodic, lengths * np.round(apart / lengths), 0.0)
    close = (apart**2).sum(-1) < (radius[i] + radius[j] + skin) ** 2
    return i[close], j[close]
