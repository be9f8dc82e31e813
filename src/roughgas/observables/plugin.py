"""Base class of observables: they observe frames, and turn time averages into results.

An observable is instantiated for every gas, so it may store frames (observables/frames.py);
`roughgas.observables.OBSERVABLES` lists the classes. Averages over time and their errors are in
observables/averages.py.

In a mixture every observable is instantiated for each species, or each pair of species, and
observes the frames of these particles; the results are `<name>_species` (SpeciesObservable).
Observables that need sums over contacts observe all particles, and compute the results of each
species themselves.
"""

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, ClassVar, TypeVar

import numpy as np

from roughgas.base import InputError, NamedValues, as_input_errors
from roughgas.base.fields import Settings, whole
from roughgas.data.netcdf import FILE_TYPES
from roughgas.data.variables import POINT, Variable
from roughgas.observables.averages import NamedArrays
from roughgas.observables.frames import Frame, FrameSeries, System


class ObservableSettings(Settings, frozen=True, kw_only=True):
    """Settings that every observable has."""

    every: Annotated[int, whole(1, 1_000_000, "Samples from one observation to the next.")] = 1


Combine = TypeVar("Combine", bound=Callable[..., NamedArrays])


def columnwise(combine: Combine) -> Combine:
    """Mark a method `combine` that accepts a batch of means, along an additional last axis.

    A column is an index of this axis: a set of means, such as a sample of a series. The results of
    the method have this axis, too, and have the same bits as if each column were passed alone.
    """
    vars(combine)["columnwise"] = True
    return combine


class Observable:
    """Base class of observables, which observe frames and compute results from averages over time.

    `variables` describes the variables in the dataset: the results of `combine`, each with an error
    bar, and the `coordinates`, which are known beforehand.
    """

    settings: ClassVar[type[ObservableSettings]] = ObservableSettings
    effects: ClassVar[tuple[str, ...]] = ()  # passive effects that it needs in the kernel
    needs_spin: ClassVar[bool] = False  # whether particles have to spin
    single_species: ClassVar[bool] = False  # undefined for a mixture as a whole
    pairwise: ClassVar[bool] = False  # defined for pairs of particles, also of two species
    series_names: tuple[str, ...] = ()  # variables that are saved per observation, not averaged
    relaxations: float = math.inf
    # shortest window of a driven gas with correct errors, in e-folds of the slowest mode of the two
    # temperatures, by benchmarks/observed.py; infinite if unknown
    depends_on_flow: bool = False  # the window needs as many e-folds of the longest flow, too
    valid_in_beds: bool = True  # whether `relaxations` is known under gravity, too
    unvalidated: tuple[str, ...] = ()  # variables whose `relaxations` is unknown
    variables: Mapping[str, Variable] = {}

    def __init__(self, system: System) -> None:
        """Store the system; raise InputError if the observable is undefined in it."""
        self.system = system
        self.coordinates: dict[str, Any] = {}

    def observe(self, frame: Frame) -> NamedArrays:
        """Return arrays by name, which are averaged over all observations, or saved as series.

        NaN where a value does not exist yet. An observation is not saved if the first array of
        `series_names` is NaN.
        """
        if type(self).observe_series is Observable.observe_series:
            raise NotImplementedError
        return {
            name: values[0] for name, values in self.observe_series(FrameSeries.of([frame])).items()
        }

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return the results of `observe` for each of k frames, arrays (k, ...) by name.

        A subclass defines either method; this one observes several instants at once, and is faster.
        Instants are passed in their order, each once; k is at least 1.
        """
        observations = [self.observe(frames.frame(number)) for number in range(frames.instants)]
        return {
            name: np.array([values[name] for values in observations]) for name in observations[0]
        }

    def saved_attributes(self) -> NamedValues:
        """Return the attributes that a checkpoint saves: numbers and arrays, by name."""
        return vars(self)

    @columnwise
    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the results by name, a smooth function of the means of all observations.

        `means` has the averages over time of the arrays of `observe`, by name.
        """
        return means

    @property
    def combines_columns(self) -> bool:
        """Whether `combine` accepts many sets of means at once: see `columnwise`."""
        return getattr(self.combine, "columnwise", False)


SUFFIX = "_species"
"""Suffix of the names of variables of species, or of pairs of species."""
PAIR = ("species", "other")
IN_THIS_BOX = "; depends on the size of the box"
"""End of the descriptions of variables that transport coefficients are computed from."""


class SpeciesObservable(Observable):
    """An observable of a mixture, evaluated for each species or pair of species.

    It is also evaluated for all particles, unless it is `single_species`.
    """

    def __init__(
        self, observable_class: type[Observable], system: System, settings: NamedValues
    ) -> None:
        """Make observables of `observable_class` for species or pairs, and all particles.

        `settings` are the further arguments of its constructor.
        """
        super().__init__(system)
        self.relaxations, self.depends_on_flow, self.valid_in_beds = (
            observable_class.relaxations,
            observable_class.depends_on_flow,
            observable_class.valid_in_beds,
        )
        self.unvalidated = (
            *observable_class.unvalidated,
            *(name + SUFFIX for name in observable_class.unvalidated),
        )
        species_indices, dims = range(len(system.species)), PAIR[: 1 + observable_class.pairwise]
        self._subsets = list(itertools.combinations_with_replacement(species_indices, len(dims)))
        number_of = {indices: n for n, indices in enumerate(self._subsets)}
        subset_numbers = [
            number_of[tuple(sorted(pair))]
            for pair in itertools.product(species_indices, repeat=len(dims))
        ]
        self._subset_of_species = np.array(subset_numbers).reshape(
            [len(species_indices)] * len(dims)
        )  # index of the subset of each species, or pair
        self._total_observable = (
            None if observable_class.single_species else observable_class(system, **settings)
        )
        self._subset_observables = [
            observable_class(system.only(*indices), **settings) for indices in self._subsets
        ]
        self.coordinates = self._subset_observables[0].coordinates
        self.series_names = (
            *observable_class.series_names,
            *(name + SUFFIX for name in observable_class.series_names[1:]),
        )
        self.variables = {}
        for name, variable in observable_class.variables.items():
            if name in self.coordinates or self._total_observable is not None:
                self.variables[name] = variable
            if name not in (*self.coordinates, *observable_class.series_names[:1]):
                leading = 1 if name in observable_class.series_names else 0
                variable_dims = (*variable.dims[:leading], *dims, *variable.dims[leading:])
                group_name = "pair of species" if observable_class.pairwise else "species"
                long_name = f"{variable.long_name}, of each {group_name}"
                self.variables[name + SUFFIX] = variable._replace(
                    long_name=long_name, dims=variable_dims
                )

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return the observations of all particles, and of each species or pair of species."""
        observed = (
            {}
            if self._total_observable is None
            else dict(self._total_observable.observe_series(frames))
        )
        pairs = zip(self._subset_observables, self._subsets, strict=True)
        by_subset = self._stacked(
            [observable.observe_series(frames.only(*indices)) for observable, indices in pairs]
        )
        species_axes = self._subset_of_species.ndim  # which follow the axis of instants
        return observed | {
            name: np.moveaxis(values, species_axes, 0) for name, values in by_subset.items()
        }

    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the results of all particles, and of each species or pair of species, by name.

        `means` has the means of `observe_series` by name.
        """
        total_means = {name: values for name, values in means.items() if not name.endswith(SUFFIX)}
        results = (
            {}
            if self._total_observable is None
            else dict(self._total_observable.combine(total_means))
        )
        subset_results = []
        for observable, indices in zip(self._subset_observables, self._subsets, strict=True):
            subset_means = {
                n.removesuffix(SUFFIX): x[indices] for n, x in means.items() if n.endswith(SUFFIX)
            }
            subset_results.append(observable.combine(subset_means))
        return results | self._stacked(subset_results)

    @property
    def combines_columns(self) -> bool:
        """Whether `combine` accepts many sets of means at once: see `columnwise`."""
        return self._subset_observables[0].combines_columns

    def _stacked(self, subset_values: Sequence[NamedArrays]) -> dict[str, np.ndarray]:
        """Return arrays over species, or pairs of species, by name with SUFFIX.

        `subset_values` has the arrays of each subset, a species or an unordered pair, by name.
        """
        names = [name for name in subset_values[0] if name not in self.series_names[:1]]
        return {
            name + SUFFIX: np.array([values[name] for values in subset_values])[
                self._subset_of_species
            ]
            for name in names
        }


class FunctionObservable(Observable):
    """An observable made of a user's function of a frame.

    The function returns a number, an array, or a mapping of names to these. An array with `dims`,
    `attrs` and `coords`, such as xarray's, is described by these; other results by the attributes
    `units` and `long_name` of the function.
    """

    def __init__(self, system: System, name: str, function: Callable[[Frame], Any]) -> None:
        """Store the function and the name of its result, unless it returns a mapping."""
        super().__init__(system)
        self._name, self._function = name, function
        self.variables: dict[str, Variable] = {}
        self._shapes: dict[str, tuple[int, ...]] = {}

    def saved_attributes(self) -> NamedValues:
        """Return variables, coordinates and shapes by the first observation, not the function."""
        attributes = vars(self)
        return {name: attributes[name] for name in ("variables", "coordinates", "_shapes")}

    def observe(self, frame: Frame) -> NamedArrays:
        """Return the result of the function as arrays of floats by name.

        Raises InputError for other results, and for shapes that change between observations.
        """
        result = self._function(frame)
        if not isinstance(result, Mapping) or not result:
            result = {self._name: result}
        values = {str(name): self._numbers(name, value) for name, value in result.items()}
        shapes = {name: value.shape for name, value in values.items()}
        if not self.variables:
            self._shapes = shapes
            for name, value in result.items():
                self._describe(str(name), value, values[name].ndim)
        if shapes != self._shapes:
            legal = f"be the same at every observation, as at the first: {self._shapes}"
            raise InputError(f"observe.{self._name}: shapes", shapes, legal)
        return values

    def _numbers(self, name: str, result: Any) -> np.ndarray:
        """Return the result `name` as floats; raise InputError for other types than numbers."""
        try:
            numbers = np.asarray(getattr(result, "values", result))
        except ValueError:  # for lists of different lengths
            numbers = np.empty(0, object)
        if numbers.dtype.kind not in "biuf":
            legal = "return a number, an array of numbers, or a mapping of names to these"
            raise InputError(f"observe.{name}", type(result).__name__, legal)
        return numbers.astype(float)

    def _describe(self, name: str, result: Any, dimensions: int) -> None:
        """Add the description and the coordinates of the result `name` to this observable's.

        `dimensions` is the number of axes of the result.
        """
        attributes = (
            {"long_name": name, "units": "1"} | _description(self._function) | _description(result)
        )
        numbered_dims = [f"{name}_{k}" for k in range(dimensions)]
        dims = tuple(str(dim) for dim in getattr(result, "dims", numbered_dims))
        self.variables[name] = Variable(attributes["long_name"], attributes["units"], dims)
        for dim, coordinate in getattr(result, "coords", {}).items():
            if dim in dims:
                coordinate_attributes = {"long_name": str(dim), "units": "1"} | _description(
                    coordinate
                )
                is_text = np.asarray(coordinate).dtype.kind not in "iuf"
                encoding: dict[str, Any] = (
                    {"units": "", "dtype": "str"}
                    if is_text
                    else {"units": coordinate_attributes["units"]}
                )
                self.variables[dim] = Variable(
                    coordinate_attributes["long_name"], dims=(dim,), **encoding
                )
                self.coordinates[dim] = np.asarray(coordinate)


RESERVED = {*POINT, *(name for _, names in FILE_TYPES.values() for name in names)}
"""Names of variables of points, and of those by which the type of a file is known."""


class StudyObservable(FunctionObservable):
    """An observable made of a function in observables.py of a study: see `study_observable`."""

    function: ClassVar[Callable[[Frame], Any]]
    file: ClassVar[str]
    """Name of its file in messages."""
    source_hash: ClassVar[str]

    def __init__(self, system: System) -> None:
        """Store the system; the result is named after the function."""
        super().__init__(system, type(self).__name__, type(self).function)

    def observe(self, frame: Frame) -> NamedArrays:
        """Return the result of the function; raise InputError for any error of it.

        A variable with a name in RESERVED is refused at the first observation.
        """
        with as_input_errors(f"{self.file}: {type(self).__name__}()", "observe this frame"):
            values = super().observe(frame)
            for name in sorted(self.variables.keys() & RESERVED):
                raise InputError("variable", name, "have a name that datasets do not have")
        return values


def study_observable(
    name: str, function: Callable[[Frame], Any], file: str, source_hash: str
) -> type[StudyObservable]:
    """Return the class of the observable `name` that a `function` of a frame defines.

    `file` is the name of its file in messages, `source_hash` a hash of its sources.
    """
    attributes = {
        "__doc__": function.__doc__,
        "__module__": function.__module__,
        "function": staticmethod(function),
        "file": file,
        "source_hash": source_hash,
    }
    return type(name, (StudyObservable,), attributes)


def _description(source: Any) -> dict[str, str]:
    """Return the attributes `long_name` and `units` of a function or an array, if it has them."""
    attributes = getattr(source, "attrs", None) or getattr(source, "__dict__", {})
    return {key: str(attributes[key]) for key in ("long_name", "units") if key in attributes}
