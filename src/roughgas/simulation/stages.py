"""The staged protocol: settings of a gas change, or temperatures are set, at the start of stages.

Functions take the scene at the r and beta of a point, and the settings of its experiment.

A change persists until a later stage changes the same setting again. Times are in T. The series run
through all stages, and contain the energy supplied by changes and by effects; averages are over the
measured stages. Errors need samples at equal intervals: with other samples the averages are means
over time without errors.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Annotated, Any, NamedTuple

import numpy as np

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, NamedValues
from roughgas.base.fields import described, number, numbers, reference
from roughgas.kernel.record import Sampling
from roughgas.kernel.state import EXPONENT
from roughgas.scene import Scene, build
from roughgas.simulation import steady
from roughgas.simulation.energies import (
    Energies,
    energies_of,
    mean_spins,
    ratio,
    species_energies,
)
from roughgas.simulation.energy_averages import (
    contact_averages,
    driven_species_averages,
    mean_energies_and_R,
    mean_spin_averages,
    trust_of_means,
)
from roughgas.simulation.energy_balance import energy_exchange, exchange_series
from roughgas.simulation.experiment import Experiment, ScheduleSettings
from roughgas.simulation.gas import PRESENT_SAMPLE, Gas, concatenated, timed_sampling
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.leg import Changes, Leg
from roughgas.simulation.point_trackers import SamplesWithBalance
from roughgas.simulation.scene_switch import (
    TargetTemperatures,
    check_scene_switch,
    switch_scene,
    with_images_continued,
)
from roughgas.simulation.simulation import Simulation
from roughgas.simulation.stage_sampling import (
    LENGTH_ROUNDING,
    StageInstants,
    StageSamplingSettings,
    common_spacing,
)
from roughgas.simulation.wall_types import with_common_wall_types
from roughgas.statistics.sample_sizes import UNKNOWN

Temperature = Annotated[
    float,
    number(
        "(0, 1e+08]",
        "Temperature of translation, 2 E_trans, that velocities are scaled to when it begins, in "
        "m a^2/T^2.",
    ),
]
SpinTemperature = Annotated[
    float,
    number(
        "[0, 1e+08]",
        "Temperature of rotation, 2 E_rot, that spins are scaled to; 0 stops all spins. Where no "
        "particle spins, spins are drawn from a Maxwellian.",
    ),
]


class StageSettings(StageSamplingSettings, frozen=True, kw_only=True):
    """A stage; its changes persist until a later stage changes the same settings again."""

    measure: Annotated[
        bool,
        described(
            "Whether R and the energies are averaged over it, too; true by default. Stages that "
            "are not measured come first. Series run through all stages."
        ),
    ] = True
    effects: Annotated[
        Mapping[str, Mapping[str, Any] | None],
        reference("effects", "New values of parameters of effects that the experiment has."),
    ] = {}
    r: (
        Annotated[float, number(RESTITUTION.text, "New normal restitution of the particles.")]
        | None
    ) = None
    beta: Annotated[float, number(ROUGHNESS.text, "New roughness of the particles.")] | None = None
    temperature: Temperature | None = None
    spin_temperature: SpinTemperature | None = None

    @property
    def changes_scene(self) -> bool:
        """Whether the stage changes effects, r or beta."""
        return bool(self.effects) or self.r is not None or self.beta is not None


class StagesSettings(ScheduleSettings, frozen=True, kw_only=True, tag="stages"):
    """A gas whose settings change from stage to stage."""

    stages: Annotated[
        tuple[StageSettings, ...],
        numbers(1, 1000, "The stages that the gas goes through, one after the other."),
    ]


# see roughgas.simulation.protocols.RunProtocol
SETTINGS: type[ScheduleSettings] = StagesSettings
DRIVEN, UNIT, LENGTH, SAMPLES_PER_REFRESH = True, "T", "stages", 1
sample = steady.sample
SPIN_SEED = 0x5B15
"""First seed of the generators of spins, which distinguishes them from all others of a run."""
UNEVEN_SAMPLING_LACK = "samples at equal intervals are needed"
"""Comment on R_ci95_trusted if intervals differ."""


class Stage(NamedTuple):
    """A stage of a run: its beginning `begin` (T), scene, sampling, and temperatures to be set.

    `measured` is whether averages include it.
    """

    rank: int  # from 0
    begin: float
    instants: StageInstants
    scene: Scene
    temperatures: TargetTemperatures
    measured: bool

    @property
    def duration(self) -> float:
        """Duration of the stage, in T."""
        return self.instants.duration

    def enter(self, gas: Gas, seed: Any) -> np.ndarray:
        """Switch a gas to the scene of this stage, at its beginning; return the supplied energy.

        The energy is (2,) of translation and rotation, in m a^2/T^2 (see
        roughgas.simulation.scene_switch). Random numbers depend on `seed`, of the point, and the
        stage's rank.
        """
        rng = np.random.default_rng([SPIN_SEED, self.rank, seed])
        return switch_scene(gas, self.scene, self.begin, self.temperatures, rng)


def course(scene: Scene, experiment: Experiment[StagesSettings], begun: float = 0.0) -> list[Stage]:
    """Return the stages of an experiment in order; the first one begins at the time `begun` (T).

    `scene` has the r and beta of stages that do not set others. Raises InputError for a stage that
    names an absent effect, or changes more than numbers.
    """
    stages: list[Stage] = []
    schedule, time = experiment.schedule, begun
    scene_before, *stage_scenes = scenes(scene, experiment)
    for rank, (settings, scene) in enumerate(zip(schedule.stages, stage_scenes, strict=True)):
        new = (
            with_images_continued(scene_before, scene, time)
            if settings.changes_scene
            else scene_before
        )
        temperatures = TargetTemperatures(settings.temperature, settings.spin_temperature)
        check_scene_switch(scene_before, new, time, temperatures, f"schedule.stages[{rank}]")
        instants = settings.instants(schedule.sample_every)
        stages.append(Stage(rank, time, instants, new, temperatures, settings.measure))
        scene_before, time = new, time + settings.duration
    return stages


def scenes(scene: Scene, experiment: Experiment[StagesSettings]) -> list[Scene]:
    """Return the initial scene of a gas and the scene of each stage, with common wall types.

    Raises InputError for a stage that names an absent effect, or has an impossible scene.
    """
    run_scenes, settings = [scene], experiment
    r, beta = scene.restitution, scene.roughness
    for rank, stage in enumerate(experiment.schedule.stages):
        key = f"schedule.stages[{rank}]"
        for name in stage.effects:
            if name not in settings.effects:
                legal_names = ", ".join(sorted(settings.effects))
                raise InputError(
                    f"{key}.effects: key", name, f"be one of this experiment: {legal_names}"
                )
        r, beta = (
            old if value is None else value for value, old in ((stage.r, r), (stage.beta, beta))
        )
        if stage.changes_scene:
            settings, scene = _changed_scene(settings, stage.effects, r, beta, key)
        run_scenes.append(scene)
    return with_common_wall_types(run_scenes)


def _changed_scene(settings, effects, r, beta, key):
    """Return the settings with changed `effects`, and their scene at r and beta.

    Raises InputError, which names the stage by `key`.
    """
    try:
        settings = settings.with_effects(effects)
        return settings, build(settings, r, beta)
    except InputError as error:
        error.key = f"{key}: {error.key}"
        raise


def length(scene: Scene, experiment: Experiment[StagesSettings]) -> float:
    """Return the simulated time of a point, the sum of all stages, in T."""
    return sum(stage.duration for stage in experiment.schedule.stages)


def start(
    scene: Scene,
    experiment: Experiment[StagesSettings],
    seed: Any,
    initial: Sequence[InitialState] = (),
) -> Gas:
    """Return the gas of a point at its start, in the scene before the first stage.

    `seed` is the seed of the point, or a random generator; `initial` has at most one state. Raises
    InputError for a state of a gas that has cooled.
    """
    gas = steady.start(scenes(scene, experiment)[0], experiment, seed, initial)
    if gas.state.counts[EXPONENT]:
        legal = "come without last_memory, in which time has another unit"
        raise InputError("initial", "a gas that has cooled", legal)
    return gas


def samples_per_period(schedule: StagesSettings) -> int:
    """Return 1, the number of samples in a period: averages weight all samples equally."""
    return 1


def phases(scene: Scene, schedule: StagesSettings, every: int = 1) -> float:
    """Return infinity, the number of sampled phases of a drive: no average is over its period."""
    return math.inf


def check(scene: Scene, experiment: Experiment[StagesSettings]) -> None:
    """Raise InputError for stages that cannot be simulated, or without a measured one."""
    schedule = experiment.schedule
    for rank, settings in enumerate(schedule.stages):
        settings.check_instants(schedule.sample_every, f"schedule.stages[{rank}]")
    stages = course(scene, experiment)
    for rank, stage in enumerate(stages):
        key = f"schedule.stages[{rank}]"
        if rank and stages[rank - 1].measured and not stage.measured:
            raise InputError(f"{key}.measure", False, "not be false after a stage that is measured")
    if not stages[-1].measured:
        key = f"schedule.stages[{len(stages) - 1}].measure"
        raise InputError(key, False, "be true of the last stage")
    if experiment.observables:
        _check_equal_intervals(schedule)
    sheared = [
        stage.scene.effects.shear for stage in stages if stage.scene.effects.shear is not None
    ]
    if experiment.observables and len({shear.velocity for shear in sheared}) > 1:
        raise InputError("observables", "with a shear that changes", "come with a constant one")


def _check_equal_intervals(schedule):
    """Raise InputError for samples at unequal intervals, over which observables cannot average."""
    default_interval = schedule.sample_every
    spacings = [stage.instants(default_interval).spacing for stage in schedule.stages]
    for rank, spacing in enumerate(spacings):
        if spacing is None or not math.isclose(
            spacing, spacings[0] or default_interval, rel_tol=LENGTH_ROUNDING
        ):
            # if this stage has the schedule's interval, the first one differs
            rank = 0 if spacing == default_interval else rank
            key, value = schedule.stages[rank].sampling_key()
            legal = "be left out beside observables, which need all samples at equal intervals"
            raise InputError(f"schedule.stages[{rank}].{key}", value, legal)


def interval(experiment: Experiment[StagesSettings]) -> float:
    """Return the interval between two samples in T; if intervals differ, the schedule's."""
    schedule = experiment.schedule
    instants = [stage.instants(schedule.sample_every) for stage in schedule.stages]
    return common_spacing(instants) or schedule.sample_every


def wait(scene: Scene, experiment: Experiment[StagesSettings]) -> int:
    """Return the number of samples in the stages before the measurement.

    Raises InputError if samples are not at equal intervals.
    """
    _check_equal_intervals(experiment.schedule)
    waited = sum(stage.duration for stage in experiment.schedule.stages if not stage.measure)
    return round(waited / interval(experiment))


def run(
    scene: Scene,
    experiment: Experiment[StagesSettings],
    seed: int,
    simulation: Simulation,
    initial: Sequence[InitialState] = (),
) -> NamedValues:
    """Simulate one gas and return the variables of the point by name (see roughgas.data.point).

    The end of each stage is its last sample. `initial` has the state that the gas begins in, if
    any.
    """
    samples = simulation.track("samples", SamplesWithBalance())
    gas = start(scene, experiment, seed, initial)
    if initial:
        gas.sample_now()  # running sums may start from nonzero values
    start_time, initial_sums, initial_balance = gas.time, gas.sample, gas.balance()
    initial_collisions = gas.collisions_before_cooling + gas.collisions
    stages = course(scene, experiment, start_time)
    legs = [_stage_legs(stage, gas.particles, seed) for stage in stages]
    simulation.follow(0, lambda: gas, lambda _: [leg for stage_legs in legs for leg in stage_legs])
    rows = [concatenated([samples.rows(leg.name) for leg in stage_legs]) for stage_legs in legs]
    series = [  # of all particles, and of each species
        [
            energies_of(columns, stage.scene, gas.state),
            *species_energies(columns, stage.scene, gas.state),
        ]
        for stage, columns in zip(stages, rows, strict=True)
    ]
    total, *species = (_joined_energies(energies) for energies in zip(*series, strict=True))
    spins_of_stages = [
        mean_spins(columns, stage.scene, gas.state)
        for stage, columns in zip(stages, rows, strict=True)
    ]
    spins = [
        np.concatenate(spin_of_stages) for spin_of_stages in zip(*spins_of_stages, strict=True)
    ]
    changes = np.array([samples.changes(stage_legs[0].name)["put_in"] for stage_legs in legs])
    counts = [len(columns["time"]) for columns in rows]
    first = sum(count for count, stage in zip(counts, stages, strict=True) if not stage.measured)
    columns_of_run = concatenated(rows)
    collisions = 2.0 * (columns_of_run["collisions"] - initial_collisions) / gas.particles
    variables = {
        **_measured_averages(total, species, spins, first, stages),
        **contact_averages(
            columns_of_run, first, 1, steady.inertia_of_contact_sums(gas.scene), initial_sums
        ),
        **energy_exchange(
            initial_balance, gas.balance(), gas.scene, gas.particles, changes.sum(axis=0)
        ),
        "equilibrated": UNKNOWN,  # stages need not be steady
        "measured_from": _measured_from(stages, first),
        "measured_collisions": collisions[-1] - (collisions[first - 1] if first else 0.0),
        **steady.period_mean_series(columns_of_run["time"], total, 1),
        "collisions_series": collisions,
        **exchange_series(
            columns_of_run, initial_balance, gas.scene, gas.particles, changes, counts
        ),
        "stage_begin": [stage.begin for stage in stages],
        "stage_input": changes / gas.particles,
    }
    if total.rotational is not None:
        variables["R_ci95_trusted"] = UNKNOWN
    if _spacing(stages, measured=True) is None:
        variables |= _without_errors(variables)
    return variables | trust_of_means(variables, UNKNOWN)


def _spacing(stages: Sequence[Stage], measured: bool = False) -> float | None:
    """Return the interval between samples in all stages, or the `measured` ones; None if it varies.

    It is in T.
    """
    return common_spacing([stage.instants for stage in stages if stage.measured or not measured])


def _measured_from(stages: Sequence[Stage], first: int) -> float:
    """Return the start of the measurement in T, after `first` samples."""
    every = _spacing(stages)
    if every is not None:
        return stages[0].begin + first * every
    return next(stage.begin for stage in stages if stage.measured)


def _stage_legs(stage: Stage, particles: int, seed: Any) -> list[Leg]:
    """Return the legs of a stage; the first one begins with the change of the gas.

    The last sample is exactly at the end of the stage, to the last bit: kicks may be due at that
    instant, and must precede the next change in every run.
    """

    def begin(gas: Gas) -> Changes:
        """Switch the gas to the stage, and return the supplied energy by name."""
        return {"put_in": stage.enter(gas, seed)}

    def until(instant: float) -> Callable[[Gas], Sampling]:
        """Return a function that makes the sampling up to `instant` (T, from the stage's start)."""
        return lambda gas: timed_sampling(stage.begin + instant - gas.time, gas.particles)

    rank, instants, legs = stage.rank, stage.instants, []
    if instants.start:
        legs.append(Leg(f"start of stage {rank}", PRESENT_SAMPLE, 1, stage.scene))
    for index, instant in enumerate(instants.listed[:-1]):
        name = f"sample {index} of stage {rank}"
        legs.append(Leg(name, until(instant), 1, stage.scene, timed=True))
    if instants.every is not None and instants.after_start > 1:
        sampling = timed_sampling(instants.every, particles)
        name, count = f"stage {rank}", instants.after_start - 1
        legs.append(Leg(name, sampling, count, stage.scene, timed=True))
    legs.append(Leg(f"end of stage {rank}", until(stage.duration), 1, stage.scene, timed=True))
    return [legs[0]._replace(begin=begin), *legs[1:]]


def _joined_energies(energies_of_stages):
    """Return the energies of all stages, each (samples,), as one series."""
    return Energies(
        *map(
            np.concatenate,
            zip(*(energies.present_components() for energies in energies_of_stages), strict=True),
        )
    )


def _measured_averages(total, species, spins, first, stages):
    """Return averages over the measured samples, from `first` on, and series of species and of the
    mean spin, by name.

    `total` and `species` are the energies (samples,) of all particles and of each species, `spins`
    their mean spins, as from `mean_spins`. The series run through all stages.
    """
    every, window = _spacing(stages, measured=True), total.map(lambda energy: energy[first:])
    weights, means = None, mean_energies_and_R(window, 1, every or math.nan)
    if every is None:
        weights = np.concatenate([stage.instants.intervals() for stage in stages if stage.measured])
        means |= _means_over_time(window, weights)
    measured = [energies.map(lambda energy: energy[first:]) for energies in species]
    all_averages = driven_species_averages(species, 1, 1)
    series = {name: values for name, values in all_averages.items() if name.endswith("_series")}
    means |= mean_spin_averages([spin[first:] for spin in spins], 1, weights)
    series |= {"mean_spin_series": spins[0]} if spins else {}
    return means | driven_species_averages(measured, 1, 1, weights) | series


def _means_over_time(window: Energies, weights: np.ndarray) -> NamedValues:
    """Return the mean energies and mean R over time, by name.

    Each sample of the measured `window` is weighted with the interval before it, in `weights`
    (samples,).
    """
    weighted = weights > 0.0  # samples at the beginning of a stage have no weight
    window, mean = (
        window.map(lambda energy: energy[weighted]),
        partial(np.average, weights=weights[weighted]),
    )
    means = {"E_trans": mean(window.translational)}
    if window.rotational is not None:
        means |= {"E_rot": mean(window.rotational), "R": mean(ratio(window))}
        means["R_ratio_of_means"] = ratio(window.map(mean))[()]
    return means


def _without_errors(variables: NamedValues) -> NamedValues:
    """Return all errors among `variables`, set to NaN, and the reason: unequal intervals."""
    endings = ("_stderr", "_dof", "_ci95", "autocorrelation_time")
    errors: NamedValues = {
        name: np.full(np.shape(value), math.nan)[()]
        for name, value in variables.items()
        if name.endswith(endings)
    }
    if "R_ci95_trusted" in variables:
        errors[steady.LACK_VARIABLE] = UNEVEN_SAMPLING_LACK
    return errors
