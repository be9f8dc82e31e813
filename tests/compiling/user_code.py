"""A function for each public means of compiling with numba.

As a program, `user_code.py [NAME ...]` calls these functions, by default all, before and after a
simulation; then compiled functions of roughgas and of a user call each other.
"""

import ctypes
import sys

import numba
import numpy as np
from numba import types
from numba.experimental import jitclass
from numba.extending import intrinsic, overload, register_jitable

from roughgas.compiling.jit import compiled, entry, jit

X = np.array([3.0, 1.0, 2.0])


@numba.njit(cache=True)
def cached_minimum(x):
    return np.sort(x)[0] + max(x.shape)


@numba.vectorize(["float64(float64)"], cache=True)
def cached_ufunc(x):
    return 2.0 * x + 1.0


def njit():
    @numba.njit
    def inner(x, n):
        if n < 0:
            raise ValueError("negative", n)
        return max(x.shape) + n, np.full(2, n)

    @numba.njit
    def outer(x, n):
        return inner(x, n)[0] + inner(x, n)[1].sum() + np.sort(x)[0], [str(k) for k in range(n)]

    assert outer(X, 2) == outer.py_func(X, 2) == (10.0, ["0", "1"])
    for function in (inner, outer):
        try:
            function(X, -1)
        except ValueError as error:
            assert error.args == ("negative", -1)
        else:
            raise AssertionError("no error")


def njit_eager():
    called = numba.njit("float64(float64)")(lambda x: x + 0.5)
    assert numba.njit("float64(float64)")(lambda x: 2.0 * called(x))(1.0) == 3.0


def recursive():
    @numba.njit
    def factorial(n):
        return 1 if n < 2 else n * factorial(n - 1)

    assert factorial(5) == 120


def generator():
    @numba.njit
    def count(n):
        for k in range(n):
            yield k * k

    assert numba.njit(lambda n: sum([k for k in count(n)]))(4) == 14
    assert list(count(3)) == [0, 1, 4]


def vectorize_lazy():
    called = numba.njit(lambda x: 2.0 * x)
    assert (numba.vectorize(lambda x: called(x) + 1.0)(X) == 2.0 * X + 1.0).all()


def vectorize_eager():
    called = numba.njit(lambda x: 2.0 * x)
    ufunc = numba.vectorize(["float32(float32)", "float64(float64)"])(lambda x: called(x) + 1.0)
    assert (ufunc(X) == 2.0 * X + 1.0).all()
    assert ufunc(X.astype(np.float32)).dtype == np.float32
    assert numba.njit(lambda x: ufunc(x).sum())(X) == 15.0


def vectorize_parallel():
    called = numba.njit(lambda x: 2.0 * x)
    ufunc = numba.vectorize(["float64(float64)"], target="parallel")(lambda x: called(x) + 1.0)
    assert (ufunc(X) == 2.0 * X + 1.0).all()


def guvectorize():
    called = numba.njit(lambda x: 2.0 * x)

    def total(x, out):
        out[0] = 0.0
        for value in x:
            out[0] += called(value)

    for target in ("cpu", "parallel"):
        ufunc = numba.guvectorize(["(float64[:], float64[:])"], "(n)->()", target=target)(total)
        assert ufunc(X) == 12.0
    lazy = numba.guvectorize("(n)->()")(total)
    out = np.zeros(1)
    lazy(X[None], out)
    assert out == 12.0


def cfunc():
    called = numba.njit(lambda x: 2.0 * x)
    callback = numba.cfunc("float64(float64)")(lambda x: called(x) + 1.0)
    assert callback.ctypes(3.0) == 7.0
    assert ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)(callback.address)(3.0) == 7.0
    assert numba.njit(lambda f, x: f(x))(callback, 3.0) == 7.0


def function_values():
    """Functions in a tuple, and as an argument of a function type."""
    kind = types.FunctionType(types.float64(types.float64))
    double = numba.njit("float64(float64)")(lambda x: 2.0 * x)
    triple = numba.njit("float64(float64)")(lambda x: 3.0 * x)

    @numba.njit
    def all_of(functions, x):
        total = 0.0
        for function in functions:
            total += function(x)
        return total

    assert all_of((double, triple), 1.0) == 5.0
    by_type = numba.njit(types.float64(kind, types.float64))(lambda f, x: f(x))
    assert by_type(double, 2.0) == 4.0


def jit_class():
    @jitclass([("values", types.float64[:]), ("number", types.int64)])
    class Heap:
        def __init__(self, room):
            self.values, self.number = np.zeros(room), 0

        def add(self, value):
            self.values[self.number] = value
            self.number += 1
            return self.number

        @property
        def total(self):
            return self.values[: self.number].sum()

    heap = Heap(4)
    assert [heap.add(1.5), heap.add(2.0)] == [1, 2]
    assert numba.njit(lambda heap: heap.add(1.0) + heap.total)(heap) == 7.5


def parallel():
    called = numba.njit(lambda x: 2.0 * x)

    @numba.njit(parallel=True)
    def total(x):
        sums = 0.0
        for k in numba.prange(len(x)):
            sums += called(x[k])
        return sums + (x * x).sum()

    assert total(X) == 26.0


def stencil():
    middle = numba.stencil(lambda a: 0.5 * (a[-1] + a[1]))
    assert (numba.njit(lambda x: middle(x))(X) == [0.0, 2.5, 0.0]).all()


def object_mode():
    def shape_of(x):
        with numba.objmode(n="int64"):
            n = len(str(x.shape))
        return n

    assert numba.njit(shape_of)(X) == 4
    assert numba.jit(forceobj=True)(lambda x: str(x))(1) == "1"


def extended():
    def triple(x):
        return 3.0 * x

    overload(triple)(lambda x: lambda x: 3.0 * x)
    helper = register_jitable(lambda x: x + 1.0)

    @intrinsic
    def one_more(context, x):
        def generate(context, builder, signature, values):
            return builder.add(values[0], values[0].type(1))

        return types.int64(types.int64), generate

    assert numba.njit(lambda x, n: helper(triple(x)) + one_more(n))(1.0, 2) == 7.0


def cached():
    assert (cached_minimum(X), *cached_ufunc(X)) == (4.0, 7.0, 3.0, 5.0)


@compiled
def doubled(x):
    return 2.0 * x


@compiled
def checked(x):
    if x < 0.0:
        raise ValueError("below zero")
    return doubled(x) + max(x, 1.0)


@jit
def halved(x):
    return 0.5 * x


@entry
def quadrupled(x):
    return doubled(doubled(x))


def user_calls_roughgas():
    """A user's functions call compiled functions of roughgas, by every means that links them."""
    function = numba.njit(lambda x: checked(x) + halved(x) + quadrupled(x))
    assert function(2.0) == 15.0
    assert numba.njit(lambda x: function(x) + doubled(x))(2.0) == 19.0
    try:
        function(-1.0)
    except ValueError as error:
        assert str(error) == "below zero"
    else:
        raise AssertionError("no error")
    ufunc = numba.vectorize(["float64(float64)"])(lambda x: checked(x) + quadrupled(x))
    assert (ufunc(X) == [21.0, 7.0, 14.0]).all()
    assert numba.cfunc("float64(float64)")(lambda x: checked(x)).ctypes(3.0) == 9.0
    total = numba.njit(parallel=True)(lambda x: sum_of(x))
    assert total(X) == 12.0 + 12.0


@numba.njit(parallel=True)
def sum_of(x):
    sums = 0.0
    for k in numba.prange(len(x)):
        sums += quadrupled(x[k])
    return sums


def roughgas_calls_user():
    """A compiled function of roughgas calls a user's function that calls another of roughgas."""
    total = entry(lambda x: total_of(x) + doubled(1.0))
    assert total(X) == 8.0


@numba.njit
def total_of(x):
    total = 0.0
    for value in x:
        total += doubled(value) - value
    return total


MEANS = (
    *(njit, njit_eager, recursive, generator, vectorize_lazy, vectorize_eager, vectorize_parallel),
    *(guvectorize, cfunc, function_values, jit_class, parallel, stencil, object_mode, extended),
    cached,
)
WITH_ROUGHGAS = user_calls_roughgas, roughgas_calls_user


def run_all(functions):
    """Call functions; each name is printed before, in case that the process crashes."""
    for function in functions:
        print(function.__name__, flush=True)
        function()


def simulate():
    """Run a kernel."""
    from brute_force import begin, run, settings

    scene, state = begin(settings("gas"), 0.9, -1.0)
    run(state, scene, 1, collisions=100)


if __name__ == "__main__":
    chosen = [function for function in MEANS if function.__name__ in sys.argv[1:]] or MEANS
    run_all(chosen)
    simulate()
    run_all([*chosen, *WITH_ROUGHGAS])
    print("all")
