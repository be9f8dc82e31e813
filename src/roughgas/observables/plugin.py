"""What an observable is: it looks at frames, and says what the means of all looks amount to.

An observable is made anew for every gas, so it may remember frames. Each file of this room holds
one, with its equation, its source and its settings; `roughgas.observables.KINDS` lists them.
"""

from collections.abc import Callable, Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import Variable
from roughgas.effects.settings import Number
from roughgas.observables.frame import Frame, System

Values = Mapping[str, np.ndarray]


class Whole(NamedTuple):
    """A setting that is a whole number in a range."""

    description: str
    low: int
    high: int
    default: int

    def read(self, key: str, value: Any) -> int:
        """Return the number; raise InputError for any other value."""
        if type(value) is not int or not self.low <= value <= self.high:
            legal = f"be a whole number in [{self.low}, {self.high}]"
            raise InputError(key, value, legal)
        return value

    def schema(self) -> dict[str, Any]:
        """Return the same as a JSON schema."""
        ends = {"minimum": self.low, "maximum": self.high}
        return {"description": self.description, "type": "integer"} | ends


Setting = Number | Whole


class Observable:
    """Something to watch in a gas.

    `variables` describes what lands in the dataset: results of `combine`, each of which gets an
    error bar, and the `coordinates`, which are known beforehand.
    """

    settings: ClassVar[Mapping[str, Setting]] = {}
    effects: ClassVar[tuple[str, ...]] = ()  # that it needs in the kernel, which only look
    spins: ClassVar[bool] = False  # it needs particles that spin
    alike: ClassVar[bool] = False  # it needs particles of one species
    variables: Mapping[str, Variable] = {}

    def __init__(self, system: System) -> None:
        """Raise InputError where the system has no such thing."""
        self.system = system
        self.coordinates: dict[str, Any] = {}

    def look(self, frame: Frame) -> Values:
        """Return arrays, which are averaged over all looks; NaN where there is nothing yet."""
        raise NotImplementedError

    def combine(self, means: Values) -> Values:
        """Return the results, a smooth function of the means of what `look` returns."""
        return means


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
