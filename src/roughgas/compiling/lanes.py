"""Vector registers, with one particle to each lane, in plain Python; simd.py has the machine code.

Lanes are values of compiled code that never leave the registers, and arrays where the kernel runs
as plain Python. + - * / < <= > >= == & | abs and the operations below take them lane by lane, with
one operand a scalar if need be. A machine with narrower registers uses several of them.
"""

import numpy as np

from roughgas.compiling.jit import Primitive, jit, static

BYTES = 64  # of a register, in plain Python


@static
def is_lanes(x):
    """Return whether x, a value or its type in numba, is lanes."""
    return (hasattr(x, "count") and hasattr(x, "kind")) or isinstance(x, np.ndarray)


@static
def is_single(x):
    """Return whether x, a value or its type in numba, is in single precision, or lanes of that."""
    return str(getattr(x, "kind", getattr(x, "dtype", x))) == "float32"


@static
def lanes_of(array):
    """Return the number of lanes of a register for numbers of an array, or of an array's type."""
    if isinstance(array, np.ndarray):
        return BYTES // array.itemsize
    from roughgas.compiling import simd

    return simd.BYTES * 8 // array.dtype.bitwidth


@Primitive
def load(array, row, first, count):
    """Return array[row, first:first + count], as lanes."""
    return array[row, first : first + count].copy()


@Primitive
def store(array, row, first, lanes):
    """Assign lanes to array[row, first:first + count]."""
    array[row, first : first + len(lanes)] = lanes


@Primitive
def load_scalars(array, first, count):
    """Load int32 elements array[first:first + count] one by one, as lanes: a vector load right
    after scalar stores would stall."""
    return array[first : first + count].copy()


@Primitive
def gather(array, column, rows):
    """Return array[row, column], or array[row], for each lane; single precision is widened."""
    values = array[rows] if array.ndim == 1 else array[rows, column]
    return values.astype(float) if is_single(values) else values


@Primitive
def gather_rows(array, rows, pattern):
    """Return array[row, k] for each lane, for as many columns k from 0 on as `pattern` has items.

    `array` (N, columns) is of floats; single precision is widened.
    """
    return tuple(gather(array, k, rows) for k in range(len(pattern)))


@Primitive
def iota(count):
    """Return the lanes 0.0, 1.0, 2.0, ..."""
    return np.arange(float(count))


@Primitive
def bits(lanes):
    """Return lanes of booleans as the bits of an integer, the first lane its lowest bit."""
    return np.uint64(sum(1 << k for k, is_set in enumerate(lanes) if is_set))


@Primitive
def horizontal_min(lanes):
    """Return the minimum over the lanes; their number is a power of two."""
    return lanes.min()


@Primitive
def trailing_zeros(word):
    """Return the number of zeros below the lowest bit that is set."""
    return (int(word) & -int(word)).bit_length() - 1


@Primitive
def prefetch(array, row):
    """Ask the processor to bring array[row] into its cache."""


@Primitive
def assume_nonnegative(number):
    """Return an integer that the compiler may take for >= 0: as an index it needs no wraparound."""
    return number


@Primitive
def multiply_add(a, b, c):
    """Return a b + c; in single precision perhaps with one rounding."""
    return a * b + c


@Primitive
def select(condition, if_true, if_false):
    """Return `if_true` in the lanes where the condition holds, `if_false` in the others."""
    return np.where(condition, if_true, if_false)


@Primitive
def sqrt(x):
    """Return the square root of a number, or of lanes."""
    return np.sqrt(x)


@Primitive
def append(array, length, lanes, first):
    """Append first + k for every lane k that is set to array[:length]; return the new length."""
    (positions,) = np.nonzero(lanes)
    array[length : length + len(positions)] = first + positions
    return length + len(positions)


@jit
def choose(condition, if_true, if_false):
    """Return `if_true` where the condition holds, else `if_false`; lane by lane, if it is lanes."""
    if is_lanes(condition):
        return select(condition, if_true, if_false)
    return if_true if condition else if_false


@jit
def larger(a, b):
    """Return the larger of two numbers, or of each lane; `a` if either is NaN."""
    return choose(b > a, b, a)


@jit
def smaller(a, b):
    """Return the smaller of two numbers, or of each lane; `a` if either is NaN."""
    return choose(b < a, b, a)
