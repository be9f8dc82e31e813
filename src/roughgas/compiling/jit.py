"""Decorators of functions that numba compiles, specialised for a scene.

A function of the kernel is plain Python, and runs as such. Before numba compiles it, it is
rewritten for the types of its arguments (compiling/specialiser.py).

IEEE arithmetic throughout, without fast-math: the same seed gives the same bits on every x86-64
machine. Division by zero gives inf or NaN as in numpy, so that no loop carries a check for it.
Numba is imported when the first compiled function is called.
"""

import ast
import functools
import inspect
import sys
import textwrap

from roughgas.compiling.specialiser import LOAD_FIELD, MARK_INLINED, Specialiser


class Compiled:
    """A function that compiled code calls; called from Python, it runs as plain Python.

    is_inner: neither Python nor C calls its machine code; is_inlined: LLVM inlines it; is_cached:
    its machine code is saved on the disk.
    """

    is_compiled = True

    def __init__(self, function, is_inner=False, is_inlined=False, is_cached=False):
        functools.update_wrapper(self, function)
        self.py_func = function
        self.is_inner, self.is_inlined, self.is_cached = is_inner, is_inlined, is_cached
        self.specialised = {}  # types of the arguments -> the definition compiled for them, a node

    def __call__(self, *args):
        return self.py_func(*args)

    @functools.cached_property
    def dispatcher(self):
        """Numba's dispatcher of the function."""
        from roughgas.compiling import compiler

        return compiler.dispatcher(self)

    @property
    def _numba_type_(self):  # numba reads it where compiled code names the function
        from roughgas.compiling import compiler

        return compiler.compiled_type(self)

    def read_source(self):
        """Read the function's source now: its file may be edited before it is compiled."""
        return self._definition

    @functools.cached_property
    def _definition(self):
        lines, first = inspect.getsourcelines(self.py_func)
        (definition,) = ast.parse(textwrap.dedent("".join(lines))).body
        return ast.increment_lineno(definition, first - 1)

    def specialise(self, argument_types, is_public=False):
        """Return the function, rewritten for arguments of these types of numba's.

        A lambda is returned as it is. is_public: for compiling/public_numba.py, by calls of
        LOAD_FIELD and MARK_INLINED.
        """
        function = self.py_func
        if function.__name__ == "<lambda>":
            return function
        nonlocals = inspect.getclosurevars(function).nonlocals
        namespace = BUILTINS | function.__globals__ | nonlocals
        load_field = LOAD_FIELD if is_public else None
        specialiser = Specialiser(self._definition, argument_types, namespace, load_field)
        self.specialised[argument_types] = definition = specialiser.visit(self._definition)
        if is_public and self.is_inlined:
            body = [*ast.parse(f"{MARK_INLINED}()").body, *definition.body]
            definition = ast.copy_location(
                ast.FunctionDef(definition.name, definition.args, body, []), definition
            )
        module = ast.fix_missing_locations(ast.Module([definition], []))
        defined = {}
        exec(compile(module, inspect.getfile(function), "exec"), specialiser.namespace, defined)
        return defined[function.__name__]


class Entry(Compiled):
    """A function whose compiled form Python calls; `py_func` runs as plain Python."""

    def __call__(self, *args):
        return self.dispatcher(*args)


def entry(function=None, *, cache=False):
    """Decorate a function that Python calls; with `cache` its machine code is saved on the disk."""
    if function is None:
        return functools.partial(entry, cache=cache)
    return Entry(function, is_cached=cache)


def specialised_source(name, entry_point, *arguments):
    """Return {module: sources} of all functions of a name, specialised for a call of an entry.

    Empty where no function has this name; without sources where the call does not use it. Only in
    a process that has compiled nothing yet.
    """
    modules = [m for key, m in sorted(sys.modules.items()) if key.startswith("roughgas.")]
    uncached = Entry(entry_point.py_func)
    functions = [f for module in modules for f in vars(module).values() if type(f) is Compiled]
    namesakes = [f for f in (uncached, *functions) if f.__name__ == name]
    if namesakes:
        uncached(*arguments)
    sources = {}
    for function in namesakes:
        unparsed = map(ast.unparse, function.specialised.values())
        sources.setdefault(function.__module__, {}).update(dict.fromkeys(unparsed))  # each once
    return sources


def compiled(function):
    """Decorate a function that only compiled code calls."""
    return Compiled(function, is_inner=True)


def jit(function):
    """Decorate a function that is inlined where compiled code calls it.

    Functions that run once an event are inlined: a call takes longer than many of them do.
    """
    return Compiled(function, is_inner=True, is_inlined=True)


class Primitive:
    """An operation of compiled code, an intrinsic of simd.py or struct_pointer.py by its name, and
    the Python function that the plain kernel runs in its place."""

    is_primitive = True

    def __init__(self, plain, result_type=None):
        functools.update_wrapper(self, plain)
        self.plain = plain
        self.result_type = result_type  # from the type of the argument, if the Specialiser needs it

    def __call__(self, *args):
        return self.plain(*args)

    @property
    def _numba_type_(self):  # numba reads it where compiled code names the operation
        from roughgas.compiling import compiler

        return compiler.primitive_type(self)


def _pointer_type(struct_type):
    from roughgas.compiling.struct_pointer import StructPointer

    return StructPointer(struct_type)


@functools.partial(Primitive, result_type=_pointer_type)
def by_reference(struct):
    """Return a named tuple; compiled code gets a pointer to it (compiling/struct_pointer.py)."""
    return struct


def static(function):
    """Mark a function that is evaluated while compiling; it receives numba types in place of
    values."""
    function.is_static = True
    return function


@static
def is_tuple(x):
    """Return whether x, a value or its type in numba, is a tuple."""
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
