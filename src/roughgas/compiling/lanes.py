"""Several particles at once, one to each lane of a vector register: what simd.py makes of them in
machine code, in plain Python.

Lanes are values of compiled code that never leave the registers, and arrays where the kernel runs
as plain Python. + - * / < <= > >= == & | abs and the operations below take them lane by lane, with
one operand a scalar if need be. A machine with narrower registers takes several for one.
"""

import numpy as np

from roughgas.compiling.jit import Primitive, jit, of_types

BYTES = 64  # of a register, in plain Python


@of_types
def is_lanes(x):
    """Return whether x is lanes; in place of a value it may be a type of numba's."""
    return (hasattr(x, "count") and hasattr(x, "kind")) or isinstance(x, np.ndarray)


@of_types
def is_single(x):
    """Return whether x, or each lane of it, is in single precision; x may be a type, too."""
    return str(getattr(x, "kind", getattr(x, "dtype", x))) == "float32"


@of_types
def lanes_of(array):
    """Return how many of an array's numbers a register has; in place of it may be its type."""
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
    """Put lanes where `load` has them from."""
    array[row, first : first + len(lanes)] = lanes


@Primitive
def numbers_in(places, first, count):
    """Return places[first:first + count], which are 32-bit integers, each read by itself: what has
    just been written one by one, a read of all would have to wait for."""
    return places[first : first + count].copy()


@Primitive
def gather(array, column, numbers):
    """Return array[number, column], or array[number], for each number; singles are widened."""
    found = array[numbers] if array.ndim == 1 else array[numbers, column]
    return found.astype(float) if is_single(found) else found


@Primitive
def order(count):
    """Return 0.0, 1.0, 2.0, ..."""
    return np.arange(float(count))


@Primitive
def bits(lanes):
    """Return lanes of booleans as an integer, the first lane its lowest bit."""
    return np.uint64(sum(1 << k for k, holds in enumerate(lanes) if holds))


@Primitive
def least(lanes):
    """Return the least of the lanes, whose number is a power of two."""
    return lanes.min()


@Primitive
def trailing_zeros(word):
    """Return the number of zeros below the lowest bit that is set."""
    return (int(word) & -int(word)).bit_length() - 1


@Primitive
def prefetch(array, row):
    """Have array[row] on its way to the cache."""


@Primitive
def index(number):
    """Return a number, promised not to count from the end of an array."""
    return number


@Primitive
def multiply_add(a, b, c):
    """Return a b + c; in single precision perhaps with one rounding."""
    return a * b + c


@Primitive
def select(condition, one, other):
    """Return `one` in the lanes where the condition holds, `other` elsewhere."""
    return np.where(condition, one, other)


@Primitive
def root(x):
    """Return the square root of a number, or of lanes."""
    return np.sqrt(x)


@Primitive
def append(places, number, lanes, first):
    """Write the numbers, counted from `first`, of the lanes that hold into places[number:]; return
    how many places are taken then."""
    (found,) = np.nonzero(lanes)
    places[number : number + len(found)] = first + found
    return number + len(found)


@jit
def choose(condition, one, other):
    """Return `one` where the condition holds, else `other`; lane by lane, where it is lanes."""
    if is_lanes(condition):
        return select(condition, one, other)
    return one if condition else other


@jit
def larger(one, other):
    """Return the larger of two numbers, lane by lane if need be; the first if one is NaN."""
    return choose(other > one, other, one)


@jit
def smaller(one, other):
    """Return the smaller of two numbers, lane by lane if need be; the first if one is NaN."""
    return choose(other < one, other, one)
