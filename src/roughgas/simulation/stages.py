"""A gas through stages: settings change, or temperatures are set, where one begins.

What a stage changes stays as it is until another one changes it again. Times are in T. The series
run through all stages, and have what a change has put in beside what effects have; the averages of
a point are over the stages that are measured.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError, merged
from roughgas.kernel.state import EXPONENT
from roughgas.scene import Scene, build
from roughgas.simulation import steady
from roughgas.simulation.change import Temperatures, change, check_change, going_on
from roughgas.simulation.energies import (
    Columns,
    Energies,
    contact_averages,
    driven_species,
    energies_of_each,
    energy_exchange,
    exchange_series,
    verdicts_on_means,
)
from roughgas.simulation.gas import Gas, joined
from roughgas.simulation.recorder import Recorder
from roughgas.simulation.restart import Initial
from roughgas.statistics.errors import UNKNOWN

# see roughgas.simulation.schedule.Kind
DRIVEN, UNIT, LENGTH, SAMPLES_PER_REFRESH = True, "T", "stages", 1
interval, sample = steady.interval, steady.sample


class Stage(NamedTuple):
    """What a gas goes through from `begin` on (T)."""

    begin: float
    duration: float
    scene: Scene
    temperatures: Temperatures
    measured: bool


def course(scene: Scene, experiment: Mapping[str, Any], begun: float = 0.0) -> list[Stage]:
    """Return the stages of an experiment whose first one begins at `begun` (T).

    `scene` has the r and beta that the gas has where no stage gives others. Raises InputError for a
    stage that names an effect that is not there, or changes more than numbers.
    """
    found: list[Stage] = []
    time, settings = begun, {**experiment, "r": scene.restitution, "beta": scene.roughness}
    present = scene
    for number, one in enumerate(experiment["schedule"]["stages"]):
        key = f"schedule.stages[{number}]"
        for name in one.get("effects", {}):
            if name not in settings["effects"]:
                known = ", ".join(sorted(settings["effects"]))
                raise InputError(f"{key}.effects: key", name, f"be one of this experiment: {known}")
        changes = {name: one[name] for name in ("effects", "r", "beta") if name in one}
        settings = merged(settings, changes)
        temperatures = Temperatures(one.get("temperature"), one.get("spin_temperature"))
        new = going_on(present, _built(settings, key) if changes else present, time)
        check_change(present, new, time, temperatures, key)
        found.append(Stage(time, one["duration"], new, temperatures, one.get("measure", True)))
        present, time = new, time + one["duration"]
    return found


def _built(settings, key):
    """Return the scene of settings; an error says of which stage."""
    try:
        return build(settings, settings["r"], settings["beta"])
    except InputError as error:
        error.key = f"{key}: {error.key}"
        raise


def length(scene: Scene, experiment: Mapping[str, Any]) -> float:
    """Return the T that a point simulates."""
    return sum(one["duration"] for one in experiment["schedule"]["stages"])


def start(scene: Scene, experiment: Mapping[str, Any], seed: Any, recorder=None, initial=()) -> Gas:
    """Return the gas of a point in its first stage; `seed` may be a random generator."""
    gas = steady.start(scene, experiment, seed, recorder, initial)
    if gas.state.counts[EXPONENT]:
        legal = "come without last_memory, in which time has another unit"
        raise InputError("initial", "a gas that has cooled", legal)
    return gas


def samples_per_period(schedule: Mapping[str, Any]) -> int:
    """Return 1: averages are over all samples alike."""
    return 1


def phases(scene: Scene, schedule: Mapping[str, Any], every: int = 1) -> float:
    """Return infinity: no average is over a period of the drive."""
    return math.inf


def check(scene: Scene, experiment: Mapping[str, Any]) -> None:
    """Raise InputError for stages that cannot be run, or measure nothing."""
    stages = course(scene, experiment)
    every = interval(experiment)
    for number, one in enumerate(stages):
        key = f"schedule.stages[{number}]"
        if not steady.is_whole(one.duration / every):
            legal = f"be a whole multiple of schedule.sample_every, {every:g} T"
            raise InputError(f"{key}.duration", one.duration, legal)
        if number and stages[number - 1].measured and not one.measured:
            raise InputError(f"{key}.measure", False, "not be false after a stage that is measured")
    if not stages[-1].measured:
        key = f"schedule.stages[{len(stages) - 1}].measure"
        raise InputError(key, False, "be true of the last stage")
    if stages[0].temperatures.rotation and not experiment.get("spin_temperature"):
        legal = "be set by `spin_temperature` of the experiment, as particles begin without spin"
        raise InputError(
            "schedule.stages[0].spin_temperature", stages[0].temperatures.rotation, legal
        )
    sheared = [one.scene.effects.shear for one in stages if one.scene.effects.shear is not None]
    if experiment.get("observables") and len({one.velocity for one in sheared}) > 1:
        raise InputError("observables", "with a shear that changes", "come with a constant one")


def wait(scene: Scene, experiment: Mapping[str, Any]) -> int:
    """Return the samples before any counts, those of stages that are not measured."""
    stages = course(scene, experiment)
    waited = sum(one.duration for one in stages if not one.measured)
    return round(waited / interval(experiment))


def through(gas: Gas, stages: Sequence[Stage]) -> Iterator[tuple[Stage, np.ndarray]]:
    """Let a gas begin each stage as soon as the one before has been run; yield it with what its
    change has put in, (2,) in m a^2/T^2."""
    for one in stages:
        yield one, change(gas, one.scene, one.begin, one.temperatures)


def run(
    scene: Scene,
    experiment: Mapping[str, Any],
    seed: int,
    recorder: Recorder,
    initial: Sequence[Initial] = (),
) -> dict[str, Any]:
    """Return the variables of the point (see roughgas.data.point), from one simulation.

    Samples are taken every `sample_every` T, from the end of the first such interval on.
    """
    gas = start(scene, experiment, seed, recorder, initial)
    gas.keeps_books = True
    if initial:
        gas.look()  # at running sums that others have begun
    begun, sums, before, every = gas.time, gas.sample, gas.balance(), interval(experiment)
    made = gas.begun + gas.collisions
    stages = course(scene, experiment, begun)
    rows: list[Columns] = []
    series: list[list[Energies]] = []  # of all particles, and of each species
    put_in = []
    for stage, energy in through(gas, stages):
        rows.append(_samples(gas, stage, every))
        series.append([gas.energies(rows[-1]), *energies_of_each(rows[-1], gas.scene, gas.state)])
        put_in.append(energy)
    total, *species = (_joined(parts) for parts in zip(*series, strict=True))
    changes, counts = np.array(put_in), [len(part["time"]) for part in rows]
    first = sum(count for count, one in zip(counts, stages, strict=True) if not one.measured)
    found = joined(rows)
    collisions = 2.0 * (found["collisions"] - made) / gas.particles
    window = total.map(lambda part: part[first:])
    variables = {
        **steady.averages(window, 1, every),
        **contact_averages(found, first, 1, steady.inertia_of_sums(gas.scene), sums),
        **_of_species(species, first),
        **energy_exchange(before, gas.balance(), gas.scene, gas.particles, changes.sum(axis=0)),
        "equilibrated": UNKNOWN,  # it need not settle in any stage
        "measured_from": begun + first * every,
        "measured_collisions": collisions[-1] - (collisions[first - 1] if first else 0.0),
        **steady.over_time(found["time"], total, 1),
        "collisions_series": collisions,
        **exchange_series(found, before, gas.scene, gas.particles, changes, counts),
        "stage_begin": [one.begin for one in stages],
        "stage_input": changes / gas.particles,
    }
    if window.rotational is not None:
        variables["R_ci95_trusted"] = UNKNOWN
    return variables | verdicts_on_means(variables, UNKNOWN)


def _samples(gas, stage, every):
    """Return the samples of a stage, the last of them to the last bit at its end: kicks may be due
    at that instant, and every run has to give them before the change."""
    count = round(stage.duration / every)
    rows = [gas.in_time(every, count - 1)] if count > 1 else []
    return joined([*rows, gas.in_time(stage.begin + stage.duration - gas.time, 1)])


def _joined(parts):
    return Energies(*map(np.concatenate, zip(*(one.there() for one in parts), strict=True)))


def _of_species(parts, first):
    """Return averages over what is measured, and series of all stages."""
    found = driven_species([one.map(lambda part: part[first:]) for one in parts], 1, 1)
    whole = driven_species(parts, 1, 1)
    return found | {name: one for name, one in whole.items() if name.endswith("_series")}
