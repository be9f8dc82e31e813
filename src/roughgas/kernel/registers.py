"""Vector registers as numba's values: imported when compiled code is first called.

A Lanes holds `count` numbers of one kind, one to each lane: a value of one of LLVM's vector types.
LLVM splits what the machine's registers are too narrow for. Operators work lane by lane, with one
operand a scalar if need be; comparisons give lanes of booleans.
"""

import math
import operator

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model


class Lanes(types.Type):
    """The type of `count` values of type `kind`."""

    def __init__(self, kind, count):
        self.kind, self.count = kind, count
        super().__init__(name=f"Lanes({kind} x {count})")


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    def __init__(self, manager, lanes):
        super().__init__(manager, lanes, _vector(manager.lookup(lanes.kind), lanes))


def _vector(model, lanes):
    one = ir.IntType(1) if lanes.kind == types.boolean else model.get_value_type()
    return ir.VectorType(one, lanes.count)


def _register(function, result, generate, number):
    """Teach numba a function of lanes, or of lanes and scalars.

    result: of a Lanes -> the type returned; generate(builder, kind, vectors) -> LLVM's value.
    """

    @infer_global(function)
    class Typing(AbstractTemplate):
        def generic(self, arguments, keywords):
            lanes = next((one for one in arguments if isinstance(one, Lanes)), None)
            if lanes is not None and len(arguments) == number:
                return signature(result(lanes), *arguments)

    def lower(context, builder, signature, arguments):
        lanes = next(one for one in signature.args if isinstance(one, Lanes))
        vectors = [
            spread(context, builder, one, kind, lanes)
            for one, kind in zip(arguments, signature.args, strict=True)
        ]
        return generate(builder, lanes.kind, vectors)

    scalars = (types.Number, types.Boolean)
    if number == 1:
        lower_builtin(function, Lanes)(lower)
        return
    lower_builtin(function, Lanes, Lanes)(lower)
    for scalar in scalars:
        lower_builtin(function, Lanes, scalar)(lower)
        lower_builtin(function, scalar, Lanes)(lower)


def spread(context, builder, value, kind, lanes):
    """Return LLVM's value of a type in every lane; lanes as they are."""
    if isinstance(kind, Lanes):
        return value
    value = context.cast(builder, value, kind, lanes.kind)
    if lanes.kind == types.boolean:
        value = builder.trunc(value, ir.IntType(1)) if value.type.width > 1 else value
    vector = ir.Constant(ir.VectorType(value.type, lanes.count), ir.Undefined)
    vector = builder.insert_element(vector, value, ir.Constant(ir.IntType(32), 0))
    zeros = ir.Constant(ir.VectorType(ir.IntType(32), lanes.count), [0] * lanes.count)
    return builder.shuffle_vector(vector, vector, zeros)


def call(builder, name, vectors):
    """Return what an operation of LLVM's makes of vectors, or of scalars, of one type."""
    kind = vectors[0].type
    function = ir.FunctionType(kind, [kind] * len(vectors))
    if isinstance(kind, ir.VectorType):
        name = f"{name}.v{kind.count}{kind.element.intrinsic_name}"
    else:
        name = f"{name}.{kind.intrinsic_name}"
    return builder.call(cgutils.get_or_insert_function(builder.module, function, name), vectors)


def _same(lanes):
    return lanes


def _truth(lanes):
    return Lanes(types.boolean, lanes.count)


def _compare(sign):
    def generate(builder, kind, vectors):
        if isinstance(kind, types.Float):
            return builder.fcmp_ordered(sign, *vectors)
        return builder.icmp_signed(sign, *vectors)

    return generate


def least_of_two(sign):
    """As numba has it for scalars: the second where it is less (or more), else the first."""

    def generate(builder, kind, vectors):
        first, second = vectors
        return builder.select(_compare(sign)(builder, kind, [second, first]), second, first)

    return generate


for _function, _name in {operator.add: "fadd", operator.sub: "fsub", operator.mul: "fmul"}.items():
    _register(_function, _same, lambda b, kind, v, name=_name: getattr(b, name)(*v), 2)
_register(operator.truediv, _same, lambda b, kind, v: b.fdiv(*v), 2)
_register(operator.neg, _same, lambda b, kind, v: b.fneg(*v), 1)
_register(operator.and_, _same, lambda b, kind, v: b.and_(*v), 2)
_register(operator.or_, _same, lambda b, kind, v: b.or_(*v), 2)
for _function, _sign in {
    operator.lt: "<",
    operator.le: "<=",
    operator.gt: ">",
    operator.ge: ">=",
    operator.eq: "==",
}.items():
    _register(_function, _truth, _compare(_sign), 2)
_register(max, _same, least_of_two(">"), 2)
_register(min, _same, least_of_two("<"), 2)
_register(abs, _same, lambda b, kind, v: call(b, "llvm.fabs", v), 1)
_register(math.sqrt, _same, lambda b, kind, v: call(b, "llvm.sqrt", v), 1)
