"""Periodic images: an axis of the box has a length, or is None and open.

Under Lees-Edwards shear (`slide` = (offset, velocity), else None) the images above are displaced
by the offset along the first axis and move with the velocity along it: the offset holds at the
clock's base (hooks.sliding) or, after `slid`, at the time in question.
"""

import numpy as np
from numba import types
from numba.extending import overload

from roughgas.kernel.arithmetic import multiply_add
from roughgas.kernel.hooks import unless_absent
from roughgas.kernel.jit import jit

FIRST_LARGE_32 = np.float32(1.5 * 2.0**23)
FIRST_LARGE_64 = 1.5 * 2.0**52


def periods(x, length):
    """x/length rounded to the nearest integer, ties to even; exact up to 2^22 (2^51 in double).

    Adding and subtracting a number whose spacing is 1 rounds in two additions, which every x86-64
    machine has in vector form and which give the same bits on all of them.
    """
    large = FIRST_LARGE_32 if isinstance(x, np.float32) else FIRST_LARGE_64
    return multiply_add(x, type(x)(1) / length, large) - large


@overload(periods)
def _compiled_periods(x, length):
    single = length == types.float32
    one, large = (np.float32(1.0), FIRST_LARGE_32) if single else (1.0, FIRST_LARGE_64)
    # a loop over many divides once and multiplies
    return lambda x, length: multiply_add(x, one / length, large) - large


@unless_absent
def slid(slide, time):
    """The slide as it is at `time` after the clock's base."""
    return slide[0] + slide[1] * time, slide[1]


@jit
def _axis_number(x, length):
    if length is None:
        return x  # not used: an open axis has one image
    return periods(x, length)


@jit
def _axis_shift(x, number, length):
    if length is None:
        return x
    return multiply_add(-number, length, x)


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
    along = multiply_add(-numbers[1], slide[0], x[0])
    return (_axis_number(along, box[0]),) + numbers[1:]


@jit
def shifted(x, u, numbers, box, slide):
    """Separation and relative velocity as that image has them."""
    moved = _shift(x, numbers, box)
    if slide is None:
        return moved, u
    return (
        (multiply_add(-numbers[1], slide[0], moved[0]),) + moved[1:],
        (multiply_add(-numbers[1], slide[1], u[0]),) + u[1:],
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


def speed_limit(box, half):
    """Square of the relative speed below which no second image is met within +-`half`.

    None where no axis is periodic. It has some room for rounding.
    """
    shortest = _shortest_period(box)
    return None if shortest is None else _limit(shortest, half)


def _shortest_period(box):
    return min((length for length in box if length is not None), default=None)


@jit
def _limit(shortest, half):
    speed = (0.5 * shortest - 2.001) / half
    return speed * speed


@overload(speed_limit)
def _compiled_speed_limit(box, half):
    periodic = [k for k, length in enumerate(box) if not isinstance(length, types.NoneType)]
    if not periodic:
        return lambda box, half: None
    first, second, third = (periodic * 3)[:3] if len(periodic) != 2 else (*periodic, periodic[0])
    return lambda box, half: _limit(min(box[first], box[second], box[third]), half)


def exceeds(squared, limit):
    """Whether the square of a relative speed is above a speed limit; NaN is not."""
    return False if limit is None else squared > limit


@overload(exceeds)
def _compiled_exceeds(squared, limit):
    if isinstance(limit, types.NoneType):
        return lambda squared, limit: False
    return lambda squared, limit: squared > limit
