"""A gas under steady driving: wait until it is stationary, then average over time."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.effects import inertia
from roughgas.effects.species import packing
from roughgas.scene import Scene, assumes_flow, for_theory, walls_of
from roughgas.simulation.energies import (
    Columns,
    Energies,
    EnergyBalance,
    contact_averages,
    driven_species,
    energies,
    energies_of_each,
    energy_exchange,
    ratio,
    ratio_of_means,
    shear_rates,
    verdicts_on_means,
)
from roughgas.simulation.gas import Gas, joined
from roughgas.simulation.memory import Memory, Thermal, drags, memory
from roughgas.simulation.recorder import KEY, Recorder, until_met
from roughgas.simulation.restart import Initial
from roughgas.statistics.errors import (
    LEAST,
    YES,
    Error,
    Evidence,
    autocorrelation_time,
    blocking,
    degrees_of_freedom,
    lack_of,
    period_means,
    verdict,
)
from roughgas.statistics.steady_state import detect_start, is_equilibrated

# see roughgas.simulation.schedule.Kind
DRIVEN, UNIT, LENGTH, SAMPLES_PER_REFRESH = True, "T", "measure", 1
KEPT = 4  # values in a period that the stored series have
LEAST_LEFT = 0.5  # share of the planned measurement below which a late start is not worth having
LEAST_PHASES = int(LEAST.phases)
WHOLE = 1e-6  # by which a number of samples, or of periods, may miss a whole one
LACK = "R_ci95_lack"
"""What R lacks to be trusted, in words, among the variables of a run: it becomes a comment."""
LEAST_IN_BED = LEAST._replace(memories=24)
"""Evidence under gravity, where R is measured to remember up to twice as long as by theory."""
LEAST_OF_MEANS = LEAST._replace(memories=96)
"""Evidence for the errors of mean energies, of which a memory is an e-fold of the slowest one."""


def length(scene: Scene, experiment: Mapping[str, Any]) -> float:
    """Return the T that a point simulates."""
    schedule = experiment["schedule"]
    return schedule["equilibrate"] + schedule["measure"]


def start(scene: Scene, experiment: Mapping[str, Any], seed: Any, recorder=None, initial=()) -> Gas:
    """Return the gas of a point as it begins; `seed` may be a random generator."""
    rng = np.random.default_rng(seed)
    return Gas.start(scene, experiment, rng, recorder, *initial)


def sample(gas: Gas, every: float, samples: int) -> Columns:
    """Return columns, sampled every so many T."""
    return gas.in_time(every, samples)


def interval(experiment: Mapping[str, Any]) -> float:
    """Return the T between two samples."""
    return experiment["schedule"]["sample_every"]


def check(scene: Scene, experiment: Mapping[str, Any]) -> None:
    """Raise InputError for lengths that make no whole period, or samples that miss phases of it."""
    _check_momentum(scene, experiment)
    schedule = experiment["schedule"]
    measure, every = schedule["measure"], schedule["sample_every"]
    period = schedule.get("period", every)
    for name, own in drive_periods(scene).items():
        if "period" not in schedule or not is_whole(period / own):
            found = schedule.get("period", "(none)")
            legal = f"be a whole multiple of that of {name}, {own:g} T"
            raise InputError("schedule.period", found, legal)
    if not is_whole(period / every):
        legal = f"divide schedule.period, {period:g} T, into whole samples"
        raise InputError("schedule.sample_every", every, legal)
    if sum(_planned(schedule)) < wait(scene, experiment) + samples_per_period(schedule):
        legal = f"hold a whole period, {period:g} T, after the whole ones of equilibrate"
        raise InputError("schedule.measure", measure, legal)
    if KEY in schedule and phases(scene, schedule) < LEAST_PHASES:
        legal = f"divide a period of the drive into {LEAST_PHASES} samples beside schedule.{KEY}"
        raise InputError("schedule.sample_every", every, legal)


def _check_momentum(scene, experiment):
    """Refuse noise on single particles where nothing damps their total momentum.

    The centre of mass would diffuse, and its energy grow for ever: there is no steady state. Walls
    damp the momentum across themselves, and along themselves if they are rough or thermal.
    """
    effects, (drag, _) = scene.effects, drags(scene)
    bath = effects.langevin
    if bath is None or not bath.noise or drag > 0.0:
        return
    walls = walls_of(effects).values()
    across = {wall.axis for wall in walls}
    gripping = any(wall.temperature is not None or wall.roughness > -1.0 for wall in walls)
    if len(across) < len(scene.box) and not gripping:
        power = experiment["effects"]["langevin"]["power"]
        legal = (
            "be 0 without a drag in a steady state: noise on single particles heats the centre of "
            "mass of a periodic box for ever (the thermostat conserves momentum)"
        )
        raise InputError("effects.langevin.power", power, legal)


def drive_periods(scene: Scene) -> dict[str, float]:
    """Return the period (T) of each effect that drives a gas periodically, by name."""
    found = scene.effects._asdict().items()
    periods = {name: getattr(one, "period", math.inf) for name, one in found}
    return {name: period for name, period in periods.items() if period < math.inf}


def phases(scene: Scene, schedule: Mapping[str, Any], every: int = 1) -> float:
    """Return how many phases of the drive one in `every` samples shows; infinity where it has no
    period."""
    per_period = samples_per_period(schedule)
    of_each = [
        per_period // math.gcd(per_period, every * round(schedule["period"] / period))
        for period in drive_periods(scene).values()
    ]
    return min(of_each, default=math.inf)


def _planned(schedule):
    """Return the samples of the wait and of the measurement."""
    every = schedule["sample_every"]
    return tuple(round(schedule[part] / every) for part in ("equilibrate", "measure"))


def is_whole(number: float) -> bool:
    """Return whether a quotient of lengths is a whole number, at least 1."""
    return number > 0.5 and abs(number - round(number)) <= WHOLE * number


def samples_per_period(schedule: Mapping[str, Any]) -> int:
    """Return the samples in a period of the drive; 1 if it has none."""
    every = schedule["sample_every"]
    return max(1, round(schedule.get("period", every) / every))


def wait(scene: Scene, experiment: Mapping[str, Any]) -> int:
    """Return the samples before any counts: whole periods."""
    schedule = experiment["schedule"]
    planned, _ = _planned(schedule)
    return -(-planned // samples_per_period(schedule)) * samples_per_period(schedule)


def run(
    scene: Scene,
    experiment: Mapping[str, Any],
    seed: int,
    recorder: Recorder,
    initial: Sequence[Initial] = (),
) -> dict[str, Any]:
    """Return the variables of the point (see roughgas.data.point), from one simulation.

    The schedule gives `equilibrate` and `measure` (T), `sample_every` (T), and `period` (T), over
    whole multiples of which averages are formed. The measurement begins later than planned if the
    energies say that the gas is not yet stationary, and the point is flagged if half of it would be
    lost or the energies drift in what is left. R is vouched for only in a steady state, and where
    samples show enough phases of a periodic drive. With a target, the measurement is prolonged.
    """
    gas = start(scene, experiment, seed, recorder, initial)
    if initial:
        gas.look()  # at running sums that others have begun
    begun = Begun(gas.time, gas.sample, gas.balance(), gas.begun + gas.collisions)
    theory = _theory(scene, experiment)
    rows: Columns = {"time": np.empty(0)}

    def run_to(schedule):
        nonlocal rows
        recorder.expect(length(scene, {"schedule": schedule}))
        more = gas.in_time(schedule["sample_every"], sum(_planned(schedule)) - len(rows["time"]))
        rows = joined([rows, more]) if len(rows["time"]) else more
        variables = _measure(gas, schedule, rows, begun, theory)
        return variables, variables.get("R_ci95_trusted") == YES

    return until_met(experiment["schedule"], LENGTH, run_to)


class Begun(NamedTuple):
    """A gas as its time begins to count: the time, running sums, energy balance and collisions."""

    time: float
    sums: Columns
    balance: EnergyBalance
    collisions: int


class Theory(NamedTuple):
    """What theory makes of a measured state, and the lengths of the box that the state has."""

    memory: Callable[[Thermal], Memory]
    lengths: tuple[float, ...]  # a


def _theory(scene: Scene, experiment: Mapping[str, Any]) -> Theory:
    lengths = tuple(math.inf if side == "open" else float(side) for side in experiment["box"])
    mixture = for_theory(scene, experiment)
    dense = mixture is not None and math.isfinite(math.prod(lengths))
    filled = packing(experiment) if dense else 0.0
    return Theory(partial(memory, scene, mixture=mixture, packing=filled), lengths)


def _measure(
    gas: Gas, schedule: Mapping[str, Any], rows: Columns, begun: Begun, theory: Theory
) -> dict[str, Any]:
    """Return the variables of a run, `rows` being its samples since it began."""
    scene, every, per_period = gas.scene, schedule["sample_every"], samples_per_period(schedule)
    planned, length = _planned(schedule)
    series = gas.energies(rows)
    first, settled = _start(series, planned, length, per_period)
    before = rows["collisions"][first - 1] if first else begun.collisions
    window = series.map(lambda part: part[first:])
    species = [
        energies.map(lambda part: part[first:])
        for energies in energies_of_each(rows, scene, gas.state)
    ]
    waited = 2 * before / gas.particles
    passed = Passed(
        2 * (rows["collisions"][-1] - before) / gas.particles, len(window.translational) * every
    )
    state = _thermal(species or [window], passed.frequency, gas.particles, theory.lengths)
    remembers = _with_fixed_spins(theory.memory(state), state, window)
    periods = len(window.translational) // per_period
    evidence = _evidence(waited, passed, periods, remembers)
    least = LEAST if scene.effects.gravity is None else LEAST_IN_BED
    steady = evidence.verdict(settled, least)
    variables = {
        **averages(window, per_period, every),
        **contact_averages(rows, first, per_period, inertia_of_sums(scene), begun.sums),
        **_unsubtracted(gas, rows, first),
        **driven_species(species, per_period, max(1, per_period // KEPT)),
        **energy_exchange(begun.balance, gas.balance(), scene, gas.particles),
        "equilibrated": steady,
        "slowest_relaxation": remembers.energies,
        "flow_relaxation": remembers.flow,
        "measured_from": begun.time + first * every,
        "measured_collisions": passed.collisions,
        **over_time(rows["time"][first:], window, max(1, per_period // KEPT)),
    }
    shown = phases(scene, schedule)
    of_means = Evidence(phases=shown, memories=_quotient(passed.time, remembers.energies))
    variables |= verdicts_on_means(variables, int(verdict(steady, of_means, LEAST_OF_MEANS)))
    if window.rotational is None:
        return variables
    of_ratio = Evidence(
        phases=shown,
        memories=_quotient(passed.time, remembers.of_R),
        times=passed.time / variables["autocorrelation_time"],
    )
    variables["R_ci95_trusted"] = int(verdict(steady, of_ratio))
    lack = lack_of(evidence, least) or lack_of(of_ratio, LEAST)
    return variables | {"memory_of_R": remembers.of_R, LACK: lack}


class Passed(NamedTuple):
    """How long a stretch of a run is."""

    collisions: float  # of each particle
    time: float  # T

    @property
    def frequency(self) -> float:
        """Contacts of a particle per T."""
        return self.collisions / self.time


def _evidence(waited: float, passed: Passed, periods: int, remembers: Memory) -> Evidence:
    """Return what a window rests on, that `passed` after the gas had `waited` for so many
    collisions per particle.

    Where R has no memory that theory knows, the energies have: twice the e-fold of the slowest.
    """
    known = 0.0 < remembers.of_R < math.inf
    longest = remembers.of_R if known else 2.0 * remembers.energies
    return Evidence(
        collisions=passed.collisions,
        samples=periods,
        relaxations=_relaxations(waited, passed, remembers.energies),
        memories=_quotient(passed.time, longest),
    )


def _quotient(length: float, unit: float) -> float:
    return length / unit if unit > 0.0 else math.inf


def _with_fixed_spins(remembers: Memory, state: Thermal, window: Energies) -> Memory:
    """Return how long a gas remembers, whose spins may never change: then R is 0 for ever, or what
    they were at the start decides."""
    if state.T_rot is not None:
        return remembers
    spinning = window.rotational is not None and bool(window.rotational.any())
    return remembers._replace(of_R=math.inf if spinning else 0.0)


def _thermal(
    species: Sequence[Energies], frequency: float, particles: int, lengths: tuple[float, ...]
) -> Thermal:
    """Return the state of a gas from the energies of its species: T is twice an energy.

    Spins that never change are left out: no contact, and nothing else, relaxes them.
    """
    T_tr = 2.0 * np.array([energies.translational.mean() for energies in species])
    spins = [energies.rotational for energies in species if energies.rotational is not None]
    changing = any(np.ptp(rotational) > 0.0 for rotational in spins)
    T_rot = 2.0 * np.array([rotational.mean() for rotational in spins]) if changing else None
    return Thermal(T_tr, T_rot, frequency, particles, lengths)


def _relaxations(waited: float, passed: Passed, slowest: float) -> float:
    """Return the e-folds of the slowest mode that a transient has had to decay in.

    Of a transient that is exp(-m) when a window of w e-folds begins, the mean has a share of
    exp(-m)/w: the window itself counts for ln w. `waited` is in collisions per particle.
    """
    within = _quotient(passed.time, slowest)
    if not (within > 0.0 and passed.collisions > 0.0):
        return -math.inf
    return within * waited / passed.collisions + math.log(within)


def _start(series, planned, length, per_period):
    """Return the first sample to measure, after whole periods, and whether the rest is steady."""
    means = [period_means(part, per_period) for part in series.there()]
    first = -(-planned // per_period) * per_period
    start = per_period * detect_start(*means, planned=first // per_period)
    if planned + length - start < LEAST_LEFT * length:
        return first, False
    return start, is_equilibrated(*means, start=start // per_period)


def averages(window, per_period, every):
    """Return the energies, and how they are shared between translation and rotation, steady or
    not."""
    found = {
        "E_trans": window.translational.mean(),
        "E_trans_stderr": blocking(period_means(window.translational, per_period))[0],
    }
    if window.rotational is None:
        return found
    R = ratio(window)
    R_periods = period_means(R, per_period)
    stderr, blocks = blocking(R_periods)
    error, correlated = Error(stderr, degrees_of_freedom(blocks)), autocorrelation_time(R_periods)
    return found | {
        "R": R.mean(),
        "R_stderr": error.stderr,
        "R_dof": error.dof,
        "R_ci95": error.half_width(0.95),
        "R_ratio_of_means": ratio_of_means(window),
        "E_rot": window.rotational.mean(),
        "E_rot_stderr": blocking(period_means(window.rotational, per_period))[0],
        "autocorrelation_time": correlated * per_period * every,
    }


def over_time(time, window, together):
    """Return what is stored over time: means of so many samples each."""
    found = {"time": time, "E_trans_series": window.translational}
    if window.rotational is not None:
        found |= {"R_series": ratio(window), "E_rot_series": window.rotational}
    return {name: period_means(values, together) for name, values in found.items()}


def inertia_of_sums(scene: Scene) -> float:
    """Return the q that sums over contacts belong to."""
    q = inertia(scene.effects)
    return 1.0 if q is None or scene.effects.species is not None else q


def _unsubtracted(gas, rows, first):
    """Return energies of a sheared gas with its mean flow and mean spin left in, not meant by R."""
    effects, found = gas.scene.effects, {}
    if not assumes_flow(effects):
        return {}
    if effects.shear is None:
        found["shear_rate"] = shear_rates(rows, gas.state)[first:].mean()
    series = energies(rows, gas.particles, inertia(effects))
    window = series.map(lambda part: part[first:])
    found["E_trans_unsubtracted"] = window.translational.mean()
    if window.rotational is not None:
        found["E_rot_unsubtracted"] = window.rotational.mean()
        found["R_unsubtracted"] = ratio(window).mean()
    return found
