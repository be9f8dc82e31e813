"""The operations on lanes (mathematics.py); imported when compiled code is first called."""

import math

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from roughgas.kernel.registers import Lanes, call, least_of_two, spread

root, larger, smaller = math.sqrt, max, min  # of lanes, too: registers.py


def _pointer(context, builder, kind, array, indices):
    made = context.make_array(kind)(context, builder, array)
    return cgutils.get_item_pointer(context, builder, kind, made, indices, wraparound=False)


def _lane(number):
    return ir.Constant(ir.IntType(32), number)


def _count(count, kind):
    """Return the number of lanes asked for: REGISTER is as many as a vector register has."""
    return count.literal_value or register_bytes() * 8 // kind.bitwidth


def register_bytes():
    """Return how many bytes a vector register has: of AVX-512, or else of AVX."""
    return 64 if "+avx512f" in cpu_target.target_context.codegen().magic_tuple()[2] else 32


@intrinsic(prefer_literal=True)
def load(context, array, row, first, count):
    """Return array[row, first:first + count], which lie side by side."""
    lanes = Lanes(array.dtype, _count(count, array.dtype))

    def generate(context, builder, signature, arguments):
        pointer = _pointer(context, builder, signature.args[0], arguments[0], arguments[1:3])
        kind = context.get_value_type(lanes)
        return builder.load(builder.bitcast(pointer, kind.as_pointer()), align=_alignment(kind))

    return lanes(array, types.intp, types.intp, count), generate


class WholeStore(ir.instructions.StoreInstr):
    """A store of all lanes, where LLVM would store only those that have changed: a load of all of
    them that follows soon would have to wait for that."""

    def descr(self, text):
        super().descr(text)
        text.append(text.pop().replace("store", "store volatile", 1))


@intrinsic
def store(context, array, row, first, lanes):
    """Set array[row, first:first + count] to the lanes."""

    def generate(context, builder, signature, arguments):
        pointer = _pointer(context, builder, signature.args[0], arguments[0], arguments[1:3])
        value = arguments[3]
        pointer = builder.bitcast(pointer, value.type.as_pointer())
        instruction = WholeStore(builder.block, value, pointer)
        instruction.align = _alignment(value.type)
        builder._insert(instruction)
        return context.get_dummy_value()

    return types.none(array, types.intp, types.intp, lanes), generate


def _alignment(kind):
    return 4 if str(kind.element) in ("float", "i32") else 8


@intrinsic(prefer_literal=True)
def gather(context, array, column, places, first, count):
    """Return array[p, column] for the `count` numbers p in places[first:]; single precision is
    widened."""
    wide = types.float64 if array.dtype == types.float32 else array.dtype
    lanes = Lanes(wide, _count(count, types.float64))

    def generate(context, builder, signature, arguments):
        rows, column, places, first, _ = arguments
        kind = signature.args[0]
        vector = ir.Constant(context.get_value_type(lanes), ir.Undefined)
        for k in range(lanes.count):
            at = builder.add(first, ir.Constant(first.type, k))
            place = builder.load(_pointer(context, builder, signature.args[2], places, [at]))
            place = builder.zext(place, ir.IntType(64))
            indices = [place, column][: kind.ndim]
            value = builder.load(_pointer(context, builder, kind, rows, indices))
            value = context.cast(builder, value, kind.dtype, wide)
            vector = builder.insert_element(vector, value, _lane(k))
        return vector

    return lanes(array, types.intp, places, types.intp, count), generate


@intrinsic(prefer_literal=True)
def numbers_in(context, places, first, count):
    """Return places[first:first + count] as 32-bit integers."""
    lanes = Lanes(types.int32, _count(count, types.float64))

    def generate(context, builder, signature, arguments):
        vector = ir.Constant(context.get_value_type(lanes), ir.Undefined)
        for k in range(lanes.count):
            at = builder.add(arguments[1], ir.Constant(arguments[1].type, k))
            pointer = _pointer(context, builder, signature.args[0], arguments[0], [at])
            vector = builder.insert_element(vector, builder.load(pointer), _lane(k))
        return vector

    return lanes(places, types.intp, count), generate


@intrinsic
def select(context, condition, one, other):
    """Return `one` in the lanes where the condition holds, `other` elsewhere."""
    lanes = one if isinstance(one, Lanes) else other

    def generate(context, builder, signature, arguments):
        values = [
            spread(context, builder, value, kind, lanes)
            for value, kind in zip(arguments[1:], signature.args[1:], strict=True)
        ]
        return builder.select(arguments[0], *values)

    return lanes(condition, one, other), generate


@intrinsic
def fused(context, a, b, c):
    """Return a b + c, in one instruction where the machine has it."""
    kinds = (a, b, c)
    lanes = next((one for one in kinds if isinstance(one, Lanes)), None)

    def generate(context, builder, signature, arguments):
        if lanes is not None:
            pairs = zip(arguments, kinds, strict=True)
            arguments = [spread(context, builder, one, kind, lanes) for one, kind in pairs]
        return call(builder, "llvm.fmuladd", arguments)

    return (lanes or a)(a, b, c), generate


@intrinsic
def bits(context, lanes):
    """Return lanes of booleans as the lowest bits of an integer, the first lane lowest."""

    def generate(context, builder, signature, arguments):
        word = builder.bitcast(arguments[0], ir.IntType(lanes.count))
        return builder.zext(word, ir.IntType(64))

    return types.uint64(lanes), generate


@intrinsic(prefer_literal=True)
def order(context, count):
    """Return the number of each lane."""
    lanes = Lanes(types.intp, _count(count, types.float64))

    def generate(context, builder, signature, arguments):
        return ir.Constant(context.get_value_type(lanes), list(range(lanes.count)))

    return lanes(count), generate


@intrinsic
def least(context, lanes):
    """Return the least of the lanes, whose number is a power of two."""

    def generate(context, builder, signature, arguments):
        value, count = arguments[0], lanes.count
        while count > 1:
            count //= 2
            order = [k ^ count for k in range(lanes.count)]
            index = ir.Constant(ir.VectorType(ir.IntType(32), lanes.count), order)
            other = builder.shuffle_vector(value, value, index)
            value = least_of_two("<")(builder, lanes.kind, [value, other])
        return builder.extract_element(value, _lane(0))

    return lanes.kind(lanes), generate


@intrinsic
def trailing_zeros(context, word):
    """Return the number of zeros below the lowest bit that is set."""

    def generate(context, builder, signature, arguments):
        count = builder.cttz(arguments[0], ir.Constant(ir.IntType(1), 0))
        return context.cast(builder, count, word, types.intp)

    return types.intp(word), generate


@intrinsic
def index(context, number):
    """Return a number, which is not negative: an index from the front, and not from the end."""

    def generate(context, builder, signature, arguments):
        value = arguments[0]
        condition = builder.icmp_signed(">=", value, ir.Constant(value.type, 0))
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(1)])
        builder.call(builder.module.declare_intrinsic("llvm.assume", fnty=kind), [condition])
        return value

    return number(number), generate


@intrinsic
def prefetch(context, array, row):
    """Have the processor fetch array[row] from memory, if it is not in a cache, and go on."""

    def generate(context, builder, signature, arguments):
        kind, indices = signature.args[0], [arguments[1]]
        indices += [ir.Constant(indices[0].type, 0)] * (kind.ndim - 1)
        pointer = _pointer(context, builder, kind, arguments[0], indices)
        pointer = builder.bitcast(pointer, ir.IntType(8).as_pointer())
        read, near, data = (ir.Constant(ir.IntType(32), number) for number in (0, 3, 1))
        function = builder.module.declare_intrinsic(
            "llvm.prefetch", [pointer.type], _prefetch_type(pointer.type)
        )
        builder.call(function, [pointer, read, near, data])
        return context.get_dummy_value()

    return types.none(array, types.intp), generate


def _prefetch_type(pointer):
    number = ir.IntType(32)
    return ir.FunctionType(ir.VoidType(), [pointer, number, number, number])


@intrinsic
def lanes_of(context, array):
    """Return how many of an array's numbers a vector register has."""
    number = _count(types.IntegerLiteral(0), array.dtype)

    def generate(context, builder, signature, arguments):
        return context.get_constant(types.intp, number)

    return types.intp(array), generate


@intrinsic
def append(context, places, number, lanes, first):
    """Write the numbers, counted from `first`, of the lanes that hold into places[number:]; return
    how many places are taken then. What lies beyond these is spoiled.

    There is no branch in it, which the processor could not foresee.
    """
    step = 16 if register_bytes() == 64 and lanes.count == 16 else 8
    numbered = Lanes(types.int32, step)

    def generate(context, builder, signature, arguments):
        places, number, mask, first = arguments
        for k in range(0, lanes.count, step):
            part = ir.Constant(ir.VectorType(ir.IntType(32), step), list(range(k, k + step)))
            some = builder.shuffle_vector(mask, mask, part) if step < lanes.count else mask
            word = builder.zext(builder.bitcast(some, ir.IntType(step)), ir.IntType(64))
            base = builder.add(first, ir.Constant(first.type, k))
            bases = spread(context, builder, base, types.intp, numbered)
            numbers = _packed(builder, some, word, bases)
            pointer = _pointer(context, builder, signature.args[0], places, [number])
            pointer = builder.bitcast(pointer, numbers.type.as_pointer())
            builder.store(numbers, pointer, align=4)
            number = builder.add(number, builder.ctpop(word))
        return number

    return types.intp(places, types.intp, lanes, types.intp), generate


def _packed(builder, mask, word, bases):
    """Return the numbers of the lanes that hold, in the first lanes, plus `bases`."""
    kind = bases.type
    if kind.count == 16:
        numbers = builder.add(bases, ir.Constant(kind, list(range(kind.count))))
        function = ir.FunctionType(kind, [kind, kind, mask.type])
        name = "llvm.x86.avx512.mask.compress.v16i32"
        compress = cgutils.get_or_insert_function(builder.module, function, name)
        return builder.call(compress, [numbers, ir.Constant(kind, None), mask])
    table = builder.gep(_table(builder.module), [ir.Constant(ir.IntType(64), 0), word])
    small = builder.load(table, align=8)
    return builder.add(bases, builder.zext(small, kind))


def _table(module):
    """Return the table of which bits are set in each byte."""
    kind = ir.VectorType(ir.IntType(8), 8)
    name = "roughgas.bits_set"
    if name in module.globals:
        return module.globals[name]
    rows = [[k for k in range(8) if byte >> k & 1] for byte in range(256)]
    rows = [ir.Constant(kind, row + [0] * (8 - len(row))) for row in rows]
    table = ir.GlobalVariable(module, ir.ArrayType(kind, 256), name)
    table.initializer = ir.Constant(table.type.pointee, rows)
    table.global_constant, table.linkage = True, "internal"
    return table
