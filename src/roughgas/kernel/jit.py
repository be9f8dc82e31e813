"""The decorators of compiled functions: `entry` for what Python calls, `compiled` for what only
compiled code does, and `jit` for what is inlined besides.

IEEE arithmetic throughout, without fast-math: the same seed gives the same bits on every x86-64
machine. Division by zero gives inf or NaN as in numpy, so that no loop carries a check for it.
"""

import functools

import numba

entry = functools.partial(numba.njit, error_model="numpy", _nrt=False)
# Unpacking a state for a call from Python takes more code, and time to compile it, than most
# functions do. Called from Python, these crash: give them an entry first (tests/compiled.py).
compiled = functools.partial(entry, no_cpython_wrapper=True, no_cfunc_wrapper=True)
# A call would pass the whole state, some two hundred words: what runs once an event is inlined
jit = functools.partial(compiled, forceinline=True)
