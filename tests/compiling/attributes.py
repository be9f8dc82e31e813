"""The attributes of numba and llvmlite whose values differ after a simulation.

As a program, `attributes.py [STATEMENT]` prints their names, each on a line; the statement runs
before the simulation. A snapshot holds every loaded module, every class of these modules, and every
object of these classes that a module or an attribute refers to, such as the targets and their code
generator. An attribute differs if it is replaced, removed or added; a list, dictionary or set also
differs if an item is replaced or removed. A new item is a registration, numba's public means to
teach it types and functions. An operator that is registered for one more type keeps its candidates.

Numba itself changes some attributes at each compilation. The program therefore compiles a function
by numba alone first, and leaves out the attributes that this changes. Snapshots are taken during
each compilation as well as after it.
"""

import sys
from types import MappingProxyType, ModuleType

import numba
import numpy as np
from numba.extending import overload

PACKAGES = "numba", "llvmlite"
VARIABLES = dict, MappingProxyType  # of an object, of a class
# pickle sets the first in each class of an object that it saves, llvmlite the second in constants
LAZY_ATTRIBUTES = "__slotnames__", "_StringReferenceCaching__cached_refstr"


def is_of_numba(module):
    """Whether a module of this name belongs to numba or llvmlite."""
    return str(module).partition(".")[0] in PACKAGES


def owners():
    """{name: attributes} of modules, classes and objects."""
    waiting = [(name, module) for name, module in [*sys.modules.items()] if is_of_numba(name)]
    waiting.reverse()
    attributes, visited = {}, {}
    while waiting:
        name, owner = waiting.pop()
        if id(owner) in visited:
            continue
        visited[id(owner)] = owner
        attributes[name] = dict(owner.__dict__)
        for key, value in attributes[name].items():
            is_class = isinstance(value, type)
            module = value.__module__ if is_class else type(value).__module__
            if is_of_numba(module) and isinstance(getattr(value, "__dict__", None), VARIABLES):
                path = f"{module}.{value.__qualname__}" if is_class else f"{name}.{key}"
                waiting.append((path, value))
    return attributes


def items_of(value):
    """Items of a container by key, index or identity."""
    if isinstance(value, dict):
        return dict(value)
    if isinstance(value, list):
        return dict(enumerate(value))
    return {id(item): item for item in value} if isinstance(value, set) else {}


def snapshot():
    """{(owner, attribute): (value, items)}."""
    return {
        (name, key): (value, items_of(value))
        for name, attributes in owners().items()
        for key, value in attributes.items()
        if key not in LAZY_ATTRIBUTES and not isinstance(value, ModuleType)
    }


def is_unchanged(item, now):
    """Whether an item is the same object, or a function that still has all its candidates."""
    candidates = set(getattr(item, "templates", ()))
    return item is now or (candidates and candidates <= set(getattr(now, "templates", ())))


def changes(before, after):
    """Names of attributes that differ between two snapshots; new objects are left out."""
    names = {name for name, _ in before}
    differing = {key for key in after.keys() - before.keys() if key[0] in names}
    for key, (value, items) in before.items():
        value_now, items_now = after.get(key, (None, {}))
        has_items = all(
            k in items_now and is_unchanged(item, items_now[k]) for k, item in items.items()
        )
        if key not in after or value_now is not value or not has_items:
            differing.add(key)
    return {f"{owner}.{attribute}" for owner, attribute in differing}


def compile_by_numba(snapshots):
    """Compile a function by numba alone, and take a snapshot meanwhile."""

    def double(x):
        return 2.0 * x

    def implementation(x):
        snapshots.append(snapshot())
        return lambda x: 2.0 * x

    overload(double)(implementation)
    function = numba.njit(lambda x, n: double(x[0]) + max(x[1], n) + np.sqrt(abs(x[2])) // 1)
    assert function(np.array([1.0, 2.0, 4.0]), 3) == 7.0


def simulate(snapshots):
    """Run a kernel; if it has to be compiled, take a snapshot meanwhile."""
    from brute_force import begin, run, settings

    from roughgas.compiling.jit import Compiled

    specialise = Compiled.specialise

    def take_snapshot(function, *arguments, **options):
        if function.__name__ == "record":
            snapshots.append(snapshot())
        return specialise(function, *arguments, **options)

    Compiled.specialise = take_snapshot
    scene, state = begin(settings("smooth"), 0.9, -1.0)
    run(state, scene, 1, collisions=100)


if __name__ == "__main__":
    compile_by_numba([])  # numba registers all types and functions at its first compilation
    first, control = snapshot(), []
    compile_by_numba(control)
    last, snapshots = snapshot(), []
    numbas_own = set().union(*(changes(first, later) for later in [*control, last]))
    exec("".join(sys.argv[1:]))
    simulate(snapshots)
    print(len(last), "attributes,", len(snapshots), "snapshots of a compilation")
    differing = set().union(*(changes(last, later) for later in [*snapshots, snapshot()]))
    for name in sorted(differing - numbas_own):
        print(name)
