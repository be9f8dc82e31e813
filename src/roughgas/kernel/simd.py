"""Vector registers as numba's values, and the operations on them; mathematics.py has both in plain
Python. Imported when compiled code is first called.

A Lanes holds `count` numbers of one kind, one to each lane: a value of one of LLVM's vector types.
LLVM splits what the machine's registers are too narrow for. Operators work lane by lane, with one
operand a scalar if need be; comparisons give lanes of booleans.
"""

import inspect
import math
import operator
from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

WORD = ir.IntType(64)
root, larger, smaller = math.sqrt, max, min  # of lanes, too


class Lanes(types.Type):
    """The type of `count` values of type `kind`."""

    def __init__(self, kind, count):
        self.kind, self.count = kind, count
        super().__init__(name=f"Lanes({kind} x {count})")


@register_model(Lanes)
class LanesModel(models.PrimitiveModel):
    def __init__(self, manager, lanes):
        is_truth = lanes.kind == types.boolean
        one = ir.IntType(1) if is_truth else manager.lookup(lanes.kind).get_value_type()
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

    def alike(self, values, kinds, whole):
        """Return values with scalars in every lane, if the whole is lanes."""
        pairs = zip(values, kinds, strict=True)
        return [self.spread(value, kind, whole) for value, kind in pairs]

    def spread(self, value, kind, lanes):
        """Return a value in every lane; lanes as they are."""
        if isinstance(kind, Lanes) or not isinstance(lanes, Lanes):
            return value
        value = self.context.cast(self.builder, value, kind, lanes.kind)
        if lanes.kind == types.boolean and value.type.width > 1:
            value = self.builder.trunc(value, ir.IntType(1))
        vector = ir.Constant(ir.VectorType(value.type, lanes.count), ir.Undefined)
        vector = self.builder.insert_element(vector, value, ir.Constant(ir.IntType(32), 0))
        return self.builder.shuffle_vector(vector, vector, _numbers([0] * lanes.count))

    def joined(self, first, value_at):
        """Return lanes of the values at the places first, first + 1, ..."""
        vector = ir.Constant(self.context.get_value_type(self.result), ir.Undefined)
        for k in range(self.result.count):
            value = value_at(self.builder.add(first, ir.Constant(first.type, k)))
            vector = self.builder.insert_element(vector, value, ir.Constant(ir.IntType(32), k))
        return vector

    def call(self, name, result, arguments):
        """Return what one of LLVM's own functions returns."""
        kind = ir.FunctionType(result, [one.type for one in arguments])
        function = cgutils.get_or_insert_function(self.builder.module, kind, name)
        return self.builder.call(function, arguments)

    def elementary(self, name, *arguments):
        """Return what one of LLVM's operations makes of values of one type, lane by lane."""
        kind = arguments[0].type
        if isinstance(kind, ir.VectorType):
            name = f"{name}.v{kind.count}{kind.element.intrinsic_name}"
        else:
            name = f"{name}.{kind.intrinsic_name}"
        return self.call(name, kind, arguments)


def _numbers(values):
    values = list(values)
    return ir.Constant(ir.VectorType(ir.IntType(32), len(values)), values)


# ------------------------------------------------------------------ operators


def _lanes_among(kinds):
    return next((one for one in kinds if isinstance(one, Lanes)), None)


def _same(lanes):
    return lanes


def _truth(lanes):
    return Lanes(types.boolean, lanes.count)


def _register(function, result, generate, number):
    """Teach numba a function of lanes, or of lanes and a scalar.

    result: of a Lanes -> the type returned; generate(site, *vectors) -> LLVM's value.
    """

    @infer_global(function)
    class Typing(AbstractTemplate):
        def generic(self, arguments, keywords):
            lanes = _lanes_among(arguments)
            if lanes is not None and len(arguments) == number:
                return signature(result(lanes), *arguments)

    def lower(context, builder, signature, arguments):
        lanes = _lanes_among(signature.args)
        site = Site(context, builder, signature.args, lanes)
        return generate(site, *site.alike(arguments, signature.args, lanes))

    lower_builtin(function, *[Lanes] * number)(lower)
    if number == 2:
        for scalar in (types.Number, types.Boolean):
            lower_builtin(function, Lanes, scalar)(lower)
            lower_builtin(function, scalar, Lanes)(lower)


def _instruction(name):
    return lambda site, *vectors: getattr(site.builder, name)(*vectors)


def _compare(sign):
    def generate(site, one, other):
        if isinstance(site.result.kind, types.Float):
            return site.builder.fcmp_ordered(sign, one, other)
        return site.builder.icmp_signed(sign, one, other)

    return generate


def _of_two(sign):
    """As numba has it for scalars: the second where it is less (or more), else the first."""
    return lambda site, one, other: site.builder.select(
        _compare(sign)(site, other, one), other, one
    )


for _name, _made in {"add": "fadd", "sub": "fsub", "mul": "fmul", "truediv": "fdiv"}.items():
    _register(getattr(operator, _name), _same, _instruction(_made), 2)
for _name, _made in {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "=="}.items():
    _register(getattr(operator, _name), _truth, _compare(_made), 2)
_register(operator.and_, _same, _instruction("and_"), 2)
_register(operator.or_, _same, _instruction("or_"), 2)
_register(operator.neg, _same, _instruction("fneg"), 1)
_register(max, _same, _of_two(">"), 2)
_register(min, _same, _of_two("<"), 2)
_register(abs, _same, lambda site, vector: site.elementary("llvm.fabs", vector), 1)
_register(math.sqrt, _same, lambda site, vector: site.elementary("llvm.sqrt", vector), 1)

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
                return generate(Site(context, builder, signature.args, returned), *values)

            return returned(*passed), lower

        define.__name__, define.__signature__ = generate.__name__, inspect.signature(generate)
        return intrinsic(prefer_literal=True)(define)

    return decorate


def register_bytes():
    """Return how many bytes a vector register has: of AVX-512, or else of AVX."""
    return 64 if "+avx512f" in cpu_target.target_context.codegen().magic_tuple()[2] else 32


def _side_by_side(kind, count, width=None):
    """Return as many lanes as are asked for; REGISTER is as many as a vector register has."""
    return Lanes(kind, count.literal_value or register_bytes() * 8 // (width or kind.bitwidth))


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


def _widened(kind):
    return types.float64 if kind == types.float32 else kind


@operation(lambda array, j, places, k, count: _side_by_side(_widened(array.dtype), count, 64))
def gather(site, array, column, places, first, count):
    kind = site.kinds[0]

    def value_at(k):
        place = site.builder.load(site.pointer(site.kinds[2], places, [k]))
        indices = [site.builder.zext(place, WORD), column][: kind.ndim]
        value = site.builder.load(site.pointer(kind, array, indices))
        return site.context.cast(site.builder, value, kind.dtype, site.result.kind)

    return site.joined(first, value_at)


@operation(lambda places, first, count: _side_by_side(types.int32, count, 64))
def numbers_in(site, places, first, count):
    pointer = site.pointer
    return site.joined(first, lambda k: site.builder.load(pointer(site.kinds[0], places, [k])))


@operation(lambda condition, one, other: _lanes_among((one, other)))
def select(site, condition, one, other):
    return site.builder.select(condition, *site.alike([one, other], site.kinds[1:], site.result))


@operation(lambda *kinds: _lanes_among(kinds) or kinds[0])
def fused(site, a, b, c):
    return site.elementary("llvm.fmuladd", *site.alike([a, b, c], site.kinds, site.result))


@operation(lambda lanes: types.uint64)
def bits(site, lanes):
    return site.builder.zext(site.builder.bitcast(lanes, ir.IntType(lanes.type.count)), WORD)


@operation(lambda count: _side_by_side(types.intp, count))
def order(site, count):
    lanes = site.result.count
    return ir.Constant(ir.VectorType(WORD, lanes), list(range(lanes)))


@operation(lambda lanes: lanes.kind)
def least(site, value):
    lanes = site.kinds[0]
    step = lanes.count
    while step > 1:  # a power of two
        step //= 2
        others = _numbers(k ^ step for k in range(lanes.count))
        other = site.builder.shuffle_vector(value, value, others)
        value = _of_two("<")(site._replace(result=lanes), value, other)
    return site.builder.extract_element(value, ir.Constant(ir.IntType(32), 0))


@operation(lambda word: types.intp)
def trailing_zeros(site, word):
    return site.builder.cttz(word, ir.Constant(ir.IntType(1), 0))


@operation(lambda number: types.intp)
def index(site, number):
    is_from_front = site.builder.icmp_signed(">=", number, ir.Constant(number.type, 0))
    site.call("llvm.assume", ir.VoidType(), [is_from_front])
    return number


@operation(lambda array, row: types.none)
def prefetch(site, array, row):
    kind = site.kinds[0]
    indices = [row] + [ir.Constant(row.type, 0)] * (kind.ndim - 1)
    pointer = site.pointer(kind, array, indices, ir.IntType(8))
    read, near, data = (ir.Constant(ir.IntType(32), number) for number in (0, 3, 1))
    name = f"llvm.prefetch.{pointer.type.intrinsic_name}"
    site.call(name, ir.VoidType(), [pointer, read, near, data])
    return site.context.get_dummy_value()


@operation(lambda array: types.intp)
def lanes_of(site, array):
    count = register_bytes() * 8 // site.kinds[0].dtype.bitwidth
    return site.context.get_constant(types.intp, count)


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
        base = builder.add(first, ir.Constant(first.type, k))
        bases = site.spread(base, types.intp, Lanes(types.int32, step))
        numbers = _packed(site, some, word, bases)
        pointer = site.pointer(site.kinds[0], places, [number], numbers.type)
        builder.store(numbers, pointer, align=4)
        number = builder.add(number, builder.ctpop(word))
    return number


def _packed(site, mask, word, bases):
    """Return the numbers of the lanes that hold, in the first lanes, plus `bases`: by an
    instruction, or from a table."""
    builder, kind = site.builder, bases.type
    if kind.count == 16:
        numbers = builder.add(bases, _numbers(range(16)))
        name = "llvm.x86.avx512.mask.compress.v16i32"
        return site.call(name, kind, [numbers, ir.Constant(kind, None), mask])
    row = builder.gep(_table(builder.module), [ir.Constant(WORD, 0), word])
    return builder.add(bases, builder.zext(builder.load(row, align=8), kind))


def _table(module):
    """Return the table of which bits are set in each byte."""
    kind, name = ir.VectorType(ir.IntType(8), 8), "roughgas.bits_set"
    if name not in module.globals:
        rows = [[k for k in range(8) if byte >> k & 1] for byte in range(256)]
        rows = [ir.Constant(kind, row + [0] * (8 - len(row))) for row in rows]
        table = ir.GlobalVariable(module, ir.ArrayType(kind, 256), name)
        table.initializer = ir.Constant(table.type.pointee, rows)
        table.global_constant, table.linkage = True, "internal"
    return module.globals[name]
