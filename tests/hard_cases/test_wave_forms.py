"""Wave forms of the floor."""

import math

import mpmath
import numpy as np
import pytest
from brute_force import begin, run, settings
from compiled import from_python

from hard_cases.waves import DIGITS, exact, level, rise_of
from roughgas.effects import motions
from roughgas.effects.motions import Sine, triangle
from roughgas.kernel.state import BASE

MEET = {kind: from_python(law.meet) for kind, law in motions.LAWS.items() if law.meet}


def time_to_hit(floor, *fall):
    """Time until a fall meets the floor, by the kernel."""
    return MEET[type(floor)](floor, *fall)[0]


def measure(margins, falls, unit):
    """Measure depths of falls below the floor, and their distances from it at predicted hits."""
    depth = distance = 0.0
    tried = 0
    with mpmath.workdps(DIGITS):
        for fall in falls:
            tried += 1
            truth, t = exact(*fall), mpmath.mpf(time_to_hit(*fall))
            assert t >= 0, fall
            lengths = truth.lengths(t)
            depth = max(depth, truth.depth(t) / lengths)
            distance = max(distance, abs(truth.gap(t) - min(0, truth.gap(0))) / lengths)
    trials = {"tried": tried, "unit": unit}
    margins.at_most("depth below the floor, over the lengths that enter", depth, 1e-15, **trials)
    margins.at_most("distance from the floor when it is hit, likewise", distance, 1e-15, **trials)


def random_floor(rng):
    """A sine, or a triangle that rises in a half, in a tenth or in nine tenths of its period."""
    stroke = 10.0 ** rng.uniform(-2, 1), 10.0 ** rng.uniform(-1, 1)
    rise = rng.choice([0.0, 0.5, 0.1, 0.9])
    return Sine(*stroke) if rise == 0.0 else triangle(*stroke, rise)


def test_falls_onto_any_wave_meet_its_surface(margins):
    rng = np.random.default_rng(0)

    def fall():
        floor, gravity = random_floor(rng), 10.0 ** rng.uniform(-2, 2)
        phase = rng.uniform(-30.0, 3.0) * floor.period
        height = level(floor, phase) + 10.0 ** rng.uniform(-6, 2)
        return floor, gravity, height, 5.0 * math.sqrt(gravity) * rng.standard_normal(), phase

    measure(margins, (fall() for _ in range(margins.size(quick=200, full=10_000))), "falls")


def grazing_fall(rng):
    """A fall from above that touches a sine without crossing it, or nearly so.

    At the touch the floor accelerates downwards faster than the particle, sometimes hardly so: then
    three roots of the gap are close together.
    """
    while True:
        floor, gravity = Sine(10.0 ** rng.uniform(-2, 1), 10.0 ** rng.uniform(-1, 1)), 1.0
        rate = 2.0 * math.pi / floor.period
        sharpest = 0.5 * floor.amplitude * rate * rate
        if sharpest <= gravity:
            continue
        edge = math.acos(-gravity / sharpest) / (2.0 * math.pi)
        share = rng.random() * 10.0 ** rng.choice([0.0, rng.uniform(-8, 0)])
        touch = edge + (1.0 - 2.0 * edge) * share
        before = rng.uniform(0.0, 0.3) * floor.period
        angle = 2.0 * math.pi * touch
        surface = 0.5 * floor.amplitude * (1.0 - math.cos(angle))
        falling = 0.5 * floor.amplitude * rate * math.sin(angle)
        height = surface - falling * before - 0.5 * gravity * before * before
        speed = falling + gravity * before
        phase = touch * floor.period - before + floor.period
        waits = np.linspace(0.0, 0.99, 200) * before
        heights = height + speed * waits - 0.5 * gravity * waits**2
        if all(y > level(floor, phase + t) for y, t in zip(heights, waits, strict=True)):
            shift = rng.choice([-1.0, 0.0, 1.0]) * 10.0 ** rng.uniform(-16, -6) * floor.amplitude
            if height + shift > level(floor, phase):  # no fall starts below the floor
                return floor, gravity, height + shift, speed, phase


@pytest.mark.slow
def test_grazing_falls_onto_sines_meet_the_surface(margins):
    rng = np.random.default_rng(1)
    falls = (grazing_fall(rng) for _ in range(margins.size(quick=200, full=10_000)))
    measure(margins, falls, "falls")


def test_falls_onto_turning_points_meet_the_surface(margins):
    rng = np.random.default_rng(2)

    def fall():
        """A fall of dyadic numbers that meets the floor at a turning point, or nearly so."""
        floor = triangle(*(2.0 ** rng.integers(-3, 3, 2)), rng.choice([0.5, 0.25]))
        crest = rng.integers(0, 2)
        before = rng.integers(1, 16) / 16.0 * floor.period * (rise_of(floor) if crest else 0.5)
        phase = floor.period * (1.0 + (rise_of(floor) if crest else 0.0)) - before
        gravity, arrives = 2.0 ** rng.integers(-4, 4), -rng.integers(0, 256) / 8.0
        speed = arrives + gravity * before
        height = floor.amplitude * crest - speed * before + 0.5 * gravity * before * before
        height = max(height, level(floor, phase))
        return floor, gravity, height + rng.integers(-1, 2) * 2.0**-50 * height, speed, phase

    measure(margins, (fall() for _ in range(margins.size(quick=400, full=30_000))), "falls")


def test_particles_take_off_from_a_moving_floor(margins):
    rng = np.random.default_rng(3)
    starts = margins.size(quick=300, full=20_000)
    early = 0.0
    falls = []
    for _ in range(starts):
        floor, gravity = random_floor(rng), 10.0 ** rng.uniform(-2, 2)
        phase = rng.random() * floor.period
        truth = exact(floor, gravity, 0.0, 0.0, phase)
        height, rising = map(float, truth.surface(0))
        leaving = 10.0 ** rng.uniform(-3, 0)
        gap = rng.choice([0.0, -1e-16, 1e-16]) * floor.amplitude
        falls.append((floor, gravity, height + gap, rising + leaving, phase))
        if isinstance(floor, Sine):
            bend = gravity + 0.5 * floor.amplitude * (2.0 * math.pi / floor.period) ** 2
            early = max(early, 1.0 - time_to_hit(*falls[-1]) * bend / (2.0 * leaving))
    measure(margins, falls, "starts")
    tried = {"tried": starts, "unit": "starts"}
    # the initial height is off by some roundings of the amplitude
    margins.at_most("share by which a hop from a sine is too short", early, 1e-6, **tried)


# each of these forms compiles a kernel
SLOW_FORMS = [
    pytest.param(form, marks=pytest.mark.slow) for form in ("reversed_sawtooth", "triangle", "sine")
]


@pytest.mark.parametrize("form", ["sawtooth", *SLOW_FORMS])
def test_no_particle_falls_through_the_floor(margins, form):
    instants = margins.size(quick=300, full=20_000)
    # on a floor at rest a gas that dissipates would come to rest
    deepest, lossy, elastic = -math.inf, (0.9, 0.2), (1.0, -1.0)
    for amplitude, period, material in ((5.0, 1.0, lossy), (0.3, 0.2, lossy), (0.0, 1.0, elastic)):
        floor = {"amplitude": amplitude, "period": period, "wave": form}
        scene, state = begin(settings("bed", 40, [12.5, "open"], floor=floor), *material, 3)
        for _ in range(instants):
            run(state, scene, 1, interval=0.137)
            # each at its last event, which often is a hit of the floor
            phases = state.clock[BASE] % period + state.trajectory[:, 4]
            for height, phase in zip(state.trajectory[:, 1], phases, strict=True):
                deepest = max(
                    deepest, 1.0 + level(scene.effects.floor.motion, phase % period) - height
                )
    tried = {"tried": 3 * instants, "unit": f"instants, {form.replace('_', ' ')}"}
    margins.at_most("depth below the floor, in a", deepest, 1e-12, **tried)
