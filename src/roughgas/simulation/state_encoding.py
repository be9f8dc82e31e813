"""Encoding of a kernel's State as arrays with dotted names, and decoding with checks.

Checkpoints, saved gases and datasets with a kernel's memory use this encoding. Files may be forged
with a valid checksum, and the kernel trusts its State: `decode` rejects any content that would
crash or hang it (see state_validation.py).
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from roughgas.kernel.state import CONSTANTS, SAVED_NAMES, State
from roughgas.scene import Scene
from roughgas.simulation.state_validation import faults


class UnusableCheckpoint(ValueError):
    """A checkpoint that a run cannot resume from.

    The text is the end of a sentence that gives the reason, and begins with a verb.
    """


def arrays_of(state: Any, prefix: str = "") -> Iterator[tuple[str, np.ndarray]]:
    """Yield (dotted name, array) for every array in nested NamedTuples, such as the kernel's State.

    `prefix` is put before the names. None, plain tuples and CONSTANTS are left out: their values
    follow from the scene.
    """
    for name, field in zip(state._fields, state, strict=True):
        if isinstance(field, np.ndarray):
            yield prefix + name, field
        elif hasattr(field, "_fields") and name not in CONSTANTS:
            yield from arrays_of(field, f"{prefix}{SAVED_NAMES.get(name, name)}.")


def encode(state: State) -> dict[str, np.ndarray]:
    """Return copies of all arrays of the kernel's state, by dotted name."""
    return {name: array.copy() for name, array in arrays_of(state)}


def decode(saved: Mapping[str, np.ndarray], state: State, scene: Scene) -> None:
    """Fill the kernel's `state` from `saved`, the arrays that `encode` returned.

    `state` must be a new state of the same scene and size. Values are copied into the existing
    arrays, so that arrays which share memory still do. Raises UnusableCheckpoint for missing or
    different arrays, and for values that no run reaches and that could crash or hang the kernel;
    `state` is then unchanged.
    """
    arrays = dict(arrays_of(state))
    if _shapes_and_types(saved) != _shapes_and_types(arrays):
        raise UnusableCheckpoint(
            "holds another kind of state, of other settings or another roughgas"
        )
    if fault := next(faults(_with_arrays(state, saved), saved, scene), None):
        raise UnusableCheckpoint(f"holds a state that no run reaches: {fault}")
    for name, array in arrays.items():
        array[...] = saved[name]


def state_bytes(state: State) -> bytes:
    """Return the bytes of all arrays of the kernel's state, concatenated, as in a dataset's memory.

    The arrays of `paths` are left out: each run counts them from its start.
    """
    return b"".join(array.tobytes() for _, array in arrays_of(state._replace(paths=None)))


def arrays_from_bytes(content: bytes, state: State) -> dict[str, np.ndarray]:
    """Return the arrays in `content`, made by `state_bytes`, by dotted name, for `decode`.

    `state` is a new state of the same scene and size. Raises UnusableCheckpoint if `content` has
    another length than the arrays of such a state.
    """
    arrays = dict(arrays_of(state._replace(paths=None)))
    length = sum(array.nbytes for array in arrays.values())
    if len(content) != length:
        raise UnusableCheckpoint(f"has {len(content)} bytes in place of {length}")
    saved, offset = {}, 0
    for name, array in arrays.items():
        values = np.frombuffer(content, array.dtype, array.size, offset)
        saved[name] = values.reshape(array.shape)
        offset += array.nbytes
    return saved


def _shapes_and_types(
    arrays: Mapping[str, np.ndarray],
) -> dict[str, tuple[tuple[int, ...], np.dtype]]:
    """Return the shape and dtype of each array by name."""
    return {name: (array.shape, array.dtype) for name, array in arrays.items()}


def _with_arrays(struct: Any, saved: Mapping[str, np.ndarray], prefix: str = "") -> Any:
    """Return a NamedTuple with its arrays, also nested ones, replaced by the saved ones.

    `saved` has them by dotted name; names of the fields of `struct` begin with `prefix` there.
    """
    fields = {}
    for name, value in zip(struct._fields, struct, strict=True):
        if isinstance(value, np.ndarray):
            fields[name] = saved[prefix + name]
        elif hasattr(value, "_fields") and name not in CONSTANTS:
            fields[name] = _with_arrays(value, saved, f"{prefix}{SAVED_NAMES.get(name, name)}.")
    return struct._replace(**fields)
