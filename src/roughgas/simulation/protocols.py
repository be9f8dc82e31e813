"""The registry of run protocols, one per kind of schedule: steady, cooling, stages."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

from roughgas.base import InputError, NamedValues
from roughgas.effects import inertia
from roughgas.effects.species import mixture_of
from roughgas.effects.walls import closed_sides
from roughgas.kernel import hooks
from roughgas.scene import Scene, rotation_of_medium, shear_rate, walls_of
from roughgas.scene.initial import check as check_scene
from roughgas.simulation import cooling, stages, steady
from roughgas.simulation.energies import Columns
from roughgas.simulation.error_target import LENGTH_KEYS, SAMPLE_LIMIT, TARGET_KEY, samples_of
from roughgas.simulation.experiment import Experiment, ScheduleSettings
from roughgas.simulation.gas import Gas
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.simulation import Simulation

if TYPE_CHECKING:
    from roughgas.observables import System


class RunProtocol(Protocol):
    """Constants and functions of a protocol module, such as roughgas.simulation.steady."""

    SETTINGS: type[ScheduleSettings]
    DRIVEN: bool  # whether time is counted in T, as in a driven gas, or in collisions per particle
    UNIT: str  # of lengths
    LENGTH: str  # key of the schedule that sets the length of the measurement of R
    SAMPLES_PER_REFRESH: int  # samples between two refreshes of a gas; 1 without refreshes

    def length(self, scene: Scene, experiment: Experiment) -> float:
        """Return the simulated length of a point, summed over its gases, in UNIT."""

    def start(
        self, scene: Scene, experiment: Experiment, seed: Any, initial: Sequence[InitialState] = ()
    ) -> Gas:
        """Return the first gas of a point at its start: the only one, or the first replica.

        `seed` is the point's seed, or a random generator. `initial` has the initial states of the
        gases; without any, particles start on a lattice. Gases that cool are thermalised first.
        """

    def interval(self, experiment: Experiment) -> float:
        """Return the actual interval between two samples, in UNIT."""

    def check(self, scene: Scene, experiment: Experiment) -> None:
        """Raise InputError for lengths that cannot be simulated, or without a measurement."""

    def sample(self, gas: Gas, every: float, samples: int) -> Columns:
        """Advance a gas and return its samples, `every` UNIT apart, as columns (samples,)."""

    def samples_per_period(self, schedule: Any) -> int:
        """Return the number of samples in a period of the drive; 1 if there is no period."""

    def phases(self, scene: Scene, schedule: Any, every: int = 1) -> float:
        """Return the number of phases of a periodic drive that every `every`-th sample shows.

        It is infinite without such a drive.
        """

    def wait(self, scene: Scene, experiment: Experiment) -> int:
        """Return the number of samples before the earliest start of the measurement."""

    def run(
        self,
        scene: Scene,
        experiment: Experiment,
        seed: int,
        simulation: Simulation,
        initial: Sequence[InitialState] = (),
    ) -> NamedValues:
        """Simulate a point and return its variables by name (see roughgas.data.point).

        `simulation` advances the gases and calls the trackers; `initial` has the states of the
        gases.
        """


PROTOCOLS: dict[str, RunProtocol] = {"steady": steady, "cooling": cooling, "stages": stages}


def protocol_of(experiment: Experiment) -> RunProtocol:
    """Return the protocol of an experiment's schedule: the module steady, cooling or stages."""
    return PROTOCOLS[experiment.schedule.kind]


def observed_system(scene: Scene, experiment: Experiment) -> "System":
    """Return the constants of a run that observables receive: particles, box, shear, sampling."""
    from roughgas.observables import System

    mixture = mixture_of(experiment)
    effects, schedule = scene.effects, experiment.schedule
    return System(
        particles=experiment.particles,
        box=experiment.lengths,
        periodic=tuple(length is not None for length in scene.box),
        inertia=inertia(effects),
        shear_rate=shear_rate(scene),
        interval=PROTOCOLS[schedule.kind].interval(experiment),
        cooling=not PROTOCOLS[schedule.kind].DRIVEN,
        species=() if mixture is None else tuple(map(_species_group, mixture.kinds)),
        period=getattr(schedule, "period", None),
        walls=tuple(closed_sides(walls_of(effects), len(scene.box))),
        rotates=rotation_of_medium(effects) is not None,
    )


def _species_group(species):
    """Return the number of particles of a species and their radius in a, NaN if radii differ."""
    from roughgas.observables.frames import SpeciesGroup

    radii = {*species.radius} if species.spread is None else ()
    return SpeciesGroup(species.number, *(radii if len(radii) == 1 else (math.nan,)))


def initial_scene(scene: Scene, experiment: Experiment) -> Scene:
    """Return the scene at the start of a run, with the wall types that all its stages share."""
    return scenes_of_run(scene, experiment)[0]


def scenes_of_run(scene: Scene, experiment: Experiment) -> list[Scene]:
    """Return the scene at the start of a run, followed by the scene of each stage, if any.

    Raises InputError for a stage with an impossible scene.
    """
    if PROTOCOLS[experiment.schedule.kind] is stages:
        return stages.scenes(scene, experiment)
    return [scene]


def check_experiment(experiment: Experiment) -> None:
    """Raise InputError if the points of an experiment cannot be simulated."""
    built = check_scene(experiment)
    effects = built.effects
    target = getattr(experiment.schedule, TARGET_KEY, None)
    if target and effects.spin is None:
        raise InputError(f"schedule.{TARGET_KEY}", target, "not be given where nothing spins")
    drives = [effects._fields[hook.effect_index] for hook in hooks.active(effects, "drives")]
    kind = experiment.schedule.kind
    if drives and not PROTOCOLS[kind].DRIVEN:
        legal = f"be steady or stages where there is a drive: {', '.join(drives)}"
        raise InputError("schedule.kind", kind, legal)
    if effects.gravity is not None and not PROTOCOLS[kind].DRIVEN:
        legal = "be steady or stages where there is gravity, as a cooling gas is rescaled"
        raise InputError("schedule.kind", kind, legal)
    if kind == "steady" and not drives:
        raise InputError(
            "schedule.kind", kind, "be cooling or stages where no effect drives the gas"
        )
    _check_samples(experiment)
    PROTOCOLS[kind].check(built, experiment)
    if experiment.observables:
        _check_observables(experiment, built)


def _check_samples(experiment):
    """Raise InputError for a schedule with too many samples for the memory."""
    schedule = experiment.schedule
    samples = samples_of(schedule)
    if samples > SAMPLE_LIMIT:
        lengths = [name for name in (*LENGTH_KEYS, "stages") if hasattr(schedule, name)]
        keys = " and ".join(f"schedule.{name}" for name in lengths)
        legal = f"make at most {SAMPLE_LIMIT:.0e} samples of {keys}, not {samples:.0e}"
        raise InputError(*_densest_interval(schedule), legal)


def _densest_interval(schedule):
    """Return the key and the value of the setting of the interval with the most samples."""
    stage_settings = getattr(schedule, "stages", ())
    sample_counts = [stage.samples(schedule.sample_every) for stage in stage_settings]
    index = sample_counts.index(max(sample_counts)) if sample_counts else None
    if index is None or stage_settings[index].sample_every is None:
        return "schedule.sample_every", schedule.sample_every
    return f"schedule.stages[{index}].sample_every", stage_settings[index].sample_every


def _check_observables(experiment, scene):
    """Raise InputError for illegal settings, or observables that do not suit the scene."""
    from roughgas.observables import requested_observables

    for listed in requested_observables(experiment.observables):
        listed.make(observed_system(scene, experiment))
