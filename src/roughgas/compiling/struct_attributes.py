"""Fields of a StructPointer as attributes and as items, by templates that are private to numba.

Faster to compile than calls of struct_pointer.load_field, which need none.
"""

from numba import types
from numba.core.typing.templates import AbstractTemplate, AttributeTemplate, signature
from numba.extending import infer, infer_getattr, lower_builtin, lower_getattr_generic

from roughgas.compiling.struct_pointer import StructPointer, field_value


@infer_getattr
class Attribute(AttributeTemplate):
    """The type of a field, by its name."""

    key = StructPointer

    def generic_resolve(self, pointer_type, name):
        fields = pointer_type.fields
        return pointer_type.types[fields.index(name)] if name in fields else None


@lower_getattr_generic(StructPointer)
def _attribute(context, builder, pointer_type, pointer, name):
    return field_value(context, builder, pointer_type, pointer, pointer_type.fields.index(name))


@infer
class Item(AbstractTemplate):
    """The type of a field, by its constant index."""

    key = "static_getitem"

    def generic(self, arguments, keywords):
        pointer_type, k = arguments
        if isinstance(pointer_type, StructPointer) and isinstance(k, int):
            return signature(pointer_type.types[k], *arguments)
        return None


@lower_builtin("static_getitem", StructPointer, types.IntegerLiteral)
def _item(context, builder, signature, arguments):
    return field_value(context, builder, signature.args[0], arguments[0], arguments[1])
