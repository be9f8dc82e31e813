"""The tracker of observables: it observes frames of the gases of a run and averages the results.

An observation is the result of an observable for a frame. Samples are numbered from 1 over all legs
of a gas, without preparations such as thermalisation. The kernel copies frames while it takes
samples.
"""

import io
import math
import pickle
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.base import InputError, NamedValues, Record
from roughgas.data.variables import ENERGY, POINT, RATE, SPEED, TIME, Variable, trust_of
from roughgas.kernel.hooks import sums
from roughgas.kernel.record import Sampling
from roughgas.observables import OBSERVABLES, Frame, System, requested_observables
from roughgas.observables.averages import NamedArrays, averaged
from roughgas.observables.frames import (
    CHANGING_PARTICLE_FIELDS,
    SCALAR_FIELDS,
    FrameSeries,
    SpeciesGroup,
)
from roughgas.observables.plugin import Observable
from roughgas.scene import Scene
from roughgas.simulation import protocols
from roughgas.simulation.checkpoint import under_prefix, with_prefix
from roughgas.simulation.energies import Columns
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.frames import frames_of, present_raw_frame
from roughgas.simulation.gas import Batch, Gas
from roughgas.simulation.leg import Changes, Leg
from roughgas.simulation.tracker import Tracker
from roughgas.simulation.trust import trust_in, window_of

Functions = Mapping[str, Callable[[Frame], Any]]
COOLING_UNITS = {
    ENERGY: "present E_trans",
    SPEED: "sqrt(present E_trans/m)",
    TIME: "collisions per particle",
    RATE: "sqrt(present E_trans/m)/a",
}
"""Units of a cooling gas, by the units of a driven gas that they replace."""
PICKLED_ARRAY_NAMES = ("_reconstruct", "_frombuffer", "scalar", "ndarray", "dtype")
"""Names of numpy's classes and functions in pickles of arrays."""


class ObservationSeries:
    """An observable of one gas, and its values for all observed frames.

    `every` is the interval between observations, in samples.
    """

    def __init__(self, observable: Observable, every: int) -> None:
        self.observable, self.every = observable, every
        self._sample_numbers: list[np.ndarray] = []  # (k,) of the observed frames
        self._values: list[NamedArrays] = []  # (k, ...) by name
        self._previous: dict[str, np.ndarray] = {}  # inputs of the last observation: see `_rates`

    def begin(self, frames: FrameSeries, sums: Columns) -> None:
        """Start the first interval of rates at a frame; `sums` are running sums of effects."""
        self._previous = _rate_inputs(frames, sums)

    def observe(
        self, frames: FrameSeries, sums: Columns, sample_numbers: np.ndarray, powers: Mapping
    ) -> None:
        """Observe k frames, taken at the samples with these numbers (k,).

        `sums` are running sums of effects, (k,) by name, and `powers` the power of velocity in each
        sum.
        """
        inputs = _rate_inputs(frames, sums)
        frames = frames._replace(
            system=self.observable.system, rates=_rates(self._previous, inputs, powers)
        )
        self._sample_numbers.append(sample_numbers)
        self._values.append(self.observable.observe_series(frames))
        self._previous = {name: values[-1:] for name, values in inputs.items()}

    def between(self, low: float, high: float) -> NamedArrays:
        """Return the observations with sample numbers between `low` and `high`, exclusive.

        They are arrays (observations, ...) by the name of the variable.
        """
        sample_numbers, values = self.sample_numbers(), self.values()
        inside = np.flatnonzero((low < sample_numbers) & (sample_numbers < high))
        return {name: array[inside] for name, array in values.items()}

    def sample_numbers(self) -> np.ndarray:
        """Return the sample number of each observation, (observations,)."""
        return np.concatenate(self._sample_numbers) if self._sample_numbers else np.empty(0, int)

    def values(self) -> NamedArrays:
        """Return the values of all observations, (observations, ...) by variable name."""
        if len(self._values) > 1:
            names = self._values[0]
            joined = {
                name: np.concatenate([values[name] for values in self._values]) for name in names
            }
            self._values = [joined]
        return self._values[0] if self._values else {}

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the observations and the observable's saved attributes as arrays by name."""
        memory = np.frombuffer(pickle.dumps(self.observable.saved_attributes()), np.uint8)
        content = {"taken": self.sample_numbers(), "memory": memory}
        return (
            content | with_prefix("values", self.values()) | with_prefix("before", self._previous)
        )

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the series from its arrays in a checkpoint.

        Raises UnpicklingError for arrays that are forged.
        """
        memory = ObservableUnpickler(io.BytesIO(arrays["memory"].tobytes())).load()
        vars(self.observable).update(memory)
        values = under_prefix("values", arrays)
        self._sample_numbers = [arrays["taken"]]
        self._values, self._previous = [values] if values else [], under_prefix("before", arrays)


class ObservableUnpickler(pickle.Unpickler):
    """Reads the pickled attributes of an observable: numbers, arrays and known classes.

    Pickles with other code are refused.
    """

    def find_class(self, module: str, name: str) -> Any:
        """Return the class or function `name` of a module.

        Raises UnpicklingError if attributes of observables must not contain it.
        """
        classes = (Frame, FrameSeries, System, SpeciesGroup, Variable, *OBSERVABLES.values())
        allowed = {cls.__name__: cls for cls in classes}
        if module.startswith("roughgas.") and name in allowed:
            return allowed[name]
        if module.startswith("numpy") and name in PICKLED_ARRAY_NAMES:
            return super().find_class(module, name)
        if (module, name) in (("collections", "deque"), ("builtins", "slice")):
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name}")


class GasObservations:
    """The observation series of one gas, one per observable, and the sample numbers of its legs.

    `start_time` is the time of the gas at its start, in T.
    """

    def __init__(self, start_time: float, series: Sequence[ObservationSeries]) -> None:
        self.start_time, self.series = start_time, series  # T
        self.samples_before_first: int | None = None  # before the first observation; None: unknown
        self.samples_before_leg = self.samples = 0


class ObservableTracker(Tracker):
    """Lets the observables of a run observe each of its gases, and averages their values.

    `functions` are observables defined as functions of a frame, by name.
    """

    def __init__(
        self, scene: Scene, experiment: Experiment, functions: Functions | None = None
    ) -> None:
        """Raise InputError for illegal settings, or observables that do not suit the scene."""
        self._listed_observables = requested_observables(experiment.observables, functions)
        self._experiment, self._protocol = experiment, protocols.protocol_of(experiment)
        self._scene, self._system = scene, protocols.observed_system(scene, experiment)
        self._wait_samples = self._protocol.wait(scene, experiment)
        self._gases: dict[int, GasObservations] = {}
        self._present_gas = 0  # number of the present gas
        self._new_series()

    def _new_series(self) -> list[ObservationSeries]:
        """Return empty observation series, one per observable, for a new gas."""
        unit = self._protocol.SAMPLES_PER_REFRESH
        series = []
        for listed in self._listed_observables:
            every = unit * math.ceil(listed.every / unit)
            system = self._system._replace(interval=every * self._system.interval)
            series.append(ObservationSeries(listed.make(system), every))
        return series

    def begin(self, gas: Gas, leg: Leg, changes: Changes) -> None:
        """Make the series of a new gas, and find the sample of its first observation."""
        if gas.number not in self._gases:
            self._gases[gas.number] = GasObservations(gas.time, self._new_series())
        self._present_gas = gas.number
        if leg.preparation:
            return
        gas_series = self._gases[gas.number]
        gas_series.samples_before_leg = gas_series.samples
        if gas_series.samples_before_first is None:
            gas_series.samples_before_first = samples_before_first(self._wait_samples, leg)
            if gas_series.samples_before_first == 0:
                self._start_rates_now(gas, gas_series)

    def _start_rates_now(self, gas, gas_series):
        """Start the first interval of rates of all series of a gas at its present instant."""
        if not gas.sample:
            gas.sample_now()
        frames = frames_of(gas, present_raw_frame(gas.state), self._system)
        for series in gas_series.series:
            series.begin(frames, _effect_sums(gas.sample, gas))

    def frames(self, leg: Leg) -> tuple[int, int]:
        """Request a frame for each observation (see Tracker.frames)."""
        if leg.preparation:
            return 0, 0
        gas_series = self._gases[self._present_gas]
        assert gas_series.samples_before_first is not None
        every = math.gcd(*(series.every for series in gas_series.series))
        first = gas_series.samples_before_first - gas_series.samples_before_leg
        return (first if first > 0 else first % every or every), every

    def take(self, gas: Gas, leg: Leg, batch: Batch) -> None:
        """Let each observable observe its due frames of a batch."""
        if leg.preparation:
            return
        gas_series = self._gases[gas.number]
        gas_series.samples = gas_series.samples_before_leg + batch.taken + batch.samples
        if not len(batch.frames.rows):
            return
        sample_numbers = gas_series.samples_before_leg + batch.sample_of_frames
        samples_since_first = sample_numbers - gas_series.samples_before_first
        frames = frames_of(gas, batch.frames, self._system)
        running_sums = {
            name: column[batch.frames.rows]
            for name, column in _effect_sums(batch.rows, gas).items()
        }
        at_start, powers = np.flatnonzero(samples_since_first == 0), _velocity_powers(gas)
        for series in gas_series.series:
            if len(at_start):
                frame_sums = {name: column[at_start] for name, column in running_sums.items()}
                series.begin(_frames_at(frames, at_start), frame_sums)
            due = np.flatnonzero(
                (samples_since_first > 0) & (samples_since_first % series.every == 0)
            )
            if len(due):
                frame_sums = {name: column[due] for name, column in running_sums.items()}
                series.observe(_frames_at(frames, due), frame_sums, sample_numbers[due], powers)

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the series of all gases as arrays by name, for a checkpoint."""
        arrays: dict[str, np.ndarray] = {"present": np.array(self._present_gas)}
        for number, gas_series in self._gases.items():
            start = (
                -1 if gas_series.samples_before_first is None else gas_series.samples_before_first
            )
            arrays[f"gas.{number}.begun"] = np.array(gas_series.start_time)
            arrays[f"gas.{number}.samples"] = np.array(
                [start, gas_series.samples_before_leg, gas_series.samples]
            )
            for rank, series in enumerate(gas_series.series):
                arrays |= with_prefix(f"gas.{number}.looks.{rank}", series.arrays())
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the series of all gases from their arrays in a checkpoint.

        Raises UnpicklingError for arrays that are forged.
        """
        self._present_gas = int(arrays["present"])
        numbers = {name.split(".")[1] for name in arrays if name.startswith("gas.")}
        for number in sorted(numbers, key=int):
            saved = under_prefix(f"gas.{number}", arrays)
            gas_series = GasObservations(saved["begun"].item(), self._new_series())
            start, gas_series.samples_before_leg, gas_series.samples = saved["samples"].tolist()
            gas_series.samples_before_first = None if start < 0 else start
            for rank, series in enumerate(gas_series.series):
                series.restore(under_prefix(f"looks.{rank}", saved))
            self._gases[int(number)] = gas_series

    def results(self, point: Record) -> tuple[NamedValues, dict[str, Variable]]:
        """Return the variables of all observables by name, and their descriptions by name.

        They are averages over the measured window. The variables of `point` give the window, the
        verdict on the steady state and the memory of the gas. Raises InputError if two observables
        have a variable of the same name, or if one has no observation in the window.
        """
        values: NamedValues = {}
        descriptions: dict[str, Variable] = {}
        gases = [self._gases[number] for number in sorted(self._gases)]
        for rank, listed in enumerate(self._listed_observables):
            averages, lacks = self._averaged(gases, rank, point)
            observable = gases[0].series[rank].observable
            shared = _equal_coordinates(values, observable.coordinates)
            names = averages.keys() | observable.variables.keys() - shared
            _refuse_twice(listed.name, names, values)
            values |= observable.coordinates | averages
            descriptions |= self._described(listed.name, observable.variables, averages, lacks)
        return values, descriptions

    def _averaged(
        self, gases: Sequence[GasObservations], rank: int, point: Record
    ) -> tuple[NamedValues, dict[str, str]]:
        """Return the averages of an observable, and the evidence that each lacks, by name.

        Averages include errors and flags. `rank` is the index of the observable, and `point` has
        the other variables of the point.
        """
        window_ends = point["measured_from"], point.get("plateau_end", math.inf)
        runs = self._windows(gases, rank, *window_ends)
        series = gases[-1].series[rank]
        observable, every = series.observable, series.every
        period = self._protocol.samples_per_period(self._experiment.schedule)
        per_period = period // every if period % every == 0 else 1
        means = [_without_names(observable.series_names, run) for run in runs]
        averages = averaged(observable.combine, means, per_period, observable.combines_columns)
        observed = _observation_count(runs[0]), every
        window = window_of(
            self._scene, self._experiment, point, observed, observable.depends_on_flow
        )
        settled = observable.valid_in_beds or self._scene.effects.gravity is None
        values, lacks = _stored_series(observable.series_names, runs), {}
        for name, value in averages.value.items():
            stderr, evidence = averages.stderr[name], averages.sample_size[name]
            measured = settled and name not in observable.unvalidated
            relaxations = observable.relaxations if measured else math.inf
            trust = trust_in(value, stderr, evidence, window, relaxations)
            values |= {name: value, f"{name}_stderr": stderr, f"{name}_dof": averages.dof[name]}
            values[f"{name}_trusted"], lacks[name] = trust
        return values, lacks

    def _windows(
        self, gases: Sequence[GasObservations], rank: int, start: float, stop: float
    ) -> list[NamedArrays]:
        """Return the observations within a window, for each gas that has some there.

        `rank` is the index of the observable. `start` and `stop` are in T since the start, or in
        collisions per particle of a cooling gas. Raises InputError if no gas has any.
        """
        every = self._system.interval
        runs = []
        for gas_series in gases:
            start_time = gas_series.start_time if self._protocol.DRIVEN else 0.0
            low, high = ((end - start_time) / every + 0.5 for end in (start, stop))
            runs.append(gas_series.series[rank].between(low, high))
        runs = [run for run in runs if _observation_count(run)]
        if not runs:
            legal = "be small enough for observations during the measurement"
            raise InputError("observables: every", gases[0].series[rank].every, legal)
        return runs

    def _described(self, observable, variables, averages, lacks) -> dict[str, Variable]:
        """Return the descriptions of an observable's variables, errors and flags, by name.

        `observable` is its name, `variables` are its own descriptions, `averages` its results and
        `lacks` the missing evidence in words, by name.
        """
        described = {}
        for name, variable in variables.items():
            units = _cooling_units(variable.units) if self._system.cooling else variable.units
            variable = variable._replace(units=units, of_settings=True, observable=observable)
            has_error = f"{name}_stderr" in averages
            if name in averages and not has_error:
                variable = variable._replace(observable="")  # a series, not in reduced datasets
            described[name] = variable
            if has_error:
                error = f"standard error of {name} within this file"
                freedom = f"degrees of freedom that {name}_stderr is known with"
                trust = trust_of(name, variable)._replace(comment=lacks[name])
                described[f"{name}_stderr"] = variable._replace(long_name=error)
                described[f"{name}_dof"] = variable._replace(long_name=freedom, units="1")
                described[f"{name}_trusted"] = trust
        return described


def _without_names(names, values):
    """Return the values by name, without the names in `names`."""
    return {name: value for name, value in values.items() if name not in names}


def _stored_series(stored, runs):
    """Return the series named in `stored` of all runs, concatenated, (observations, ...) by name.

    Observations are left out if the first series is not finite there.
    """
    if not stored:
        return {}
    series = {name: np.concatenate([run[name] for run in runs]) for name in stored}
    first = series[stored[0]].reshape(len(series[stored[0]]), -1)
    finite = np.isfinite(first).all(axis=1)
    return {name: values[finite] for name, values in series.items()}


def _observation_count(observations: NamedArrays) -> int:
    """Return the number of observations in arrays (observations, ...) by name."""
    return len(next(iter(observations.values()))) if observations else 0


def samples_before_first(wait: int, leg: Leg) -> int:
    """Return the number of samples before the first observation: at least `wait`, up to a refresh.

    `leg` is the first leg with samples of the run.
    """
    if not isinstance(leg.sampling, Sampling) or not leg.sampling.refresh:
        return wait
    refresh, samples_taken = leg.sampling.refresh, leg.sampling.taken
    return refresh * max(1, math.ceil((wait + samples_taken) / refresh)) - samples_taken


def _frames_at(frames: FrameSeries, indices: Any) -> FrameSeries:
    """Return the frames with these rising indices, as a series of their own."""
    if len(indices) == frames.instants:
        return frames
    selected = {
        name: getattr(frames, name)[indices]
        for name in (*SCALAR_FIELDS, *CHANGING_PARTICLE_FIELDS)
        if getattr(frames, name) is not None
    }
    return frames._replace(**selected)


def _velocity_powers(gas: Gas) -> dict[str, float]:
    """Return the power of velocity in each running sum of effects, by name."""
    return {
        name: power for powers in sums(gas.scene.effects).values() for name, power in powers.items()
    }


def _effect_sums(columns: Columns, gas: Gas) -> Columns:
    """Return the running sums of effects among the columns of samples, in units of a, m and T."""
    return {name: columns[name] for name in _velocity_powers(gas)}


def _rate_inputs(frames: FrameSeries, sums: Columns) -> dict[str, np.ndarray]:
    """Return the inputs of `_rates` at k instants, (k,) by name.

    They are times in T, units of speed, and running sums of effects.
    """
    return {"time": frames.time, "speed unit": frames.speed_unit, **with_prefix("sum", sums)}


def _rates(
    before: Mapping[str, np.ndarray], now: Mapping[str, np.ndarray], powers: Mapping[str, float]
) -> dict[str, np.ndarray]:
    """Return the rates of running sums between consecutive instants, (k,) by name, per T.

    `now` has the inputs (k,) from `_rate_inputs`, `before` the inputs at the preceding instant, and
    `powers` the power of velocity in each sum. Rates are in the frames' units of velocity. In a gas
    that cools by Haff's law, the mean of a power of the thermal speed over an interval equals this
    power of the geometric mean of its two ends: exactly for the square, as in a pressure.
    """

    def ends(name):
        """Return the values of an input at both ends of each interval, (k,) each."""
        series = np.concatenate([before[name], now[name]])
        return series[:-1], series[1:]

    (begin, end), units = ends("time"), ends("speed unit")
    unit = np.sqrt(units[0]) * np.sqrt(units[1])
    rates = {}
    for name, power in powers.items():
        first, last = ends(f"sum.{name}")
        scale = np.array([value**power for value in unit.tolist()])
        rates[name] = (last - first) / scale / ((end - begin) * unit)
    return rates


def _cooling_units(units: str) -> str:
    """Return the units of a variable in a cooling gas from its units in a driven gas."""
    for driven, cooling in COOLING_UNITS.items():
        units = cooling if units == driven else units.replace(f"{driven} ", f"{cooling} ")
    return units


def _equal_coordinates(values, coordinates):
    """Return the names of coordinates that `values` already has, with equal values."""
    shared = coordinates.keys() & values.keys()
    return {name for name in shared if np.array_equal(values[name], coordinates[name])}


def _refuse_twice(observable, names, values):
    """Raise InputError if a variable's name is already in `values`, or reserved.

    `names` are the names of the variables of the observable.
    """
    for name in sorted(names):
        if name in values or name in POINT:
            legal = "have a name that no other variable of the dataset has"
            raise InputError(f"variable of {observable}", name, legal)
