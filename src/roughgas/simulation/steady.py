"""The steady protocol: a driven gas is equilibrated, then R and the energies are averaged.

Functions take the scene at the r and beta of a point, and the settings of its experiment. The
measured window is the series of samples after equilibration.
"""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Annotated, Any, NamedTuple

import numpy as np
from msgspec.structs import replace

from roughgas.base import InputError, NamedValues
from roughgas.base.fields import described
from roughgas.effects import inertia
from roughgas.effects.gravity import BodyForce
from roughgas.effects.species import packing
from roughgas.scene import Scene, assumes_flow, rotation_of_medium, theory_mixture, walls_of
from roughgas.simulation.energies import (
    Columns,
    Energies,
    energies,
    mean_spins,
    ratio,
    shear_rates,
    species_energies,
)
from roughgas.simulation.energy_averages import (
    contact_averages,
    driven_species_averages,
    mean_energies_and_R,
    mean_spin_averages,
    trust_of_means,
    vertical_share,
)
from roughgas.simulation.energy_balance import EnergyBalance, energy_exchange
from roughgas.simulation.error_target import SAMPLE_LIMIT, TARGET_KEY, prolonged_until_met
from roughgas.simulation.experiment import (
    Duration,
    Experiment,
    Length,
    RelaxationTimes,
    ScheduleSettings,
    Target,
)
from roughgas.simulation.gas import Gas, timed_sampling
from roughgas.simulation.gas_memory import GasMemory, ThermalState, drag_rates, gas_memory
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.leg import Leg
from roughgas.simulation.point_trackers import Samples
from roughgas.simulation.simulation import Simulation
from roughgas.statistics.errors import (
    period_means,
)
from roughgas.statistics.sample_sizes import (
    MINIMUM_SAMPLE_SIZE,
    YES,
    SampleSize,
    describe_shortfall,
    verdict,
)
from roughgas.statistics.steady_state import detect_start, is_equilibrated

WAIT_LIMIT = 100  # times `equilibrate`: the longest wait for relaxation times of theory


class SteadySettings(ScheduleSettings, frozen=True, kw_only=True, tag="steady"):
    """A driven gas in a steady state; lengths are in T."""

    equilibrate: Annotated[Length, described("Time before the measurement, in T.")]
    measure: Annotated[Duration, described("Length of the measurement, in T.")]
    relaxation_times: RelaxationTimes | None = None
    period: (
        Annotated[
            Duration,
            described("Period of the drive in T; samples are averaged over whole periods."),
        ]
        | None
    ) = None
    target_stderr: Target | None = None


# see roughgas.simulation.protocols.RunProtocol
SETTINGS: type[ScheduleSettings] = SteadySettings
DRIVEN, UNIT, LENGTH, SAMPLES_PER_REFRESH = True, "T", "measure", 1
SERIES_VALUES_PER_PERIOD = 4  # in stored series
MIN_SHARE_LEFT = 0.5  # of the planned measurement that a late start must leave
REQUIRED_PHASES = int(MINIMUM_SAMPLE_SIZE.phases)
WHOLE_TOLERANCE = 1e-6  # relative deviation of a number of samples, or periods, from an integer
LACK_VARIABLE = "R_ci95_lack"
"""Temporary variable with the missing evidence of R in words, which becomes a comment."""
REQUIRED_IN_BED = MINIMUM_SAMPLE_SIZE._replace(memories=24)
"""Evidence under gravity, where the measured memory of R is up to twice the theoretical one."""
REQUIRED_FOR_MEANS = MINIMUM_SAMPLE_SIZE._replace(memories=96)
"""Evidence for the errors of mean energies, in e-folds of the slowest relaxation."""


def length(scene: Scene, experiment: Experiment[SteadySettings]) -> float:
    """Return the simulated time of a point, equilibration and measurement, in T.

    Relaxation times of theory may prolong the equilibration.
    """
    schedule = experiment.schedule
    return schedule.equilibrate + schedule.measure


def start(
    scene: Scene, experiment: Experiment[Any], seed: Any, initial: Sequence[InitialState] = ()
) -> Gas:
    """Return the gas of a point at its start; `seed` may be a random generator.

    `initial` has at most one state; with it, the gas begins there.
    """
    return Gas.start(scene, experiment, np.random.default_rng(seed), *initial)


def sample(gas: Gas, every: float, samples: int) -> Columns:
    """Advance a gas and return its samples, `every` T apart, as columns (samples,)."""
    return gas.in_time(every, samples)


def interval(experiment: Experiment[Any]) -> float:
    """Return the interval between two samples, in T."""
    return experiment.schedule.sample_every


def check(scene: Scene, experiment: Experiment[SteadySettings]) -> None:
    """Raise InputError for lengths without a whole period, or samples that do not divide it.

    With a target error the samples must also show enough phases of the drive.
    """
    _check_momentum(scene, experiment)
    _check_body_force(scene)
    schedule = experiment.schedule
    measure, every = schedule.measure, schedule.sample_every
    period = schedule.period or every
    for name, drive_period in drive_periods(scene).items():
        if schedule.period is None or not is_whole(period / drive_period):
            value = "(none)" if schedule.period is None else schedule.period
            legal = f"be a whole multiple of that of {name}, {drive_period:g} T"
            raise InputError("schedule.period", value, legal)
    if not is_whole(period / every):
        legal = f"divide schedule.period, {period:g} T, into whole samples"
        raise InputError("schedule.sample_every", every, legal)
    if sum(_planned_samples(schedule)) < wait(scene, experiment) + samples_per_period(schedule):
        legal = f"hold a whole period, {period:g} T, after the whole ones of equilibrate"
        raise InputError("schedule.measure", measure, legal)
    if schedule.relaxation_times is not None and not _planned_samples(schedule)[0]:
        legal = f"be at least schedule.sample_every, {every:g} T, beside schedule.relaxation_times"
        raise InputError("schedule.equilibrate", schedule.equilibrate, legal)
    if schedule.target_stderr is not None and phases(scene, schedule) < REQUIRED_PHASES:
        legal = (
            f"divide a period of the drive into {REQUIRED_PHASES} samples "
            f"beside schedule.{TARGET_KEY}"
        )
        raise InputError("schedule.sample_every", every, legal)


def _check_momentum(scene, experiment):
    """Raise InputError for noise on single particles if nothing damps their total momentum.

    The velocity of the centre of mass would diffuse, and its energy grow for ever, without a steady
    state. Walls damp the momentum across themselves, and along themselves if rough or thermal.
    """
    effects, (drag, _) = scene.effects, drag_rates(scene)
    bath = effects.langevin
    if bath is None or not bath.noise or drag > 0.0:
        return
    walled_axes = {wall.axis for wall in walls_of(effects).values()}
    if len(walled_axes) < len(scene.box) and not _walls_grip(effects):
        power = experiment.effects["langevin"].power
        legal = (
            "be 0 without a drag in a steady state: noise on single particles heats the centre of "
            "mass of a periodic box for ever (the thermostat conserves momentum)"
        )
        raise InputError("effects.langevin.power", power, legal)


def _check_body_force(scene):
    """Raise InputError for gravity along a periodic axis if nothing damps the momentum along it."""
    effects, (drag, _) = scene.effects, drag_rates(scene)
    if isinstance(effects.gravity, BodyForce) and not drag > 0.0 and not _walls_grip(effects):
        legal = (
            "have no component along a periodic axis in a steady state without rough or thermal "
            "walls, or a drag: the gas falls ever faster"
        )
        raise InputError("effects.gravity.direction", effects.gravity.direction, legal)


def _walls_grip(effects):
    """Return whether walls or the floor change the velocity along themselves."""
    walls = walls_of(effects).values()
    return any(wall.temperature is not None or wall.roughness > -1.0 for wall in walls)


def drive_periods(scene: Scene) -> dict[str, float]:
    """Return the periods (T) of the effects that drive a gas periodically, by name."""
    effects = scene.effects._asdict().items()
    periods = {name: getattr(effect, "period", math.inf) for name, effect in effects}
    return {name: period for name, period in periods.items() if period < math.inf}


def phases(scene: Scene, schedule: SteadySettings, every: int = 1) -> float:
    """Return the number of phases of the drive that every `every`-th sample shows.

    It is infinite for a drive without period.
    """
    per_period, repetition = samples_per_period(schedule), schedule.period or schedule.sample_every
    phase_counts = [
        per_period // math.gcd(per_period, every * round(repetition / period))
        for period in drive_periods(scene).values()
    ]
    return min(phase_counts, default=math.inf)


def _planned_samples(schedule):
    """Return the planned numbers of samples of the equilibration and of the measurement."""
    lengths = schedule.equilibrate, schedule.measure
    return tuple(round(length / schedule.sample_every) for length in lengths)


def is_whole(number: float) -> bool:
    """Return whether a quotient of lengths is an integer, at least 1, to within rounding."""
    return number > 0.5 and abs(number - round(number)) <= WHOLE_TOLERANCE * number


def samples_per_period(schedule: SteadySettings) -> int:
    """Return the number of samples in the schedule's period; 1 without a period."""
    every = schedule.sample_every
    return max(1, round((schedule.period or every) / every))


def wait(scene: Scene, experiment: Experiment[SteadySettings]) -> int:
    """Return the number of samples of equilibration, rounded up to whole periods."""
    schedule = experiment.schedule
    planned, _ = _planned_samples(schedule)
    return -(-planned // samples_per_period(schedule)) * samples_per_period(schedule)


def run(
    scene: Scene,
    experiment: Experiment[SteadySettings],
    seed: int,
    simulation: Simulation,
    initial: Sequence[InitialState] = (),
) -> NamedValues:
    """Simulate one gas and return the variables of the point by name (see roughgas.data.point).

    The schedule has `equilibrate`, `measure`, `sample_every` and `period`, all in T; averages are
    taken over whole periods. If the energies are not yet stationary, the measurement begins later
    than planned. The point is flagged if half of the measurement would be lost, or if the energies
    drift in the rest. R is trusted only in a steady state, and if samples show enough phases of a
    periodic drive. With a target error, the measurement is prolonged.
    """
    samples = simulation.track("samples", Samples())
    gas = start(scene, experiment, seed, initial)
    if initial:
        gas.sample_now()  # running sums may start from nonzero values
    gas_start = GasStart(
        gas.time, gas.sample, gas.balance(), gas.collisions_before_cooling + gas.collisions
    )
    theory = _theory_of_gas(scene, experiment)

    def rows_to(schedule):
        """Prolong the run to a schedule; return all its samples as columns by name."""
        simulation.expect(schedule.equilibrate + schedule.measure)
        leg = driven_leg(gas, schedule)
        simulation.follow(0, lambda: gas, lambda _: [leg])
        return samples.rows(leg.name, leg.samples)

    def run_to(schedule):
        """Prolong the run to a schedule; return the variables, and whether R may be trusted."""
        rows = rows_to(schedule)
        variables = _measured_variables(gas, schedule, rows, gas_start, theory)
        return variables, variables.get("R_ci95_trusted") == YES

    def settling_time(wait):
        """Prolong the run to the end of a wait, and return theory's e-fold in its second half.

        Both are in T.
        """
        rows = rows_to(replace(experiment.schedule, equilibrate=wait, measure=0.0))
        middle, every = len(rows["time"]) // 2, experiment.schedule.sample_every
        return _window_from(gas, rows, middle, gas_start, theory, every).memory_times.settling

    schedule, wait_variables = _with_relaxed_start(experiment.schedule, settling_time)
    return prolonged_until_met(schedule, LENGTH, run_to) | wait_variables


def _with_relaxed_start(
    schedule: SteadySettings, settling_time: Callable[[float], float]
) -> tuple[SteadySettings, NamedValues]:
    """Return a schedule that waits for its `relaxation_times`, and variables on the wait by name.

    `settling_time(wait)` runs to the end of a wait (T), and returns the e-fold of the slowest
    transient (T), by theory in the state of the gas there. The energies may still change then:
    the wait is at most doubled before theory is asked again.
    """
    if schedule.relaxation_times is None:
        return schedule, {}
    longest = min(
        WAIT_LIMIT * schedule.equilibrate,
        max(schedule.equilibrate, SAMPLE_LIMIT * schedule.sample_every - schedule.measure),
    )
    wait, unit = schedule.equilibrate, schedule.period or schedule.sample_every
    while True:
        relaxation_time = settling_time(wait)
        required = schedule.relaxation_times * relaxation_time
        if wait >= min(required, longest):
            relaxations = _quotient_or_infinity(wait, relaxation_time)
            variables = {"wait": wait, "wait_relaxations": relaxations}
            return replace(schedule, equilibrate=wait), variables
        wait = math.ceil(min(required, 2.0 * wait, longest) / unit) * unit


def driven_leg(gas: Gas, schedule: SteadySettings) -> Leg:
    """Return the only leg of a driven gas: equilibration and measurement with equal sampling."""
    sampling = timed_sampling(schedule.sample_every, gas.particles)
    return Leg("driven", sampling, sum(_planned_samples(schedule)), gas.scene, timed=True)


class GasStart(NamedTuple):
    """Time (T), running sums, energy balance and number of collisions of a gas at its start."""

    time: float
    sums: Columns
    balance: EnergyBalance
    collisions: int


class TheoryOfGas(NamedTuple):
    """The memory times of a gas by theory, as a function of its measured state, and its box.

    `lengths` are the sides of the box, infinite along an open axis.
    """

    memory: Callable[[ThermalState], GasMemory]
    lengths: tuple[float, ...]  # a


def _theory_of_gas(scene: Scene, experiment: Experiment[SteadySettings]) -> TheoryOfGas:
    """Return the function of memory times, and the sides of the box, for a point's scene."""
    lengths = tuple(math.inf if side is None else side for side in experiment.lengths)
    mixture = theory_mixture(scene, experiment)
    has_packing = mixture is not None and math.isfinite(math.prod(lengths))
    packing_fraction = packing(experiment) if has_packing else 0.0
    return TheoryOfGas(
        partial(gas_memory, scene, mixture=mixture, packing=packing_fraction), lengths
    )


def _measured_variables(
    gas: Gas, schedule: SteadySettings, rows: Columns, gas_start: GasStart, theory: TheoryOfGas
) -> NamedValues:
    """Return the variables of a run by name, from all its samples `rows` (columns by name)."""
    scene, every, per_period = gas.scene, schedule.sample_every, samples_per_period(schedule)
    planned, length = _planned_samples(schedule)
    spins = mean_spins(rows, scene, gas.state)
    signals = [*gas.energies(rows).present_components(), *spins]
    first, settled = _measurement_start(signals, planned, length, per_period)
    window, species, waited, measured, memory_times = _window_from(
        gas, rows, first, gas_start, theory, every
    )
    periods = len(window.translational) // per_period
    evidence = _evidence_of_window(waited, measured, periods, memory_times)
    required = MINIMUM_SAMPLE_SIZE if scene.effects.gravity is None else REQUIRED_IN_BED
    steady = evidence.verdict(settled, required)
    variables = {
        **mean_energies_and_R(window, per_period, every),
        **contact_averages(rows, first, per_period, inertia_of_contact_sums(scene), gas_start.sums),
        **_vertical_share(gas, rows, window.translational, per_period),
        **_unsubtracted_energies(gas, rows, first),
        **mean_spin_averages([spin[first:] for spin in spins], per_period),
        **driven_species_averages(
            species, per_period, max(1, per_period // SERIES_VALUES_PER_PERIOD)
        ),
        **energy_exchange(gas_start.balance, gas.balance(), scene, gas.particles),
        "equilibrated": steady,
        "slowest_relaxation": memory_times.energies,
        "flow_relaxation": memory_times.flow,
        "measured_from": gas_start.time + first * every,
        "measured_collisions": measured.collisions,
        **period_mean_series(
            rows["time"][first:], window, max(1, per_period // SERIES_VALUES_PER_PERIOD)
        ),
    }
    phases_shown = phases(scene, schedule)
    means_evidence = SampleSize(
        phases=phases_shown, memories=_quotient_or_infinity(measured.time, memory_times.energies)
    )
    variables |= trust_of_means(variables, int(verdict(steady, means_evidence, REQUIRED_FOR_MEANS)))
    if window.rotational is None:
        return variables
    ratio_evidence = SampleSize(
        phases=phases_shown,
        memories=_quotient_or_infinity(measured.time, memory_times.of_R),
        times=measured.time / variables["autocorrelation_time"],
    )
    variables["R_ci95_trusted"] = int(verdict(steady, ratio_evidence))
    lack = describe_shortfall(evidence, required) or describe_shortfall(
        ratio_evidence, MINIMUM_SAMPLE_SIZE
    )
    return variables | {"memory_of_R": memory_times.of_R, LACK_VARIABLE: lack}


class MeasuredLength(NamedTuple):
    """The length of the measured window, in collisions per particle and in T."""

    collisions: float  # of each particle
    time: float  # T

    @property
    def frequency(self) -> float:
        """Number of contacts of a particle per T."""
        return self.collisions / self.time


class Window(NamedTuple):
    """A measured window: its energies and theory's memory times in its state."""

    energies: Energies  # (samples,)
    species: Sequence[Energies]  # empty if all particles are identical
    waited: float  # collisions per particle before it
    measured: MeasuredLength
    memory_times: GasMemory


def _window_from(
    gas: Gas, rows: Columns, first: int, gas_start: GasStart, theory: TheoryOfGas, every: float
) -> Window:
    """Return the window of all samples in `rows`, `every` T apart, from the index `first` on."""
    collisions_before = rows["collisions"][first - 1] if first else gas_start.collisions
    window = gas.energies(rows).map(lambda values: values[first:])
    species = [
        energies.map(lambda values: values[first:])
        for energies in species_energies(rows, gas.scene, gas.state)
    ]
    measured = MeasuredLength(
        2 * (rows["collisions"][-1] - collisions_before) / gas.particles,
        len(window.translational) * every,
    )
    state = _thermal_state(species or [window], measured.frequency, gas.particles, theory.lengths)
    memory_times = _with_fixed_spins(theory.memory(state), state, window)
    return Window(window, species, 2 * collisions_before / gas.particles, measured, memory_times)


def _evidence_of_window(
    waited: float, measured: MeasuredLength, periods: int, memory_times: GasMemory
) -> SampleSize:
    """Return the amounts of data in a measured window.

    It began after `waited` collisions per particle. `periods` is the number of periods of the drive
    in it, and `memory_times` come from theory. If theory gives no memory of R, twice the slowest
    e-fold of the energies takes its place.
    """
    has_memory = 0.0 < memory_times.of_R < math.inf
    memory = memory_times.of_R if has_memory else 2.0 * memory_times.energies
    return SampleSize(
        collisions=measured.collisions,
        samples=periods,
        relaxations=_transient_relaxations(waited, measured, memory_times.energies),
        memories=_quotient_or_infinity(measured.time, memory),
    )


def _quotient_or_infinity(length: float, unit: float) -> float:
    """Return `length` over `unit`; infinity unless the unit is positive."""
    return length / unit if unit > 0.0 else math.inf


def _with_fixed_spins(memory_times: GasMemory, state: ThermalState, window: Energies) -> GasMemory:
    """Return the memory times, corrected if spins never change in the measured window.

    Then R is 0 for ever, or depends on the initial spins: its memory is 0 or infinite.
    """
    if state.T_rot is not None:
        return memory_times
    has_spin = window.rotational is not None and bool(window.rotational.any())
    return memory_times._replace(of_R=math.inf if has_spin else 0.0)


def _thermal_state(
    species: Sequence[Energies], frequency: float, particles: int, lengths: tuple[float, ...]
) -> ThermalState:
    """Return the thermal state of a gas: T_tr and T_rot of its species, and constants.

    Temperatures are twice the mean energies (samples,) in `species`; `frequency` is the number of
    contacts of a particle per T, and `lengths` are the sides of the box in a. Spins that never
    change are left out, since nothing relaxes them.
    """
    T_tr = 2.0 * np.array([energies.translational.mean() for energies in species])
    spins = [energies.rotational for energies in species if energies.rotational is not None]
    changing = any(np.ptp(rotational) > 0.0 for rotational in spins)
    T_rot = 2.0 * np.array([rotational.mean() for rotational in spins]) if changing else None
    return ThermalState(T_tr, T_rot, frequency, particles, lengths)


def _transient_relaxations(waited: float, measured: MeasuredLength, slowest: float) -> float:
    """Return the decay of the transient before the window, in e-folds of the slowest mode.

    A transient with amplitude exp(-m) at the start of a window of w e-folds contributes exp(-m)/w
    to the mean: the window itself counts for ln w. `waited` is in collisions per particle, and
    `slowest` is the e-fold of the mode in T.
    """
    window_relaxations = _quotient_or_infinity(measured.time, slowest)
    if not (window_relaxations > 0.0 and measured.collisions > 0.0):
        return -math.inf
    return window_relaxations * waited / measured.collisions + math.log(window_relaxations)


def _measurement_start(signals, planned, length, per_period):
    """Return the index of the first measured sample, and whether the samples from there are steady.

    It follows whole periods of `per_period` samples. `signals` are the energies and the mean spins,
    each (samples,), `planned` and `length` the planned numbers of samples of equilibration and
    measurement.
    """
    means = [period_means(signal, per_period) for signal in signals]
    first = -(-planned // per_period) * per_period
    start = per_period * detect_start(*means, planned=first // per_period)
    if planned + length - start < MIN_SHARE_LEFT * length:
        return first, False
    return start, is_equilibrated(*means, start=start // per_period)


def period_mean_series(time, window, samples_per_value):
    """Return the series of time, E_trans, E_rot and R, by name.

    `time` (samples,) is in T and `window` are the energies (samples,). Each value averages
    `samples_per_value` samples.
    """
    series = {"time": time, "E_trans_series": window.translational}
    if window.rotational is not None:
        series |= {"R_series": ratio(window), "E_rot_series": window.rotational}
    return {name: period_means(values, samples_per_value) for name, values in series.items()}


def inertia_of_contact_sums(scene: Scene) -> float:
    """Return the q that weights sums over contacts: 1 in a mixture or without spin."""
    q = inertia(scene.effects)
    return 1.0 if q is None or scene.effects.species is not None else q


def _vertical_share(gas, rows, translational, per_period):
    """Return the share of vertical motion in the translational energy of a bed, with its errors.

    It is averaged over the last samples of `rows`, whose E_trans is `translational` (samples,);
    `per_period` is the number of samples in a period of the drive. Without gravity the result is
    empty.
    """
    if gas.scene.effects.gravity is None:
        return {}
    window = {name: values[-len(translational) :] for name, values in rows.items()}
    return vertical_share(window, translational, gas.particles, per_period)


def _unsubtracted_energies(gas, rows, first):
    """Return energies and R that include a mean flow and a mean spin, by name.

    They are averages over the samples `rows` from the index `first` on. The result is empty without
    such a flow, and outside of baths whose medium rotates.
    """
    effects, variables = gas.scene.effects, {}
    flow_is_assumed = assumes_flow(effects)
    if not flow_is_assumed and rotation_of_medium(effects) is None:
        return {}
    if flow_is_assumed and effects.shear is None:
        variables["shear_rate"] = shear_rates(rows, gas.state)[first:].mean()
    series = energies(rows, gas.particles, inertia(effects))
    window = series.map(lambda energy: energy[first:])
    variables["E_trans_unsubtracted"] = window.translational.mean()
    if window.rotational is not None:
        variables["E_rot_unsubtracted"] = window.rotational.mean()
        variables["R_unsubtracted"] = ratio(window).mean()
    return variables
