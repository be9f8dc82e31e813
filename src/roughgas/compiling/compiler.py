"""The choice of how numba compiles a function: imported when compiled code is first called.

There are two paths, to the same bits. private_numba.py takes half of the time by parts that are
private to numba, and is the default. public_numba.py uses numba.njit and numba.extending alone. It
is chosen by ROUGHGAS_PUBLIC_NUMBA=1, and by itself, with a warning, where numba is newer than
tested or lacks a private part; ROUGHGAS_PUBLIC_NUMBA=0 insists on the private path.
"""

import functools
import os
import re
import sys

import numba

from roughgas.base import InputError

SWITCH = "ROUGHGAS_PUBLIC_NUMBA"
NEWEST_TESTED = (0, 68)
"""The newest numba whose private parts the tests have passed with."""


@functools.cache
def path():
    """Return the module, private_numba or public_numba, that this process compiles by.

    Raises InputError for an illegal ROUGHGAS_PUBLIC_NUMBA.
    """
    chosen = os.environ.get(SWITCH, "")
    if chosen not in ("", "0", "1"):
        raise InputError(SWITCH, chosen, "be 0 or 1")
    reason = None if chosen else why_public()
    if reason:
        print(
            f"roughgas: warning: {reason}: kernels are compiled by its public functions alone, "
            f"which takes twice as long ({SWITCH}=1 says so)",
            file=sys.stderr,
        )
    if chosen == "1" or reason:
        from roughgas.compiling import public_numba

        return public_numba
    from roughgas.compiling import private_numba

    return private_numba


def why_public():
    """Return why the private parts of this numba cannot be used; None if they can."""
    version = tuple(map(int, re.findall(r"\d+", numba.__version__)[:2]))
    if version > NEWEST_TESTED:
        return f"numba {numba.__version__} is newer than {'.'.join(map(str, NEWEST_TESTED))}"
    try:
        from roughgas.compiling import private_numba

        missing = private_numba.missing_part()
    except (AttributeError, ImportError, TypeError) as error:
        return f"numba {numba.__version__}: {error}"
    return missing and f"numba {numba.__version__} has no {missing}"


def dispatcher(compiled):
    """Return numba's dispatcher of a Compiled function.

    Raises InputError if numba is told not to compile, or if ROUGHGAS_PUBLIC_NUMBA is illegal.
    """
    if numba.config.DISABLE_JIT:
        raise InputError("NUMBA_DISABLE_JIT", 1, "be unset: the kernels run compiled only")
    return path().dispatcher(compiled)


def compiled_type(compiled):
    """Return the type that numba gives to a Compiled function."""
    return path().compiled_type(compiled)


def primitive_type(primitive):
    """Return the type that numba gives to a Primitive."""
    return path().primitive_type(primitive)
