"""Compiling by numba.njit and numba.extending alone (docs/compiling.md).

A Compiled function is an overload of its plain function: numba asks for it with the types of each
call, and gets the specialised function. In the globals of this, a Compiled is replaced by its plain
function, and a Primitive by its intrinsic. An entry is a function that calls the overload.
"""

import functools
import inspect
import types

import numba
from numba.extending import intrinsic, overload, typeof_impl

from roughgas.compiling import simd, struct_pointer
from roughgas.compiling.public_cache import CachedEntry, write_entry
from roughgas.compiling.specialiser import LOAD_FIELD, MARK_INLINED

VAR_POSITIONAL = inspect.Parameter.VAR_POSITIONAL
OPTIONS = {"error_model": "numpy"}


@intrinsic
def mark_inlined(context):
    """Have LLVM inline the function that calls this.

    Numba's option `forceinline` would count for callees, too, and each function be compiled once
    for callers with it, and once for those without.
    """

    def generate(context, builder, signature, arguments):
        builder.function.attributes.add("alwaysinline")
        return context.get_dummy_value()

    return numba.types.none(), generate


def _replacement(value):
    """Return the object that numba gets in place of a global of the kernel."""
    if hasattr(value, "is_compiled"):
        return _overloaded(value)
    if hasattr(value, "is_primitive"):
        module = simd if hasattr(simd, value.__name__) else struct_pointer
        return getattr(module, value.__name__)
    return value


@functools.cache
def _overloaded(compiled):
    """Return the plain function of a Compiled, once numba has its overload."""

    @overload(compiled.py_func, jit_options=OPTIONS, strict=False)
    def specialise(*argument_types, **keywords):
        return _specialised(compiled, _by_parameter(compiled.py_func, argument_types, keywords))

    return compiled.py_func


def _by_parameter(function, argument_types, keywords):
    """Return the types of a call's arguments, one for each parameter; *args count as a tuple."""
    signature = inspect.signature(function)
    by_name = signature.bind(*argument_types, **keywords).arguments
    return tuple(
        numba.types.BaseTuple.from_types(by_name[name])
        if parameter.kind is VAR_POSITIONAL
        else by_name[name]
        for name, parameter in signature.parameters.items()
        if name in by_name
    )


@functools.cache
def _specialised(compiled, argument_types):
    """Return a function for arguments of these types, whose globals numba knows."""
    function = compiled.specialise(argument_types, is_public=True)
    namespace, closure = dict(function.__globals__), function.__closure__ or ()
    for name in {*function.__code__.co_names} & {*namespace}:
        namespace[name] = _replacement(namespace[name])
    namespace |= {LOAD_FIELD: struct_pointer.load_field, MARK_INLINED: mark_inlined}
    cells = tuple(types.CellType(_replacement(cell.cell_contents)) for cell in closure)
    return types.FunctionType(
        function.__code__, namespace, function.__name__, function.__defaults__, cells
    )


def dispatcher(compiled):
    """Return numba's dispatcher of a function that calls the overload of a Compiled; a CachedEntry
    if it is cached.

    Raises OSError if it is cached and no folder for compiled code can be written.
    """
    _register(*type(compiled).__mro__[:-1])  # all but object
    parameters = inspect.signature(compiled.py_func).parameters.values()
    names = ", ".join(str(p.replace(annotation=p.empty, default=p.empty)) for p in parameters)
    name = "entry" if compiled.__name__ == "<lambda>" else compiled.__name__
    source = f"def {name}({names}):\n    return overloaded({names})\n"
    path = write_entry(compiled, source) if compiled.is_cached else None
    namespace = {"overloaded": _overloaded(compiled), "__name__": compiled.__module__}
    exec(compile(source, path or "<entry>", "exec"), namespace)
    uncached = numba.njit(**OPTIONS)(namespace[name])
    if path is None:
        return uncached
    cached = numba.njit(cache=True, **OPTIONS)(namespace[name])
    return CachedEntry(cached, uncached, path, compiled.__module__)


def compiled_type(compiled):
    """Return the type that numba gives to a Compiled function where a user's function calls it."""
    entry = compiled.dispatcher
    return numba.typeof(entry.uncached if isinstance(entry, CachedEntry) else entry)


@functools.cache
def _register(*classes):
    """Have numba ask `compiled_type` for the type of objects of these classes."""
    for class_ in classes:
        typeof_impl.register(class_)(lambda compiled, context: compiled_type(compiled))


def primitive_type(primitive):
    """Raise AttributeError: a Primitive is replaced before numba sees it."""
    raise AttributeError(primitive.__name__)
