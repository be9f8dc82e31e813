"""Named tuples behind a pointer: imported when compiled code is first called.

A State has some two hundred words. Passed by value, each function that gets it would take it apart
and put it together again. A Reference points to a named tuple in memory; what it consists of is
loaded where it is used, and named tuples within it are references, too. Nothing ever writes to this
memory again, and the loads say so (`invariant.load`): no store to an array makes LLVM repeat them.
"""

import hashlib

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, signature
from numba.extending import (
    infer,
    infer_getattr,
    intrinsic,
    lower_builtin,
    lower_getattr_generic,
    models,
    register_model,
)

NAMED = types.NamedTuple, types.NamedUniTuple


class Reference(types.Type):
    """The type of a pointer to a named tuple, which has its fields as attributes and as items."""

    def __init__(self, whole):
        self.fields, self.instance_class = whole.fields, whole.instance_class
        self.types = tuple(
            Reference(kind) if isinstance(kind, NAMED) else kind for kind in whole.types
        )
        # short: it is a part of the name of each function that gets one
        digest = hashlib.sha256(str(whole).encode()).hexdigest()[:16]
        super().__init__(name=f"{whole.instance_class.__name__}@{digest}")


@register_model(Reference)
class ReferenceModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _struct(manager, kind).as_pointer())


def _struct(manager, kind):
    """Return LLVM's type of what a Reference points to; what is None takes a byte."""
    return ir.LiteralStructType(
        _struct(manager, one)
        if isinstance(one, Reference)
        else ir.IntType(8)
        if one == types.none
        else manager.lookup(one).get_value_type()
        for one in kind.types
    )


def _place(builder, pointer, k):
    zero = ir.Constant(ir.IntType(32), 0)
    return builder.gep(pointer, [zero, ir.Constant(ir.IntType(32), k)], inbounds=True)


def _store(builder, kind, whole, pointer):
    for k, one in enumerate(kind.types):
        if isinstance(one, Reference):
            _store(builder, one, builder.extract_value(whole, k), _place(builder, pointer, k))
        elif one != types.none:
            builder.store(builder.extract_value(whole, k), _place(builder, pointer, k))


def _load(builder, kind, pointer, skip=0):
    """Return the value of an LLVM type that is kept behind a pointer, loaded word by word."""
    if not isinstance(kind, ir.Aggregate):
        loaded = builder.load(pointer)
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded
    value = ir.Constant(kind, None)
    kinds = [kind.element] * kind.count if isinstance(kind, ir.ArrayType) else kind.elements
    for k in range(skip, len(kinds)):
        part = _load(builder, kinds[k], _place(builder, pointer, k))
        value = builder.insert_value(value, part, k)
    return value


def _part(context, builder, kind, pointer, k):
    """Return the LLVM value of a field of what a Reference points to."""
    one = kind.types[k]
    if one == types.none:
        return context.get_dummy_value()
    if isinstance(one, Reference):
        return _place(builder, pointer, k)
    skip = 2 if isinstance(one, types.Array) else 0  # whose it is, which nobody asks for
    return _load(builder, context.get_value_type(one), _place(builder, pointer, k), skip)


@infer_getattr
class Attribute(AttributeTemplate):
    key = Reference

    def generic_resolve(self, kind, name):
        return kind.types[kind.fields.index(name)] if name in kind.fields else None


@lower_getattr_generic(Reference)
def _attribute(context, builder, kind, value, name):
    return _part(context, builder, kind, value, kind.fields.index(name))


@infer
class Item(AbstractTemplate):
    key = "static_getitem"

    def generic(self, arguments, keywords):
        kind, k = arguments
        if isinstance(kind, Reference) and isinstance(k, int):
            return signature(kind.types[k], *arguments)
        return None


@lower_builtin("static_getitem", Reference, types.IntegerLiteral)
def _item(context, builder, signature, arguments):
    return _part(context, builder, signature.args[0], arguments[0], arguments[1])


@intrinsic
def by_reference(context, whole):
    """Return a Reference to a named tuple that is put into memory."""
    kind = Reference(whole)

    def generate(context, builder, signature, arguments):
        memory = cgutils.alloca_once(builder, context.get_value_type(kind).pointee)
        _store(builder, kind, arguments[0], memory)
        # LLVM must not know that it is this memory: an invariant load may be moved before the store
        same = ir.FunctionType(memory.type, [memory.type])
        hidden = ir.InlineAsm(same, "", "=r,0,~{memory}", side_effect=True)
        return builder.call(hidden, [memory])

    return kind(whole), generate
