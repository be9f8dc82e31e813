"""When two particles meet: exact, in double precision, and a function of their paths alone.

The time does not depend on when the question is asked, by whom, or which of the two asks, so that
no scheduling choice can change a trajectory.
"""

import math

from roughgas.kernel import hooks
from roughgas.kernel.flight import whereabouts
from roughgas.kernel.images import exceeds, image_numbers, shifted, speed_limits
from roughgas.kernel.jit import compiled, jit
from roughgas.kernel.vectors import add_scaled, cross_squared, dot, subtract

DIAMETER = 2.0


@jit
def time_to_contact(x, u):
    """Time until two particles at separation x, with relative velocity u, touch; inf if never.

    Touching or overlapping (by rounding) and approaching is a contact now; receding never is one.
    The smaller root is formed by division, so that it does not cancel when the particles are
    close, and the discriminant from the cross product, so that it does not when they are far. Roots
    and quotients are taken before anything is decided: a branch that the processor cannot foresee
    would cost more than they do.
    """
    b = dot(x, u)
    c = dot(x, x) - DIAMETER * DIAMETER
    discriminant = DIAMETER * DIAMETER * dot(u, u) - cross_squared(x, u)
    time = max(c, 0.0) / (math.sqrt(max(discriminant, 0.0)) - b)
    meets = (b < 0.0) & ((discriminant >= 0.0) | (c <= 0.0))
    return time if meets else math.inf


@jit
def contact_of_nearest_image(state, scene, i, j, middle, half):
    """(whether it is decided, time) of the first contact of i and j within `half` of `middle`.

    The nearest image at `middle` is the only one that can be met as long as the pair moves less
    than half a box, less a diameter, from there; of faster pairs this says that it is undecided.
    """
    last = 2 * len(scene.box)
    since = max(state.trajectory[i, last], state.trajectory[j, last])
    position_i, velocity_i = whereabouts(state, scene, i, since)
    position_j, velocity_j = whereabouts(state, scene, j, since)
    x = subtract(position_j, position_i)
    u = subtract(velocity_j, velocity_i)
    numbers = image_numbers(
        add_scaled(x, u, middle - since),
        scene.box,
        hooks.sliding(scene.effects, None, state, middle),
    )
    x, u = shifted(x, u, numbers, scene.box, hooks.sliding(scene.effects, None, state, since))
    return not exceeds(u, speed_limits(scene.box, half)), since + time_to_contact(x, u)


@compiled
def contact_of_any_image(state, scene, i, j, start, end):
    """Time of the first contact of i and j with any image between `start` and `end`, or inf.

    The interval is cut until within each piece the nearest image decides.
    """
    pieces = 2
    k = 0
    while k < pieces:
        length = (end - start) / pieces
        middle = start + (k + 0.5) * length
        decided, time = contact_of_nearest_image(state, scene, i, j, middle, 0.5 * length)
        if not decided:
            pieces *= 2
            k *= 2
        elif time <= start + (k + 1) * length:
            return time
        else:
            k += 1
    return math.inf
