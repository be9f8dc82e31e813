"""The decorators of compiled functions: `jit`, and `compiled` for what runs rarely.

IEEE arithmetic throughout, without fast-math: the same seed gives the same bits on every x86-64
machine. Division by zero gives inf or NaN as in numpy, so that no loop carries a check for it.
"""

import functools

import numba

compiled = functools.partial(numba.njit, error_model="numpy", _nrt=False)
# A call would pass the whole state, some two hundred words: what runs once an event is inlined
jit = functools.partial(compiled, forceinline=True)
