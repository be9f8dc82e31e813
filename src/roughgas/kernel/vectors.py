"""Vectors of one to three components as tuples, unrolled at compile time.

A tuple's length is part of its type, so the dimension of space costs nothing at run time and the
compiler keeps every component in a register. Each function's plain-Python body is the definition
that its compiled forms unroll.
"""

from numba.extending import overload

from roughgas.kernel.arithmetic import multiply_add


def dot(a, b):
    """Scalar product of two vectors of equal length."""
    return sum(x * y for x, y in zip(a, b, strict=True))


def subtract(a, b):
    """Difference a - b of two vectors."""
    return tuple(x - y for x, y in zip(a, b, strict=True))


def scale(a, s):
    """Vector a times the scalar s."""
    return tuple(x * s for x in a)


def add_scaled(a, b, s):
    """a + s b, for vectors a and b and a scalar s."""
    return tuple(x + y * s for x, y in zip(a, b, strict=True))


def cross_squared(a, b):
    """|a x b|^2, the square of the area that two vectors span."""
    if len(a) == 2:
        return (a[0] * b[1] - a[1] * b[0]) ** 2
    return dot(cross_to_spin(a, b), cross_to_spin(a, b))


def read(array, i, first, like):
    """Components array[i, first:first + len(like)] as a tuple."""
    return tuple(array[i, first + k] for k in range(len(like)))


def write(array, i, first, vector):
    """Store a tuple in array[i, first:first + len(vector)]."""
    for k, x in enumerate(vector):
        array[i, first + k] = x


def spin_cross(w, n):
    """w x n: in the plane w has its one component along the third axis."""
    if len(w) == 1:
        return (-w[0] * n[1], w[0] * n[0])
    return _cross(w, n)


def cross_to_spin(n, g):
    """n x g as a spin: one component in the plane, three in space."""
    if len(n) == 2:
        return (n[0] * g[1] - n[1] * g[0],)
    return _cross(n, g)


def _cross(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@overload(dot)
def _dot(a, b):
    return {
        1: lambda a, b: a[0] * b[0],
        2: lambda a, b: multiply_add(a[1], b[1], a[0] * b[0]),
        3: lambda a, b: multiply_add(a[2], b[2], multiply_add(a[1], b[1], a[0] * b[0])),
    }[len(a)]


@overload(subtract)
def _subtract(a, b):
    return {
        1: lambda a, b: (a[0] - b[0],),
        2: lambda a, b: (a[0] - b[0], a[1] - b[1]),
        3: lambda a, b: (a[0] - b[0], a[1] - b[1], a[2] - b[2]),
    }[len(a)]


@overload(scale)
def _scale(a, s):
    return {
        1: lambda a, s: (a[0] * s,),
        2: lambda a, s: (a[0] * s, a[1] * s),
        3: lambda a, s: (a[0] * s, a[1] * s, a[2] * s),
    }[len(a)]


@overload(add_scaled)
def _add_scaled(a, b, s):
    return {
        1: lambda a, b, s: (multiply_add(b[0], s, a[0]),),
        2: lambda a, b, s: (multiply_add(b[0], s, a[0]), multiply_add(b[1], s, a[1])),
        3: lambda a, b, s: (
            multiply_add(b[0], s, a[0]),
            multiply_add(b[1], s, a[1]),
            multiply_add(b[2], s, a[2]),
        ),
    }[len(a)]


@overload(read)
def _read(array, i, first, like):
    return {
        1: lambda array, i, first, like: (array[i, first],),
        2: lambda array, i, first, like: (array[i, first], array[i, first + 1]),
        3: lambda array, i, first, like: (
            array[i, first],
            array[i, first + 1],
            array[i, first + 2],
        ),
    }[len(like)]


@overload(write)
def _write(array, i, first, vector):
    def compiled(array, i, first, vector):
        for k in range(len(vector)):
            array[i, first + k] = vector[k]

    return compiled


@overload(spin_cross)
def _spin_cross(w, n):
    def plane(w, n):
        return (-w[0] * n[1], w[0] * n[0])

    def space(w, n):
        return (
            w[1] * n[2] - w[2] * n[1],
            w[2] * n[0] - w[0] * n[2],
            w[0] * n[1] - w[1] * n[0],
        )

    return plane if len(w) == 1 else space


@overload(cross_to_spin)
def _cross_to_spin(n, g):
    def plane(n, g):
        return (n[0] * g[1] - n[1] * g[0],)

    def space(n, g):
        return (
            n[1] * g[2] - n[2] * g[1],
            n[2] * g[0] - n[0] * g[2],
            n[0] * g[1] - n[1] * g[0],
        )

    return plane if len(n) == 2 else space


def along_first(like, s):
    """The vector s along the first axis, of as many components as `like`."""
    return (s,) + (0.0,) * (len(like) - 1)


def along_last(like, s):
    """The vector s along the last axis, of as many components as `like`."""
    return (0.0,) * (len(like) - 1) + (s,)


@overload(along_first)
def _along_first(like, s):
    if len(like) == 2:
        return lambda like, s: (s, 0.0)
    return lambda like, s: (s, 0.0, 0.0)


@overload(along_last)
def _along_last(like, s):
    if len(like) == 2:
        return lambda like, s: (0.0, s)
    return lambda like, s: (0.0, 0.0, s)


@overload(cross_squared)
def _cross_squared(a, b):
    def plane(a, b):
        area = multiply_add(a[0], b[1], -(a[1] * b[0]))
        return area * area

    def space(a, b):
        area = cross_to_spin(a, b)
        return dot(area, area)

    return plane if len(a) == 2 else space


def column(array, j, first, like):
    """Components array[first:first + len(like), j] as a tuple."""
    return tuple(array[first + k, j] for k in range(len(like)))


@overload(column)
def _column(array, j, first, like):
    return {
        2: lambda array, j, first, like: (array[first, j], array[first + 1, j]),
        3: lambda array, j, first, like: (
            array[first, j],
            array[first + 1, j],
            array[first + 2, j],
        ),
    }[len(like)]
