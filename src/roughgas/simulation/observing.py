"""Observables of a run: when they look at its gases, and what lands in the dataset.

Samples are taken in pieces that end where something is to be looked at, which changes no bit.
"""

import io
import math
import pickle
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.data.variables import ENERGY, POINT, RATE, SPEED, TIME, Variable, trust_of
from roughgas.kernel.hooks import displacement, sums
from roughgas.kernel.state import EXPONENT
from roughgas.observables import KINDS, Frame, System, wanted
from roughgas.observables.plugin import Group, Observable, Values, averaged
from roughgas.scene import Scene
from roughgas.simulation import schedule
from roughgas.simulation.flow import FlowWatch, watch_of
from roughgas.simulation.gas import Gas
from roughgas.simulation.paths import in_order, rotations, unwrapped_positions
from roughgas.simulation.restart import positions_and_velocities
from roughgas.simulation.trust import trust_in, window_of
from roughgas.statistics.errors import Estimate

Functions = Mapping[str, Callable[[Frame], Any]]
PRESENT = {
    ENERGY: "present E_trans",
    SPEED: "sqrt(present E_trans/m)",
    TIME: "collisions per particle",
    RATE: "sqrt(present E_trans/m)/a",
}
"""Units of a cooling gas in place of those of a driven one."""
ARRAYS = ("_reconstruct", "_frombuffer", "scalar", "ndarray", "dtype")
"""What numpy's pickles are made of."""


class Look(NamedTuple):
    """What an observable has seen after so many samples."""

    taken: int
    values: Values


class Registered(NamedTuple):
    """An observable of one gas, and what it has seen."""

    observable: Observable
    every: int  # samples
    looks: list[Look]
    before: dict[str, Any]  # the clock, unit of speed and running sums of the look before


class Observer:
    """Looks at one gas; it is a Gas's `observer`."""

    def __init__(
        self, gas: Gas, watched: Sequence[Registered], wait: int, flow: FlowWatch | None = None
    ) -> None:
        self.begun, self.watched, self.flow = gas.time, watched, flow
        self._wait, self._taken = wait, 0
        self._start: int | None = None  # samples before the first look; None: not known yet
        self._intervals = {one.every for one in watched}
        self._intervals |= {flow.every} if flow else set()

    def lengths(self, samples: int, first: int, unit: int) -> Iterator[int]:
        """Yield the lengths of the pieces that so many more samples are taken in.

        Pieces end `first` samples from the start, or a multiple of `unit` later.
        """
        end = self._taken + samples
        if self._start is None:
            self._start = first + unit * max(0, math.ceil((self._wait - first) / unit))
            yield min(self._start, end)
        while self._taken < end:
            since = self._taken - self._start
            due = (every - since % every for every in self._intervals)
            piece = -since if since < 0 else min(due)
            yield min(piece, end - self._taken)

    def look(self, gas: Gas, taken: int) -> None:
        """Look at a gas that so many samples more have been taken of."""
        self._taken += taken
        assert self._start is not None
        since = self._taken - self._start
        if self.flow and since > 0 and since % self.flow.every == 0:
            self.flow.look(gas, self._taken)
        due = [one for one in self.watched if since >= 0 and since % one.every == 0]
        if not due:
            return
        if not gas.sample:
            gas.look()
        sums, frame = running_sums(gas), frame_of(gas, due[0].observable.system)
        now = {"time": frame.time, "unit": frame.speed_unit, "sums": sums}
        for one in due:
            if since:
                seen = frame._replace(
                    system=one.observable.system, rates=_rates(one.before, now, gas)
                )
                one.looks.append(Look(self._taken, one.observable.look(seen)))
            one.before.update(now)

    def saved(self) -> bytes:
        """Return what it has seen so far."""
        seen = [(vars(one.observable), one.looks, one.before) for one in self.watched]
        shifts = self.flow.shifts() if self.flow else []
        return pickle.dumps((self._start, self._taken, seen, shifts))

    def restore(self, saved: bytes) -> None:
        """See what another one has seen. Raises UnpicklingError where there is anything else."""
        self._start, self._taken, seen, shifts = Seen(io.BytesIO(saved)).load()
        if self.flow:
            self.flow.restore(shifts)
        for one, (own, looks, before) in zip(self.watched, seen, strict=True):
            vars(one.observable).update(own)
            one.looks[:] = looks
            one.before.update(before)


class Seen(pickle.Unpickler):
    """Reads what observables have seen: numbers and arrays, and nothing that could be run."""

    def find_class(self, module: str, name: str) -> Any:
        """Return a class that may be there."""
        own = {one.__name__: one for one in (Look, Frame, System, Group, Variable, *KINDS.values())}
        if module.startswith("roughgas.") and name in own:
            return own[name]
        if module.startswith("numpy") and name in ARRAYS:
            return super().find_class(module, name)
        if (module, name) in (("collections", "deque"), ("builtins", "slice")):
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"{module}.{name}")


class Observers:
    """The observables of a run: looks at each of its gases, and averages what was seen."""

    def __init__(
        self, scene: Scene, experiment: Mapping[str, Any], functions: Functions | None = None
    ) -> None:
        """Raise InputError for settings that are illegal, or do not suit the scene."""
        self._wanted = wanted(experiment.get("observables", {}), functions)
        self._experiment, self._kind = experiment, schedule.of(experiment)
        self._scene, self._system = scene, schedule.system_of(scene, experiment)
        self._observers: list[Observer] = []
        self._make()

    def _make(self) -> list[Registered]:
        unit = self._kind.SAMPLES_PER_REFRESH
        registered = []
        for listed in self._wanted:
            every = unit * math.ceil(listed.every / unit)
            system = self._system._replace(interval=every * self._system.interval)
            registered.append(Registered(listed.make(system), every, [], {}))
        return registered

    def flow_shift(self, start: float) -> Estimate | None:
        """Return by how much R is larger over the local flow, from `start` (T) on; None where R
        assumes no flow."""
        (observer,) = self._observers[:1]
        if observer.flow is None:
            return None
        return observer.flow.shift(round((start - observer.begun) / self._system.interval))

    def begin(self, gas: Gas) -> None:
        """Watch a gas from now on."""
        wait = self._kind.wait(self._scene, self._experiment)
        flow = watch_of(self._scene, self._system, self._experiment)
        gas.observer = Observer(gas, self._make(), wait, flow)
        self._observers.append(gas.observer)

    def results(self, point: Mapping[str, Any]) -> tuple[dict, dict[str, Variable]]:
        """Return variables of a point by name, and what they are, of the window that the variables
        of `point` say was measured. They say too whether the gas was steady, and how long it
        remembers."""
        values: dict[str, Any] = {}
        about: dict[str, Variable] = {}
        for number, one in enumerate(self._wanted):
            watched = [observer.watched[number] for observer in self._observers]
            found, lacks = self._averaged(watched, point)
            kind = watched[0].observable
            shared = _same(values, kind.coordinates)
            _refuse_twice(one.name, (found.keys() | kind.variables.keys() - shared), values)
            values |= kind.coordinates | found
            about |= self._described(one.name, kind.variables, found, lacks)
        return values, about

    def _averaged(
        self, watched: Sequence[Registered], point: Mapping[str, Any]
    ) -> tuple[dict[str, Any], dict[str, str]]:
        """Return averages with their errors and flags of trust, and by name what trust lacks."""
        runs = self._windows(watched, point["measured_from"], point.get("plateau_end", math.inf))
        observable, every = watched[-1].observable, watched[0].every
        period = self._kind.samples_per_period(self._experiment["schedule"])
        per_period = period // every if period % every == 0 else 1
        means = [[_without(observable.kept, values) for values in run] for run in runs]
        found = averaged(observable.combine, means, per_period)
        looks = len(runs[0]), every
        window = window_of(self._scene, self._experiment, point, looks, observable.of_flow)
        known = observable.beds or self._scene.effects.gravity is None
        values, lacks = _series(observable.kept, [x for run in runs for x in run]), {}
        for name, value in found.value.items():
            stderr, evidence = found.stderr[name], found.evidence[name]
            measured = known and name not in observable.doubtful
            relaxations = observable.relaxations if measured else math.inf
            trust = trust_in(value, stderr, evidence, window, relaxations)
            values |= {name: value, f"{name}_stderr": stderr, f"{name}_dof": found.dof[name]}
            values[f"{name}_trusted"], lacks[name] = trust
        return values, lacks

    def _windows(
        self, watched: Sequence[Registered], start: float, stop: float
    ) -> list[list[Values]]:
        """Return what was seen of each gas in a window; its ends are in T since the start, or in
        collisions per particle of a cooling gas."""
        every = self._system.interval
        runs = []
        for one, observer in zip(watched, self._observers, strict=True):
            begun = observer.begun if self._kind.DRIVEN else 0.0
            low, high = ((end - begun) / every + 0.5 for end in (start, stop))
            runs.append([look.values for look in one.looks if low < look.taken < high])
        runs = [run for run in runs if run]
        if not runs:
            legal = "be small enough for observations during the measurement"
            raise InputError("observables: every", watched[0].every, legal)
        return runs

    def _described(self, observable, variables, found, lacks) -> dict[str, Variable]:
        """Return what the variables of an observable are, errors and flags of trust included."""
        described = {}
        for name, about in variables.items():
            units = _present(about.units) if self._system.cooling else about.units
            about = about._replace(units=units, of_settings=True, observable=observable)
            if name in found and f"{name}_stderr" not in found:
                about = about._replace(observable="")  # a series, which reduced datasets leave out
            described[name] = about
            if f"{name}_stderr" in found:
                error = f"standard error of {name} within this file"
                freedom = f"degrees of freedom that {name}_stderr is known with"
                described[f"{name}_stderr"] = about._replace(long_name=error)
                described[f"{name}_dof"] = about._replace(long_name=freedom, units="1")
                described[f"{name}_trusted"] = trust_of(name, about)._replace(comment=lacks[name])
        return described


def _without(names, values):
    return {name: value for name, value in values.items() if name not in names}


def _series(kept, looks):
    """Return what is kept of looks, (looks, ...) by name."""
    there = [values for values in looks if kept and np.isfinite(values[kept[0]]).all()]
    return {name: np.array([values[name] for values in there]) for name in kept}


def frame_of(gas: Gas, system: System) -> Frame:
    """Return a frame of the present instant, without `rates`."""
    state, time = gas.state, gas.time
    position, velocity = positions_and_velocities(state, gas.scene, time)
    scale = unit = 2.0 ** int(state.counts[EXPONENT])
    radius, mass, inertia = _bodies(state, system)
    if system.cooling:
        present_energy = 0.5 * np.mean(mass[:, None] * in_order(state, velocity) ** 2)
        scale = 1.0 / math.sqrt(present_energy) if present_energy else 0.0
    spin = None if state.spin is None else in_order(state, state.spin * scale)
    return Frame(
        system=system,
        time=time,
        collisions=2.0 * gas.collisions / gas.particles,
        position=in_order(state, position),
        velocity=in_order(state, velocity * scale),
        spin=spin,
        unwrapped_position=unwrapped_positions(state, gas.scene),
        angle=rotations(state),
        radius=radius,
        mass=mass,
        inertia=inertia,
        image_shift=displacement(gas.scene.effects.shear, time) or 0.0,
        rates={},
        species_of=None if state.bodies is None else in_order(state, state.bodies.species),
        speed_unit=unit / scale if scale else math.nan,
        floor=displacement(gas.scene.effects.floor, time) or 0.0,
    )


def _bodies(state, system):
    """Return radius, mass and q of each particle, (N,)."""
    if state.bodies is None:
        ones = np.ones(system.particles)
        return ones, ones, ones * (system.inertia or 0.0)
    bodies = state.bodies
    return tuple(in_order(state, one) for one in (bodies.radius, bodies.mass, bodies.inertia))


def running_sums(gas: Gas) -> dict[str, float]:
    """Return what effects have summed up until the last sample, in units of a, m and T."""
    return {name: float(gas.sample[name][0]) for name in _powers(gas)}


def _powers(gas):
    """Return, for each sum of effects, the power of velocity that it has."""
    return {name: one for own in sums(gas.scene.effects).values() for name, one in own.items()}


def _rates(before, now, gas):
    """Return what was summed up between two looks, per T, in the frame's units of velocity.

    In a gas that cools by Haff's law, the mean of a power of the thermal speed over an interval is
    that of the two ends' geometric mean: exactly so for its square, as in a pressure.
    """
    elapsed = now["time"] - before["time"]
    unit = math.sqrt(before["unit"]) * math.sqrt(now["unit"])
    return {
        name: (now["sums"][name] - before["sums"][name]) / unit**power / (elapsed * unit)
        for name, power in _powers(gas).items()
    }


def _present(units: str) -> str:
    for driven, cooling in PRESENT.items():
        units = cooling if units == driven else units.replace(f"{driven} ", f"{cooling} ")
    return units


def _same(values, coordinates):
    """Return the names of coordinates that are there already, with the same values."""
    there = coordinates.keys() & values.keys()
    return {name for name in there if np.array_equal(values[name], coordinates[name])}


def _refuse_twice(observable, names, values):
    for name in sorted(names):
        if name in values or name in POINT:
            legal = "have a name that no other variable of the dataset has"
            raise InputError(f"variable of {observable}", name, legal)
