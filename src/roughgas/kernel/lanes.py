"""Several particles at once, one to each lane of a vector register.

These are names for compiled code alone (registers.py makes them): a Lanes is a value that never
leaves the registers, and takes + - * / < <= > >= == & | abs max min math.sqrt lane by lane, with one
operand a scalar if need be. The machine may have narrower registers, and then takes several.
"""

from roughgas.kernel.jit import Primitive

REGISTER = 0  # a count: as many as a register of the machine has; of numbers of 64 bits, unless of an
# array of others
load = Primitive("load")  # (array, row, first, count) -> array[row, first:first + count]
store = Primitive("store")  # (array, row, first, lanes): the reverse
gather = Primitive("gather")  # (array, column, places, first, count) -> array[p, column] for each
# p in places[first:first + count]
numbers_in = Primitive("numbers_in")  # (places, first, count) -> places[...] as 32-bit integers
order = Primitive("order")  # (count) -> 0, 1, 2, ...
bits = Primitive("bits")  # lanes of booleans -> an integer, the first lane its lowest bit
least = Primitive("least")  # lanes -> the least of them
trailing_zeros = Primitive("trailing_zeros")  # integer -> the number of zeros below its lowest bit
index = Primitive("index")  # number -> the same, promised not to count from the end of an array
lanes_of = Primitive("lanes_of")  # array -> how many of its numbers a register has
append = Primitive("append")  # (places, number, lanes, first): write those that hold after the first
# `number` of places, counted from `first`; -> how many there are then
