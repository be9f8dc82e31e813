"""The floor."""

import math

import mpmath
import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from compiled import from_python

from hard_cases.falls import Exact, dyadic, general, nearly_at_rest
from roughgas.effects.motions import time_to_piecewise
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import BASE, BOUNDARY_HITS, NOW

time_to_floor = from_python(time_to_piecewise)
ROUNDING = 2.0**-53
LOWEST_SPEED = 1e-3  # a/T: lowest speed of particles that leave the floor, relative to it
PHASE = 0.3  # of the accelerating mode; not a dyadic number


def test_hits_near_the_return_of_the_floor_are_on_its_surface(margins):
    falls = margins.size(quick=600, full=30_000)
    rng = np.random.default_rng(0)
    depth = distance = 0.0
    with mpmath.workdps(50):
        for k in range(falls):
            fall = (dyadic if k % 2 else general)(rng)
            exact = Exact(*fall)
            t = mpmath.mpf(time_to_floor(*fall)[0])
            lengths = exact.lengths(t)
            depth = max(depth, exact.depth(t) / lengths)
            distance = max(distance, exact.miss(t) / lengths)
    tried = {"tried": falls, "unit": "falls"}
    margins.at_most("depth below the floor, over the lengths that enter", depth, 1e-15, **tried)
    margins.at_most("distance from the floor when it is hit, likewise", distance, 1e-15, **tried)


def test_slow_particles_take_off_from_the_floor(margins):
    starts = margins.size(quick=1000, full=50_000)
    rng = np.random.default_rng(1)
    distance = early = 0.0
    with mpmath.workdps(50):
        for _ in range(starts):
            start = nearly_at_rest(rng)
            exact = Exact(*start)
            t = mpmath.mpf(time_to_floor(*start)[0])
            speed = exact.v - exact.fastest
            # particles below the floor by rounding count as on it
            distance = max(
                distance, abs(exact.gap(t, 0) - min(0, exact.gap(0, 0))) / exact.lengths(t)
            )
            if speed > 0:
                early = max(early, 1 - t * exact.g / (2 * speed))
    tried = {"tried": starts, "unit": "starts"}
    margins.at_most("distance from the floor when it is hit, likewise", distance, 1e-15, **tried)
    # the time and its reference are both off by some roundings
    margins.at_most("share by which a hop from the floor is too short", early, 1e-15, **tried)


class Bouncer:
    """A single particle above a floor, in the scene of a bed."""

    def __init__(self, height, speed, width=10, gravity=1.0, **floor):
        experiment = settings(
            "bed", 1, [width, "open"], floor=floor, gravity={"acceleration": gravity}
        )
        self.scene, _ = begin(experiment, 1.0, 0.0)
        start = np.array([[3.0, 1.0 + float(height)]]), np.array([[0.0, float(speed)]])
        self.state = new_state(self.scene, *start, np.zeros((1, 1)))

    def run_to(self, time):
        """Advance to an absolute time."""
        clock = self.state.clock
        run(self.state, self.scene, 1, interval=(time - clock[BASE]) - clock[NOW])

    @property
    def hits(self):
        """Number of hits of the floor."""
        return int(self.state.counts[BOUNDARY_HITS])

    def last_hit(self):
        """(base of the clock, time since then, height, velocity) at the last hit."""
        _, y, _, v, time = self.state.trajectory[0]
        return self.state.clock[BASE], time, y - 1.0, v


def test_bounces_on_a_floor_at_rest_follow_the_closed_form(margins):
    bounces = margins.size(quick=10_000, full=300_000)
    height = 7.3
    bouncer = Bouncer(height, 0.0, amplitude=0.0)
    with mpmath.workdps(50):
        fall = mpmath.sqrt(2 * mpmath.mpf(height))
        late, fast = [], []
        for k in range(bounces):
            bouncer.run_to(float((2 * k + 2) * fall))
            assert bouncer.hits == k + 1
            base, time, _, speed = bouncer.last_hit()
            late.append(float(base - (2 * k + 1) * fall + time))
            fast.append(float(speed / fall - 1))
    k = np.arange(1, bounces + 1)
    # each bounce changes the speed by a rounding or two, as in a random walk, and errors of the
    # times are sums over this walk
    walk = np.max(np.abs(fast) / (ROUNDING * np.sqrt(k)))
    sums = np.max(np.abs(late) / (2 * float(fall) * ROUNDING * k**1.5))
    tried = {"tried": bounces, "unit": "bounces"}
    margins.at_most("error of the speed, in roundings of a random walk", walk, 10.0, **tried)
    margins.at_most("error of the time, in those of its sum", sums, 10.0, **tried)


@pytest.mark.parametrize(("amplitude", "flight", "gained"), [(0.25, 2, 1), (5.0, 20, 20)])
def test_the_accelerating_mode_follows_the_closed_form(margins, amplitude, flight, gained):
    """With g = period = 1 the k-th flight lasts `flight` + k `gained` periods.

    An error e of the speed w becomes e (w - V)/(w + V) in the next bounce: e w is nearly constant,
    and shifts each phase by 2 e/g. So errors do not grow exponentially: roundings of w, as in a
    random walk, add up to some 4 V/g roundings times k^2.5 in the phase.
    """
    bounces = margins.size(quick=10_000, full=10_000)
    bouncer = Bouncer(
        *_start_of_accelerating_mode(amplitude, flight), 1e9, amplitude=amplitude, period=1.0
    )
    shift, periods = [], 0
    for k in range(bounces):
        following = flight + gained * (k + 1)
        bouncer.run_to(periods + following // 2)
        assert bouncer.hits == k + 1
        base, time, _, _ = bouncer.last_hit()
        shift.append(abs(base - periods + time - PHASE))
        periods += following
    k = np.arange(1, bounces + 1)
    worst = np.max(shift / (4.0 * amplitude * ROUNDING * k**2.5))
    tried = {"tried": bounces, "unit": f"bounces, V = {amplitude:g} a/T"}
    margins.at_most("shift of the phase, in roundings of the law", worst, 10.0, **tried)
    margins.at_most("shift of the phase, in T", np.max(shift), 1e-4, **tried)


def _start_of_accelerating_mode(amplitude, flight):
    """(height, speed) at time 0 of a particle whose flight, in periods, ends at PHASE."""
    with mpmath.workdps(50):
        gone = flight - mpmath.mpf(PHASE)
        return amplitude * PHASE + flight * gone / 2 - gone**2 / 2, mpmath.mpf(flight) / 2 - gone


@pytest.mark.parametrize("amplitude", [0.0, 5.0])
@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_bounces_that_accumulate_come_to_an_end(margins, restitution, amplitude):
    """A particle leaves the floor at LOWEST_SPEED or more, relative to it.

    Until then, with u0 the speed at the first hit, the k-th flight lasts 2 u0 r^k/g.
    """
    period, height = 100.0, 7.3  # within a single stroke, at constant velocity of the floor
    floor = {"amplitude": amplitude, "period": period, "restitution": restitution}
    bouncer = Bouncer(height, 0.0, **floor)
    floor_speed = amplitude / period
    first = math.sqrt(floor_speed**2 + 2.0 * height)
    hit, leaving, late, slowest = first - floor_speed, first * restitution, 0.0, math.inf
    while True:
        bouncer.run_to(hit + leaving)
        base, time, _, speed = bouncer.last_hit()
        slowest = min(slowest, speed - floor_speed)
        if leaving < LOWEST_SPEED:
            break
        # a rounding of the height shifts a hit by this over the speed
        roundings = ROUNDING * (hit + (height + amplitude) / leaving)
        late = max(late, abs(base + time - hit) / roundings)
        hit, leaving = hit + 2.0 * leaving, leaving * restitution
    tried = {"tried": bouncer.hits, "unit": f"bounces, r = {restitution:g}, V = {floor_speed:g}"}
    # a flight passes a share r of its error on to the next flight
    limit = 3.0 / (1.0 - restitution)
    margins.at_most("error of the time of a bounce, in roundings", late, limit, **tried)
    margins.at_least(
        "speed at which the floor is left, in a/T", slowest, LOWEST_SPEED * 0.999999, **tried
    )
    _check_bounces_at_rest(margins, bouncer, floor_speed)


def _check_bounces_at_rest(margins, bouncer, floor_speed):
    """Small bounces last 2 LOWEST_SPEED/g and rise to LOWEST_SPEED^2/2g."""
    begin, hits = bouncer.last_hit()[0] + bouncer.state.clock[NOW], bouncer.hits
    highest = 0.0
    for k in range(1, 2001):
        bouncer.run_to(begin + k / 1000)
        shot = snapshot(bouncer.state, bouncer.scene)
        highest = max(highest, shot.position[0, 1] - 1.0 - floor_speed * shot.time)
    tried = {"tried": bouncer.hits - hits, "unit": "bounces at rest"}
    margins.at_most("bounces per T", 0.5 * tried["tried"], 0.5 / LOWEST_SPEED + 1.0, **tried)
    margins.at_most("height of these, in a", highest, 0.501 * LOWEST_SPEED**2, **tried)
