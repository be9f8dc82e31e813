"""Where a state lies in memory, and by which scheme its contacts are found."""

import math

import numpy as np

from roughgas.kernel import hooks
from roughgas.kernel.state import (
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
    State,
    Sweep,
)

FEW = 500  # number of particles up to which all pairs are swept: see docs/performance.md
LANES = 16  # the arrays that are swept are padded to whole vector registers
BLOCK = 16  # particles to a block of the queue; divides LANES
TOGETHER = 8  # candidates that are decided at once
SLOTS_OF_FEW, SLOTS_OF_MANY = 8, 2  # upcoming contacts kept per particle
LINE = 64  # bytes that the processor fetches at once
NARROWEST = 2.002  # of a cell: a diameter and room for rounding, in a
OF_BODIES = {"radius": (float,), "mass": (float,), "inertia": (float,), "species": (np.int32,)}
MOMENT = "moment of "  # before the name of an effect: the array of its moments
PER_CELL = {2: 0.6, 3: 0.4}  # particles to a cell in so many dimensions, if that is wide enough
IN_LAYER = 4.0  # density where most contacts of a layer are, over that of the layer as it is filled
SKIN = 0.45  # added to the width of a cell where particles keep lists: the sides of their regions
ROOM = 16  # on a particle's list, which is a line of the cache then
FEWEST = 8  # cells along an axis: fewer would be met twice


def new_state(scene, position, velocity, spin, precision=np.float64, rng=None, bodies=None):
    """Return a state at time 0: positions (N, D) in a, velocities (N, D) and spins (N, D') in a/T.

    `precision` is that of trajectories and spins. Effects that draw random numbers start from the
    numpy generator `rng`, by default one of a fixed seed. A scene without spin leaves the spins
    out; one of several species needs to be told the Bodies. More than FEW particles are sorted into
    cells if the box has room for these.

    Particles are kept in the order of their positions: where events coincide, their order in memory
    decides, and the result must not depend on how the particles were numbered.
    """
    number, dimension = position.shape
    narrowest = NARROWEST if bodies is None else NARROWEST * bodies.radius.max()
    width, few = narrowest + (SKIN if scene.lists else 0.0), number <= FEW
    grid = () if few else cell_grid(scene, position, width)
    if few or min(grid[0]) < FEWEST:
        state = _few(scene, number, dimension, precision)
    else:
        state = _many(scene, number, dimension, precision, *grid, narrowest)
    order = np.lexsort(position.T[::-1])
    state.trajectory[:, :dimension] = position[order]
    state.trajectory[:, dimension:-1] = velocity[order]
    if state.spin is not None:
        state.spin[:] = spin[order]
    if bodies is not None:
        for name in OF_BODIES:
            getattr(state.bodies, name)[:] = getattr(bodies, name)[order]
        state.bodies.largest[0] = bodies.radius.max()
        state.bodies.pairs[:] = bodies.pairs
        if state.sweep is not None:
            rounded_up = np.nextafter(state.bodies.radius.astype(np.float32), np.float32(np.inf))
            state.sweep.sizes[0, :number] = rounded_up
    rng = np.random.default_rng(0) if rng is None else rng
    for place, _, moment in hooks.present(scene.effects, "moment"):
        state.moments[place][:] = moment(scene.effects[place], number, rng)
    if state.random is not None:
        state.random[:] = rng.integers(2**64, dtype=np.uint64)
    state.label[:] = order
    state.agenda.key[:] = np.inf
    state.agenda.kind[:] = NOTHING
    state.clock[SPAN] = 1.0
    return state


def cell_grid(scene, position, narrowest=NARROWEST):
    """Return (number, width) of cells along each axis, for PER_CELL particles to a cell or more.

    None is narrower than `narrowest`, of the largest particles. Along an open axis they fill the
    initial height of the gas.
    """
    heights = np.ptp(position, axis=0) + narrowest
    lengths = [length or height for length, height in zip(scene.box, heights, strict=True)]
    density = len(position) / math.prod(lengths) * (IN_LAYER if scene.box[-1] is None else 1.0)
    volume = PER_CELL[len(lengths)] / density
    least = max(narrowest, volume ** (1.0 / len(lengths)))
    fewest = [FEWEST if length is None else 1 for length in scene.box]
    lengths = [max(length, n * least) for length, n in zip(lengths, fewest, strict=True)]
    counts = tuple(max(1, math.floor(length / least)) for length in lengths)
    return counts, tuple(float(length / n) for length, n in zip(lengths, counts, strict=True))


def _few(scene, number, dimension, precision):
    fields, padded = _fields(scene, dimension, precision, SLOTS_OF_FEW), _whole(number, LANES)
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


def _many(scene, number, dimension, precision, counts, widths, narrowest):
    """Give each particle one line of the cache for where it is, and one for what comes next."""
    fields = _fields(scene, dimension, precision, SLOTS_OF_MANY)
    fields |= {name: (np.int32,) for name in ("home", "following", "later")}
    fields |= {"leave": (float,), "heading": (np.int8,)}
    ahead = [name for name in fields if name in Agenda._fields and name != "kind"]
    here, ahead = ["trajectory", "changes", "following"], [*ahead, "later", "leave"]
    (here if dimension == 2 else ahead).append("home")
    here += [name for name in ("label", "spin", "radius") if dimension == 2 and name in fields]
    records = [{name: fields.pop(name) for name in record} for record in (here, ahead)]
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
            first=np.full(math.prod(counts), NOBODY, np.int32),
            **{name: arrays[name] for name in ("following", "home", "leave", "heading")},
            neighbours=_neighbours(number, widths, narrowest) if scene.lists else None,
        ),
    )


def _neighbours(number, widths, narrowest):
    """Let those whose regions are no more than `narrowest` apart be in cells next to each other."""
    return Neighbours(
        middle=np.zeros((number, len(widths))),
        sides=tuple(width - narrowest for width in widths),
        members=_interleaved(number, {"members": (np.int32, ROOM)})["members"],
        number=np.zeros(number, np.int32),
        frame=np.zeros(2),
    )


def _fields(scene, dimension, precision, slots):
    """Return type and width of every array that has an entry for each particle."""
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
        fields |= OF_BODIES
    fields |= {MOMENT + name: (float,) for name in _with_moments(effects)}
    if hooks.present(effects, "predict"):
        fields |= {"boundary_time": (float,), "boundary_code": (np.int32,)}
    return fields


def _with_moments(effects):
    return [effects._fields[part.place] for part in hooks.present(effects, "moment")]


def _state(scene, number, arrays, **parts):
    effects = scene.effects
    accounts = hooks.accounts(effects)
    moments = {name: arrays[MOMENT + name] for name in _with_moments(effects)}
    return State(
        **{name: arrays.get(name) for name in ("trajectory", "spin")},
        **{name: arrays[name] for name in ("changes", "label")},
        bodies=_bodies(effects.species, arrays),
        moments=type(effects)(**moments),
        phase=np.zeros(accounts) if hooks.present(effects, "phase") else None,
        ledger=np.zeros((2, accounts + 1, 2)),
        sums=_sums(effects),
        log=_log(effects.contact_log, arrays),
        paths=_path_counts(scene, number),
        random=np.zeros(1, np.uint64) if hooks.present(effects, "random") else None,
        clock=np.zeros(8),
        counts=np.zeros(13, np.int64),
        agenda=Agenda(**{name: arrays.get(name) for name in Agenda._fields}),
        shortlist=Shortlist(
            found=arrays["found"], beyond=np.zeros(2, np.int64), when=arrays["when"]
        ),
        **parts,
    )


def _bodies(species, arrays):
    if species is None:
        return None
    return Bodies(
        **{name: arrays[name] for name in OF_BODIES},
        largest=np.zeros(1),
        pairs=np.zeros((species.kinds, species.kinds + 1, 3)),
    )


def _sums(effects):
    found = hooks.sums(effects)
    powers = {effects._fields[place]: list(own.values()) for place, own in found.items()}
    kept = {name: np.array([[0.0], [0.0], [1.0]]) * own for name, own in powers.items()}
    return type(effects)(**kept) if kept else None


def _log(effect, arrays):
    if effect is None:
        return None
    components = arrays["trajectory"].shape[1] - 1  # of position and velocity
    width = 3 + 3 * components + (4 * arrays["spin"].shape[1] if "spin" in arrays else 0)
    return Log(rows=np.zeros((effect.most, width)), made=np.zeros(1, np.int64))


def _path_counts(scene, number):
    effects, dimension = scene.effects, len(scene.box)
    if not hooks.present(effects, "observe_flight"):
        return None
    disks_spin = dimension == 2 and effects.spin is not None
    rotation = np.zeros(number) if disks_spin else None
    return PathCounts(np.zeros((number, dimension)), rotation)


def _whole(number, unit):
    return -(-number // unit) * unit


def _arrays(number, fields, **shapes):
    """Return arrays with an entry for each particle, those of other shapes, and the shortlist's."""
    shapes |= {name: (kind, number, *width) for name, (kind, *width) in fields.items()}
    room = 2 * (_whole(number, LANES) + LANES)
    return _aligned(**shapes, found=(np.int32, room), when=(float, 1, TOGETHER))


def _aligned(**shapes):
    """Return zeros of each (type, *shape), which begin with a line of the cache: a register that
    spans two lines takes longer to load and to store."""
    sizes = [math.prod(shape) * np.dtype(kind).itemsize for kind, *shape in shapes.values()]
    memory = np.zeros(sum(_whole(size, LINE) for size in sizes) + LINE, np.uint8)
    arrays, place = {}, -memory.ctypes.data % LINE
    for (name, (kind, *shape)), size in zip(shapes.items(), sizes, strict=True):
        arrays[name] = np.ndarray(shape, kind, memory, place)
        place += _whole(size, LINE)
    return arrays


def _interleaved(number, fields):
    """Return arrays in which all entries of a particle are in the same cache lines."""
    order = sorted(fields.items(), key=lambda field: -np.dtype(field[1][0]).itemsize)
    sizes = {name: np.dtype(kind).itemsize * math.prod(width) for name, (kind, *width) in order}
    size = _whole(sum(sizes.values()), 8)
    rows = _aligned(rows=(np.uint8, number, size))["rows"]
    arrays, offset = {}, 0
    for name, (kind, *width) in order:
        array = rows[:, offset : offset + sizes[name]].view(kind)
        arrays[name] = array if width else array[:, 0]
        offset += sizes[name]
    return arrays
