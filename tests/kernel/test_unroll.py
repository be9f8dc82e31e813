"""Loops over components are written out as plain Python runs them."""

import numpy as np
import pytest
from compiled import from_python

from roughgas.kernel import vectors
from roughgas.kernel.jit import unrolled


@unrolled
def pairs(box, x):
    """Nested loops, and parts that are left out."""
    total = 0.0
    for k in range(len(x)):
        if box[k] is not None:
            for j in range(k + 1, len(x)):
                total += (k - 3 * j) * x[k] * x[j]
    return total, tuple(2.0 * x[k] for k in range(len(x)) if box[k] is None)


@unrolled
def undecidable(x, y):
    if x > y:
        return x
    else:
        return y


@unrolled
def nothing(box, x):
    for k in range(len(box)):
        if box[k] is not None:
            x[k] += box[k]


@pytest.mark.parametrize("box", [(None, 5.0), (5.0, None, 7.0), (5.0, 6.0, 7.0), (None, None)])
def test_what_is_written_out_is_what_plain_python_does(box):
    x = (1.5, -2.0, 0.25)[: len(box)]
    assert from_python(pairs)(box, x) == pairs(box, x)
    ends = np.zeros((2, 3))
    for function, end in zip((nothing, from_python(nothing)), ends, strict=True):
        function(box, end)
    assert np.array_equal(*ends)


def test_a_branch_that_types_do_not_decide_is_refused():
    with pytest.raises(Exception, match="name 'x' is not defined"):
        from_python(undecidable)(1.0, 2.0)
    assert undecidable(1.0, 2.0) == 2.0


VECTORS = {
    "dot": "ab",
    "subtract": "ab",
    "scale": "as",
    "add_scaled": "abs",
    "cross_squared": "ab",
    "cross_to_spin": "ab",
    "along_first": "as",
    "along_last": "as",
}


@pytest.mark.parametrize("dimension", [2, 3])
def test_vectors_are_compiled_to_the_same_bits(dimension):
    a, b = map(tuple, np.random.default_rng(1).standard_normal((2, dimension)).tolist())
    values = {"a": a, "b": b, "s": 0.7}
    for name, arguments in VECTORS.items():
        function = getattr(vectors, name)
        given = [values[one] for one in arguments]
        assert from_python(function)(*given) == function(*given), name
    array = np.arange(12.0).reshape(2, 6)
    for function in (vectors.read, vectors.column):
        given = array, 1, 0, (0.0, 0.0)
        assert from_python(function)(*given) == function(*given)
