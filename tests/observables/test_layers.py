"""The pattern of a layer from fields whose answer is known, and a layer over its drive."""

import math

import numpy as np
import pytest
from brute_force import settings
from tests.observables.frames import frame_of, system_of

from roughgas import simulate
from roughgas.observables.layers import FOLDS, Pattern, height_field, smoothed, spectrum

SIDE = 40.0
CELLS = 100
PERIOD = 2.0


def waves(number, angles, phase=0.3):
    """A sum of plane waves with so many wavelengths in a side, one for each direction."""
    x, y = np.meshgrid(*[(np.arange(CELLS) + 0.5) / CELLS] * 2, indexing="ij")
    along = [x * math.cos(angle) + y * math.sin(angle) for angle in angles]
    return sum(np.cos(2 * math.pi * number * one + phase * k) for k, one in enumerate(along))


@pytest.mark.parametrize("number", [4, 5, 8, 13, 20])
def test_the_order_of_stripes_is_what_a_hann_window_leaves(number):
    """It adds a quarter of the power of the peak one shell to either side along the stripes, and
    what it adds across them is on other shells: Q_m = [1 + cos(m arctan(1/n))/2]/(3/2)."""
    found = spectrum(waves(number, [0.0]), (SIDE, SIDE))
    assert found.wavelength == pytest.approx(SIDE / number)
    for fold, order in zip(FOLDS, found.order, strict=True):
        expected = (1.0 + 0.5 * math.cos(fold * math.atan(1.0 / number))) / 1.5
        assert order == pytest.approx(expected, abs=0.01)


PATTERNS = {  # directions of the waves, their order Q_m, and by how much a window may lower it
    "stripes": ([0.7], 2, 0.02),
    "squares": ([0.2, 0.2 + math.pi / 2], 4, 0.05),
    "hexagons": ([0.1, 0.1 + math.pi / 3, 0.1 + 2 * math.pi / 3], 6, 0.1),
}


@pytest.mark.parametrize("name", PATTERNS)
def test_stripes_squares_and_hexagons_have_their_own_order(name):
    """With twelve wavelengths in a side, in any direction; lower orders of a lattice vanish."""
    angles, own, tolerance = PATTERNS[name]
    found = spectrum(waves(12, angles), (SIDE, SIDE))
    order = dict(zip(FOLDS, found.order, strict=True))
    assert 1.0 - tolerance < order[own] <= 1.0
    assert all(order[fold] < 0.1 for fold in FOLDS if fold < own)
    assert found.wavelength == pytest.approx(SIDE / 12)
    assert found.power.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("number", "told"), [(2, [0.83, 0.47, 0.21]), (3, [0.93, 0.74, 0.51]), (5, [0.97, 0.89, 0.78])]
)
def test_few_wavelengths_in_a_side_lower_the_order(number, told):
    """The means of perfect patterns in any direction, as docs/observables.md has them; 0.04 is 4
    errors of what varies most."""
    rng = np.random.default_rng(7)
    for fold, expected in zip(FOLDS, told, strict=True):
        found = []
        for turn, phase in rng.uniform(0.0, 2.0 * math.pi, (200, 2)):
            angles = [turn + 2.0 * math.pi * k / fold for k in range(fold // 2)]
            order = spectrum(waves(number, angles, phase), (SIDE, SIDE)).order
            found.append(order[FOLDS.index(fold)])
        assert np.mean(found) == pytest.approx(expected, abs=0.04)


def test_noise_has_no_order():
    """97.8 % of fields have all orders below 1/2 (of 2000); 95 % of 500 is 4 sigma less."""
    rng = np.random.default_rng(3)
    found = [spectrum(rng.standard_normal((32, 32)), (1.0, 1.0)).order for _ in range(500)]
    assert np.mean(np.max(found, axis=1) < 0.5) > 0.95


def test_a_spectrum_is_that_of_a_sum_term_by_term():
    """By another way: a discrete Fourier transform as it is defined, in an oblong box."""
    rng = np.random.default_rng(5)
    field, sides = rng.standard_normal((12, 9)), (6.0, 4.0)
    n, m = field.shape
    w = [0.5 - 0.5 * np.cos(2 * np.pi * np.arange(k) / (k - 1)) for k in (n, m)]
    weighed = (field - field.mean()) * w[0][:, None] * w[1]
    shells, peaks = {}, {}
    for a in range(-(n // 2), (n + 1) // 2):
        for b in range(-(m // 2), (m + 1) // 2):
            turns = a * np.arange(n)[:, None] / n + b * np.arange(m) / m
            power = abs((weighed * np.exp(-2j * np.pi * turns)).sum()) ** 2
            k = np.array([a / sides[0], b / sides[1]])
            peaks[a, b] = power, k
            shell = round(math.hypot(*k) * 6.0)
            shells[shell] = shells.get(shell, 0.0) + power * (shell >= 2)
    best = max(shells, key=shells.get)
    found = spectrum(field, sides)
    assert found.wavelength == pytest.approx(6.0 / best)
    for shell, power in shells.items():
        assert found.power[shell] == pytest.approx(power / sum(shells.values()), abs=1e-12)
    near = [(p, k) for p, k in peaks.values() if abs(math.hypot(*k) * 6.0 - best) <= 0.75]
    for fold, order in zip(FOLDS, found.order, strict=True):
        total = sum(p * complex(*k) ** fold / abs(complex(*k)) ** fold for p, k in near)
        assert order == pytest.approx(abs(total) / sum(p for p, _ in near), rel=1e-9)


def test_smoothing_keeps_the_mean_and_damps_each_wave_by_its_gaussian():
    for number in (1, 4, 9):
        field = 2.0 + waves(number, [0.0])
        gain = math.exp(-2.0 * (math.pi * 2.0 * number / CELLS) ** 2)
        assert smoothed(field, 2.0) == pytest.approx(2.0 + gain * (field - 2.0), abs=1e-12)


def test_a_height_field_is_that_of_a_loop_over_particles():
    rng = np.random.default_rng(2)
    position = rng.uniform(0.0, 1.0, (200, 3)) * [SIDE, 30.0, 9.0]
    radius = rng.uniform(0.5, 1.5, 200)
    highest = {}
    for (x, y, z), a in zip(position, radius, strict=True):
        cell = min(int(x / SIDE * 8), 7), min(int(y / 30.0 * 8), 7)
        highest[cell] = max(highest.get(cell, -1.0), z + a)
    middle = np.median(list(highest.values()))
    expected = [[highest.get((i, j), middle) for j in range(8)] for i in range(8)]
    assert 40 < len(highest) < 64  # some are empty
    assert height_field(position, radius, (SIDE, 30.0), 8) == pytest.approx(np.array(expected))


def stripes(side, wavelength, turned=0.0):
    """Particles that cover a wavy layer, on a floor at 3 a."""
    x, y = np.meshgrid(*[np.arange(0.25, side, 0.5)] * 2)
    height = 5.0 + 1.5 * np.cos(2 * math.pi * x / wavelength + turned)
    return np.array([x.ravel(), y.ravel(), height.ravel() + 3.0]).T


def layered(side, particles):
    system = system_of((side, side, 1.0), particles=particles, period=PERIOD, interval=0.1)
    return system._replace(box=(side, side, None), periodic=(False, False, False))


def test_a_layer_that_stands_in_stripes():
    """Particles that cover a wavy layer: its wavelength and contrast, whatever the floor does."""
    position = stripes(60.0, 15.0)
    system = layered(60.0, len(position))
    pattern = Pattern(system, 100, 0.0, None, 1, 2)
    found = pattern.look(frame_of(system, position, floor=3.0))
    assert found["wavelength_series"] == pytest.approx(15.0)
    assert found["fold_order_series"][0] > 0.95
    assert found["contrast"] == pytest.approx(1.5 / math.sqrt(2.0), rel=0.02)
    assert np.median(found["height_field"]) == pytest.approx(6.0, abs=0.1)


def test_stripes_that_turn_come_back_after_a_turn():
    """Four looks in a period; in each stripes turn by a quarter: C_k = cos(pi k/2)."""
    quarters = [stripes(60.0, 15.0, math.pi / 2.0 * k) for k in range(4)]
    system = layered(60.0, len(quarters[0]))._replace(interval=PERIOD / 4)
    pattern = Pattern(system, 100, 0.0, 0.25, 4, 6)
    assert pattern.coordinates["pattern_phase"] == pytest.approx([0.25, 0.5, 0.75, 0.0])
    assert pattern.coordinates["pattern_delay"] == pytest.approx(np.arange(6) / 4)
    for k in range(6):
        frame = frame_of(system, quarters[k % 4], time=(k + 1) * PERIOD / 4, floor=3.0)
        found = pattern.look(frame)
        there = np.isfinite(found["mean_height"]).all(axis=(1, 2))
        assert np.flatnonzero(there).tolist() == [k % 4]
        expected = [math.cos(math.pi / 2.0 * n) if n <= k else math.nan for n in range(6)]
        assert found["height_autocorrelation"] == pytest.approx(expected, abs=0.03, nan_ok=True)


LAYER = settings("layer", 48) | {
    "schedule": {
        "kind": "steady",
        "equilibrate": 4.0,
        "measure": 24.0,
        "sample_every": 0.25,
        "period": PERIOD,
    }
}


def layer(**observe):
    return simulate(r=0.7, beta=0.35, observe=observe, progress=False, **LAYER)


def test_a_layer_over_the_phase_of_its_drive():
    """Its energy is E_trans phase by phase, the series is what the phases are means of."""
    found = layer(layer={"phases": 8}, pattern={"cells": 8, "phase": 0.5})
    assert found.layer_energy.mean() == pytest.approx(float(found.E_trans), rel=1e-12)
    phase = np.round(found.layer_time % PERIOD / PERIOD * 8) % 8
    for name in ("layer_height", "layer_depth", "layer_energy"):
        series = found[f"{name}_series"]
        means = [float(series[phase == k].mean()) for k in range(8)]
        assert found[name].values == pytest.approx(means, rel=1e-12)
        assert np.all(found[f"{name}_stderr"] > 0)
    assert np.ptp(found.layer_height.values) > 0.2  # the floor moves by 1 a
    assert found.pattern_time.values % PERIOD == pytest.approx(PERIOD / 2)
    assert found.height_field.shape == (12, 8, 8)
    weight = found.contrast_series**2
    for name in ("wavelength", "fold_order"):
        mean = found[f"{name}_series"].weighted(weight).mean("pattern_time")
        assert found[name].values == pytest.approx(mean.values, rel=1e-12)
    assert found.fold_order_series.dims == ("pattern_time", "fold")


def test_a_pattern_over_the_phases_of_its_drive():
    """Its mean heights and correlations are those of the fields that points keep."""
    found = layer(pattern={"cells": 8, "phase": 0.25, "phases": 2, "delays": 4})
    assert found.pattern_time.values % 1.0 == pytest.approx(0.5)  # twice in a period of 2 T
    fields = found.height_field.values
    for k in range(2):
        assert found.mean_height[k].values == pytest.approx(fields[k::2].mean(axis=0), rel=1e-12)
    assert np.all(found.mean_height_stderr > 0)
    flat = fields.reshape(len(fields), -1)
    for delay in range(4):
        pairs = [np.corrcoef(*pair)[0, 1] for pair in zip(flat, flat[delay:], strict=False)]
        periods = np.array([math.nan] * delay + pairs).reshape(-1, 2)  # of two looks
        periods = periods[np.isfinite(periods).any(axis=1)]
        expected = np.nanmean(periods, axis=1).mean()
        assert found.height_autocorrelation[delay] == pytest.approx(expected, rel=1e-9)
