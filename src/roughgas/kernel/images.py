"""Periodic images: an axis of the box has a length, or is None and open.

Under Lees-Edwards shear (`slide` = (offset, velocity), else None) the images above are displaced
by the offset along the first axis and move with the velocity along it: the offset holds at the
clock's base (hooks.sliding) or, after `slid`, at the time in question.
"""

import numpy as np

from roughgas.kernel.arithmetic import multiply_add
from roughgas.kernel.hooks import either, unless_absent
from roughgas.kernel.jit import is_single, jit, overload
from roughgas.kernel.unroll import unrolled

FIRST_LARGE_32 = np.float32(1.5 * 2.0**23)
FIRST_LARGE_64 = 1.5 * 2.0**52


def periods(x, length):
    """Return x/length rounded to the nearest integer, ties to even; exact to 2^22 (2^51 in double).

    Adding and subtracting a number whose spacing is 1 rounds in two additions, which every x86-64
    machine has in vector form and which give the same bits on all of them.
    """
    large = FIRST_LARGE_32 if isinstance(x, np.float32) else FIRST_LARGE_64
    return multiply_add(x, type(x)(1) / length, large) - large


@overload(periods)
def _compiled_periods(x, length):
    large = FIRST_LARGE_32 if is_single(length) else FIRST_LARGE_64
    one = type(large)(1.0)
    # a loop over many divides once and multiplies
    return lambda x, length: multiply_add(x, one / length, large) - large


@unless_absent
def slid(slide, time):
    """Return the slide as it is at `time` after the clock's base."""
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


@unrolled
def _numbers(x, box):
    return tuple(_axis_number(x[k], box[k]) for k in range(len(box)))


@unrolled
def _shift(x, numbers, box):
    return tuple(_axis_shift(x[k], numbers[k], box[k]) for k in range(len(box)))


@jit
def image_numbers(x, box, slide):
    """Return which periodic image brings the separation x closest to zero, in periods per axis."""
    numbers = _numbers(x, box)
    if slide is None:
        return numbers
    along = multiply_add(-numbers[1], slide[0], x[0])
    return (_axis_number(along, box[0]),) + numbers[1:]


@jit
def shifted(x, u, numbers, box, slide):
    """Return separation and relative velocity as that image has them."""
    moved = _shift(x, numbers, box)
    if slide is None:
        return moved, u
    return (
        (multiply_add(-numbers[1], slide[0], moved[0]),) + moved[1:],
        (multiply_add(-numbers[1], slide[1], u[0]),) + u[1:],
    )


@jit
def fold_into_box(position, velocity, box, slide):
    """Return the image of a particle in the box, whose periodic axes reach from 0 to L."""
    centred = _shift(position, _halves(position), box)
    return shifted(position, velocity, image_numbers(centred, box, slide), box, slide)


@unrolled
def _halves(like):
    return tuple(0.5 for k in range(len(like)))


@jit
def speed_limit(box, half, reach):
    """Return the square of the relative speed below which no second image is met within +-`half`.

    None where no axis is periodic. It has some room for rounding. `reach` is the distance of a pair
    in contact, or of any; None stands for 2.
    """
    return _limit(_lengths(box), half, _roomy(reach))


_roomy = either(lambda reach: 1.0005 * reach, lambda reach: 2.001)


@unrolled
def _lengths(box):
    return tuple(box[k] for k in range(len(box)) if box[k] is not None)


@unrolled
def _limit(lengths, half, reach):
    if len(lengths) == 0:
        return None
    else:
        shortest = lengths[0]
        for k in range(1, len(lengths)):
            shortest = min(shortest, lengths[k])
        speed = (0.5 * shortest - reach) / half
        return speed * speed


@unrolled
def exceeds(squared, limit):
    """Return whether the square of a relative speed is above a speed limit; NaN is not."""
    if limit is None:
        return False
    else:
        return squared > limit
