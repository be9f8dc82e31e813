"""The decorators of compiled functions. Numba is imported when the first of them is called.

IEEE arithmetic throughout, without fast-math: the same seed gives the same bits on every x86-64
machine. Division by zero gives inf or NaN as in numpy, so that no loop carries a check for it.
"""

import functools
from collections.abc import Callable


class Compiled:
    """A function that compiled code calls; called from Python, it runs as plain Python."""

    def __init__(self, function, **options):
        functools.update_wrapper(self, function)
        self.py_func, self.options = function, options

    def __call__(self, *args):
        return self.py_func(*args)

    @functools.cached_property
    def dispatcher(self):
        """Numba's object for the function."""
        from roughgas.kernel import compiler

        compiler.register(overloads)
        return compiler.dispatcher(self.py_func, **self.options)

    @property
    def _numba_type_(self):  # which numba asks for where compiled code names the function
        return self.dispatcher._numba_type_


class Entry(Compiled):
    """A function that Python calls in its compiled form."""

    def __call__(self, *args):
        return self.dispatcher(*args)


def entry(function=None, *, cache=False):
    """Decorate a function that Python calls; with `cache` its machine code is kept on the disk."""
    if function is None:
        return functools.partial(entry, cache=cache)
    return Entry(function, cache=cache)


def compiled(function):
    """Decorate a function that only compiled code calls."""
    return Compiled(function, inner=True)


def jit(function):
    """Decorate a function that is inlined where compiled code calls it.

    A call would pass the whole state, some two hundred words: what runs once an event is inlined.
    """
    return Compiled(function, inner=True, inline=True)


class Primitive:
    """An operation that only compiled code knows, by its name in operations.py."""

    def __init__(self, name):
        self.name = name

    @property
    def _numba_type_(self):
        from roughgas.kernel import compiler

        return compiler.type_of(self.name)


overloads: list[tuple[Callable, Callable]] = []
"""(function, chooser) of each overload that numba has not been told of yet."""


def overload(function):
    """Have compiled code call what the decorated function returns in place of `function`.

    The decorated function gets numba's types in place of arguments; see `is_none` and `is_single`.
    """

    def keep(chooser):
        overloads.append((function, chooser))
        return chooser

    return keep


def is_none(kind):
    """Return whether one of numba's types is that of None."""
    return str(kind) == "none"


def is_lanes(kind):
    """Return whether one of numba's types is that of lanes (lanes.py)."""
    return hasattr(kind, "count") and hasattr(kind, "kind")


def is_single(kind):
    """Return whether one of numba's types, or that of each lane, is single precision."""
    return str(kind.kind if is_lanes(kind) else kind) == "float32"
