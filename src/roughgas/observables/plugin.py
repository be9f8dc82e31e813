"""What an observable is: it looks at frames, and says what the means of all looks amount to.

Of a mixture every observable is made once for each species, or for each pair of species, and sees
the frame of these particles alone: `<name>_species` has what it finds (OfSpecies). One that needs
sums over contacts sees all particles, and says itself what each species has.

An observable is made anew for every gas, so it may remember frames; `roughgas.observables.KINDS`
lists them. A frame holds the particles of a gas at an instant, as plain numpy arrays. Units:
particle radius a = particle mass m = time unit T = 1. A freely cooling gas has no lasting energy:
its velocities and spins are in units in which the present E_trans is 1.

The standard error of a function f of means is that of the series to which f is linear in the
deviations from the means: z_k = df(m).(x_k - m), whose mean vanishes (the infinitesimal jackknife,
B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans, 1982, chapter 6).
"""

import itertools
import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np

from roughgas.base import InputError, NeedsError
from roughgas.data.variables import Variable
from roughgas.effects.contacts import columns_of_pairs
from roughgas.effects.settings import Number, Whole
from roughgas.statistics.errors import (
    Evidence,
    autocorrelation_time,
    blocking,
    carriers,
    degrees_of_freedom,
    period_means,
)

AXES = "xyz"


class Group(NamedTuple):
    """The particles of a species."""

    particles: int
    radius: float  # in a; NaN where their radii differ


class System(NamedTuple):
    """What stays the same during a run."""

    particles: int  # N
    box: tuple[float | None, ...]  # lengths in a, D of them; None is open above
    periodic: tuple[bool, ...]  # of each axis
    inertia: float | None  # q = I/(m a^2); None where particles do not spin
    shear_rate: float  # 1/T: the mean flow is v_x = shear_rate (y - L/2)
    interval: float  # between looks, in T or in collisions per particle
    cooling: bool
    species: tuple[Group, ...] = ()  # none where all particles have radius a and mass m
    period: float | None = None  # of the schedule, in T: whole ones of the drive

    def only(self, *species: int) -> "System":
        """Return what is known of the particles of some species alone, by index."""
        chosen = tuple(self.species[k] for k in sorted({*species}))
        return self._replace(particles=sum(one.particles for one in chosen), species=chosen)

    @property
    def dimension(self) -> int:
        """D, 2 of disks and 3 of spheres."""
        return len(self.box)

    @property
    def volume(self) -> float:
        """Area or volume of the box in a^D; infinite if it is open."""
        return math.prod(math.inf if length is None else length for length in self.box)

    @property
    def across(self) -> int:
        """The axis that layers are across, the vertical one; of a sheared gas that of the shear."""
        return 1 if self.shear_rate else self.dimension - 1

    @property
    def axes(self) -> list[str]:
        """The names of the axes, `x`, `y`, `z`."""
        return list(AXES[: self.dimension])


OF_EACH = (
    *("position", "velocity", "spin", "radius", "mass", "inertia", "species_of"),
    *("unwrapped_position", "angle"),
)
"""The fields of a frame with an entry for each particle."""


class Frame(NamedTuple):
    """The particles at an instant, in the order of the start."""

    system: System
    time: float  # T since the start
    collisions: float  # per particle, since the start or since the gas began to cool
    position: np.ndarray  # (N, D) in a, folded into the box
    velocity: np.ndarray  # (N, D) in a/T, of the images in the box
    spin: np.ndarray | None  # (N, 2 D - 3) surface velocities in a/T; None without spin
    radius: np.ndarray  # (N,) in a
    mass: np.ndarray  # (N,) in m
    inertia: np.ndarray  # (N,) q, I over mass and radius^2
    image_shift: float  # displacement along x of the image above, of a sheared gas; else 0
    rates: Mapping[str, float]  # what effects have summed up since the look before, per T
    species_of: np.ndarray | None = None  # (N,) index of each one's species; None: all are alike
    speed_unit: float = 1.0  # of the velocities, in a/T: not 1 in a cooling gas
    floor: float = 0.0  # height of a shaken floor, in a
    unwrapped_position: np.ndarray | None = None  # (N, D) in a, along continuous paths, NaN along
    # the flow of a sheared gas; None without the effect `paths`
    angle: np.ndarray | None = None  # (N,) rad by which disks have turned; None as above

    def only(self, *species: int) -> "Frame":
        """Return the frame of the particles of some species alone, by index, without `rates`.

        Raises NeedsError where all particles are alike.
        """
        if self.species_of is None:
            raise NeedsError("Frame.only", "species")
        there, own = np.isin(self.species_of, species), self._asdict()
        of_each: dict[str, Any] = {
            name: own[name][there] for name in OF_EACH if own[name] is not None
        }
        return self._replace(system=self.system.only(*species), rates={}, **of_each)

    def of_each_species(self) -> list["Frame"]:
        """Return the frame of each species, without `rates`."""
        return [self.only(kind) for kind in range(len(self.system.species))]

    def of_pairs(self, names: Iterable[str]) -> np.ndarray:
        """Return sums over contacts per T, (species, species, names), half of each contact of
        unlike partners for either order of them: all of them are the sum. (1, 1, names) without
        species."""
        kinds, names = max(1, len(self.system.species)), [*names]
        sums = np.array([self.rates[name] for name in columns_of_pairs(names, kinds)])
        either = sums.reshape(kinds, kinds, len(names))
        return (either + either.transpose(1, 0, 2)) / 2.0

    @property
    def energy(self) -> np.ndarray:
        """Kinetic energies (N,), m v^2/2 and, without a mean spin, m q a^2 w^2/2."""
        square, spin_square = (self.velocity**2).sum(axis=1), (self.thermal_spin**2).sum(axis=1)
        return 0.5 * (self.mass * square + self.mass * self.inertia * spin_square)

    @property
    def thermal_velocity(self) -> np.ndarray:
        """Velocities (N, D) without the mean flow of a sheared gas."""
        rate, velocity = self.system.shear_rate, self.velocity
        if rate:
            velocity = velocity.copy()
            middle = (self.system.box[1] or 0.0) / 2.0
            velocity[:, 0] -= rate * (self.position[:, 1] - middle)
        return velocity

    @property
    def thermal_spin(self) -> np.ndarray:
        """Spins (N, 2 D - 3) without their mean in a sheared gas; zeros where nothing spins."""
        if self.spin is None:
            return np.zeros((self.system.particles, 2 * self.system.dimension - 3))
        if not self.system.shear_rate:
            return self.spin
        turning = (self.mass * self.inertia * self.radius)[:, None]
        rotation = (turning * self.spin).sum(axis=0) / (turning[:, 0] @ self.radius)
        return self.spin - self.radius[:, None] * rotation


Values = Mapping[str, np.ndarray]


Setting = Number | Whole


class Observable:
    """Something to watch in a gas.

    `variables` describes what lands in the dataset: results of `combine`, each of which gets an
    error bar, and the `coordinates`, which are known beforehand.
    """

    settings: ClassVar[Mapping[str, Setting]] = {}
    effects: ClassVar[tuple[str, ...]] = ()  # that it needs in the kernel, which only look
    spins: ClassVar[bool] = False  # it needs particles that spin
    alike: ClassVar[bool] = False  # of a mixture, it makes sense of each species alone
    pairs: ClassVar[bool] = False  # it is of pairs, which may be of two species
    kept: tuple[str, ...] = ()  # what points keep look by look, and nobody averages
    relaxations: float = math.inf
    # e-folds of the slowest mode of the two temperatures that a window of a driven gas must have
    # for errors that are right, by benchmarks/observed.py; infinite where no such length is known
    of_flow: bool = (
        False  # it depends on flows: the window needs as many e-folds of the longest one
    )
    beds: bool = True  # whether that length is known under gravity, too
    doubtful: tuple[str, ...] = ()  # variables for which no length is known
    variables: Mapping[str, Variable] = {}

    def __init__(self, system: System) -> None:
        """Raise InputError where the system has no such thing."""
        self.system = system
        self.coordinates: dict[str, Any] = {}

    def look(self, frame: Frame) -> Values:
        """Return arrays, which are averaged over all looks, or `kept`; NaN where there is nothing
        yet. A look whose first kept array is NaN is not kept."""
        raise NotImplementedError

    def combine(self, means: Values) -> Values:
        """Return the results, a smooth function of the means of what `look` returns."""
        return means


SUFFIX = "_species"
"""Ends the names of what a species, or a pair of species, has of its own."""
PAIR = ("species", "other")
IN_THIS_BOX = "; depends on the size of the box"
"""Ends what is said of numbers that transport coefficients are made of."""


class OfSpecies(Observable):
    """An observable of a mixture: of all particles, unless they must be alike, and of each species
    or pair of species alone, unless it rests on sums over all contacts."""

    def __init__(self, kind: type[Observable], system: System, settings: Mapping[str, Any]) -> None:
        super().__init__(system)
        self.relaxations, self.of_flow, self.beds = kind.relaxations, kind.of_flow, kind.beds
        self.doubtful = (*kind.doubtful, *(name + SUFFIX for name in kind.doubtful))
        kinds, dims = range(len(system.species)), PAIR[: 1 + kind.pairs]
        self._which = list(itertools.combinations_with_replacement(kinds, len(dims)))
        number = {which: n for n, which in enumerate(self._which)}
        every = [number[tuple(sorted(at))] for at in itertools.product(kinds, repeat=len(dims))]
        self._place = np.array(every).reshape([len(kinds)] * len(dims))  # parts by species
        self._whole = None if kind.alike else kind(system, **settings)
        self._parts = [kind(system.only(*which), **settings) for which in self._which]
        self.coordinates = self._parts[0].coordinates
        self.kept = (*kind.kept, *(name + SUFFIX for name in kind.kept[1:]))
        self.variables = {}
        for name, about in kind.variables.items():
            if name in self.coordinates or self._whole is not None:
                self.variables[name] = about
            if name not in (*self.coordinates, *kind.kept[:1]):
                looks = 1 if name in kind.kept else 0
                own = (*about.dims[:looks], *dims, *about.dims[looks:])
                of = "pair of species" if kind.pairs else "species"
                said = f"{about.long_name}, of each {of}"
                self.variables[name + SUFFIX] = about._replace(long_name=said, dims=own)

    def look(self, frame: Frame) -> Values:
        """Return what is seen of all particles, and of each part."""
        found = {} if self._whole is None else dict(self._whole.look(frame))
        each = zip(self._parts, self._which, strict=True)
        return found | self._stacked([part.look(frame.only(*which)) for part, which in each])

    def combine(self, means: Values) -> Values:
        """Return the results of all particles, and of each part."""
        of_all = {name: one for name, one in means.items() if not name.endswith(SUFFIX)}
        found = {} if self._whole is None else dict(self._whole.combine(of_all))
        parts = []
        for part, which in zip(self._parts, self._which, strict=True):
            own = {n.removesuffix(SUFFIX): x[which] for n, x in means.items() if n.endswith(SUFFIX)}
            parts.append(part.combine(own))
        return found | self._stacked(parts)

    def _stacked(self, parts: Sequence[Values]) -> dict[str, np.ndarray]:
        names = [name for name in parts[0] if name not in self.kept[:1]]
        return {
            name + SUFFIX: np.array([part[name] for part in parts])[self._place] for name in names
        }


class Function(Observable):
    """A function of a user's: of a frame, it returns a number, an array, or several by name.

    An array that has `dims`, `attrs` and `coords`, as that of xarray, is described by these; the
    function's attributes `units` and `long_name` describe any other.
    """

    def __init__(self, system: System, name: str, function: Callable[[Frame], Any]) -> None:
        super().__init__(system)
        self._name, self._function = name, function
        self.variables: dict[str, Variable] = {}
        self._shapes: dict[str, tuple[int, ...]] = {}

    def look(self, frame: Frame) -> Values:
        """Return what the function does, as numbers."""
        found = self._function(frame)
        if not isinstance(found, Mapping) or not found:
            found = {self._name: found}
        values = {str(name): self._numbers(name, one) for name, one in found.items()}
        shapes = {name: one.shape for name, one in values.items()}
        if not self.variables:
            self._shapes = shapes
            for name, one in found.items():
                self._describe(str(name), one, values[name].ndim)
        if shapes != self._shapes:
            legal = f"be the same at every observation, as at the first: {self._shapes}"
            raise InputError(f"observe.{self._name}: shapes", shapes, legal)
        return values

    def _numbers(self, name: str, found: Any) -> np.ndarray:
        try:
            numbers = np.asarray(getattr(found, "values", found))
        except ValueError:  # of lists of unlike lengths
            numbers = np.empty(0, object)
        if numbers.dtype.kind not in "biuf":
            legal = "return a number, an array of numbers, or a mapping of names to these"
            raise InputError(f"observe.{name}", type(found).__name__, legal)
        return numbers.astype(float)

    def _describe(self, name: str, found: Any, dimensions: int) -> None:
        about = {"long_name": name, "units": "1"} | _told(self._function) | _told(found)
        own = [f"{name}_{k}" for k in range(dimensions)]
        dims = tuple(str(dim) for dim in getattr(found, "dims", own))
        self.variables[name] = Variable(about["long_name"], about["units"], dims)
        for dim, along in getattr(found, "coords", {}).items():
            if dim in dims:
                text = {"long_name": str(dim), "units": "1"} | _told(along)
                words = np.asarray(along).dtype.kind not in "iuf"
                kind: dict[str, Any] = (
                    {"units": "", "dtype": "str"} if words else {"units": text["units"]}
                )
                self.variables[dim] = Variable(text["long_name"], dims=(dim,), **kind)
                self.coordinates[dim] = np.asarray(along)


def _told(one: Any) -> dict[str, str]:
    """Return the long name and units that a function or an array has as attributes."""
    found = getattr(one, "attrs", None) or getattr(one, "__dict__", {})
    return {key: str(found[key]) for key in ("long_name", "units") if key in found}


STEP = 1e-4  # of the deviations, in which the slope is taken


class Averages(NamedTuple):
    """Results, their standard errors, the degrees of freedom of these, and what the errors rest on,
    each by name."""

    value: dict[str, np.ndarray]
    stderr: dict[str, np.ndarray]
    dof: dict[str, np.ndarray]
    evidence: dict[str, Evidence]  # arrays in the shape of the value


def averaged(
    combine: Callable[[Values], Values], runs: Sequence[Sequence[Values]], per_period: int = 1
) -> Averages:
    """Return the averages of what was seen in independent runs, in each at equal intervals.

    Means are over whole periods of so many looks, if there is one. The error is by blocking in a
    single run, else from the scatter over runs. Looks that are NaN do not count.
    """
    with np.errstate(divide="ignore", invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # means of nothing are NaN
        series = [_stacked(run, per_period) for run in runs]
        own = [{name: np.nanmean(x, axis=0) for name, x in one.items()} for one in series]
        if len(runs) > 1:
            series = [{name: np.array([one[name] for one in own]) for name in own[0]}]
        mean = {name: np.nanmean(x, axis=0) for name, x in series[0].items()}
        found = combine(mean)
        slopes = list(_slopes(combine, mean, series[0]))
    value = {name: np.asarray(one, float) for name, one in found.items()}
    error, support = (_scatter, _replicas) if len(runs) > 1 else (_blocked, _length_of_series)
    linear = {name: np.array([one[name] for one in slopes]) for name in value}
    errors = {name: error(one) for name, one in linear.items()}
    evidence = {name: support(one) for name, one in linear.items()}
    stderr, dof = ({name: pair[k] for name, pair in errors.items()} for k in range(2))
    return Averages(value, stderr, dof, evidence)


def _replicas(runs: np.ndarray) -> Evidence:
    """Return in how many independent runs (runs, ...) there is each number."""
    return Evidence(runs=np.isfinite(runs).sum(axis=0))


def _length_of_series(series: np.ndarray) -> Evidence:
    """Return how long each linearised series (samples, ...) is, and what carries its variance."""
    columns = [column[np.isfinite(column)] for column in series.reshape(len(series), -1).T]
    lengths = [(len(one), autocorrelation_time(one) if len(one) else math.nan) for one in columns]
    rows = [
        (samples, samples / time, carriers(one, time))
        for one, (samples, time) in zip(columns, lengths, strict=True)
    ]
    of_each = np.array(rows, float).reshape(-1, 3).T.reshape(3, *series.shape[1:])
    return Evidence(samples=of_each[0], times=of_each[1], carriers=of_each[2])


def _stacked(looks: Sequence[Values], per_period: int) -> dict[str, np.ndarray]:
    """Return arrays (periods, ...) by name."""
    stacks = {name: np.array([look[name] for look in looks], float) for name in looks[0]}
    if per_period == 1 or len(looks) < per_period:
        return stacks
    return {name: _by_period(x, per_period) for name, x in stacks.items()}


def _by_period(x: np.ndarray, per_period: int) -> np.ndarray:
    """Return means over periods (periods, ...), of what there is in each."""
    if np.isfinite(x).all():
        return np.moveaxis(period_means(np.moveaxis(x, 0, -1), per_period), -1, 0)
    whole = x[: len(x) // per_period * per_period]
    return np.nanmean(whole.reshape(-1, per_period, *x.shape[1:]), axis=1)


def _slopes(combine, mean, series) -> Iterator[Values]:
    """Generate the linear part of f(x_k) - f(mean) for each k."""
    for k in range(len(next(iter(series.values())))):
        ends = [
            combine({name: m + sign * STEP * (series[name][k] - m) for name, m in mean.items()})
            for sign in (1, -1)
        ]
        yield {name: (ends[0][name] - ends[1][name]) / (2.0 * STEP) for name in ends[0]}


def _blocked(series: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return error and degrees of freedom of the means of a series (samples, ...)."""
    columns = series.reshape(len(series), -1).T
    found = [blocking(column[np.isfinite(column)]) for column in columns]
    pairs = [(one.stderr, degrees_of_freedom(one.blocks)) for one in found]
    return tuple(np.array(pairs).T.reshape(2, *series.shape[1:]))


def _scatter(runs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return error and degrees of freedom of the means of independent numbers (runs, ...)."""
    there = np.isfinite(runs)
    count = there.sum(axis=0)
    square = np.where(there, runs, 0.0) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        stderr = np.sqrt(square.sum(axis=0) / (count * (count - 1.0)))
    return np.where(count > 1, stderr, math.nan), np.maximum(count - 1.0, 0.0)
