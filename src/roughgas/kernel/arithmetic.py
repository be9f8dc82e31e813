"""a b + c, and when the compiler may round it once instead of twice.

Results are in double precision and rounded step by step, the same on every machine. Single
precision is used by the sieve alone (sweep.py), whose rounding nobody sees: there a product and a
sum become one instruction where the machine has it.
"""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload


def multiply_add(a, b, c):
    """a b + c; in single precision perhaps with one rounding."""
    return a * b + c


@intrinsic
def _fused(context, a, b, c):
    def generate(context, builder, signature, arguments):
        kind = context.get_value_type(signature.return_type)
        function = ir.FunctionType(kind, [kind] * 3)
        intrinsic = builder.module.declare_intrinsic("llvm.fmuladd", (kind,), function)
        return builder.call(intrinsic, arguments)

    return a(a, a, a), generate


@overload(multiply_add)
def _compiled_multiply_add(a, b, c):
    if a == b == c == types.float32:
        return lambda a, b, c: _fused(a, b, c)
    return lambda a, b, c: a * b + c
