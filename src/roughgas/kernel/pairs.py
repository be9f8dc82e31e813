"""When two particles meet: exact, in double precision, and a function of their paths alone.

The time does not depend on when it is computed, or for which of the two, so that no choice of the
scheduler can change a trajectory. A path is (position, velocity, time at which they
hold), and goes on in free flight.
"""

import math

from roughgas.kernel.arithmetic import choose
from roughgas.kernel.flight import along
from roughgas.kernel.hooks import either
from roughgas.kernel.images import exceeds, image_numbers, shifted, slid, speed_limit
from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.vectors import add_scaled, cross_squared, dot, subtract

DIAMETER = 2.0

_touching = either(lambda reach: reach, lambda reach: DIAMETER)


@jit
def time_to_contact(x, u, reach):
    """Return the time until two particles at separation x, with relative velocity u, touch, or inf.

    They touch at the distance `reach`; None stands for 2, here and below.

    Touching or overlapping (by rounding) and approaching is a contact now; receding never is one.
    The smaller root is formed by division, so that it does not cancel when the particles are
    close, and the discriminant from the cross product, so that it does not when they are far. For
    a pair that touches but for a rounding, root - b may be almost 0: a contact is therefore never
    later than the closest approach. Roots and quotients are taken before anything is decided: a
    branch that the processor cannot foresee would cost more, and without branches several pairs
    are done at once.
    """
    b, uu = dot(x, u), dot(u, u)
    diameter = _touching(reach)
    c = dot(x, x) - diameter * diameter
    discriminant = diameter * diameter * uu - cross_squared(x, u)
    time = max(c, 0.0) / (math.sqrt(max(discriminant, 0.0)) - b)
    time = min(time, -b / uu)
    meets = (b < 0.0) & ((discriminant >= 0.0) | (c <= 0.0))
    return choose(meets, time, math.inf)


@jit
def meeting(path_i, path_j, box, gravity, slide, middle, limit, reach):
    """Return the time of the first contact of two paths, and whether a second image might be met.

    The nearest image at `middle` is the only one that can be met as long as the pair moves less
    than half a box, less a diameter, from there: as long as it is not faster than the speed_limit.
    """
    since = max(path_i[2], path_j[2])
    position_i, velocity_i = along(path_i, since, gravity)
    position_j, velocity_j = along(path_j, since, gravity)
    x = subtract(position_j, position_i)
    u = subtract(velocity_j, velocity_i)
    numbers = image_numbers(add_scaled(x, u, middle - since), box, slid(slide, middle))
    x, u = shifted(x, u, numbers, box, slid(slide, since))
    time = since + time_to_contact(x, u, reach)
    return time, exceeds(dot(u, u), limit)


@compiled
def meeting_of_any_image(path_i, path_j, box, gravity, slide, start, end, reach):
    """Return when, between `start` and `end`, any images of two paths first touch, or inf.

    The interval is cut until within each piece the nearest image decides.
    """
    pieces = 2
    k = 0
    while k < pieces:
        length = (end - start) / pieces
        middle = start + (k + 0.5) * length
        limit = speed_limit(box, 0.5 * length, reach)
        time, unsure = meeting(path_i, path_j, box, gravity, slide, middle, limit, reach)
        if unsure:
            pieces *= 2
            k *= 2
        elif time <= start + (k + 1) * length:
            return time
        else:
            k += 1
    return math.inf
