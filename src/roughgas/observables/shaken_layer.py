"""A shaken layer: its depth and energy over the phase of the drive, and its pattern from above.

The pattern is defined as in C. Bizon, M. D. Shattuck, J. B. Swift, W. D. McCormick and H. L.
Swinney, Phys. Rev. Lett. 80, 57 (1998), and evaluated as in the public code granular_benchmark of
C. Bizon. The height of a cell is the height above the floor of the highest surface of a particle in
it; an empty cell has the median of the occupied cells. The field is smoothed by a Gaussian, as if
it were periodic. The mean is subtracted, and the field is multiplied by a Hann window along each
axis. The power P of its Fourier transform is summed in shells of wavenumbers (inverse wavelengths)
n/L, L the longer side of the box and n = 2, 3, ...; the first two shells contain the leakage of the
mean by the window. The shell with most power has the wavelength L/n, uncertain by half a shell. On
it, within 3/4 of the width of a shell,

    Q_m = |sum P exp(i m angle)| / sum P

is the m-fold order: Q_2 is 1 for stripes, Q_4 for squares, Q_6 for hexagons. A window widens each
peak by about a shell, which lowers Q_m; more for large m and few wavelengths in the box. Averages
over observations of shares of power, wavelength and Q_m are weighted with the variance of the
field, as a layer in flight has hardly any pattern.

A pattern may need several cycles of the drive to repeat. With z' the smoothed field without its
mean, C_k = <z'(t) z'(t + k)>/sqrt(<z'^2>(t) <z'^2>(t + k)) over all cells is the correlation of
fields k observations apart: C_k = 1 if the pattern repeats after k observations.

Arrays (k, ...) are of the k instants of a FrameSeries.
"""

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np

from roughgas.base import InputError, NeedsError
from roughgas.base.fields import number, whole
from roughgas.data.variables import ENERGY, LENGTH, TIME, Variable
from roughgas.observables.averages import NamedArrays
from roughgas.observables.frames import Frame, FrameSeries, System
from roughgas.observables.plugin import Observable, ObservableSettings

FOLDS = (2, 4, 6)
FIRST_COUNTED_SHELL = 2
ANNULUS_HALF_WIDTH = 0.75  # in widths of a shell
DEPTH_PERCENTILES = (5.0, 95.0)  # the depth of a layer is the distance of these heights
LAYER_PHASE_DIMS = ("layer_phase",)
LAYER_TIME_DIMS, PATTERN_TIME_DIMS = ("layer_time",), ("pattern_time",)
PATTERN_PHASE_DIMS, PATTERN_DELAY_DIMS = ("pattern_phase",), ("pattern_delay",)
VARIANCE_WEIGHTED = ("shell_power", "wavelength", "fold_order")
"""Variables of a pattern that are averaged with the variance of the field as weight."""


class Spectrum(NamedTuple):
    """Power spectrum of a field in a plane, its wavelength and its orders."""

    wavenumber: np.ndarray  # (S,) inverse wavelengths of the shells, in 1/a
    power: np.ndarray  # (S,) share of each shell in the power
    wavelength: float  # of the shell with most power, in a; NaN for a flat field
    order: np.ndarray  # (3,) Q_2, Q_4 and Q_6 on that shell


def height_field(
    position: np.ndarray, radius: np.ndarray, sides: Sequence[float], cells: int
) -> np.ndarray:
    """Return the height of the highest surface in each cell, (cells, cells), in particle radii a.

    `position` (N, 3) has heights above the floor, `radius` is (N,), `sides` the lengths of the box
    along the first two axes, all in a; `cells` is the number of cells along each side.
    """
    cell_index = np.floor(position[:, :2] * cells / np.asarray(sides)).astype(int)
    cell_index = np.clip(cell_index, 0, cells - 1)
    field = np.full((cells, cells), -math.inf)
    np.maximum.at(field, (cell_index[:, 0], cell_index[:, 1]), position[:, 2] + radius)
    occupied = np.isfinite(field)
    return np.where(occupied, field, np.median(field[occupied]))


def smoothed(field: np.ndarray, width: float) -> np.ndarray:
    """Return a periodic field, smoothed by a Gaussian of standard deviation `width`, in cells.

    `field` has shape (n, m), and so has the result.
    """
    gain = [np.exp(-2.0 * (math.pi * width * np.fft.fftfreq(n)) ** 2) for n in field.shape]
    return np.fft.ifft2(np.fft.fft2(field) * np.outer(*gain)).real


def spectrum(field: np.ndarray, sides: Sequence[float]) -> Spectrum:
    """Return the power of a field in shells of wavenumbers, its wavelength and its orders.

    `field` (n, m) covers a rectangle with these `sides` in particle radii a; it may be any
    quantity.
    """
    window = np.outer(*(np.hanning(n) for n in field.shape))
    power = abs(np.fft.fft2((field - field.mean()) * window)) ** 2
    axes = [np.fft.fftfreq(n, side / n) for n, side in zip(field.shape, sides, strict=True)]
    k_x, k_y = np.meshgrid(*axes, indexing="ij")
    wavenumbers, width = np.hypot(k_x, k_y), 1.0 / max(sides)
    shell = np.rint(wavenumbers / width).astype(int)
    shells = np.bincount(shell.ravel(), power.ravel())
    shells[:FIRST_COUNTED_SHELL] = 0.0
    wavenumber, total = np.arange(len(shells)) * width, shells.sum()
    if not total > 0.0:
        undefined = np.full(len(FOLDS), math.nan)
        return Spectrum(wavenumber, np.full(len(shells), math.nan), math.nan, undefined)
    peak = wavenumber[shells.argmax()]
    in_annulus = abs(wavenumbers - peak) <= ANNULUS_HALF_WIDTH * width
    angle, weight = np.arctan2(k_y[in_annulus], k_x[in_annulus]), power[in_annulus]
    order = [abs(weight @ np.exp(1j * fold * angle)) / weight.sum() for fold in FOLDS]
    return Spectrum(wavenumber, shells / total, float(1.0 / peak), np.array(order))


def required_period(name: str, system: System) -> float:
    """Return the period of a run in units of T; `name` is the observable that needs it.

    Raises NeedsError without a period or without a floor.
    """
    if system.period is None:
        raise NeedsError(f"observables.{name}", "schedule.period")
    if system.box[-1] is not None and system.periodic[-1]:
        raise NeedsError(f"observables.{name}", "a floor")
    return system.period


class LayerSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `layer`."""

    phases: Annotated[int, whole(1, 10_000, "Number of phases in schedule.period.")] = 20


class Layer(Observable):
    """Height, depth and energy of a shaken layer over the phase of its drive."""

    settings = LayerSettings
    relaxations = 24.0
    variables: Mapping[str, Variable] = {
        "layer_phase": Variable("share of schedule.period that has passed", "1", LAYER_PHASE_DIMS),
        "layer_height": Variable("mean height above the floor", LENGTH, LAYER_PHASE_DIMS),
        "layer_depth": Variable(
            "height between the 5th and 95th percentile", LENGTH, LAYER_PHASE_DIMS
        ),
        "layer_energy": Variable("E_trans at this phase", ENERGY, LAYER_PHASE_DIMS),
        "layer_time": Variable(
            "when the layer was looked at, since the start", TIME, LAYER_TIME_DIMS
        ),
        "layer_height_series": Variable("mean height above the floor", LENGTH, LAYER_TIME_DIMS),
        "layer_depth_series": Variable(
            "height between the 5th and 95th percentile", LENGTH, LAYER_TIME_DIMS
        ),
        "layer_energy_series": Variable("E_trans", ENERGY, LAYER_TIME_DIMS),
    }
    series_names: tuple[str, ...] = (
        "layer_time",
        "layer_height_series",
        "layer_depth_series",
        "layer_energy_series",
    )

    def __init__(self, system: System, phases: int) -> None:
        """Divide the period of the run into `phases` phases; raise NeedsError without a period."""
        super().__init__(system)
        self._period, self._phases = required_period("layer", system), phases
        self.coordinates = {"layer_phase": np.arange(phases) / phases}

    def observe_series(self, frames: FrameSeries) -> NamedArrays:
        """Return height, depth and energy at the present phase, (k, phases), and as series, (k,).

        Values at the other phases are NaN.
        """
        height, instants = frames.position[..., -1], frames.instants
        low, high = np.percentile(height, DEPTH_PERCENTILES, axis=-1)
        squares = (frames.mass[:, None] * frames.velocity**2).reshape(instants, -1)
        averages = {
            "layer_height": height.mean(axis=-1) - frames.floor,
            "layer_depth": high - low,
            "layer_energy": 0.5 * squares.mean(axis=-1),
        }
        phases = np.rint(frames.time / self._period % 1.0 * self._phases).astype(int)
        at_phase = {name: np.full((instants, self._phases), math.nan) for name in averages}
        for name, values in averages.items():
            at_phase[name][np.arange(instants), phases % self._phases] = values
        series = {f"{name}_series": values for name, values in averages.items()}
        return at_phase | series | {"layer_time": frames.time}


Smoothing = Annotated[float, number("[0, 100]", "Width of the Gaussian that smooths, in cells.")]
Phase = Annotated[
    float,
    number(
        "[0, 1)", "Share of schedule.period at which it looks; at every observation if not given."
    ),
]
Delays = Annotated[
    int, whole(2, 1000, "Number of delays, the first one 0, of the autocorrelation.")
]


class PatternSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `pattern`."""

    cells: Annotated[int, whole(4, 2000, "Number of cells along each side.")] = 100
    smoothing: Smoothing = 2.0
    phase: Phase | None = None
    phases: Annotated[int, whole(1, 1000, "Number of phases, evenly spaced from `phase` on.")] = 1
    delays: Delays = 5


class Pattern(Observable):
    """The height of a layer from above, its wavelength, and its two-, four- and sixfold order."""

    settings = PatternSettings
    variables: Mapping[str, Variable] = {
        "wavenumber": Variable("inverse wavelength of a shell", f"{LENGTH}^-1", ("wavenumber",)),
        "fold": Variable("m of the m-fold order", "1", ("fold",)),
        "cell_x": Variable("middle of a cell", LENGTH, ("cell_x",)),
        "cell_y": Variable("middle of a cell", LENGTH, ("cell_y",)),
        "pattern_phase": Variable(
            "share of schedule.period that has passed", "1", PATTERN_PHASE_DIMS
        ),
        "pattern_delay": Variable(
            "share of schedule.period between two looks", "1", PATTERN_DELAY_DIMS
        ),
        "shell_power": Variable("share of a shell in the power", "1", ("wavenumber",)),
        "contrast": Variable("standard deviation of the height", LENGTH),
        "wavelength": Variable("wavelength of the shell with most power", LENGTH),
        "wavelength_resolution": Variable("half a shell, as a wavelength", LENGTH),
        "fold_order": Variable("m-fold order on that shell", "1", ("fold",)),
        "mean_height": Variable(
            "mean height above the floor at a phase",
            LENGTH,
            (*PATTERN_PHASE_DIMS, "cell_x", "cell_y"),
        ),
        "height_autocorrelation": Variable(
            "autocorrelation of the height", "1", PATTERN_DELAY_DIMS
        ),
        "pattern_time": Variable(
            "when the pattern was looked at, since the start", TIME, PATTERN_TIME_DIMS
        ),
        "contrast_series": Variable("standard deviation of the height", LENGTH, PATTERN_TIME_DIMS),
        "wavelength_series": Variable(
            "wavelength of the shell with most power", LENGTH, PATTERN_TIME_DIMS
        ),
        "fold_order_series": Variable(
            "m-fold order on that shell", "1", (*PATTERN_TIME_DIMS, "fold")
        ),
        "height_field": Variable(
            "height above the floor, smoothed", LENGTH, (*PATTERN_TIME_DIMS, "cell_x", "cell_y")
        ),
    }
    series_names: tuple[str, ...] = (
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
        """Store the settings (see PatternSettings); raise InputError for disks.

        Raises NeedsError without a period of the run or without a floor.
        """
        super().__init__(system)
        self._period = required_period("pattern", system)
        if system.dimension != 3:
            raise InputError("observables.pattern", "of disks", "be of spheres")
        self._sides = [side or math.nan for side in system.box[:2]]
        self._cells, self._smoothing = cells, smoothing
        self._phase, self._phases = phase, phases
        self._earlier_fields: deque[np.ndarray] = deque(maxlen=delays)
        flat_spectrum = spectrum(np.zeros((cells, cells)), self._sides)
        empty_field = np.full((phases, cells, cells), math.nan)
        empty = self._observation(
            math.nan, empty_field, 0, flat_spectrum, np.full(delays, math.nan)
        )
        self._empty_observation = {
            name: np.full_like(array, math.nan) for name, array in empty.items()
        }
        cell_centres = (np.arange(cells) + 0.5) / cells
        delay = system.interval / self._period if phase is None else 1.0 / phases
        self.coordinates: dict[str, Any] = {
            "wavenumber": flat_spectrum.wavenumber,
            "fold": np.array(FOLDS),
            "cell_x": cell_centres * self._sides[0],
            "cell_y": cell_centres * self._sides[1],
            "pattern_phase": ((phase or 0.0) + np.arange(phases) / phases) % 1.0,
            "pattern_delay": np.arange(delays) * delay,
        }

    def observe(self, frame: Frame) -> NamedArrays:
        """Return the height field, its spectrum and its correlations; NaN between phases."""
        phase_index = self._phase_of(frame)
        if phase_index is None:
            return self._empty_observation
        position = frame.position - [0.0, 0.0, frame.floor]
        field = height_field(position, frame.radius, self._sides, self._cells)
        field = smoothed(field, self._smoothing)
        fields_by_phase = np.full((self._phases, *field.shape), math.nan)
        fields_by_phase[phase_index] = field
        field_spectrum = spectrum(field, self._sides)
        return self._observation(
            frame.time, fields_by_phase, phase_index, field_spectrum, self._correlations(field)
        )

    def _phase_of(self, frame):
        """Return the index of the phase that a frame is observed at; None between phases."""
        if self._phase is None:
            return 0
        phases_passed = (frame.time / self._period - self._phase) * self._phases
        phase_offset = (phases_passed + 0.5) % 1.0 - 0.5
        step = self.system.interval / self._period * self._phases
        return (
            round(phases_passed - phase_offset) % self._phases
            if -0.5 * step < phase_offset <= 0.5 * step
            else None
        )

    def _correlations(self, field):
        """Return the correlations (delays,) of a field with itself and with earlier fields.

        `field` has shape (cells, cells); it is stored for later observations.
        """
        deviation = field - field.mean()
        norm = np.linalg.norm(deviation)
        self._earlier_fields.appendleft(
            deviation / norm if norm > 0.0 else np.full_like(deviation, math.nan)
        )
        correlations = np.full(self._earlier_fields.maxlen or 0, math.nan)
        correlations[: len(self._earlier_fields)] = [
            (self._earlier_fields[0] * earlier_field).sum()
            for earlier_field in self._earlier_fields
        ]
        return correlations

    def _observation(self, time, fields_by_phase, phase_index, field_spectrum, correlations):
        """Return an observation by name, with VARIANCE_WEIGHTED variables times the variance.

        `time` is in T, `fields_by_phase` (phases, cells, cells) has the height field, in a, at
        `phase_index`, and `field_spectrum` its spectrum; `correlations` has shape (delays,).
        """
        field = fields_by_phase[phase_index]
        variance, wavelength = np.array(field.var()), np.array(field_spectrum.wavelength)
        contrast, values = (
            np.sqrt(variance),
            (field_spectrum.power, wavelength, field_spectrum.order),
        )
        # NaN for a flat field, which has no weight
        weighted = {
            n: np.nan_to_num(variance * x) for n, x in zip(VARIANCE_WEIGHTED, values, strict=True)
        }
        return weighted | {
            "contrast": contrast,
            "variance": variance,
            "mean_height": fields_by_phase,
            "height_autocorrelation": correlations,
            "pattern_time": np.array(time),
            "contrast_series": contrast,
            "wavelength_series": wavelength,
            "fold_order_series": field_spectrum.order,
            "height_field": field,
        }

    def combine(self, means: NamedArrays) -> NamedArrays:
        """Return the means, and the resolution of the wavelength, half a shell.

        Variables weighted with the variance of the field are divided by its mean.
        """
        results = dict(means)
        variance = results.pop("variance")
        results |= {name: means[name] / variance for name in VARIANCE_WEIGHTED}
        half = results["wavelength"] ** 2 / (2.0 * max(self._sides))
        return results | {"wavelength_resolution": half}
