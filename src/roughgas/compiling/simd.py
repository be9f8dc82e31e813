"""Vector registers as numba's values, and the operations on them; mathematics.py has both in plain
Python. Imported when compiled code is first called.

A Lanes holds `count` numbers of one kind, one to each lane: a value of one of LLVM's vector types.
LLVM splits what the machine's registers are too narrow for. Operators work lane by lane, with one
operand a scalar if need be; comparisons give lanes of booleans.
"""

import inspect
import operator
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

BIT, NUMBER, WORD = ir.IntType(1), ir.IntType(32), ir.IntType(64)


class Lanes(types.Type):
    """The type of `count` values of type `kind`."""

    def __init__(self, kind, count):
        self.kind, self.count = kind, count
        super().__init__(name=f"Lanes({kind} x {count})")


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    def __init__(self, manager, lanes):
        is_truth = lanes.kind == types.boolean
        one = BIT if is_truth else manager.lookup(lanes.kind).get_value_type()
        super().__init__(manager, lanes, ir.VectorType(one, lanes.count))


class Site(NamedTuple):
    """Where an operation becomes instructions."""

    context: Any
    builder: ir.IRBuilder
    kinds: tuple  # of the arguments, numba's types
    result: types.Type

    def pointer(self, array, value, indices, vector=None):
        """Return where an item of an array is, or where a vector of items begins."""
        made = self.context.make_array(array)(self.context, self.builder, value)
        place = cgutils.get_item_pointer(
            self.context, self.builder, array, made, indices, wraparound=False
        )
        return place if vector is None else self.builder.bitcast(place, vector.as_pointer())

    def spread(self, value, kind):
        """Return a number as the result has it, in every lane of lanes; lanes as they are."""
        if isinstance(kind, Lanes):
            return value
        if not isinstance(self.result, Lanes):
            return self.context.cast(self.builder, value, kind, self.result)
        value = self.context.cast(self.builder, value, kind, self.result.kind)
        vector = ir.Constant(ir.VectorType(value.type, self.result.count), ir.Undefined)
        vector = self.builder.insert_element(vector, value, NUMBER(0))
        return self.builder.shuffle_vector(vector, vector, _numbers([0] * self.result.count))

    def joined(self, values):
        """Return numbers as lanes."""
        vector = ir.Constant(self.context.get_value_type(self.result), ir.Undefined)
        for k, value in enumerate(values):
            vector = self.builder.insert_element(vector, value, NUMBER(k))
        return vector

    def call(self, name, result, *arguments, **more):
        """Return what one of LLVM's functions makes of values, named by the type of the first."""
        kind = arguments[0].type
        one = kind.element if isinstance(kind, ir.VectorType) else kind
        count = f"v{kind.count}" if kind != one else ""
        name = f"{name}.{count}{one.intrinsic_name}"
        kind = ir.FunctionType(result, [one.type for one in arguments])
        function = cgutils.get_or_insert_function(self.builder.module, kind, name)
        return self.builder.call(function, arguments, **more)


def _numbers(values, kind=NUMBER):
    return ir.VectorType(kind, len(values))(list(values))


def _lanes_among(kinds):
    return next((one for one in kinds if isinstance(one, Lanes)), None)


# ------------------------------------------------------------------ operators


def _operator(function, generate, is_comparison=False):
    """Teach numba an operator of lanes, or of lanes and a scalar; generate(site, *vectors)."""

    @infer_global(function)
    class Typing(AbstractTemplate):
        def generic(self, arguments, keywords):
            lanes = _lanes_among(arguments)
            if lanes is None:
                return None
            truth = Lanes(types.boolean, lanes.count)
            return signature(truth if is_comparison else lanes, *arguments)

    def lower(context, builder, signature, arguments):
        kinds = signature.args
        site = Site(context, builder, kinds, _lanes_among(kinds))
        return generate(site, *map(site.spread, arguments, kinds))

    for kinds in ((Lanes,), (Lanes, Lanes), (Lanes, types.Number), (types.Number, Lanes)):
        lower_builtin(function, *kinds)(lower)


def _instruction(of_floats, of_integers, *sign):
    def generate(site, *values):
        is_float = isinstance(getattr(site.result, "kind", site.result), types.Float)
        return getattr(site.builder, of_floats if is_float else of_integers)(*sign, *values)

    return generate


def _compare(sign):
    return _instruction("fcmp_ordered", "icmp_signed", sign)


_operator(operator.add, _instruction("fadd", "add"))
_operator(operator.sub, _instruction("fsub", "sub"))
_operator(operator.mul, _instruction("fmul", "mul"))
_operator(operator.truediv, _instruction("fdiv", ""))
_operator(operator.neg, _instruction("fneg", "neg"))
_operator(operator.and_, _instruction("", "and_"))
_operator(operator.or_, _instruction("", "or_"))
_operator(abs, lambda site, vector: site.call("llvm.fabs", vector.type, vector))
for _name, _sign in {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "=="}.items():
    _operator(getattr(operator, _name), _compare(_sign), is_comparison=True)

# ------------------------------------------------------------------ operations


def operation(result):
    """Decorate generate(site, *values) -> LLVM's value, an operation of compiled code.

    result: of the arguments' types, literal ones where a number is known -> the type returned.
    """

    def decorate(generate):
        def define(context, *kinds):
            returned = result(*kinds)
            passed = [types.intp if type(one) is types.Integer else one for one in kinds]

            def lower(context, builder, signature, values):
                site = Site(context, builder, signature.args, returned)
                if result is _last_lanes:
                    values = map(site.spread, values, site.kinds)
                return generate(site, *values)

            return returned(*passed), lower

        define.__name__, define.__signature__ = generate.__name__, inspect.signature(generate)
        return intrinsic(prefer_literal=True)(define)

    return decorate


def _last_lanes(*kinds):
    """Return the type of what is done lane by lane, to numbers if there are no lanes."""
    return _lanes_among(kinds[::-1]) or max(kinds, key=lambda kind: kind.bitwidth)


def _number(*kinds):
    return types.intp


def register_bytes():
    """Return how many bytes a vector register has: of AVX-512, or else of AVX."""
    return 64 if "+avx512f" in cpu_target.target_context.codegen().magic_tuple()[2] else 32


def _side_by_side(kind, count, width=None):
    """Return as many lanes as are asked for; REGISTER is as many as a vector register has."""
    return Lanes(kind, count.literal_value or register_bytes() * 8 // (width or kind.bitwidth))


def _wide(kind):
    return types.float64 if kind == types.float32 else kind


@operation(lambda array, row, first, count: _side_by_side(array.dtype, count))
def load(site, array, row, first, count):
    vector = site.context.get_value_type(site.result)
    pointer = site.pointer(site.kinds[0], array, [row, first], vector)
    return site.builder.load(pointer, align=site.result.kind.bitwidth // 8)


class WholeStore(ir.instructions.StoreInstr):
    """A store of all lanes, where LLVM would store only those that have changed: a load of all of
    them that follows soon would have to wait for that."""

    def descr(self, text):
        super().descr(text)
        text.append(text.pop().replace("store", "store volatile", 1))


@operation(lambda array, row, first, lanes: types.none)
def store(site, array, row, first, lanes):
    pointer = site.pointer(site.kinds[0], array, [row, first], lanes.type)
    instruction = WholeStore(site.builder.block, lanes, pointer)
    instruction.align = site.kinds[3].kind.bitwidth // 8
    site.builder._insert(instruction)
    return site.context.get_dummy_value()


@operation(lambda places, first, count: _side_by_side(types.int32, count, 64))
def numbers_in(site, places, first, count):
    here = [site.builder.add(first, first.type(k)) for k in range(site.result.count)]
    pointers = [site.pointer(site.kinds[0], places, [place]) for place in here]
    return site.joined(map(site.builder.load, pointers))


@operation(lambda array, column, numbers: Lanes(_wide(array.dtype), numbers.count))
def gather(site, array, column, numbers):
    kind, values = site.kinds[0], []
    for k in range(site.result.count):
        row = site.builder.zext(site.builder.extract_element(numbers, NUMBER(k)), WORD)
        value = site.builder.load(site.pointer(kind, array, [row, column][: kind.ndim]))
        values.append(site.context.cast(site.builder, value, kind.dtype, site.result.kind))
    return site.joined(values)


lane_by_lane = operation(_last_lanes)
select = lane_by_lane(lambda site, condition, a, b: site.builder.select(condition, a, b))
larger = lane_by_lane(lambda site, a, b: site.builder.select(_compare(">")(site, b, a), b, a))
smaller = lane_by_lane(lambda site, a, b: site.builder.select(_compare("<")(site, b, a), b, a))
root = lane_by_lane(lambda site, x: site.call("llvm.sqrt", x.type, x))
trailing_zeros = operation(_number)(lambda site, word: site.builder.cttz(word, BIT(0)))


@lane_by_lane
def multiply_add(site, a, b, c):
    if getattr(site.result, "kind", site.result) == types.float32:
        return site.call("llvm.fmuladd", a.type, a, b, c)
    return site.builder.fadd(site.builder.fmul(a, b), c)


@operation(lambda lanes: lanes.kind)
def least(site, value):
    builder, count = site.builder, value.type.count
    step = count
    while step > 1:  # a power of two
        step //= 2
        other = builder.shuffle_vector(value, value, _numbers([k ^ step for k in range(count)]))
        value = builder.select(builder.fcmp_ordered("<", other, value), other, value)
    return builder.extract_element(value, NUMBER(0))


@operation(lambda lanes: types.uint64)
def bits(site, lanes):
    return site.builder.zext(site.builder.bitcast(lanes, ir.IntType(lanes.type.count)), WORD)


@operation(lambda count: _side_by_side(types.intp, count))
def order(site, count):
    return _numbers(range(site.result.count), WORD)


@operation(_number)
def lanes_of(site, array):
    return WORD(register_bytes() * 8 // site.kinds[0].dtype.bitwidth)


@operation(_number)
def index(site, number):
    site.builder.assume(site.builder.icmp_signed(">=", number, number.type(0)))
    return number


@operation(lambda array, row: types.none)
def prefetch(site, array, row):
    indices = [row, WORD(0)][: site.kinds[0].ndim]
    pointer = site.pointer(site.kinds[0], array, indices, ir.IntType(8))
    read, near, data = NUMBER(0), NUMBER(3), NUMBER(1)
    site.call("llvm.prefetch", ir.VoidType(), pointer, read, near, data)
    return site.context.get_dummy_value()


@operation(lambda places, number, lanes, first: types.intp)
def append(site, places, number, mask, first):
    """What lies beyond the places that are taken is spoiled; and there is no branch in it, which
    the processor could not foresee."""
    builder, lanes = site.builder, mask.type.count
    step = 16 if register_bytes() == 64 and lanes == 16 else 8
    for k in range(0, lanes, step):
        part = _numbers(range(k, k + step))
        some = builder.shuffle_vector(mask, mask, part) if step < lanes else mask
        word = builder.zext(builder.bitcast(some, ir.IntType(step)), WORD)
        packed = site._replace(result=Lanes(types.int32, step))
        base = packed.spread(builder.add(first, first.type(k)), types.intp)
        numbers = _packed(site, some, word, base)
        pointer = site.pointer(site.kinds[0], places, [number], numbers.type)
        builder.store(numbers, pointer, align=4)
        number = builder.add(number, builder.ctpop(word))
    return number


def _packed(site, mask, word, base):
    """Return the numbers of the lanes that hold, in the first lanes, plus `base`: by an
    instruction, or from a table of which bits are set in each byte."""
    builder, kind = site.builder, base.type
    if kind.count == 16:
        compress = ir.FunctionType(kind, [kind, kind, mask.type])
        name = "llvm.x86.avx512.mask.compress.v16i32"
        function = cgutils.get_or_insert_function(builder.module, compress, name)
        numbers = builder.add(base, _numbers(range(16)))
        return builder.call(function, [numbers, ir.Constant(kind, None), mask])
    rows = [[k for k in range(8) if byte >> k & 1] for byte in range(256)]
    rows = [_numbers(one + [0] * (8 - len(one)), ir.IntType(8)) for one in rows]
    table = ir.Constant(ir.ArrayType(rows[0].type, 256), rows)
    table = cgutils.global_constant(builder, "roughgas.bits_set", table)
    place = builder.gep(table, [WORD(0), word])
    return builder.add(base, builder.zext(builder.load(place, align=8), kind))
