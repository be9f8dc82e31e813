"""Named tuples behind a pointer: imported when compiled code is first called.

A State has some two hundred words. Passed by value, each function that gets it would take it apart
and put it together again. A StructPointer points to a named tuple in memory; its fields are
loaded at each use, and named tuples within it are StructPointers, too. Nothing ever writes to this
memory again, and the loads say so (`invariant.load`): no store to an array makes LLVM repeat them.
"""

import hashlib

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, models, register_model

NAMED_TUPLES = types.NamedTuple, types.NamedUniTuple


class StructPointer(types.Type):
    """The type of a pointer to a named tuple, which has its fields as attributes and as items."""

    is_struct_pointer = True

    def __init__(self, struct_type):
        self.fields, self.instance_class = struct_type.fields, struct_type.instance_class
        self.types = tuple(
            StructPointer(field) if isinstance(field, NAMED_TUPLES) else field
            for field in struct_type.types
        )
        # short: the names of all functions that get one contain it
        digest = hashlib.sha256(str(struct_type).encode()).hexdigest()[:16]
        super().__init__(name=f"{self.instance_class.__name__}@{digest}")


@register_model(StructPointer)
class StructPointerModel(models.PrimitiveModel):
    """LLVM's type of a StructPointer."""

    def __init__(self, manager, pointer_type):
        super().__init__(manager, pointer_type, _llvm_struct(manager, pointer_type).as_pointer())


def _llvm_struct(manager, pointer_type):
    """Return LLVM's type of the memory behind a StructPointer; a None takes a byte."""
    return ir.LiteralStructType(
        _llvm_struct(manager, field)
        if isinstance(field, StructPointer)
        else ir.IntType(8)
        if field == types.none
        else manager.lookup(field).get_value_type()
        for field in pointer_type.types
    )


def _field_pointer(builder, pointer, k):
    zero = ir.Constant(ir.IntType(32), 0)
    return builder.gep(pointer, [zero, ir.Constant(ir.IntType(32), k)], inbounds=True)


def _store_fields(builder, pointer_type, struct, pointer):
    for k, field in enumerate(pointer_type.types):
        if field == types.none:
            continue
        value, destination = builder.extract_value(struct, k), _field_pointer(builder, pointer, k)
        if isinstance(field, StructPointer):
            _store_fields(builder, field, value, destination)
        else:
            builder.store(value, destination)


def _load_words(builder, llvm_type, pointer, skip=0):
    """Return the value of an LLVM type behind a pointer, loaded word by word; the first `skip`
    members of an aggregate are zero instead."""
    if not isinstance(llvm_type, ir.Aggregate):
        loaded = builder.load(pointer)
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded
    value = ir.Constant(llvm_type, None)
    is_array = isinstance(llvm_type, ir.ArrayType)
    members = [llvm_type.element] * llvm_type.count if is_array else llvm_type.elements
    for k in range(skip, len(members)):
        member = _load_words(builder, members[k], _field_pointer(builder, pointer, k))
        value = builder.insert_value(value, member, k)
    return value


def field_value(context, builder, pointer_type, pointer, k):
    """Return the LLVM value of field k of the named tuple behind a StructPointer."""
    field = pointer_type.types[k]
    if field == types.none:
        return context.get_dummy_value()
    if isinstance(field, StructPointer):
        return _field_pointer(builder, pointer, k)
    skip = 2 if isinstance(field, types.Array) else 0  # its owners, which nothing uses
    llvm_type = context.get_value_type(field)
    return _load_words(builder, llvm_type, _field_pointer(builder, pointer, k), skip)


@intrinsic(prefer_literal=True)
def load_field(context, struct, k):
    """Return field k, a constant, of the named tuple behind a StructPointer."""

    def generate(context, builder, signature, arguments):
        return field_value(context, builder, struct, arguments[0], k.literal_value)

    # k by its literal type: numba looks up the instructions by the types of the arguments
    return struct.types[k.literal_value](struct, k), generate


@intrinsic
def by_reference(context, struct):
    """Return a StructPointer to a named tuple, which is copied to the stack."""
    pointer_type = StructPointer(struct)

    def generate(context, builder, signature, arguments):
        with builder.goto_entry_block():
            memory = builder.alloca(context.get_value_type(pointer_type).pointee)
        _store_fields(builder, pointer_type, arguments[0], memory)
        # LLVM must not know that it is this memory: an invariant load may be moved before the store
        identity = ir.FunctionType(memory.type, [memory.type])
        hidden = ir.InlineAsm(identity, "", "=r,0,~{memory}", side_effect=True)
        return builder.call(hidden, [memory])

    return pointer_type(struct), generate
