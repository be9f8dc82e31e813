"""Patterns of layers from fields with a known spectrum, and a layer over its drive."""

import math

import numpy as np
import pytest
from brute_force import settings
from tests.observables.frames import frame_of, system_of

from roughgas import simulate
from roughgas.observables.shaken_layer import FOLDS, Pattern, height_field, smoothed, spectrum

SIDE = 40.0
CELLS = 100
PERIOD = 2.0


def waves(number, angles, phase=0.3):
    """Return a sum of plane waves, one per angle, each with `number` wavelengths in a side."""
    x, y = np.meshgrid(*[(np.arange(CELLS) + 0.5) / CELLS] * 2, indexing="ij")
    coordinates = [x * math.cos(angle) + y * math.sin(angle) for angle in angles]
    return sum(
        np.cos(2 * math.pi * number * coordinate + phase * k)
        for k, coordinate in enumerate(coordinates)
    )


@pytest.mark.parametrize("number", [4, 5, 8, 13, 20])
def test_the_order_of_stripes_is_that_under_a_hann_window(number):
    """It adds a quarter of the peak's power one shell to either side along the stripes; additions
    across them are on other shells: Q_m = [1 + cos(m arctan(1/n))/2]/(3/2)."""
    pattern = spectrum(waves(number, [0.0]), (SIDE, SIDE))
    assert pattern.wavelength == pytest.approx(SIDE / number)
    for fold, order in zip(FOLDS, pattern.order, strict=True):
        expected = (1.0 + 0.5 * math.cos(fold * math.atan(1.0 / number))) / 1.5
        assert order == pytest.approx(expected, abs=0.01)


PATTERNS = {  # directions of the waves, their order Q_m, and by how much a window may lower it
    "stripes": ([0.7], 2, 0.02),
    "squares": ([0.2, 0.2 + math.pi / 2], 4, 0.05),
    "hexagons": ([0.1, 0.1 + math.pi / 3, 0.1 + 2 * math.pi / 3], 6, 0.1),
}


@pytest.mark.parametrize("name", PATTERNS)
def test_stripes_squares_and_hexagons_have_the_order_of_their_symmetry(name):
    """With twelve wavelengths in a side, in any direction; lower orders of a lattice vanish."""
    angles, symmetry, tolerance = PATTERNS[name]
    pattern = spectrum(waves(12, angles), (SIDE, SIDE))
    order = dict(zip(FOLDS, pattern.order, strict=True))
    assert 1.0 - tolerance < order[symmetry] <= 1.0
    assert all(order[fold] < 0.1 for fold in FOLDS if fold < symmetry)
    assert pattern.wavelength == pytest.approx(SIDE / 12)
    assert pattern.power.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("number", "orders"),
    [(2, [0.83, 0.47, 0.21]), (3, [0.93, 0.74, 0.51]), (5, [0.97, 0.89, 0.78])],
)
def test_few_wavelengths_in_a_side_lower_the_order(number, orders):
    """The means of perfect patterns in any direction, as in docs/observables.md; 0.04 is 4 errors
    of the most variable order."""
    rng = np.random.default_rng(7)
    for fold, expected in zip(FOLDS, orders, strict=True):
        samples = []
        for turn, phase in rng.uniform(0.0, 2.0 * math.pi, (200, 2)):
            angles = [turn + 2.0 * math.pi * k / fold for k in range(fold // 2)]
            order = spectrum(waves(number, angles, phase), (SIDE, SIDE)).order
            samples.append(order[FOLDS.index(fold)])
        assert np.mean(samples) == pytest.approx(expected, abs=0.04)


def test_noise_has_no_order():
    """97.8 % of fields have all orders below 1/2 (of 2000); 95 % of 500 is 4 sigma less."""
    rng = np.random.default_rng(3)
    orders = [spectrum(rng.standard_normal((32, 32)), (1.0, 1.0)).order for _ in range(500)]
    assert np.mean(np.max(orders, axis=1) < 0.5) > 0.95


def test_a_spectrum_is_that_of_a_sum_term_by_term():
    """Against the definition of the discrete Fourier transform, in an oblong box."""
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
    pattern = spectrum(field, sides)
    assert pattern.wavelength == pytest.approx(6.0 / best)
    for shell, power in shells.items():
        assert pattern.power[shell] == pytest.approx(power / sum(shells.values()), abs=1e-12)
    near = [(p, k) for p, k in peaks.values() if abs(math.hypot(*k) * 6.0 - best) <= 0.75]
    for fold, order in zip(FOLDS, pattern.order, strict=True):
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
    """Return positions of particles that cover a wavy layer, on a floor at 3 a."""
    x, y = np.meshgrid(*[np.arange(0.25, side, 0.5)] * 2)
    height = 5.0 + 1.5 * np.cos(2 * math.pi * x / wavelength + turned)
    return np.array([x.ravel(), y.ravel(), height.ravel() + 3.0]).T


def layered(side, particles):
    system = system_of((side, side, 1.0), particles=particles, period=PERIOD, interval=0.1)
    return system._replace(box=(side, side, None), periodic=(False, False, False))


def test_a_layer_in_stripes_has_their_wavelength_and_contrast():
    """Particles that cover a wavy layer: its wavelength and contrast, whatever the floor does."""
    position = stripes(60.0, 15.0)
    system = layered(60.0, len(position))
    pattern = Pattern(system, 100, 0.0, None, 1, 2)
    results = pattern.observe(frame_of(system, position, floor=3.0))
    assert results["wavelength_series"] == pytest.approx(15.0)
    assert results["fold_order_series"][0] > 0.95
    assert results["contrast"] == pytest.approx(1.5 / math.sqrt(2.0), rel=0.02)
    assert np.median(results["height_field"]) == pytest.approx(6.0, abs=0.1)


def test_turning_stripes_are_correlated_again_after_a_turn():
    """Four frames in a period; stripes turn by a quarter between frames: C_k = cos(pi k/2)."""
    quarters = [stripes(60.0, 15.0, math.pi / 2.0 * k) for k in range(4)]
    system = layered(60.0, len(quarters[0]))._replace(interval=PERIOD / 4)
    pattern = Pattern(system, 100, 0.0, 0.25, 4, 6)
    assert pattern.coordinates["pattern_phase"] == pytest.approx([0.25, 0.5, 0.75, 0.0])
    assert pattern.coordinates["pattern_delay"] == pytest.approx(np.arange(6) / 4)
    for k in range(6):
        frame = frame_of(system, quarters[k % 4], time=(k + 1) * PERIOD / 4, floor=3.0)
        results = pattern.observe(frame)
        has_mean = np.isfinite(results["mean_height"]).all(axis=(1, 2))
        assert np.flatnonzero(has_mean).tolist() == [k % 4]
        expected = [math.cos(math.pi / 2.0 * n) if n <= k else math.nan for n in range(6)]
        assert results["height_autocorrelation"] == pytest.approx(expected, abs=0.03, nan_ok=True)


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


def test_a_layer_is_averaged_by_the_phase_of_its_drive():
    """Its energy is E_trans phase by phase; the values of phases are means over the series."""
    dataset = layer(layer={"phases": 8}, pattern={"cells": 8, "phase": 0.5})
    assert dataset.layer_energy.mean() == pytest.approx(float(dataset.E_trans), rel=1e-12)
    phase = np.round(dataset.layer_time % PERIOD / PERIOD * 8) % 8
    for name in ("layer_height", "layer_depth", "layer_energy"):
        series = dataset[f"{name}_series"]
        means = [float(series[phase == k].mean()) for k in range(8)]
        assert dataset[name].values == pytest.approx(means, rel=1e-12)
        assert np.all(dataset[f"{name}_stderr"] > 0)
    assert np.ptp(dataset.layer_height.values) > 0.2  # the floor moves by 1 a
    assert dataset.pattern_time.values % PERIOD == pytest.approx(PERIOD / 2)
    assert dataset.height_field.shape == (12, 8, 8)
    weight = dataset.contrast_series**2
    for name in ("wavelength", "fold_order"):
        mean = dataset[f"{name}_series"].weighted(weight).mean("pattern_time")
        assert dataset[name].values == pytest.approx(mean.values, rel=1e-12)
    assert dataset.fold_order_series.dims == ("pattern_time", "fold")


def test_a_pattern_is_averaged_by_the_phase_of_its_drive():
    """Its mean heights and correlations follow from the height fields in the point."""
    dataset = layer(pattern={"cells": 8, "phase": 0.25, "phases": 2, "delays": 4})
    assert dataset.pattern_time.values % 1.0 == pytest.approx(0.5)  # twice in a period of 2 T
    fields = dataset.height_field.values
    for k in range(2):
        assert dataset.mean_height[k].values == pytest.approx(fields[k::2].mean(axis=0), rel=1e-12)
    assert np.all(dataset.mean_height_stderr > 0)
    flat = fields.reshape(len(fields), -1)
    for delay in range(4):
        pairs = [np.corrcoef(*pair)[0, 1] for pair in zip(flat, flat[delay:], strict=False)]
        periods = np.array([math.nan] * delay + pairs).reshape(-1, 2)  # of two frames
        periods = periods[np.isfinite(periods).any(axis=1)]
        expected = np.nanmean(periods, axis=1).mean()
        assert dataset.height_autocorrelation[delay] == pytest.approx(expected, rel=1e-9)
