"""Vectors of one to three components as tuples."""

from roughgas.kernel.jit import jit
from roughgas.kernel.mathematics import multiply_add


@jit
def dot(a, b):
    """Return the scalar product of two vectors of equal length."""
    total = a[0] * b[0]
    for k in range(1, len(a)):
        total = multiply_add(a[k], b[k], total)
    return total


@jit
def subtract(a, b):
    """Return the difference a - b of two vectors."""
    return tuple(a[k] - b[k] for k in range(len(a)))


@jit
def subtract_last(a, s):
    """Return the vector a with the scalar s taken off its last component."""
    return tuple(a[k] for k in range(len(a) - 1)) + (a[len(a) - 1] - s,)


@jit
def scale(a, s):
    """Return the vector a times the scalar s."""
    return tuple(a[k] * s for k in range(len(a)))


@jit
def divide(a, s):
    """Return the vector a over the scalar s."""
    return tuple(a[k] / s for k in range(len(a)))


@jit
def add_scaled(a, b, s):
    """Return a + s b, for vectors a and b and a scalar s."""
    return tuple(multiply_add(b[k], s, a[k]) for k in range(len(a)))


@jit
def read(array, i, first, like):
    """Return the components array[i, first:first + len(like)] as a tuple."""
    return tuple(array[i, first + k] for k in range(len(like)))


@jit
def column(array, j, first, like):
    """Return the components array[first:first + len(like), j] as a tuple."""
    return tuple(array[first + k, j] for k in range(len(like)))


@jit
def write(array, i, first, vector):
    """Store a tuple in array[i, first:first + len(vector)]."""
    for k in range(len(vector)):
        array[i, first + k] = vector[k]


@jit
def along_axis(like, axis, s):
    """Return the vector s along an axis, with as many components as `like`."""
    return tuple(s if k == axis else 0.0 for k in range(len(like)))


@jit
def spin_cross(w, n):
    """Return w x n; in the plane w has one component, along the third axis."""
    if len(w) == 1:
        return (-w[0] * n[1], w[0] * n[0])
    return (w[1] * n[2] - w[2] * n[1], w[2] * n[0] - w[0] * n[2], w[0] * n[1] - w[1] * n[0])


@jit
def cross_to_spin(n, g):
    """Return n x g as a spin: one component in the plane, three in space."""
    if len(n) == 2:
        return (n[0] * g[1] - n[1] * g[0],)
    return spin_cross(n, g)


@jit
def cross_squared(a, b):
    """Return |a x b|^2, the square of the area that two vectors span."""
    if len(a) == 2:
        area = multiply_add(a[0], b[1], -(a[1] * b[0]))
        return area * area
    area = cross_to_spin(a, b)
    return dot(area, area)
