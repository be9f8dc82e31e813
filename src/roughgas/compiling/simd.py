"""Vector registers as values of numba's, and their operations, which lanes.py has in plain Python.

Imported when compiled code is first called. A Lanes holds `count` numbers of one type, one to each
lane, as a vector of LLVM, which splits it if the machine's registers are narrower. Operators work
on floats, lane by lane, with one operand a scalar if need be; comparisons give lanes of booleans.
"""

import inspect
import itertools
import operator
from typing import Any, NamedTuple

import llvmlite.binding
import numba
from llvmlite import ir
from numba import types
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

BIT, NUMBER, WORD = ir.IntType(1), ir.IntType(32), ir.IntType(64)


def processor_features():
    """Return the features that numba compiles for, as LLVM lists them: "+avx2,-avx512f,..."."""
    chosen = numba.config.CPU_FEATURES  # NUMBA_CPU_FEATURES
    if chosen is not None:
        return chosen
    return llvmlite.binding.get_host_cpu_features().flatten() if numba.config.ENABLE_AVX else ""


BYTES = 64 if "+avx512f" in processor_features() else 32
"""Size of a register: of AVX-512, or else of AVX."""


class Lanes(types.Type):
    """The type of `count` values of a numba type, `kind`."""

    def __init__(self, kind, count):
        self.kind, self.count = kind, count
        super().__init__(name=f"Lanes({kind} x {count})")


@register_model(Lanes)
def _model(manager, lanes):
    """Return numba's data model of the type `lanes`, a vector register of LLVM."""
    element = manager.lookup(lanes.kind).get_value_type()
    return models.PrimitiveModel(manager, lanes, ir.VectorType(element, lanes.count))


# ------------------------------------------------------------------ operations


class Lowering(NamedTuple):
    """The context for writing an operation as instructions of LLVM."""

    context: Any
    builder: ir.IRBuilder
    argument_types: tuple
    result_type: types.Type

    def pointer(self, array, indices, vector_type=None):
        """Return the address of an item of the first argument, an array, or of a vector of items
        that begins there."""
        array_type, builder = self.argument_types[0], self.builder
        model = self.context.data_model_manager.lookup(array_type)
        data = model.get(builder, array, "data")
        is_contiguous = array_type.layout == "C"
        sizes = model.get(builder, array, "shape" if is_contiguous else "strides")
        sizes = [builder.extract_value(sizes, axis) for axis in range(array_type.ndim)]
        offset = WORD(0)
        for axis, index in enumerate(indices):
            step = WORD(1) if is_contiguous else sizes[axis]
            for size in sizes[axis + 1 :] if is_contiguous else ():
                step = builder.mul(step, size)
            offset = builder.add(offset, builder.mul(index, step))
        if is_contiguous:
            address = builder.gep(data, [offset])
        else:
            first = builder.bitcast(data, ir.IntType(8).as_pointer())
            address = builder.bitcast(builder.gep(first, [offset]), data.type)
        return (
            address if vector_type is None else builder.bitcast(address, vector_type.as_pointer())
        )

    def joined(self, values):
        """Return numbers as lanes."""
        vector = ir.Constant(ir.VectorType(values[0].type, len(values)), ir.Undefined)
        for k, value in enumerate(values):
            vector = self.builder.insert_element(vector, value, NUMBER(k))
        return vector

    def call(self, name, result_type, *values, **options):
        """Return the result of LLVM's intrinsic `name`, of the variant for the first value."""
        first = values[0].type
        element, count = (
            (first.element, f"v{first.count}") if hasattr(first, "count") else (first, "")
        )
        variant = f"{name}.{count}{element.intrinsic_name}"
        return self.call_variant(variant, result_type, values, **options)

    def call_variant(self, variant, result_type, values, **options):
        """Return the result of the `variant` of an intrinsic of LLVM, by its complete name."""
        function = self.builder.module.globals.get(variant)
        if function is None:
            function_type = ir.FunctionType(result_type, [value.type for value in values])
            function = ir.Function(self.builder.module, function_type, variant)
        return self.builder.call(function, values, **options)

    def spread(self, value, argument_type):
        """Return a number in every lane where an argument is lanes; lanes as they are."""
        if isinstance(argument_type, Lanes):
            return value
        widest = _lane_by_lane(*self.argument_types)
        number_type = getattr(widest, "kind", widest)
        value = self.context.cast(self.builder, value, argument_type, number_type)
        return self.joined([value] * widest.count) if isinstance(widest, Lanes) else value


def operation(result_type):
    """Decorate generate(lowering, *values) -> LLVM's value: an operation of compiled code.

    result_type: from the types of the arguments, literal ones where a number is a constant, to that
    of the result.
    """

    def decorate(generate):
        def define(context, *argument_types):
            returned = result_type(*argument_types)
            passed = [types.intp if type(x) is types.Integer else x for x in argument_types]

            def lower(context, builder, signature, values):
                lowering = Lowering(context, builder, signature.args, returned)
                if result_type is _lane_by_lane:
                    values = map(lowering.spread, values, lowering.argument_types)
                return generate(lowering, *values)

            return returned(*passed), lower

        define.__name__, define.__signature__ = generate.__name__, inspect.signature(generate)
        return intrinsic(prefer_literal=True)(define)

    return decorate


def define_operator(function, result_type, generate):
    """Have numba compile an operator of Python's for lanes.

    result_type, generate: as of an operation.
    """

    def type_of(*operand_types):
        has_lanes = any(isinstance(x, Lanes) for x in operand_types)
        return result_type(*operand_types) if has_lanes else None

    def lower(context, builder, signature, values):
        lowering = Lowering(context, builder, signature.args, signature.return_type)
        return generate(lowering, *map(lowering.spread, values, lowering.argument_types))

    arity = len(inspect.signature(function).parameters)
    type_of_operands = {1: lambda x: type_of(x), 2: lambda x, y: type_of(x, y)}[arity]
    type_callable(function)(lambda context: type_of_operands)
    for operand_types in itertools.product((Lanes, types.Any), repeat=arity):
        if Lanes in operand_types:
            lower_builtin(function, *operand_types)(lower)


def _lane_by_lane(*argument_types):
    """Return the result type of an operation that is carried out lane by lane: the widest number
    where no argument is lanes."""
    lanes = [x for x in argument_types if isinstance(x, Lanes)]
    return lanes[-1] if lanes else max(argument_types, key=lambda x: x.bitwidth)


def _truth(*argument_types):
    return Lanes(types.boolean, _lane_by_lane(*argument_types).count)


def _constants(values, number_type=NUMBER):
    return ir.VectorType(number_type, len(values))(list(values))


# ------------------------------------------------------------------ lane by lane

ARITHMETIC = {"add": "fadd", "sub": "fsub", "mul": "fmul", "truediv": "fdiv", "neg": "fneg"}
LOGIC = {"and_": "and_", "or_": "or_"}
COMPARISONS = {"lt": "<", "le": "<=", "gt": ">", "ge": ">=", "eq": "=="}


def _instruction(name, *sign):
    return lambda lowering, *values: getattr(lowering.builder, name)(*sign, *values)


for _name, _llvm_name in (ARITHMETIC | LOGIC).items():
    define_operator(getattr(operator, _name), _lane_by_lane, _instruction(_llvm_name))
for _name, _sign in COMPARISONS.items():
    define_operator(getattr(operator, _name), _truth, _instruction("fcmp_ordered", _sign))
define_operator(abs, _lane_by_lane, lambda lowering, x: lowering.call("llvm.fabs", x.type, x))

lane_by_lane = operation(_lane_by_lane)
sqrt = lane_by_lane(lambda lowering, x: lowering.call("llvm.sqrt", x.type, x))
select = lane_by_lane(lambda lowering, condition, a, b: lowering.builder.select(condition, a, b))


@lane_by_lane
def multiply_add(lowering, a, b, c):
    if getattr(a.type, "element", a.type) == ir.FloatType():
        return lowering.call("llvm.fmuladd", a.type, a, b, c)
    return lowering.builder.fadd(lowering.builder.fmul(a, b), c)


# ------------------------------------------------------------------ memory


@operation(lambda array, row, first, count: Lanes(array.dtype, count.literal_value))
def load(lowering, array, row, first, count):
    pointer = lowering.pointer(
        array, [row, first], lowering.context.get_value_type(lowering.result_type)
    )
    return lowering.builder.load(pointer, align=lowering.result_type.kind.bitwidth // 8)


class VectorStore(ir.instructions.StoreInstr):
    """A store of all lanes. LLVM might store changed lanes only, and a vector load right after
    scalar stores would stall."""

    def descr(self, text):
        super().descr(text)
        text.append(text.pop().replace("store", "store volatile", 1))


@operation(lambda array, row, first, lanes: types.none)
def store(lowering, array, row, first, lanes):
    pointer = lowering.pointer(array, [row, first], lanes.type)
    instruction = VectorStore(lowering.builder.block, lanes, pointer)
    instruction.align = lowering.argument_types[3].kind.bitwidth // 8
    lowering.builder._insert(instruction)
    return lowering.context.get_dummy_value()


@operation(lambda array, first, count: Lanes(array.dtype, count.literal_value))
def load_scalars(lowering, array, first, count):
    indices = [lowering.builder.add(first, WORD(k)) for k in range(lowering.result_type.count)]
    pointers = [lowering.pointer(array, [index]) for index in indices]
    return lowering.joined([lowering.builder.load(pointer) for pointer in pointers])


def _widened(number_type):
    return types.float64 if number_type == types.float32 else number_type


@operation(lambda array, column, rows: Lanes(_widened(array.dtype), rows.count))
def gather(lowering, array, column, rows):
    (array_type, *_), builder, values = lowering.argument_types, lowering.builder, []
    for k in range(lowering.result_type.count):
        row = builder.zext(builder.extract_element(rows, NUMBER(k)), WORD)
        value = builder.load(lowering.pointer(array, [row, column][: array_type.ndim]))
        number_type = lowering.result_type.kind
        values.append(lowering.context.cast(builder, value, array_type.dtype, number_type))
    return lowering.joined(values)


@operation(lambda array, rows, pattern: types.UniTuple(_doubles(rows), pattern.count))
def gather_rows(lowering, array, rows, pattern):
    """Whole rows are loaded, and transposed in registers: there are fewer loads than numbers."""
    gathered = ir.Constant(lowering.context.get_value_type(lowering.result_type), ir.Undefined)
    for first in range(0, lowering.result_type.count, rows.type.count):
        columns = _gather_columns(lowering, array, rows, first)
        for k, column in enumerate(columns[: lowering.result_type.count - first]):
            gathered = lowering.builder.insert_value(gathered, column, first + k)
    return gathered


def _doubles(lanes):
    return Lanes(types.float64, lanes.count)


def _gather_columns(lowering, array, rows, first):
    """Return columns of rows of an array, as many as there are lanes, from column `first` on.

    Columns beyond the gathered ones are undefined.
    """
    builder, lanes = lowering.builder, lowering.result_type.dtype.count
    element = lowering.context.get_value_type(lowering.argument_types[0].dtype)
    vector, doubles = ir.VectorType(element, lanes), ir.VectorType(ir.DoubleType(), lanes)
    mask = _constants([first + k < lowering.result_type.count for k in range(lanes)], BIT)
    loaded = []
    for k in range(lanes):
        row = builder.zext(builder.extract_element(rows, NUMBER(k)), WORD)
        pointer = lowering.pointer(array, [row, WORD(first)], vector)
        loaded.append(_masked_load(lowering, pointer, mask, vector))
    if element != ir.DoubleType():
        loaded = [builder.fpext(values, doubles) for values in loaded]
    return _transposed(builder, loaded)


def _masked_load(lowering, pointer, mask, vector):
    """Return the items at an address whose lanes are set in the mask; the others are not read."""
    variant = f"llvm.masked.load.v{vector.count}{vector.element.intrinsic_name}.p0"
    alignment = NUMBER(8 if vector.element == ir.DoubleType() else 4)
    values = [pointer, alignment, mask, ir.Constant(vector, ir.Undefined)]
    return lowering.call_variant(variant, vector, values)


def _transposed(builder, rows):
    """Return the columns of a square of numbers from its rows, each in lanes."""
    count, step = len(rows), 1
    while step < count:
        # exchanges the off-diagonal quarters of each square of 2 step by 2 step numbers
        lower = [k if not k & step else count + k - step for k in range(count)]
        upper = [k + step if not k & step else count + k for k in range(count)]
        exchanged = list(rows)
        for i in range(count):
            if not i & step:
                pair = rows[i], rows[i + step]
                exchanged[i] = builder.shuffle_vector(*pair, _constants(lower))
                exchanged[i + step] = builder.shuffle_vector(*pair, _constants(upper))
        rows, step = exchanged, 2 * step
    return rows


@operation(lambda array, row: types.none)
def prefetch(lowering, array, row):
    pointer = lowering.pointer(
        array, [row, WORD(0)][: lowering.argument_types[0].ndim], ir.IntType(8)
    )
    lowering.call("llvm.prefetch", ir.VoidType(), pointer, NUMBER(0), NUMBER(3), NUMBER(1))
    return lowering.context.get_dummy_value()


horizontal_min = operation(lambda lanes: lanes.kind)(
    lambda lowering, x: lowering.call(
        "llvm.vector.reduce.fmin", x.type.element, x, fastmath=("nnan",)
    )
)
bits = operation(lambda lanes: types.uint64)(
    lambda lowering, x: lowering.builder.zext(
        lowering.builder.bitcast(x, ir.IntType(x.type.count)), WORD
    )
)
iota = operation(lambda count: Lanes(types.float64, count.literal_value))(
    lambda lowering, count: _constants(range(lowering.result_type.count), ir.DoubleType())
)
trailing_zeros = operation(lambda word: types.intp)(
    lambda lowering, x: lowering.builder.cttz(x, BIT(0))
)


@operation(lambda x: types.intp)
def integer(lowering, x):
    return lowering.context.cast(
        lowering.builder, x, lowering.argument_types[0], lowering.result_type
    )


@operation(lambda number: types.intp)
def assume_nonnegative(lowering, number):
    lowering.builder.assume(lowering.builder.icmp_signed(">=", number, number.type(0)))
    return number


@operation(lambda array, length, lanes, first: types.intp)
def append(lowering, array, length, mask, first):
    """The array is overwritten to a register's width beyond the new length: so there is no branch,
    which the processor could not predict."""
    builder, count = lowering.builder, mask.type.count
    word = builder.zext(builder.bitcast(mask, ir.IntType(count)), WORD)
    base = lowering.joined([builder.trunc(first, NUMBER)] * count)
    numbers = builder.add(base, _set_lanes(lowering, mask, word))
    builder.store(numbers, lowering.pointer(array, [length], numbers.type), align=4)
    return builder.add(length, builder.ctpop(word))


def _set_lanes(lowering, mask, word):
    """Return the numbers of the lanes that are set, packed into the first lanes: of 16 by an
    instruction, of 8 from a table."""
    result_type = ir.VectorType(NUMBER, mask.type.count)
    if mask.type.count == 16:
        name = "llvm.x86.avx512.mask.compress"
        zeros = ir.Constant(result_type, None)
        return lowering.call(name, result_type, _constants(range(16)), zeros, mask)
    packed = [[k for k in range(8) if byte >> k & 1] for byte in range(256)]
    rows = [_constants(row + [0] * (8 - len(row)), ir.IntType(8)) for row in packed]
    content = ir.Constant(ir.ArrayType(rows[0].type, 256), rows)
    module = lowering.builder.module
    table = ir.GlobalVariable(module, content.type, module.get_unique_name("roughgas.bits_set"))
    table.linkage, table.global_constant, table.initializer = "internal", True, content
    row = lowering.builder.load(lowering.builder.gep(table, [WORD(0), word]), align=8)
    return lowering.builder.zext(row, result_type)
