"""Compiling with numba: what is compiled, and how a function is written for a scene.

A function of the kernel is plain Python, and runs as such. Before numba compiles it it is written
anew for the types of its arguments. They tell what is None, how many components a vector has, and
which effects a scene has: `if scene.effects.gravity is None`, `for k in range(len(x))` and
`for part in present(effects, "restitution")` are decided, and only what is left is compiled. What a
scene lacks leaves no instruction; and the compiler keeps each component of a vector, a tuple, in a
register. `python -m roughgas.kernel --show FUNCTION --scene EXPERIMENT` prints what is left.

Types are known of an argument, of a field or an item of one (`state.sweep.sizes`), and of a name
that is assigned once, to one of these. Where they do not decide `is None` the function is refused:
it would be a branch at run time. Other tests stay.

IEEE arithmetic throughout, without fast-math: the same seed gives the same bits on every x86-64
machine. Division by zero gives inf or NaN as in numpy, so that no loop carries a check for it.
Numba is imported when the first compiled function is called.
"""

import ast
import functools
import inspect
import sys
import textwrap
from types import SimpleNamespace


class Compiled:
    """A function that compiled code calls; called from Python, it runs as plain Python."""

    def __init__(self, function, **options):
        functools.update_wrapper(self, function)
        self.py_func, self.options = function, options
        self.written = {}  # types of the arguments -> the function as it is compiled for them

    def __call__(self, *args):
        return self.py_func(*args)

    @functools.cached_property
    def dispatcher(self):
        """Numba's object for the function."""
        from roughgas.compiling import compiler

        made = compiler.dispatcher(self.py_func, **self.options)
        made._compiler._get_implementation = self._for_types
        return made

    @property
    def _numba_type_(self):  # which numba asks for where compiled code names the function
        return self.dispatcher._numba_type_

    @functools.cached_property
    def _definition(self):
        lines, first = inspect.getsourcelines(self.py_func)
        (definition,) = ast.parse(textwrap.dedent("".join(lines))).body
        return ast.increment_lineno(definition, first - 1)

    def _for_types(self, kinds, keywords):
        """Return the function for arguments of these types of numba's."""
        function = self.py_func
        if function.__name__ == "<lambda>":
            return function
        around = BUILTINS | function.__globals__ | inspect.getclosurevars(function).nonlocals
        writer = _Writer(self._definition, kinds, around)
        self.written[kinds] = definition = writer.visit(self._definition)
        module = ast.fix_missing_locations(ast.Module([definition], []))
        defined = {}
        exec(compile(module, inspect.getfile(function), "exec"), writer.around, defined)
        return defined[function.__name__]


class Entry(Compiled):
    """A function that Python calls in its compiled form; `py_func` runs as plain Python."""

    def __call__(self, *args):
        return self.dispatcher(*args)


def entry(function=None, *, cache=False):
    """Decorate a function that Python calls; with `cache` its machine code is kept on the disk."""
    if function is None:
        return functools.partial(entry, cache=cache)
    return Entry(function, cache=cache)


def texts_of(name, called, *arguments):
    """Return {module: texts} of all functions of a name, as they are written for an entry's call.

    Empty where no function has this name; without texts where the call has no need of it. In a
    process that has compiled nothing yet.
    """
    modules = [m for key, m in sorted(sys.modules.items()) if key.startswith("roughgas.")]
    called = Entry(called.py_func)  # not from the cache
    known = [called, *(one for m in modules for one in vars(m).values() if type(one) is Compiled)]
    named = [one for one in known if one.__name__ == name]
    if named:
        called(*arguments)
    found = {}
    for one in named:
        texts = found.setdefault(one.__module__, {})  # in order, and each once
        texts |= dict.fromkeys(map(ast.unparse, one.written.values()))
    return found


def compiled(function):
    """Decorate a function that only compiled code calls."""
    return Compiled(function, inner=True)


def jit(function):
    """Decorate a function that is inlined where compiled code calls it.

    What runs once an event is inlined: a call takes longer than much that such functions do.
    """
    return Compiled(function, inner=True, inline=True)


class Primitive:
    """An operation of compiled code, by its name in simd.py, and what Python runs for it."""

    def __init__(self, plain):
        functools.update_wrapper(self, plain)
        self.plain = plain

    def __call__(self, *args):
        return self.plain(*args)

    @property
    def _numba_type_(self):
        from roughgas.compiling import compiler

        return compiler.type_of(self.__name__)


@Primitive
def by_reference(whole):
    """Return a named tuple, which compiled code takes from memory then: compiling/reference.py."""
    return whole


def of_types(function):
    """Decorate a plain function whose value the types of its arguments tell, if they stand in for
    these: the writer calls it, and compiled code does not."""
    function.of_types = True
    return function


@of_types
def is_tuple(x):
    """Return whether x is a tuple; it may be a type of numba's."""
    return isinstance(x, tuple) or hasattr(x, "types")


@Primitive
def integer(x):
    """Return int(x)."""
    return int(x)


@jit
def largest(*values):
    """Return max(*values)."""
    numbers = values[0] if is_tuple(values[0]) else values
    number = numbers[0]
    for k in range(1, len(numbers)):
        if numbers[k] > number:
            number = numbers[k]
    return number


@jit
def smallest(*values):
    """Return min(*values)."""
    numbers = values[0] if is_tuple(values[0]) else values
    number = numbers[0]
    for k in range(1, len(numbers)):
        if numbers[k] < number:
            number = numbers[k]
    return number


BUILTINS = {"int": integer, "max": largest, "min": smallest}
"""Functions that compiled code calls by these names. Numba's own have a library each, which is
optimised before the kernel is, or was by a user's function."""


def part_of(kind, step):
    """Return the type of a field, by its name, or of an item of a type of numba's.

    None is what types do not tell. Raises TypeError for a field that a NamedTuple does not have.
    """
    fields = getattr(getattr(kind, "instance_class", None), "_fields", ())
    if isinstance(step, str):
        if fields and step not in fields:
            raise TypeError(f"{kind.instance_class.__name__} has no {step}")
        return kind.types[fields.index(step)] if fields else None
    return kind.types[step] if hasattr(kind, "types") else None


def _has_ended(nodes):
    return nodes[-1:] and isinstance(nodes[-1], ast.Return | ast.Raise | ast.Break | ast.Continue)


class _Writer(ast.NodeTransformer):
    """Writes a function for types; nodes stay as they are, new ones take their place.

    `known` has, by name, a type of numba's, or a constant as a node. A name that is assigned more
    than once is not in it.
    """

    def __init__(self, definition, kinds, around):
        self.around, self._place = around, definition.name
        parameters = [*definition.args.args, definition.args.vararg][: len(kinds)]
        nodes = [node for node in ast.walk(definition) if isinstance(node, ast.Name)]
        names = [node.id for node in nodes if isinstance(node.ctx, ast.Store)]
        self._once = {name for name in names if names.count(name) == 1}
        given = zip([one.arg for one in parameters], kinds, strict=True)
        self._known = {name: kind for name, kind in given if name not in names}

    def visit(self, node):
        """Return what takes the node's place; of a statement it may be a list."""
        new = super().visit(node)
        return new if isinstance(new, list) else ast.copy_location(new, node)

    def generic_visit(self, node):
        """Return a copy of the node with what it consists of visited; if it is known, its value."""
        new = type(node)(**{name: self._visited(value) for name, value in ast.iter_fields(node)})
        parts = [one for one in ast.iter_child_nodes(new) if isinstance(one, ast.expr)]
        is_known = all(isinstance(getattr(one, "value", None), int) for one in parts)
        if is_known and isinstance(node, ast.BinOp | ast.UnaryOp | ast.Compare):
            whole = ast.fix_missing_locations(ast.Expression(new))
            return ast.Constant(eval(compile(whole, self._place, "eval")))
        return new

    def _visited(self, value):
        if isinstance(value, list):
            return [self._visited(one) for one in value]
        return self.visit(value) if isinstance(value, ast.AST) else value

    # ------------------------------------------------------------------ statements

    def visit_FunctionDef(self, node):
        return ast.FunctionDef(node.name, node.args, self._all(node.body), [])

    def _all(self, nodes):
        """Return statements as they are written; what follows a return is left out."""
        written = []
        for node in nodes:
            part = self.visit(node)
            written += part if isinstance(part, list) else [part]
            if _has_ended(written):
                break
        return written or [ast.Pass()]

    def visit_If(self, node):
        test = self._test(node.test)
        if isinstance(test, ast.Constant):
            chosen = node.body if test.value else node.orelse
            return self._all(chosen) if chosen else []
        return ast.If(test, self._all(node.body), self._all(node.orelse) if node.orelse else [])

    def visit_While(self, node):
        return ast.While(self._test(node.test), self._all(node.body), [])

    def visit_For(self, node):
        values = self.visit(node.iter)
        if not isinstance(values, ast.Constant):
            return ast.For(node.target, values, self._all(node.body), [])
        if any(isinstance(one, ast.Break | ast.Continue) for one in ast.walk(node)):
            self._refuse(node.iter, "what is written out has no break and no continue")
        written = []
        for _ in self._each(node, values):
            written += [] if _has_ended(written) else self._all(node.body)
        return written

    def _each(self, loop, values):
        """Go through the values of a loop, each of which its target has meanwhile."""
        outer = self._known
        for value in values.value:
            self._known = outer | {loop.target.id: ast.Constant(value)}
            yield value
        self._known = outer

    def visit_Assign(self, node):
        new, (target,) = self.generic_visit(node), node.targets
        pairs = [(target, new.value)]
        if isinstance(target, ast.Tuple) and isinstance(new.value, ast.Tuple):
            pairs = zip(target.elts, new.value.elts, strict=True)
        for name, part in pairs:
            is_constant = isinstance(part, ast.Constant) and isinstance(part.value, int | None)
            told = part if is_constant else self._kind(part)
            if getattr(name, "id", None) in self._once and told is not None:
                self._known |= {name.id: told}
        return new

    # ------------------------------------------------------------------ expressions

    def _kind(self, node):
        """Return the type of an expression, None where types do not tell it."""
        if isinstance(node, ast.Constant) and node.value is None:
            return "none"
        if isinstance(node, ast.Name):
            return self._known.get(node.id)
        if isinstance(node, ast.Attribute):
            return part_of(self._kind(node.value), node.attr)
        if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
            return part_of(self._kind(node.value), node.slice.value)
        if isinstance(node, ast.Tuple):
            return SimpleNamespace(types=[self._kind(one) for one in node.elts])
        return None

    def _refuse(self, node, why):
        raise TypeError(f"{self._place}, line {node.lineno}: {ast.unparse(node)}: {why}")

    def _test(self, node):
        """Return a test, decided or not; refuse one of something that has no truth."""
        test = self.visit(node)
        kind = self._kind(test.operand if isinstance(test, ast.UnaryOp) else test)
        if not isinstance(test, ast.Constant) and (is_none(kind) or hasattr(kind, "types")):
            self._refuse(node, "a test must say `is None`")
        return test

    def visit_Name(self, node):
        known = self._known.get(node.id) if isinstance(node.ctx, ast.Load) else None
        return known if isinstance(known, ast.Constant) else node

    def visit_Attribute(self, node):
        new = self.generic_visit(node)
        if not isinstance(new.value, ast.Constant):
            return new
        value = getattr(new.value.value, node.attr)
        if not callable(value):
            return ast.Constant(value)
        name = f"{value.__module__}.{value.__name__}".replace(".", "_")
        while self.around.setdefault(name, value) is not value:  # another function of this name
            name += "_"
        return ast.Name(name, node.ctx)

    def visit_IfExp(self, node):
        test = self._test(node.test)
        if isinstance(test, ast.Constant):
            return self.visit(node.body if test.value else node.orelse)
        return ast.IfExp(test, self.visit(node.body), self.visit(node.orelse))

    def visit_BoolOp(self, node):
        settles, left = isinstance(node.op, ast.Or), []
        for value in node.values:
            test = self._test(value)
            if not isinstance(test, ast.Constant):
                left.append(test)
            elif bool(test.value) == settles:
                left.append(test)
                break
        return ast.BoolOp(node.op, left) if left[1:] else (left or [ast.Constant(not settles)])[0]

    def visit_Compare(self, node):
        new = self.generic_visit(node)
        if not isinstance(node.ops[0], ast.Is | ast.IsNot) or isinstance(new, ast.Constant):
            return new
        kind = self._kind(new.left)
        if kind is None and not isinstance(new.left, ast.Constant):
            self._refuse(node, "types do not decide it")
        return ast.Constant(is_none(kind) == isinstance(node.ops[0], ast.Is))

    def visit_Call(self, node):
        name = getattr(node.func, "id", "")
        if name == "tuple" and isinstance(node.args[0], ast.GeneratorExp):
            return self._tuple(node.args[0])
        new = self.generic_visit(node)
        constants = [one.value for one in new.args if isinstance(one, ast.Constant)]
        told = [one.value if isinstance(one, ast.Constant) else self._kind(one) for one in new.args]
        if name == "len" and hasattr(told[0], "types"):
            return ast.Constant(len(told[0].types))
        if name == "range" and len(constants) == len(told) and ast.dump(new) != ast.dump(node):
            return ast.Constant(range(*told))
        if hasattr(function := self.around.get(name), "of_types"):
            if None in told:
                self._refuse(node, "types do not decide it")
            return ast.Constant(function(*told))
        return new

    def _tuple(self, node):
        """Return what tuple(... for k in range(...) if ...) consists of."""
        (loop,) = node.generators
        values = self.visit(loop.iter)
        if not isinstance(values, ast.Constant):
            self._refuse(loop.iter, "types do not decide it")
        chosen = (all(self._test(one).value for one in loop.ifs) for _ in self._each(loop, values))
        return ast.Tuple([self.visit(node.elt) for is_chosen in chosen if is_chosen], ast.Load())


def is_none(kind):
    """Return whether one of numba's types is that of None."""
    return str(kind) == "none"
