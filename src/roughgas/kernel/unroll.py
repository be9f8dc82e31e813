"""Loops over the components of vectors, written out before numba compiles them.

A vector is a tuple whose length is part of its type. So the dimension of space costs nothing at run
time, and the compiler keeps every component in a register.
"""

import ast
import copy
import inspect
import textwrap

from roughgas.kernel.jit import is_none, overload


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
