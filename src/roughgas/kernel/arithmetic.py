"""a b + c, and when the compiler may round it once instead of twice; and a choice without a branch.

Results are in double precision and rounded step by step, the same on every machine. Only
the sieve (sweep.py) uses single precision, and its rounding shows in no result: there a product and
a sum become one instruction where the machine has it.
"""

from roughgas.kernel.jit import is_lanes, is_single, overload


def multiply_add(a, b, c):
    """Return a b + c; in single precision perhaps with one rounding."""
    return a * b + c


@overload(multiply_add)
def _compiled_multiply_add(a, b, c):
    from roughgas.kernel.operations import fused

    if is_single(a) and is_single(b) and is_single(c):
        return lambda a, b, c: fused(a, b, c)
    return lambda a, b, c: a * b + c


def choose(condition, one, other):
    """Return `one` where the condition holds, else `other`; lane by lane, where it is lanes."""
    return one if condition else other


@overload(choose)
def _compiled_choose(condition, one, other):
    from roughgas.kernel.operations import select

    if is_lanes(condition):
        return lambda condition, one, other: select(condition, one, other)
    return lambda condition, one, other: one if condition else other
