"""Reads states of particles from datasets of any program: by the names of dimensions, in the order
of coordinates, and with their units.

A state has the variables of QUANTITIES, each along its dimensions in any order, and along `replica`
if there are several states. If a dataset has the coordinates `axis` and `spin_axis`, they are x, y
and z, or numbers from 0. Labels of `particle` are distinct numbers or names.
"""

import re
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import InputError, short_repr
from roughgas.data.netcdf import unit_of
from roughgas.data.variables import LENGTH, SPEED, TIME

if TYPE_CHECKING:
    import xarray

REPLICA = "replica"
READ_FROM = "read_from"
"""Attribute of a state from a file of another program: the file and the frame, for messages."""


class Quantity(NamedTuple):
    """Unit, such as "a/T", and dimensions, without the replica, of a variable of a state."""

    unit: str
    dims: tuple[str, ...]


QUANTITIES = {
    "position": Quantity(LENGTH, ("particle", "axis")),
    "velocity": Quantity(SPEED, ("particle", "axis")),
    "spin": Quantity(SPEED, ("particle", "spin_axis")),
    "radius": Quantity(LENGTH, ("particle",)),
    "mass": Quantity("m", ("particle",)),
    "inertia": Quantity("1", ("particle",)),
    "species_of": Quantity("1", ("particle",)),
    "time": Quantity(TIME, ()),
    "box": Quantity(LENGTH, ("axis",)),
}
AXES = {1: "z", 2: "xy", 3: "xyz"}
"""Coordinates along an axis, by their number: disks have a spin along z alone."""
MULTIPLE = re.compile(r"(?:([0-9.]+(?:[eE][+-]?\d+)?) *\*? *)?(.+)", re.DOTALL)
SPELLINGS = {SPEED: {"a T^-1", "a T-1", "a*T^-1", "a T**-1"}}


def check_type(dataset: Any) -> None:
    """Raise InputError unless `dataset` is an xarray.Dataset."""
    import xarray

    if not isinstance(dataset, xarray.Dataset):
        kind = f"of type {type(dataset).__name__}"
        legal = "be an xarray.Dataset, as read_point(FILE) or read_frame(FILE) returns it"
        raise InputError("initial", kind, legal)


def read_quantity(dataset: "xarray.Dataset", name: str, prefix: str = "") -> np.ndarray:
    """Return the variable `name` of all states: floats (replicas, *dims), in units of QUANTITIES.

    Its name in the dataset has the `prefix`, such as "last_". A variable without the dimension
    `replica` applies to every replica. Raises InputError for other dimensions, coordinates and
    units, and for values that are not finite numbers.
    """
    key, variable = f"initial.{name}", dataset[prefix + name]
    unit, dims = QUANTITIES[name]
    if dims[-1:] == ("spin_axis",) and "spin_axis" not in variable.dims:
        variable = variable.expand_dims("spin_axis")  # of disks
    _check_dims(key, variable.dims, dims)
    if variable.dtype.kind not in "iuf":
        raise InputError(key, f"of type {variable.dtype}", "be real numbers")
    replica_dims = [REPLICA] if REPLICA in variable.dims else []
    values = np.asarray(variable.transpose(*replica_dims, *dims).values, float)
    for position, dim in enumerate(dims, len(replica_dims)):
        order = _order_along(dataset, dim)
        values = values if order is None else np.take(values, order, position)
    if not np.isfinite(values).all():
        raise InputError(key, "with numbers that are not finite", "be finite numbers")
    values = values * _multiple(key, str(unit_of(variable.attrs)), unit)
    return (
        values if replica_dims else np.repeat(values[None], dataset.sizes.get(REPLICA, 1), axis=0)
    )


def read_memory(dataset: "xarray.Dataset") -> list[bytes]:
    """Return the memory of the kernel at the end of the run, as bytes for each replica.

    The bytes are empty without `last_memory` in the dataset. Raises InputError for dimensions other
    than replica and byte.
    """
    replicas = dataset.sizes.get(REPLICA, 1)
    if "last_memory" not in dataset:
        return [b""] * replicas
    memory = dataset["last_memory"]
    _check_dims("initial.last_memory", memory.dims, ("byte",))
    if REPLICA not in memory.dims:
        return [memory.values.tobytes()] * replicas
    return [row.tobytes() for row in memory.transpose(REPLICA, "byte").values]


def _check_dims(key, dims, legal):
    """Raise InputError, with this `key`, unless the dimensions are `legal`, in any order.

    The dimension `replica` may come in addition.
    """
    if "frame" in dims:
        advice = "have no frames: choose one, as by initial.isel(frame=-1)"
        raise InputError(key, dims, advice)
    if {*dims} - {REPLICA} != {*legal}:
        listed = " and ".join(legal) or "none"
        text = ", ".join(map(str, dims)) or "(none)"
        raise InputError(f"dimensions of {key}", text, f"be {listed}, without or with replica")


def _order_along(dataset, dim):
    """Return the indices that sort the dimension `dim` by its coordinate; None if it is sorted.

    Raises InputError for illegal labels along it.
    """
    if dim not in dataset.coords:
        return None
    key, labels = f"initial.{dim}", dataset[dim].values
    if dim == "particle":
        return _order_of_particles(key, labels)
    names = AXES.get(len(labels), "")
    for legal_order in (list(names), list(range(len(names)))):
        if set(labels.tolist()) == {*legal_order}:
            return (
                None
                if labels.tolist() == legal_order
                else [labels.tolist().index(n) for n in legal_order]
            )
    listed = ", ".join(names) or "x, y and z"
    raise InputError(key, short_repr(labels.tolist()), f"be {listed}, in any order")


def _order_of_particles(key, labels):
    """Return the indices that sort particles by their number; None if they are sorted, or named.

    Raises InputError, with this `key`, for a label that occurs twice.
    """
    if len({*labels.tolist()}) < len(labels):
        raise InputError(key, "with a label twice", "have another label for each particle")
    rising = labels.dtype.kind not in "iuf" or bool((labels[:-1] < labels[1:]).all())
    return None if rising else np.argsort(labels, kind="stable")


def _multiple(key, text, unit):
    """Return the factor before `unit` in units as `text`, such as 2 for "2 a"; 1 for "" and "1".

    Raises InputError, with this `key`, for another unit, and for a factor that is not positive.
    """
    if text in ("", "1"):
        return 1.0
    match = MULTIPLE.fullmatch(text.strip())
    number, base = match.groups() if match else ("0", text)
    try:
        scale = float(number or 1.0)
    except ValueError:
        scale = 0.0
    if base not in {unit, *SPELLINGS.get(unit, ())} or not 0.0 < scale < np.inf:
        legal = f"be {unit}, or a multiple such as 2 {unit}" if unit != "1" else "be 1"
        raise InputError(f"units of {key}", short_repr(text), legal)
    return scale
