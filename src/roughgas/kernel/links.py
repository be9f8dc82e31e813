"""Lists of particles, one per cell or per day, as links from each particle to the next ones."""

from roughgas.kernel.jit import jit
from roughgas.kernel.state import NOBODY


@jit
def enter(first, following, previous, place, i):
    """Put particle i first on the list of a place."""
    head = first[place]
    following[i] = head
    previous[i] = NOBODY
    if head != NOBODY:
        previous[head] = i
    first[place] = i


@jit
def strike_out(first, following, previous, place, i):
    """Take particle i off the list of a place."""
    after, before = following[i], previous[i]
    if before == NOBODY:
        first[place] = after
    else:
        following[before] = after
    if after != NOBODY:
        previous[after] = before
