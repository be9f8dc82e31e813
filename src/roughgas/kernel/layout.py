"""Memory layout of a State."""

import functools
import math
from typing import NamedTuple

import numpy as np

from roughgas.kernel import hierarchy, hooks
from roughgas.kernel.scheme import (
    LISTS,
    MIN_CELLS,
    SWEEP,
    Grid,
    cell_grid,
    chosen_scheme,
    density_of,
    filling,
)
from roughgas.kernel.state import (
    COUNTS,
    NOBODY,
    NOTHING,
    SPAN,
    Agenda,
    Blocks,
    Bodies,
    Calendar,
    Cells,
    Log,
    Neighbours,
    PathCounts,
    Shortlist,
    SizeClasses,
    State,
    Sweep,
)

LANES = 16  # arrays for the sweep are padded to multiples of this: whole vector registers
BLOCK = 16  # particles in a block of the queue; divides LANES
BATCH = 8  # candidates whose contacts are predicted at once
SWEEP_SLOTS, CELL_SLOTS = 8, 2  # upcoming contacts stored per particle
CACHE_LINE = 64  # bytes
MIN_CELL_WIDTH = 2.002  # over the largest radius: a diameter, and a margin for rounding
BODY_FIELDS = {"radius": (float,), "mass": (float,), "inertia": (float,), "species": (np.int32,)}
TIMES_OF = "moment of "  # before the name of an effect: its array of particle_times
# Sides of the regions of neighbour lists, in a; cells are wider by as much. The surroundings of a
# particle in a bed change fast as the bed lands.
BED_SKIN, GAS_SKIN = 0.45, {2: 1.0, 3: 0.7}
LIST_CAPACITY = 24  # neighbours on a list; in dense spheres 12 of them, and rarely more than 20


def new_state(scene, position, velocity, spin, precision=np.float64, rng=None, bodies=None):
    """Return a state at time 0, from the positions, velocities and spins of all particles.

    Positions (N, D) are in particle radii a, velocities (N, D) and spins (N, 2 D - 3), which are
    surface velocities, in a/T. `precision` is the type of trajectories and spins. Effects that draw
    random numbers start from the numpy generator `rng`, by default with a fixed seed. A scene
    without spin ignores the spins; a scene with several species needs the Bodies. The
    chosen scheme finds candidates for contacts, or a sweep where the box has no room for cells.

    Particles are stored in the order of their positions: their order in memory decides between
    simultaneous events, and results must not depend on how the particles were numbered.
    """
    number, dimension = position.shape
    radii = np.ones(number) if bodies is None else bodies.radius
    gas, narrowest = filling(position, radii), MIN_CELL_WIDTH * radii.max()
    scheme = chosen_scheme(scene, gas, density_of(scene, gas, narrowest).packing)
    grids = None if scheme == SWEEP else _grids(scene, gas, bodies, narrowest, scheme == LISTS)
    if grids is None:
        state = _swept_state(scene, number, dimension, precision)
    else:
        state = _celled_state(scene, number, dimension, precision, grids)
    order = np.lexsort(position.T[::-1])
    state.trajectory[:, :dimension] = position[order]
    state.trajectory[:, dimension:-1] = velocity[order]
    if state.spin is not None:
        state.spin[:] = spin[order]
    if bodies is not None:
        for name in BODY_FIELDS:
            getattr(state.bodies, name)[:] = getattr(bodies, name)[order]
        state.bodies.largest[0] = bodies.radius.max()
        state.bodies.pairs[:] = bodies.pairs
        if state.sweep is not None:
            rounded_up = np.nextafter(state.bodies.radius.astype(np.float32), np.float32(np.inf))
            state.sweep.sizes[0, :number] = rounded_up
    rng = np.random.default_rng(0) if rng is None else rng
    for k, _, draw_times in hooks.active(scene.effects, "particle_times"):
        state.particle_times[k][:] = draw_times(scene.effects[k], number, rng)
    if state.random is not None:
        state.random[:] = rng.integers(2**64, dtype=np.uint64)
    state.label[:] = order
    state.agenda.key[:] = np.inf
    state.agenda.kind[:] = NOTHING
    state.clock[SPAN] = 1.0
    return state


class Grids(NamedTuple):
    """Cells of all particles."""

    grid: Grid  # all cells, or the finest ones
    classes: SizeClasses | None  # None where all particles are in one grid
    cells: int  # number of cells of all grids
    reach: float | None  # distance within which listed neighbours may touch; None without lists


def _grids(scene, gas, bodies, narrowest, has_lists):
    """Return the Grids of cells, or None if the box has no room for them.

    `gas` is the Filling of the box, `narrowest` (a) the least width of the cells in a single grid:
    the largest diameter, without the room for neighbour lists. There are no size classes under
    shear, nor with lists.
    """
    skin = 0.0
    if has_lists:
        skin = BED_SKIN if scene.box[-1] is None else GAS_SKIN[len(scene.box)]
    grid = cell_grid(scene, gas, narrowest + skin)
    cells, reach = math.prod(grid.counts), narrowest if has_lists else None
    single = Grids(grid, None, cells, reach) if min(grid.counts) >= MIN_CELLS else None
    if bodies is None or has_lists or scene.effects.shear is not None:
        return single
    smallest = MIN_CELL_WIDTH * bodies.radius.min()
    mixture = hierarchy.composition(bodies, density_of(scene, gas, smallest).number)
    grid_with = functools.partial(cell_grid, scene, gas, diameter=narrowest)
    fastest = hierarchy.fastest(mixture, grid_with, MIN_CELL_WIDTH)
    if fastest is None:
        return single
    one_class = hierarchy.single_grid(mixture, *grid)
    if single is not None and not hierarchy.is_worthwhile(mixture, fastest, one_class):
        return single
    classes = hierarchy.size_classes(mixture, fastest)
    return Grids(Grid(fastest.counts, fastest.widths), *classes, reach=None)


def _swept_state(scene, number, dimension, precision):
    """Return an empty state for few particles, whose contacts are found by a sweep over all."""
    fields, padded = _fields(scene, dimension, precision, SWEEP_SLOTS), _round_up(number, LANES)
    blocks = padded // BLOCK
    arrays = _arrays(
        number,
        fields,
        keys=(float, blocks, BLOCK),
        least=(float, -(-blocks // BLOCK), BLOCK),
        lines=(np.float32, 2 * dimension, padded),
        sizes=(np.float32, 1, padded),
    )
    for name, value in (("keys", np.inf), ("least", np.inf), ("lines", np.nan)):
        arrays[name][...] = value
    return _state(
        scene,
        number,
        arrays | {"key": arrays["keys"].reshape(-1)},
        queue=Blocks(arrays["keys"], arrays["least"], whose=np.zeros(blocks, np.int64)),
        sweep=Sweep(arrays["lines"], arrays["sizes"] if "radius" in fields else None),
        cells=None,
    )


def _celled_state(scene, number, dimension, precision, grids):
    """Return an empty state with the cells of Grids.

    Each particle has a cache line for its path, and another for its events.
    """
    counts, widths = grids.grid
    fields = _fields(scene, dimension, precision, CELL_SLOTS)
    fields |= {name: (np.int32,) for name in ("home", "following", "later")}
    fields |= {"leave": (float,), "heading": (np.int8,)}
    event_fields = [name for name in fields if name in Agenda._fields and name != "kind"]
    path_fields, event_fields = (
        ["trajectory", "changes", "following"],
        [*event_fields, "later", "leave"],
    )
    (path_fields if dimension == 2 else event_fields).append("home")
    path_fields += [
        name for name in ("label", "spin", "radius") if dimension == 2 and name in fields
    ]
    records = [
        {name: fields.pop(name) for name in record} for record in (path_fields, event_fields)
    ]
    arrays = _arrays(number, fields)
    for record in records:
        arrays |= _interleaved(number, record)
    return _state(
        scene,
        number,
        arrays,
        queue=Calendar(
            first=np.full(2 ** (number - 1).bit_length(), NOBODY, np.int32),
            later=arrays["later"],
            pace=np.ones(1),
            today=np.zeros(1, np.int64),
            since=np.zeros(1, np.int64),
            events=np.zeros(1, np.int64),
        ),
        sweep=None,
        cells=Cells(
            counts=counts,
            widths=widths,
            periods=tuple(n * width for n, width in zip(counts, widths, strict=True)),
            first=np.full(grids.cells, NOBODY, np.int32),
            **{name: arrays[name] for name in ("following", "home", "leave", "heading")},
            neighbours=None if grids.reach is None else _neighbours(number, widths, grids.reach),
            classes=grids.classes,
        ),
    )


def _neighbours(number, widths, reach):
    """Return empty neighbour lists, with regions whose candidates all lie in adjacent cells.

    `widths` are the sides of a cell, `reach` is the distance within which particles may touch.
    """
    fields = {"middle": (float, len(widths)), "members": (np.int32, LIST_CAPACITY)}
    return Neighbours(
        sides=tuple(width - reach for width in widths),
        frame=np.zeros(2),
        **_interleaved(number, fields | {"number": (np.int32,)}),
    )


def _fields(scene, dimension, precision, slots):
    """Return {name: (type, *row shape)} of every array that has a row for each particle.

    `slots` is the number of contacts stored per particle.
    """
    effects = scene.effects
    fields = {
        "trajectory": (precision, 2 * dimension + 1),
        "changes": (np.int32,),
        "label": (np.int32,),
        "key": (float,),
        "kind": (np.int8,),
        "slot_time": (float, slots),
        "slot_partner": (np.int32, slots),
        "slot_change": (np.int32, slots),
        "complete_until": (float,),
    }
    if effects.spin is not None:
        fields["spin"] = (precision, 2 * dimension - 3)
    if effects.species is not None:
        fields |= BODY_FIELDS
    fields |= {TIMES_OF + name: (float,) for name in _effects_with_times(effects)}
    if hooks.active(effects, "predict"):
        fields |= {"boundary_time": (float,), "boundary_code": (np.int32,)}
    return fields


def _effects_with_times(effects):
    """Return the names of the active effects that keep a time for each particle."""
    return [effects._fields[hook.effect_index] for hook in hooks.active(effects, "particle_times")]


def _state(scene, number, arrays, **scheme_fields):
    """Return the State of these arrays by name; `scheme_fields` are its queue, sweep and cells."""
    effects = scene.effects
    accounts = hooks.accounts(effects)
    times = {name: arrays[TIMES_OF + name] for name in _effects_with_times(effects)}
    return State(
        **{name: arrays.get(name) for name in ("trajectory", "spin")},
        **{name: arrays[name] for name in ("changes", "label")},
        bodies=_bodies(effects.species, arrays),
        particle_times=type(effects)(**times),
        phase=np.zeros(accounts) if hooks.active(effects, "phase") else None,
        ledger=np.zeros((2, accounts + 1, 2)),
        sums=_sums(effects),
        log=_log(effects.contact_log, arrays),
        paths=_path_counts(scene, number),
        random=np.zeros(1, np.uint64) if hooks.active(effects, "random") else None,
        clock=np.zeros(8),
        counts=np.zeros(COUNTS, np.int64),
        agenda=Agenda(**{name: arrays.get(name) for name in Agenda._fields}),
        shortlist=Shortlist(
            found=arrays["found"], beyond=np.zeros(2, np.int64), when=arrays["when"]
        ),
        **scheme_fields,
    )


def _bodies(species, arrays):
    """Return Bodies of these arrays, without properties of pairs yet; None without species."""
    if species is None:
        return None
    return Bodies(
        **{name: arrays[name] for name in BODY_FIELDS},
        largest=np.zeros(1),
        pairs=np.zeros((species.kinds, species.kinds + 1, 3)),
    )


def _sums(effects):
    """Return zeros (3, sums) for each effect with running sums, as in State.sums, or None."""
    columns = hooks.sums(effects)
    powers = {effects._fields[k]: list(powers_of.values()) for k, powers_of in columns.items()}
    sums = {name: np.array([[0.0], [0.0], [1.0]]) * row for name, row in powers.items()}
    return type(effects)(**sums) if sums else None


def _log(effect, arrays):
    """Return an empty contact log for the effect contact_log; None without the effect.

    Its rows are as wide as paths and spins need. `arrays` are the state's arrays by name; only the
    shapes of trajectories and spins are used.
    """
    if effect is None:
        return None
    components = arrays["trajectory"].shape[1] - 1  # of position and velocity
    width = 3 + 3 * components + (4 * arrays["spin"].shape[1] if "spin" in arrays else 0)
    return Log(rows=np.zeros((effect.most, width)), made=np.zeros(1, np.int64))


def _path_counts(scene, number):
    """Return zero crossings and rotations of each particle; None without the effect paths."""
    effects, dimension = scene.effects, len(scene.box)
    if not hooks.active(effects, "observe_flight"):
        return None
    disks_spin = dimension == 2 and effects.spin is not None
    rotation = np.zeros(number) if disks_spin else None
    return PathCounts(np.zeros((number, dimension)), rotation)


def _round_up(number, unit):
    """Return the smallest multiple of `unit` that is not below `number`."""
    return -(-number // unit) * unit


def _arrays(number, fields, **shapes):
    """Return zero arrays by name: with a row for each particle, of other shapes, the shortlist's.

    `fields` is as in _fields; `shapes` has (type, *shape) of the others.
    """
    shapes |= {name: (kind, number, *width) for name, (kind, *width) in fields.items()}
    room = 2 * (_round_up(number, LANES) + LANES)
    return _aligned(**shapes, found=(np.int32, room), when=(float, 1, BATCH))


def _aligned(**shapes):
    """Return arrays of zeros by name, of each (type, *shape), aligned to cache lines.

    A register that spans two lines takes longer to load and to store.
    """
    sizes = [math.prod(shape) * np.dtype(kind).itemsize for kind, *shape in shapes.values()]
    memory = np.zeros(sum(_round_up(size, CACHE_LINE) for size in sizes) + CACHE_LINE, np.uint8)
    arrays, offset = {}, -memory.ctypes.data % CACHE_LINE
    for (name, (kind, *shape)), size in zip(shapes.items(), sizes, strict=True):
        arrays[name] = np.ndarray(shape, kind, memory, offset)
        offset += _round_up(size, CACHE_LINE)
    return arrays


def _interleaved(number, fields):
    """Return zero arrays by name whose rows for one particle are adjacent, in the same cache lines.

    `fields` has (type, *row shape) of each array.
    """
    order = sorted(fields.items(), key=lambda field: -np.dtype(field[1][0]).itemsize)
    sizes = {name: np.dtype(kind).itemsize * math.prod(width) for name, (kind, *width) in order}
    size = _round_up(sum(sizes.values()), 8)
    rows = _aligned(rows=(np.uint8, number, size))["rows"]
    arrays, offset = {}, 0
    for name, (kind, *width) in order:
        array = rows[:, offset : offset + sizes[name]].view(kind)
        arrays[name] = array if width else array[:, 0]
        offset += sizes[name]
    return arrays
