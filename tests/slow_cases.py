"""Cases of a test, as parameters, all but some of them with the mark `slow`."""

import pytest


def slow_but(quick, cases):
    """The cases as parameters of a test, each one value or a tuple of values, all of them slow but
    those in `quick`."""
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=[] if case in quick else [pytest.mark.slow],
        )
        for case in cases
    ]
