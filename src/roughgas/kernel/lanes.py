"""Several particles at once, one to each lane of a vector register.

Lanes are values of compiled code that never leave the registers (registers.py tells numba of
them).
+ - * / < <= > >= == & | abs max min math.sqrt take them lane by lane, with one operand a scalar if
need be. A machine with narrower registers takes several for one.

| operation | returns |
| --- | --- |
| load(array, row, first, count) | array[row, first:first + count], as lanes |
| store(array, row, first, lanes) | nothing; the reverse of load |
| gather(array, column, places, first, count) | array[p, column] for each p in places[first:...] |
| numbers_in(places, first, count) | places[first:first + count], of 32-bit integers |
| order(count) | 0, 1, 2, ... |
| lanes_of(array) | how many of the array's numbers a register has |
| bits(lanes of booleans) | an integer, the first lane its lowest bit |
| least(lanes) | the least of them; their number is a power of two |
| append(places, number, lanes of booleans, first) | see operations.py |
| trailing_zeros(integer) | the number of zeros below its lowest bit |
| prefetch(array, row) | nothing; array[row] is on its way to the cache |
| index(number) | the number, promised not to count from the end of an array |
"""

from roughgas.kernel.jit import Primitive

REGISTER = 0  # a count: as many as a register has, of doubles if not of the array's own numbers

load = Primitive("load")
store = Primitive("store")
gather = Primitive("gather")
numbers_in = Primitive("numbers_in")
order = Primitive("order")
lanes_of = Primitive("lanes_of")
bits = Primitive("bits")
least = Primitive("least")
append = Primitive("append")
trailing_zeros = Primitive("trailing_zeros")
prefetch = Primitive("prefetch")
index = Primitive("index")
