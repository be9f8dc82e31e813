"""A shaken layer: its depth and energy over the phase of the drive, and the pattern from above.

The pattern is that of C. Bizon, M. D. Shattuck, J. B. Swift, W. D. McCormick and H. L. Swinney,
Phys. Rev. Lett. 80, 57 (1998), taken as the public code granular_benchmark of C. Bizon takes it.
The height of a cell is that of the highest surface of a particle in it, above the floor; an empty
one has the median of the others. The field is smoothed by a Gaussian, as if it were periodic. Of
the field without its mean, times a Hann window along each axis, the power P of the Fourier
transform is summed in shells of wavenumbers (inverse wavelengths) n/L, L the longer side of the
box and n = 2, 3, ...; the first two shells hold what the window leaves of the mean. The shell with
most power has the wavelength L/n, half a shell uncertain. On it, within 3/4 of a shell's width,

    Q_m = |sum P exp(i m angle)| / sum P

is the m-fold order: Q_2 is 1 for stripes, Q_4 for squares, Q_6 for hexagons. A window widens each
peak by a shell or so, which lowers Q_m the more, the larger m and the fewer wavelengths there are.
Averages over looks of shares of power, wavelength and Q_m have the variance of the field as weight,
as a layer in flight has hardly any pattern.

A pattern may need several cycles of the drive to repeat. With z' the smoothed field without its
mean, C_k = <z'(t) z'(t + k)>/sqrt(<z'^2>(t) <z'^2>(t + k)) over all cells is the correlation of
fields k looks apart: 1 after as many as it repeats after.
"""

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np

from roughgas.base import InputError, NeedsError
from roughgas.data.variables import ENERGY, LENGTH, TIME, Variable
from roughgas.effects.settings import Number
from roughgas.observables.plugin import Frame, Observable, Setting, System, Values, Whole

FOLDS = (2, 4, 6)
FIRST_SHELL = 2
ANNULUS = 0.75  # of a shell's width, to either side
DEPTH = (5.0, 95.0)  # percentiles of height, between which the depth of a layer is
ALONG = ("layer_phase",)
LOOKS, PATTERNS = ("layer_time",), ("pattern_time",)
PHASES, DELAYS = ("pattern_phase",), ("pattern_delay",)
WEIGHED = ("shell_power", "wavelength", "fold_order")
"""Variables of a pattern that are averaged with the variance of the field as weight."""


class Spectrum(NamedTuple):
    """What the Fourier transform of a field in a plane says."""

    wavenumber: np.ndarray  # (S,) inverse wavelengths of the shells, in 1/a
    power: np.ndarray  # (S,) share of each shell in the power
    wavelength: float  # of the shell with most power, in a; NaN of a field that is flat
    order: np.ndarray  # (3,) Q_2, Q_4 and Q_6 on that shell


def height_field(
    position: np.ndarray, radius: np.ndarray, sides: Sequence[float], cells: int
) -> np.ndarray:
    """Return the highest surface in each of cells x cells cells, in a.

    `position` (N, 3) has heights above the floor, `sides` the lengths of the box along the first
    two axes, in a.
    """
    place = np.floor(position[:, :2] * cells / np.asarray(sides)).astype(int)
    place = np.clip(place, 0, cells - 1)
    field = np.full((cells, cells), -math.inf)
    np.maximum.at(field, (place[:, 0], place[:, 1]), position[:, 2] + radius)
    there = np.isfinite(field)
    return np.where(there, field, np.median(field[there]))


def smoothed(field: np.ndarray, width: float) -> np.ndarray:
    """Return a periodic field, smoothed by a Gaussian of this standard deviation, in cells."""
    gain = [np.exp(-2.0 * (math.pi * width * np.fft.fftfreq(n)) ** 2) for n in field.shape]
    return np.fft.ifft2(np.fft.fft2(field) * np.outer(*gain)).real


def spectrum(field: np.ndarray, sides: Sequence[float]) -> Spectrum:
    """Return the power of a field in shells of wavenumbers, its wavelength and its order.

    `field` (n, m) covers a rectangle with these `sides` in a; it may be anything.
    """
    window = np.outer(*(np.hanning(n) for n in field.shape))
    power = abs(np.fft.fft2((field - field.mean()) * window)) ** 2
    axes = [np.fft.fftfreq(n, side / n) for n, side in zip(field.shape, sides, strict=True)]
    along, across = np.meshgrid(*axes, indexing="ij")
    size, width = np.hypot(along, across), 1.0 / max(sides)
    shell = np.rint(size / width).astype(int)
    shells = np.bincount(shell.ravel(), power.ravel())
    shells[:FIRST_SHELL] = 0.0
    wavenumber, total = np.arange(len(shells)) * width, shells.sum()
    if not total > 0.0:
        nothing = np.full(len(FOLDS), math.nan)
        return Spectrum(wavenumber, np.full(len(shells), math.nan), math.nan, nothing)
    peak = wavenumber[shells.argmax()]
    near = abs(size - peak) <= ANNULUS * width
    angle, weight = np.arctan2(across[near], along[near]), power[near]
    order = [abs(weight @ np.exp(1j * fold * angle)) / weight.sum() for fold in FOLDS]
    return Spectrum(wavenumber, shells / total, float(1.0 / peak), np.array(order))


def period_of(name: str, system: System) -> float:
    """Return the period of a run in T; raise InputError where it has none, or no floor."""
    if system.period is None:
        raise NeedsError(f"observables.{name}", "schedule.period")
    if system.box[-1] is not None and system.periodic[-1]:
        raise NeedsError(f"observables.{name}", "a floor")
    return system.period


class Layer(Observable):
    """Height, depth and energy of a shaken layer over the phase of its drive."""

    settings: ClassVar[Mapping[str, Setting]] = {
        "phases": Whole("Number of phases in schedule.period.", 1, 10_000, 20)
    }
    relaxations = 24.0
    variables: Mapping[str, Variable] = {
        "layer_phase": Variable("share of schedule.period that has passed", "1", ALONG),
        "layer_height": Variable("mean height above the floor", LENGTH, ALONG),
        "layer_depth": Variable("height between the 5th and 95th percentile", LENGTH, ALONG),
        "layer_energy": Variable("E_trans at this phase", ENERGY, ALONG),
        "layer_time": Variable("when the layer was looked at, since the start", TIME, LOOKS),
        "layer_height_series": Variable("mean height above the floor", LENGTH, LOOKS),
        "layer_depth_series": Variable("height between the 5th and 95th percentile", LENGTH, LOOKS),
        "layer_energy_series": Variable("E_trans", ENERGY, LOOKS),
    }
    kept: tuple[str, ...] = (
        "layer_time",
        "layer_height_series",
        "layer_depth_series",
        "layer_energy_series",
    )

    def __init__(self, system: System, phases: int) -> None:
        super().__init__(system)
        self._period, self._phases = period_of("layer", system), phases
        self.coordinates = {"layer_phase": np.arange(phases) / phases}

    def look(self, frame: Frame) -> Values:
        """Return what the layer is like, at the phase that is now; NaN at the others."""
        low, high = np.percentile(frame.position[:, -1], DEPTH)
        found = {
            "layer_height": frame.position[:, -1].mean() - frame.floor,
            "layer_depth": high - low,
            "layer_energy": 0.5 * np.mean(frame.mass[:, None] * frame.velocity**2),
        }
        now = round(frame.time / self._period % 1.0 * self._phases) % self._phases
        at_phase = {name: np.full(self._phases, math.nan) for name in found}
        for name, value in found.items():
            at_phase[name][now] = value
        series = {f"{name}_series": np.array(value) for name, value in found.items()}
        return at_phase | series | {"layer_time": np.array(frame.time)}


class Pattern(Observable):
    """The height of a layer from above, its wavelength, and its two-, four- and sixfold order."""

    settings: ClassVar[Mapping[str, Setting]] = {
        "cells": Whole("Number of cells along each side.", 4, 2000, 100),
        "smoothing": Number("Width of the Gaussian that smooths, in cells.", "[0, 100]", 2.0),
        "phase": Number(
            "Share of schedule.period at which it looks; at every observation if not given.",
            "[0, 1)",
        ),
        "phases": Whole("Number of phases, evenly spaced from `phase` on.", 1, 1000, 1),
        "delays": Whole("Number of delays, the first one 0, of the autocorrelation.", 2, 1000, 5),
    }
    variables: Mapping[str, Variable] = {
        "wavenumber": Variable("inverse wavelength of a shell", f"{LENGTH}^-1", ("wavenumber",)),
        "fold": Variable("m of the m-fold order", "1", ("fold",)),
        "cell_x": Variable("middle of a cell", LENGTH, ("cell_x",)),
        "cell_y": Variable("middle of a cell", LENGTH, ("cell_y",)),
        "pattern_phase": Variable("share of schedule.period that has passed", "1", PHASES),
        "pattern_delay": Variable("share of schedule.period between two looks", "1", DELAYS),
        "shell_power": Variable("share of a shell in the power", "1", ("wavenumber",)),
        "contrast": Variable("standard deviation of the height", LENGTH),
        "wavelength": Variable("wavelength of the shell with most power", LENGTH),
        "wavelength_resolution": Variable("half a shell, as a wavelength", LENGTH),
        "fold_order": Variable("m-fold order on that shell", "1", ("fold",)),
        "mean_height": Variable(
            "mean height above the floor at a phase", LENGTH, (*PHASES, "cell_x", "cell_y")
        ),
        "height_autocorrelation": Variable("autocorrelation of the height", "1", DELAYS),
        "pattern_time": Variable("when the pattern was looked at, since the start", TIME, PATTERNS),
        "contrast_series": Variable("standard deviation of the height", LENGTH, PATTERNS),
        "wavelength_series": Variable("wavelength of the shell with most power", LENGTH, PATTERNS),
        "fold_order_series": Variable("m-fold order on that shell", "1", (*PATTERNS, "fold")),
        "height_field": Variable(
            "height above the floor, smoothed", LENGTH, (*PATTERNS, "cell_x", "cell_y")
        ),
    }
    kept: tuple[str, ...] = (
        "pattern_time",
        "contrast_series",
        "wavelength_series",
        "fold_order_series",
        "height_field",
    )

    def __init__(
        self,
        system: System,
        cells: int,
        smoothing: float,
        phase: float | None,
        phases: int,
        delays: int,
    ) -> None:
        super().__init__(system)
        self._period = period_of("pattern", system)
        if system.dimension != 3:
            raise InputError("observables.pattern", "of disks", "be of spheres")
        self._sides = [side or math.nan for side in system.box[:2]]
        self._cells, self._smoothing = cells, smoothing
        self._phase, self._phases = phase, phases
        self._before: deque[np.ndarray] = deque(maxlen=delays)
        flat = spectrum(np.zeros((cells, cells)), self._sides)
        nowhere = np.full((phases, cells, cells), math.nan)
        nothing = self._found(math.nan, nowhere, 0, flat, np.full(delays, math.nan))
        self._nothing = {name: np.full_like(one, math.nan) for name, one in nothing.items()}
        middles = (np.arange(cells) + 0.5) / cells
        apart = system.interval / self._period if phase is None else 1.0 / phases
        self.coordinates: dict[str, Any] = {
            "wavenumber": flat.wavenumber,
            "fold": np.array(FOLDS),
            "cell_x": middles * self._sides[0],
            "cell_y": middles * self._sides[1],
            "pattern_phase": ((phase or 0.0) + np.arange(phases) / phases) % 1.0,
            "pattern_delay": np.arange(delays) * apart,
        }

    def look(self, frame: Frame) -> Values:
        """Return the field, and what its transform says; NaN at other phases."""
        now = self._phase_of(frame)
        if now is None:
            return self._nothing
        position = frame.position - [0.0, 0.0, frame.floor]
        field = height_field(position, frame.radius, self._sides, self._cells)
        field = smoothed(field, self._smoothing)
        at_phase = np.full((self._phases, *field.shape), math.nan)
        at_phase[now] = field
        about = spectrum(field, self._sides)
        return self._found(frame.time, at_phase, now, about, self._correlations(field))

    def _phase_of(self, frame):
        """Return the number of the phase that is now; None between phases."""
        if self._phase is None:
            return 0
        passed = (frame.time / self._period - self._phase) * self._phases
        off = (passed + 0.5) % 1.0 - 0.5
        step = self.system.interval / self._period * self._phases
        return round(passed - off) % self._phases if -0.5 * step < off <= 0.5 * step else None

    def _correlations(self, field):
        """Return the correlation (delays,) of a field with this one and earlier ones."""
        about = field - field.mean()
        norm = np.linalg.norm(about)
        self._before.appendleft(about / norm if norm > 0.0 else np.full_like(about, math.nan))
        found = np.full(self._before.maxlen or 0, math.nan)
        found[: len(self._before)] = [(self._before[0] * one).sum() for one in self._before]
        return found

    def _found(self, time, at_phase, now, about, correlations):
        field = at_phase[now]
        variance, wavelength = np.array(field.var()), np.array(about.wavelength)
        contrast, seen = np.sqrt(variance), (about.power, wavelength, about.order)
        # of a field that is flat these are NaN: it has no weight
        weighed = {n: np.nan_to_num(variance * x) for n, x in zip(WEIGHED, seen, strict=True)}
        return weighed | {
            "contrast": contrast,
            "variance": variance,
            "mean_height": at_phase,
            "height_autocorrelation": correlations,
            "pattern_time": np.array(time),
            "contrast_series": contrast,
            "wavelength_series": wavelength,
            "fold_order_series": about.order,
            "height_field": field,
        }

    def combine(self, means: Values) -> Values:
        """Return the means, and how much of a wavelength half a shell is."""
        found = dict(means)
        variance = found.pop("variance")
        found |= {name: means[name] / variance for name in WEIGHED}
        half = found["wavelength"] ** 2 / (2.0 * max(self._sides))
        return found | {"wavelength_resolution": half}
