"""What the springs of one pair do within a step.

A step is a flight of half its length, the action of the springs, and another half flight. A pair
overlaps during a part of the step, tau, found on the straight line on which it flies; the springs
act for just so long, at the middle of that part. So a contact begins and ends within a step to
second order. If the springs were on or off for whole steps, a contact's change of velocity would be
off by its share of a step, since neither dashpot nor tangential spring starts or ends at zero
force. Within tau the damping and the springs are integrated exactly, whatever tau is.
"""

import math

from roughgas.kernel.jit import jit
from roughgas.kernel.particles import spin_of, turn_spin
from roughgas.kernel.vectors import (
    add_scaled,
    cross_to_spin,
    dot,
    read,
    scale,
    spin_cross,
    subtract,
    write,
)
from roughgas.studies.soft_spheres.gas import CONTACTS, DIAMETER, FASTEST


@jit
def act(gas, spheres, p, x, half):
    """Let the springs of pair p act, at separation x in the middle of a step of twice `half`."""
    box = spheres.box
    i, j = gas.pair[p, 0], gas.pair[p, 1]
    v_i, v_j = read(gas.velocity, i, 0, box), read(gas.velocity, j, 0, box)
    u = subtract(v_i, v_j)
    begin, end = overlapping(x, u, half)
    if end <= begin:
        if gas.touching[p]:
            part(gas, box, p)
        return
    if not gas.touching[p]:
        gas.touching[p] = True
        gas.counts[CONTACTS] += 1
    middle = 0.5 * (begin + end)
    w_i, w_j = spin_of(gas.spin, box, i), spin_of(gas.spin, box, j)
    spins = add_scaled(w_i, w_j, 1.0)
    x = add_scaled(x, u, middle)
    stretch = read(gas.stretch, p, 0, box)
    push, turn, stretch = respond(spheres.springs, x, u, spins, stretch, end - begin)
    write(gas.stretch, p, 0, stretch)
    # as if the velocities had changed at `middle`: so angular momentum is conserved
    _change(gas, box, i, v_i, push, middle)
    _change(gas, box, j, v_j, scale(push, -1.0), middle)
    turn_spin(gas.spin, i, w_i, turn)
    turn_spin(gas.spin, j, w_j, turn)


@jit
def overlapping(x, u, half):
    """Return when, within +-half, a pair at separation x and relative velocity u overlaps."""
    b, uu = dot(x, u), dot(u, u)
    square = b * b - uu * (dot(x, x) - DIAMETER * DIAMETER)
    if square <= 0.0:
        return 0.0, 0.0
    root = math.sqrt(square)
    return max(-half, (-b - root) / uu), min(half, (-b + root) / uu)


@jit
def respond(springs, x, u, spins, stretch, time):
    """Return the change of the first velocity and of both spins a w, and the stretch at the end.

    x and u are separation and relative velocity in the middle of `time`, during which the springs
    act. Both arms reach to the middle between the centres, and the forces on the two are opposite:
    momentum and angular momentum are conserved.
    """
    distance = math.sqrt(dot(x, x))
    n = scale(x, 1.0 / distance)
    arm = 0.5 * distance
    speed = dot(u, n)
    slip = subtract(add_scaled(u, n, -speed), scale(spin_cross(spins, n), arm))
    part = 0.5 * _parting(springs, DIAMETER - distance, speed, time)
    slowed, stretch = _turned(springs, slip, _along(stretch, n), time)
    q = springs.inertia
    sheared = scale(subtract(slowed, slip), 0.5 * q / (1.0 + q))
    turn = scale(cross_to_spin(n, sheared), -arm / q)
    return add_scaled(sheared, n, part), turn, stretch


@jit
def _parting(springs, overlap, speed, time):
    """Return the change of the normal velocity, halfway through a flight of `time`.

    The linear map flight-change-flight is given the eigenvalues exp(-gamma t +- i w t) of the
    damped oscillator itself, so that neither its frequency nor its damping depends on the step.
    """
    damped = springs.damping * time
    sine = math.sin(0.5 * springs.frequency * time)
    rigid = (math.expm1(-damped) ** 2 + 4.0 * math.exp(-damped) * sine * sine) / time
    return rigid * overlap + math.expm1(-2.0 * damped) * speed


@jit
def _turned(springs, slip, stretch, time):
    """Return tangential velocity and stretch after `time` on an undamped spring, exactly."""
    angle = springs.turning * time
    cosine, sine = math.cos(angle), math.sin(angle)
    per_turning = time if angle == 0.0 else sine / springs.turning
    return (
        add_scaled(scale(slip, cosine), stretch, -springs.turning * sine),
        add_scaled(scale(stretch, cosine), slip, per_turning),
    )


@jit
def _along(stretch, n):
    """Return the stretch turned into the plane normal to n, as long as it was."""
    flat = add_scaled(stretch, n, -dot(stretch, n))
    square = dot(flat, flat)
    if square == 0.0:
        return flat
    return scale(flat, math.sqrt(dot(stretch, stretch) / square))


@jit
def _change(gas, box, i, velocity, push, when):
    velocity = add_scaled(velocity, push, 1.0)
    write(gas.velocity, i, 0, velocity)
    write(gas.position, i, 0, add_scaled(read(gas.position, i, 0, box), push, -when))
    gas.reach[FASTEST] = max(gas.reach[FASTEST], math.sqrt(dot(velocity, velocity)))


@jit
def part(gas, box, p):
    """Note that pair p does not touch, and that its spring is relaxed."""
    gas.touching[p] = False
    write(gas.stretch, p, 0, scale(box, 0.0))
