"""Periodic images: an axis of the box has a length, or is None and open.

Under Lees-Edwards shear (`slide` = (offset, velocity), else None) the images above are displaced
by the offset along the first axis and move with the velocity along it.
"""

import numpy as np
from numba import types
from numba.extending import overload

from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.jit import jit

FIRST_LARGE_32 = np.float32(1.5 * 2.0**23)
FIRST_LARGE_64 = 1.5 * 2.0**52


def nearest_integer(x):
    """x rounded to the nearest integer, ties to even; exact for |x| < 2^22 (2^51 in double).

    Adding and subtracting a number whose spacing is 1 rounds in two additions, which every x86-64
    machine has in vector form and which give the same bits on all of them.
    """
    large = FIRST_LARGE_32 if isinstance(x, np.float32) else FIRST_LARGE_64
    return (x + large) - large


@overload(nearest_integer)
def _nearest_integer(x):
    if x == types.float32:
        return lambda x: (x + FIRST_LARGE_32) - FIRST_LARGE_32
    return lambda x: (x + FIRST_LARGE_64) - FIRST_LARGE_64


def reciprocal(length):
    """1/length in its own precision: a loop over many divides once and multiplies."""
    return type(length)(1) / length


@overload(reciprocal)
def _reciprocal(length):
    one = np.float32(1.0) if length == types.float32 else 1.0
    return lambda length: one / length


@jit
def _axis_number(x, length):
    if length is None:
        return x  # not used: an open axis has one image
    return nearest_integer(x * reciprocal(length))


@jit
def _axis_shift(x, number, length):
    if length is None:
        return x
    return x - number * length


def _numbers(x, box):
    return tuple(_axis_number(a, length) for a, length in zip(x, box, strict=True))


def _shift(x, numbers, box):
    return tuple(_axis_shift(*axis) for axis in zip(x, numbers, box, strict=True))


@overload(_numbers)
def _compiled_numbers(x, box):
    if len(box) == 2:
        return lambda x, box: (_axis_number(x[0], box[0]), _axis_number(x[1], box[1]))
    return lambda x, box: (
        _axis_number(x[0], box[0]),
        _axis_number(x[1], box[1]),
        _axis_number(x[2], box[2]),
    )


@overload(_shift)
def _compiled_shift(x, numbers, box):
    if len(box) == 2:
        return lambda x, numbers, box: (
            _axis_shift(x[0], numbers[0], box[0]),
            _axis_shift(x[1], numbers[1], box[1]),
        )
    return lambda x, numbers, box: (
        _axis_shift(x[0], numbers[0], box[0]),
        _axis_shift(x[1], numbers[1], box[1]),
        _axis_shift(x[2], numbers[2], box[2]),
    )


@jit
def image_numbers(x, box, slide):
    """Which periodic image brings the separation x closest to zero, in periods per axis."""
    numbers = _numbers(x, box)
    if slide is None:
        return numbers
    along = x[0] - numbers[1] * slide[0]
    return (_axis_number(along, box[0]),) + numbers[1:]


@jit
def shifted(x, u, numbers, box, slide):
    """Separation and relative velocity as that image has them."""
    moved = _shift(x, numbers, box)
    if slide is None:
        return moved, u
    return (
        (moved[0] - numbers[1] * slide[0],) + moved[1:],
        (u[0] - numbers[1] * slide[1],) + u[1:],
    )


@jit
def fold_into_box(position, velocity, box, slide):
    """The image of a particle that lies in the box, each periodic axis reaching from 0 to L."""
    centred = _shift(position, _halves(position), box)
    return shifted(position, velocity, image_numbers(centred, box, slide), box, slide)


def _halves(like):
    return (0.5,) * len(like)


@overload(_halves)
def _compiled_halves(like):
    halves = (0.5,) * len(like)
    return lambda like: halves


@unless_absent
def _axis_limit(length, half):
    return (0.5 * length - 2.0) / half


@jit
def _axis_exceeds(u, limit):
    if limit is None:
        return False
    return abs(u) > limit


def speed_limits(box, half):
    """Fastest relative velocities, per axis, at which no second image is met within +-`half`."""
    return tuple(_axis_limit(length, half) for length in box)


@overload(speed_limits)
def _compiled_speed_limits(box, half):
    if len(box) == 2:
        return lambda box, half: (_axis_limit(box[0], half), _axis_limit(box[1], half))
    return lambda box, half: (
        _axis_limit(box[0], half),
        _axis_limit(box[1], half),
        _axis_limit(box[2], half),
    )


def exceeds(u, limits):
    """Whether a relative velocity exceeds a speed limit; NaN does not."""
    return any(_axis_exceeds(a, limit) for a, limit in zip(u, limits, strict=True))


@overload(exceeds)
def _compiled_exceeds(u, limits):
    if len(limits) == 2:
        return lambda u, limits: _axis_exceeds(u[0], limits[0]) | _axis_exceeds(u[1], limits[1])
    return lambda u, limits: (
        _axis_exceeds(u[0], limits[0])
        | _axis_exceeds(u[1], limits[1])
        | _axis_exceeds(u[2], limits[2])
    )
