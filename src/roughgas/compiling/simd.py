"""Vector registers as numba's values, and what is done to them: lanes.py has all of it in plain
Python. Imported when compiled code is first called.

A Lanes holds `count` numbers of one kind, one to each lane: a value of one of LLVM's vector types,
which LLVM splits where the machine's registers are narrower. Operators work on floats, lane by
lane, with one operand a scalar if need be; comparisons give lanes of booleans.
"""

import inspect
import itertools
import operator
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

BIT, NUMBER, WORD = ir.IntType(1), ir.IntType(32), ir.IntType(64)
# of a register: of AVX-512, or else of AVX
BYTES = 64 if "+avx512f" in cpu_target.target_context.codegen().magic_tuple()[2] else 32


class Lanes(types.Type):
    """The type of `count` values of type `kind`."""

    def __init__(self, kind, count):
        self.kind, self.count = kind, count
        super().__init__(name=f"Lanes({kind} x {count})")


@register_model(Lanes)
def _model(manager, lanes):
    one = manager.lookup(lanes.kind).get_value_type()
    return models.PrimitiveModel(manager, lanes, ir.VectorType(one, lanes.count))


# ------------------------------------------------------------------ operations


class Site(NamedTuple):
    """Where an operation becomes instructions."""

    context: Any
    builder: ir.IRBuilder
    kinds: tuple  # of the arguments, numba's types
    result: types.Type

    def pointer(self, value, indices, vector=None):
        """Return where an item of the first argument is, or where a vector of items begins."""
        array = self.kinds[0]
        made = self.context.make_array(array)(self.context, self.builder, value)
        place = cgutils.get_item_pointer(self.context, self.builder, array, made, indices)
        return place if vector is None else self.builder.bitcast(place, vector.as_pointer())

    def joined(self, values):
        """Return numbers as lanes."""
        vector = ir.Constant(ir.VectorType(values[0].type, len(values)), ir.Undefined)
        for k, value in enumerate(values):
            vector = self.builder.insert_element(vector, value, NUMBER(k))
        return vector

    def call(self, name, result, *values, **more):
        """Return what one of LLVM's functions makes of values, named by the type of the first."""
        kind = values[0].type
        one, count = (kind.element, f"v{kind.count}") if hasattr(kind, "count") else (kind, "")
        name = f"{name}.{count}{one.intrinsic_name}"
        kind = ir.FunctionType(result, [value.type for value in values])
        function = cgutils.get_or_insert_function(self.builder.module, kind, name)
        return self.builder.call(function, values, **more)

    def spread(self, value, kind):
        """Return a number in every lane where an argument is lanes; lanes as they are."""
        if isinstance(kind, Lanes):
            return value
        whole = _lane_by_lane(*self.kinds)
        value = self.context.cast(self.builder, value, kind, getattr(whole, "kind", whole))
        return self.joined([value] * whole.count) if isinstance(whole, Lanes) else value


def operation(result):
    """Decorate generate(site, *values) -> LLVM's value: an operation of compiled code.

    result: of the arguments' types, literal ones where a number is known -> the type returned.
    """

    def decorate(generate):
        def define(context, *kinds):
            returned = result(*kinds)
            passed = [types.intp if type(one) is types.Integer else one for one in kinds]

            def lower(context, builder, signature, values):
                site = Site(context, builder, signature.args, returned)
                if result is _lane_by_lane:
                    values = map(site.spread, values, site.kinds)
                return generate(site, *values)

            return returned(*passed), lower

        define.__name__, define.__signature__ = generate.__name__, inspect.signature(generate)
        return intrinsic(prefer_literal=True)(define)

    return decorate


def define_operator(function, result, generate):
    """Have numba compile one of Python's operators for lanes.

    result, generate: as of an operation.
    """

    def type_of(*kinds):
        return result(*kinds) if any(isinstance(kind, Lanes) for kind in kinds) else None

    def lower(context, builder, signature, values):
        site = Site(context, builder, signature.args, signature.return_type)
        return generate(site, *map(site.spread, values, site.kinds))

    arity = len(inspect.signature(function).parameters)
    type_of_operands = {1: lambda x: type_of(x), 2: lambda x, y: type_of(x, y)}[arity]
    type_callable(function)(lambda context: type_of_operands)
    for kinds in itertools.product((Lanes, types.Any), repeat=arity):
        if Lanes in kinds:
            lower_builtin(function, *kinds)(lower)


def _lane_by_lane(*kinds):
    """Return the type of what is done lane by lane, to numbers if there are no lanes."""
    lanes = [one for one in kinds if isinstance(one, Lanes)]
    return lanes[-1] if lanes else max(kinds, key=lambda kind: kind.bitwidth)


def _truth(*kinds):
    return Lanes(types.boolean, _lane_by_lane(*kinds).count)


def _numbers(values, kind=NUMBER):
    return ir.VectorType(kind, len(values))(list(values))


# ------------------------------------------------------------------ lane by lane

ARITHMETIC = {"add": "fadd", "sub": "fsub", "mul": "fmul", "truediv": "fdiv", "neg": "fneg"}
LOGIC = {"and_": "and_", "or_": "or_"}
COMPARED = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "=="}


def _instruction(name, *sign):
    return lambda site, *values: getattr(site.builder, name)(*sign, *values)


for _name, _of_llvm in (ARITHMETIC | LOGIC).items():
    define_operator(getattr(operator, _name), _lane_by_lane, _instruction(_of_llvm))
for _name, _sign in COMPARED.items():
    define_operator(getattr(operator, _name), _truth, _instruction("fcmp_ordered", _sign))
define_operator(abs, _lane_by_lane, lambda site, x: site.call("llvm.fabs", x.type, x))

lane_by_lane = operation(_lane_by_lane)
root = lane_by_lane(lambda site, x: site.call("llvm.sqrt", x.type, x))
select = lane_by_lane(lambda site, condition, a, b: site.builder.select(condition, a, b))


@lane_by_lane
def multiply_add(site, a, b, c):
    if getattr(a.type, "element", a.type) == ir.FloatType():
        return site.call("llvm.fmuladd", a.type, a, b, c)
    return site.builder.fadd(site.builder.fmul(a, b), c)


# ------------------------------------------------------------------ memory


@operation(lambda array, row, first, count: Lanes(array.dtype, count.literal_value))
def load(site, array, row, first, count):
    pointer = site.pointer(array, [row, first], site.context.get_value_type(site.result))
    return site.builder.load(pointer, align=site.result.kind.bitwidth // 8)


class WholeStore(ir.instructions.StoreInstr):
    """A store of all lanes, where LLVM would store only those that have changed: a load of all of
    them that follows soon would have to wait for that."""

    def descr(self, text):
        super().descr(text)
        text.append(text.pop().replace("store", "store volatile", 1))


@operation(lambda array, row, first, lanes: types.none)
def store(site, array, row, first, lanes):
    pointer = site.pointer(array, [row, first], lanes.type)
    instruction = WholeStore(site.builder.block, lanes, pointer)
    instruction.align = site.kinds[3].kind.bitwidth // 8
    site.builder._insert(instruction)
    return site.context.get_dummy_value()


@operation(lambda places, first, count: Lanes(places.dtype, count.literal_value))
def numbers_in(site, places, first, count):
    here = [site.builder.add(first, WORD(k)) for k in range(site.result.count)]
    return site.joined([site.builder.load(site.pointer(places, [place])) for place in here])


def _wide(kind):
    return types.float64 if kind == types.float32 else kind


@operation(lambda array, column, numbers: Lanes(_wide(array.dtype), numbers.count))
def gather(site, array, column, numbers):
    kind, values = site.kinds[0], []
    for k in range(site.result.count):
        row = site.builder.zext(site.builder.extract_element(numbers, NUMBER(k)), WORD)
        value = site.builder.load(site.pointer(array, [row, column][: kind.ndim]))
        values.append(site.context.cast(site.builder, value, kind.dtype, site.result.kind))
    return site.joined(values)


@operation(lambda array, row: types.none)
def prefetch(site, array, row):
    pointer = site.pointer(array, [row, WORD(0)][: site.kinds[0].ndim], ir.IntType(8))
    site.call("llvm.prefetch", ir.VoidType(), pointer, NUMBER(0), NUMBER(3), NUMBER(1))
    return site.context.get_dummy_value()


least = operation(lambda lanes: lanes.kind)(
    lambda site, x: site.call("llvm.vector.reduce.fmin", x.type.element, x, fastmath=("nnan",))
)
bits = operation(lambda lanes: types.uint64)(
    lambda site, x: site.builder.zext(site.builder.bitcast(x, ir.IntType(x.type.count)), WORD)
)
order = operation(lambda count: Lanes(types.float64, count.literal_value))(
    lambda site, count: _numbers(range(site.result.count), ir.DoubleType())
)
trailing_zeros = operation(lambda word: types.intp)(lambda site, x: site.builder.cttz(x, BIT(0)))


@operation(lambda x: types.intp)
def integer(site, x):
    return site.context.cast(site.builder, x, site.kinds[0], site.result)


@operation(lambda number: types.intp)
def index(site, number):
    site.builder.assume(site.builder.icmp_signed(">=", number, number.type(0)))
    return number


@operation(lambda places, number, lanes, first: types.intp)
def append(site, places, number, mask, first):
    """What lies beyond the places that are taken is spoiled; and there is no branch in it, which
    the processor could not foresee."""
    builder, count = site.builder, mask.type.count
    word = builder.zext(builder.bitcast(mask, ir.IntType(count)), WORD)
    base = site.joined([builder.trunc(first, NUMBER)] * count)
    numbers = builder.add(base, _packed(site, mask, word))
    builder.store(numbers, site.pointer(places, [number], numbers.type), align=4)
    return builder.add(number, builder.ctpop(word))


def _packed(site, mask, word):
    """Return which lanes hold, in the first lanes: of 16 by an instruction, of 8 from a table."""
    kind = ir.VectorType(NUMBER, mask.type.count)
    if mask.type.count == 16:
        name = "llvm.x86.avx512.mask.compress"
        return site.call(name, kind, _numbers(range(16)), ir.Constant(kind, None), mask)
    rows = [[k for k in range(8) if byte >> k & 1] for byte in range(256)]
    rows = [_numbers(one + [0] * (8 - len(one)), ir.IntType(8)) for one in rows]
    table = ir.Constant(ir.ArrayType(rows[0].type, 256), rows)
    table = cgutils.global_constant(site.builder, "roughgas.bits_set", table)
    row = site.builder.load(site.builder.gep(table, [WORD(0), word]), align=8)
    return site.builder.zext(row, kind)
