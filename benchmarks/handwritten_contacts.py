"""Rough disks in a periodic box, by hand: candidates, contact times, and collisions.

The formulae are derived in roughgas.kernel (sweep.py, pairs.py, contact.py); here they are written
out for two dimensions, with the same order of operations.
"""

import math

import numpy as np

from roughgas.compiling.jit import compiled, jit
from roughgas.compiling.lanes import multiply_add, trailing_zeros

ROUNDING = 2.0**-24
LARGE_SINGLE, LARGE = np.float32(1.5 * 2.0**23), 1.5 * 2.0**52  # numbers spaced by 1
BATCH = 8  # candidates per loop over vectors


@jit
def nearest_image_single(x, length):
    """Return the separation from the nearest image along an axis, in single precision."""
    number = multiply_add(x, np.float32(1.0) / length, LARGE_SINGLE) - LARGE_SINGLE
    return multiply_add(-number, length, x)


@jit
def whole_periods(x, length):
    """Return x / length, rounded to a whole number."""
    return x * (1.0 / length) + LARGE - LARGE


@jit
def max_speed_squared(width, height, half):
    """Return the square of the relative speed below which, within +-half of the time, only the
    nearest image can be met."""
    speed = (0.5 * min(width, height) - 2.001) / half
    return speed * speed


@jit
def update_line(path, lines, extent, span, i):
    """Store the path of disk i, from time 0 on, in single precision."""
    elapsed, u, v = 0.0 - path[i, 4], path[i, 2], path[i, 3]
    x, y = u * elapsed + path[i, 0], v * elapsed + path[i, 1]
    lines[0, i], lines[1, i], lines[2, i], lines[3, i] = x, y, u, v
    extent[0] = max(extent[0], abs(x) + abs(y) + 3.0 * span * (abs(u) + abs(v)))


@jit
def mark_candidates(lines, marks, i, width, height, middle, half, margin, speed):
    """Mark the candidates: all disks that disk i touches within `half` of time `middle`, and a few
    others."""
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
        np.float32(max_speed_squared(width, height, half)),
    )


@jit
def sweep(lines, marks, i, width, height, middle, reach, spare, square, speed_limit):
    """Mark candidates among all disks, in vector registers."""
    n = marks.size
    x_i, y_i, u_i, v_i = lines[0, i], lines[1, i], lines[2, i], lines[3, i]
    for j in range(n):
        u, v = lines[2, j] - u_i, lines[3, j] - v_i
        x = nearest_image_single(multiply_add(u, middle, lines[0, j] - x_i), width)
        y = nearest_image_single(multiply_add(v, middle, lines[1, j] - y_i), height)
        uu = multiply_add(v, v, u * u)
        area = multiply_add(x, v, -(y * u))
        is_soon = abs(multiply_add(y, v, x * u)) <= multiply_add(uu, reach, spare)
        marks[j] = ((area * area <= square * uu) & is_soon) | (uu > speed_limit)


@jit
def list_candidates(mark_words, packed, packed_words, candidates, i):
    """List the marked disks except i; return their number."""
    for word in range(mark_words.size):
        packed[word] = (mark_words[word] * np.uint64(0x0102040810204080)) >> np.uint64(56)
    number = 0
    for word in range(packed_words.size):
        remaining_bits = packed_words[word]
        while remaining_bits != 0:
            j = 64 * word + trailing_zeros(remaining_bits)
            candidates[number] = j
            number += j != i
            remaining_bits &= remaining_bits - np.uint64(1)
    return number


@jit
def contact_times(path, candidates, candidate_paths, times, i, number, width, height, start, end):
    """Store the times of contacts of disk i with candidates (see contact_time)."""
    for k in range(number):
        for c in range(5):
            candidate_paths[c, k] = path[candidates[k], c]
    half = 0.5 * (end - start)
    middle, limit = start + half, max_speed_squared(width, height, half)
    a = path_of(path, i)
    for k in range(-(-number // BATCH) * BATCH):
        b = (
            candidate_paths[0, k],
            candidate_paths[1, k],
            candidate_paths[2, k],
            candidate_paths[3, k],
            candidate_paths[4, k],
        )
        times[k] = contact_time(a, b, width, height, middle, limit)


@jit
def path_of(path, i):
    """Return the path of disk i: position, velocity and time."""
    return path[i, 0], path[i, 1], path[i, 2], path[i, 3], path[i, 4]


@jit
def contact_time(a, b, width, height, middle, limit):
    """Return the time of the first contact of two paths (x, y, u, v, time), in double precision:
    inf if there is none, NaN if another image might be first."""
    start = max(a[4], b[4])
    x = (b[2] * (start - b[4]) + b[0]) - (a[2] * (start - a[4]) + a[0])
    y = (b[3] * (start - b[4]) + b[1]) - (a[3] * (start - a[4]) + a[1])
    u, v = b[2] - a[2], b[3] - a[3]
    x -= whole_periods(u * (middle - start) + x, width) * width
    y -= whole_periods(v * (middle - start) + y, height) * height
    approach, uu, area = y * v + x * u, v * v + u * u, x * v - y * u
    gap = y * y + x * x - 4.0
    discriminant = 4.0 * uu - area * area
    time = max(gap, 0.0) / (math.sqrt(max(discriminant, 0.0)) - approach)
    time = min(time, -approach / uu)
    is_contact = (approach < 0.0) & ((discriminant >= 0.0) | (gap <= 0.0))
    time = start + (time if is_contact else math.inf)
    return math.nan if uu > limit else time


@compiled
def contact_time_of_any_image(path, i, j, width, height, start, end):
    """Return the time of the first contact with any image between `start` and `end`, inf without
    any: intervals are halved until the nearest image is the only one in each."""
    a, b = path_of(path, i), path_of(path, j)
    intervals, k = 2, 0
    while k < intervals:
        length = (end - start) / intervals
        limit = max_speed_squared(width, height, 0.5 * length)
        time = contact_time(a, b, width, height, start + (k + 0.5) * length, limit)
        if math.isnan(time):
            intervals, k = 2 * intervals, 2 * k
        elif time <= start + (k + 1) * length:
            return time
        else:
            k += 1
    return math.inf


@jit
def enter_box(path, i, time, width, height):
    """Return the position of disk i at `time`, moved into the box."""
    x = path[i, 2] * (time - path[i, 4]) + path[i, 0]
    y = path[i, 3] * (time - path[i, 4]) + path[i, 1]
    return x - whole_periods(x - 0.5 * width, width) * width, y - whole_periods(
        y - 0.5 * height, height
    ) * height


@jit
def collide(gas, i, j, time, min_speed):
    """Collide disks i and j, which part at `min_speed` or more; return whether they approached at
    less."""
    path, spin, width, height = gas.path, gas.spin, gas.width, gas.height
    x_i, y_i = enter_box(path, i, time, width, height)
    x_j, y_j = enter_box(path, j, time, width, height)
    x, y = x_i - x_j, y_i - y_j
    x, y = x - whole_periods(x, width) * width, y - whole_periods(y, height) * height
    u, v = path[i, 2] - path[j, 2], path[i, 3] - path[j, 3]
    distance_squared = y * y + x * x
    length = math.sqrt(distance_squared)
    overlap = (4.0 - distance_squared) / (length * (2.0 + length))
    n_x, n_y = 0.5 * x * overlap + 0.5 * x, 0.5 * y * overlap + 0.5 * y
    speed, w = v * n_y + u * n_x, spin[j] + spin[i]
    slip_x, slip_y = n_x * -speed + u + w * n_y, n_y * -speed + v - w * n_x
    turn = 0.5 * (1.0 + gas.beta) / (1.0 + gas.q)
    push = 0.5 * (1.0 + gas.r) * speed
    p_x, p_y = slip_x * (gas.q * turn) + n_x * push, slip_y * (gas.q * turn) + n_y * push
    turn *= n_x * slip_y - n_y * slip_x
    extra_push = 0.5 * max(0.0, min_speed - ((p_y * -2.0 + v) * n_y + (p_x * -2.0 + u) * n_x))
    p_x, p_y = p_x - n_x * extra_push, p_y - n_y * extra_push
    add_to_account(
        gas.account, gas.q, p_x * p_x + p_y * p_y - u * p_x - v * p_y, spin[i] + spin[j], turn
    )
    path[i, 0], path[i, 1], path[i, 4] = x_i, y_i, time
    path[j, 0], path[j, 1], path[j, 4] = x_j, y_j, time
    path[i, 2] -= p_x
    path[i, 3] -= p_y
    path[j, 2] += p_x
    path[j, 3] += p_y
    spin[i] += turn
    spin[j] += turn
    return -speed < min_speed


@jit
def add_to_account(account, q, work, spins, turn):
    """Add the energy gained to the account: of translation and of rotation."""
    if account is not None:
        account[0] += work
        account[1] += q * (spins * turn + turn * turn)
