"""Compiling with numba: what is compiled, and loops over components that are unrolled before.

The decorators of compiled functions. Numba is imported when the first of them is called.

IEEE arithmetic throughout, without fast-math: the same seed gives the same bits on every x86-64
machine. Division by zero gives inf or NaN as in numpy, so that no loop carries a check for it.

Loops over the components of vectors, written out before numba compiles them.

A vector is a tuple whose length is part of its type. So the dimension of space costs nothing at run
time, and the compiler keeps every component in a register.
"""

import ast
import copy
import functools
import inspect
import textwrap
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

    What runs once an event is inlined: a call takes longer than much that such functions do.
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


by_reference = Primitive("by_reference")
"""(whole) -> the named tuple, which compiled code takes from memory: kernel/reference.py"""


def is_none(kind):
    """Return whether one of numba's types is that of None."""
    return str(kind) == "none"


def is_lanes(kind):
    """Return whether one of numba's types is that of lanes (lanes.py)."""
    return hasattr(kind, "count") and hasattr(kind, "kind")


def is_single(kind):
    """Return whether one of numba's types, or that of each lane, is single precision."""
    return str(kind.kind if is_lanes(kind) else kind) == "float32"


def unrolled(function):
    """Let compiled code call a plain function, with its loops over components written out.

    Numba's types tell the length of each argument that is a tuple, `len(x)`, and what is None,
    `x is None` and `x[0] is None`. Loops `for k in range(...)` and `tuple(... for k in range(...))`
    must depend on nothing else, nor may the tests of `if`: of these only the branch taken stays.
    """

    @overload(function)
    def written_out(*kinds):
        lines, first = inspect.getsourcelines(function)
        (definition,) = ast.parse(textwrap.dedent("".join(lines))).body
        definition.decorator_list = []
        ast.increment_lineno(definition, first - 1)
        known = {}
        for argument, kind in zip(definition.args.args, kinds, strict=True):
            known |= _told_by(argument.arg, kind)
        written = _Writer(known).visit(definition)
        written.body = written.body or [ast.Pass()]
        module = ast.Module([written], [])
        code = compile(ast.fix_missing_locations(module), inspect.getfile(function), "exec")
        defined = {}
        exec(code, function.__globals__, defined)
        return defined[function.__name__]

    return function


def _told_by(name, kind):
    """Return the values of expressions that the type of an argument tells, by their text."""
    parts = getattr(kind, "types", None) or ()
    items = {name: kind} | {f"{name}[{k}]": part for k, part in enumerate(parts)}
    lengths = {f"len({name})": len(parts)} if hasattr(kind, "types") else {}
    absent = {item: is_none(one) for item, one in items.items()}
    return (
        lengths
        | {f"{item} is None": value for item, value in absent.items()}
        | {f"{item} is not None": not value for item, value in absent.items()}
    )


class _Writer(ast.NodeTransformer):
    """Writes loops out; `known` has the values of expressions by their text."""

    def __init__(self, known):
        self._known = known

    def visit(self, node):
        node = super().visit(node)
        if isinstance(node, ast.expr):
            text = ast.unparse(node)
            return ast.Constant(self._known[text]) if text in self._known else node
        return node

    def visit_Call(self, node):
        if isinstance(node.func, ast.Name) and node.func.id == "tuple":
            (loop,) = node.args[0].generators
            return ast.Tuple(self._each(loop, [node.args[0].elt], loop.ifs), ast.Load())
        return self.generic_visit(node)

    def visit_For(self, node):
        return self._each(node, node.body)

    def visit_If(self, node):
        return self._all(node.body if self._value(node.test) else node.orelse)

    def _each(self, loop, nodes, tests=()):
        written = []
        for k in self._value(loop.iter):
            here = _Writer(self._known | {loop.target.id: k})
            if all(here._value(test) for test in tests):
                written += here._all(nodes)
        return written

    def _all(self, nodes):
        visited = [self.visit(copy.deepcopy(node)) for node in nodes]
        return [one for part in visited for one in (part if isinstance(part, list) else [part])]

    def _value(self, node):
        known = ast.Expression(self.visit(copy.deepcopy(node)))
        return eval(compile(ast.fix_missing_locations(known), "a range or a test", "eval"))
