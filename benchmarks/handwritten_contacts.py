"""Rough disks in a periodic box, by hand: who meets whom, when, and what becomes of it.

The formulae are those of roughgas.kernel (sweep.py, pairs.py, contact.py, which derive them), in
the same order of operations, written out for two dimensions.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import multiply_add, trailing_zeros

ROUNDING = 2.0**-24
LARGE_SINGLE, LARGE = np.float32(1.5 * 2.0**23), 1.5 * 2.0**52  # numbers spaced by 1
TOGETHER = 8  # candidates decided at once


@jit
def nearest_single(x, length):
    """The separation from the nearest image, in single precision."""
    number = multiply_add(x, np.float32(1.0) / length, LARGE_SINGLE) - LARGE_SINGLE
    return multiply_add(-number, length, x)


@jit
def periods(x, length):
    """x / length, rounded to a whole number."""
    return x * (1.0 / length) + LARGE - LARGE


@jit
def fastest(width, height, half):
    """Square of the relative speed below which only the nearest image is met within +-half."""
    speed = (0.5 * min(width, height) - 2.001) / half
    return speed * speed


@jit
def redraw_line(path, lines, extent, span, i):
    """The path of disk i, from time 0 on, in single precision."""
    since, u, v = 0.0 - path[i, 4], path[i, 2], path[i, 3]
    x, y = u * since + path[i, 0], v * since + path[i, 1]
    lines[0, i], lines[1, i], lines[2, i], lines[3, i] = x, y, u, v
    extent[0] = max(extent[0], abs(x) + abs(y) + 3.0 * span * (abs(u) + abs(v)))


@jit
def mark(lines, marks, i, width, height, middle, half, margin, speed):
    """Mark whom disk i may touch within `half` of time `middle`, and some more."""
    speed = max(speed, 1e-30)
    sweep(
        lines,
        marks,
        i,
        np.float32(width),
        np.float32(height),
        np.float32(middle),
        np.float32(half + 0.55 * margin / speed),
        np.float32(0.55 * margin * speed),
        np.float32(margin * margin),
        np.float32(fastest(width, height, half)),
    )


@jit
def sweep(lines, marks, i, width, height, middle, reach, spare, square, limit):
    """All disks against disk i, in vector registers."""
    n = marks.size
    x_i, y_i, u_i, v_i = lines[0, i], lines[1, i], lines[2, i], lines[3, i]
    for j in range(n):
        u, v = lines[2, j] - u_i, lines[3, j] - v_i
        x = nearest_single(multiply_add(u, middle, lines[0, j] - x_i), width)
        y = nearest_single(multiply_add(v, middle, lines[1, j] - y_i), height)
        uu = multiply_add(v, v, u * u)
        area = multiply_add(x, v, -(y * u))
        soon = abs(multiply_add(y, v, x * u)) <= multiply_add(uu, reach, spare)
        marks[j] = ((area * area <= square * uu) & soon) | (uu > limit)


@jit
def collect(words, packed, packed_words, found, i):
    """List the marked disks but i; how many there are."""
    for word in range(words.size):
        packed[word] = (words[word] * np.uint64(0x0102040810204080)) >> np.uint64(56)
    number = 0
    for word in range(packed_words.size):
        rest = packed_words[word]
        while rest != 0:
            j = 64 * word + trailing_zeros(rest)
            found[number] = j
            number += j != i
            rest &= rest - np.uint64(1)
    return number


@jit
def decide(path, found, near, when, i, number, width, height, start, end):
    """Times of disk i's contacts with those found, or NaN (meeting), in double precision."""
    for k in range(number):
        for c in range(5):
            near[c, k] = path[found[k], c]
    half = 0.5 * (end - start)
    middle, limit = start + half, fastest(width, height, half)
    a = path_of(path, i)
    for k in range(-(-number // TOGETHER) * TOGETHER):
        b = near[0, k], near[1, k], near[2, k], near[3, k], near[4, k]
        when[k] = meeting(a, b, width, height, middle, limit)


@jit
def path_of(path, i):
    """Position, velocity and time of disk i."""
    return path[i, 0], path[i, 1], path[i, 2], path[i, 3], path[i, 4]


@jit
def meeting(a, b, width, height, middle, limit):
    """When two paths (x, y, u, v, time) first touch: inf if never, NaN if another image might."""
    since = max(a[4], b[4])
    x = (b[2] * (since - b[4]) + b[0]) - (a[2] * (since - a[4]) + a[0])
    y = (b[3] * (since - b[4]) + b[1]) - (a[3] * (since - a[4]) + a[1])
    u, v = b[2] - a[2], b[3] - a[3]
    x -= periods(u * (middle - since) + x, width) * width
    y -= periods(v * (middle - since) + y, height) * height
    approach, uu, area = y * v + x * u, v * v + u * u, x * v - y * u
    gap = y * y + x * x - 4.0
    discriminant = 4.0 * uu - area * area
    time = max(gap, 0.0) / (math.sqrt(max(discriminant, 0.0)) - approach)
    time = min(time, -approach / uu)
    meets = (approach < 0.0) & ((discriminant >= 0.0) | (gap <= 0.0))
    time = since + (time if meets else math.inf)
    return math.nan if uu > limit else time


@compiled
def meeting_of_any_image(path, i, j, width, height, start, end):
    """The same between `start` and `end`, cut until in each piece the nearest image decides."""
    a, b = path_of(path, i), path_of(path, j)
    pieces, k = 2, 0
    while k < pieces:
        length = (end - start) / pieces
        limit = fastest(width, height, 0.5 * length)
        time = meeting(a, b, width, height, start + (k + 0.5) * length, limit)
        if math.isnan(time):
            pieces, k = 2 * pieces, 2 * k
        elif time <= start + (k + 1) * length:
            return time
        else:
            k += 1
    return math.inf


@jit
def enter_box(path, i, time, width, height):
    """Where disk i is at `time`, as the image of it that is in the box."""
    x = path[i, 2] * (time - path[i, 4]) + path[i, 0]
    y = path[i, 3] * (time - path[i, 4]) + path[i, 1]
    return x - periods(x - 0.5 * width, width) * width, y - periods(
        y - 0.5 * height, height
    ) * height


@jit
def collide(gas, i, j, time, least):
    """The contact of disks i and j; whether they hardly approached. They part at `least`."""
    path, spin, width, height = gas.path, gas.spin, gas.width, gas.height
    x_i, y_i = enter_box(path, i, time, width, height)
    x_j, y_j = enter_box(path, j, time, width, height)
    x, y = x_i - x_j, y_i - y_j
    x, y = x - periods(x, width) * width, y - periods(y, height) * height
    u, v = path[i, 2] - path[j, 2], path[i, 3] - path[j, 3]
    square = y * y + x * x
    length = math.sqrt(square)
    lacking = (4.0 - square) / (length * (2.0 + length))
    n_x, n_y = 0.5 * x * lacking + 0.5 * x, 0.5 * y * lacking + 0.5 * y
    speed, w = v * n_y + u * n_x, spin[j] + spin[i]
    slip_x, slip_y = n_x * -speed + u + w * n_y, n_y * -speed + v - w * n_x
    turn = 0.5 * (1.0 + gas.beta) / (1.0 + gas.q)
    push = 0.5 * (1.0 + gas.r) * speed
    p_x, p_y = slip_x * (gas.q * turn) + n_x * push, slip_y * (gas.q * turn) + n_y * push
    turn *= n_x * slip_y - n_y * slip_x
    more = 0.5 * max(0.0, least - ((p_y * -2.0 + v) * n_y + (p_x * -2.0 + u) * n_x))
    p_x, p_y = p_x - n_x * more, p_y - n_y * more
    book(gas.account, gas.q, p_x * p_x + p_y * p_y - u * p_x - v * p_y, spin[i] + spin[j], turn)
    path[i, 0], path[i, 1], path[i, 4] = x_i, y_i, time
    path[j, 0], path[j, 1], path[j, 4] = x_j, y_j, time
    path[i, 2] -= p_x
    path[i, 3] -= p_y
    path[j, 2] += p_x
    path[j, 3] += p_y
    spin[i] += turn
    spin[j] += turn
    return -speed < least


@jit
def book(account, q, work, spins, turn):
    """Enter the energy gained, in translation and in rotation."""
    if account is not None:
        account[0] += work
        account[1] += q * (spins * turn + turn * turn)
