"""Simulation of one point: from the settings of an experiment to the variables of its dataset."""

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base import InputError, NamedValues, Record, __version__
from roughgas.data.point import Point
from roughgas.data.variables import POINT, TRUSTED_SUFFIX, Variable
from roughgas.effects import reference_speed, sources_of
from roughgas.effects.species import packing
from roughgas.effects.walls import LEAST_DEPARTURE
from roughgas.kernel import hooks
from roughgas.scene import Scene, assumes_flow, build, conserves_momentum, shear_rate
from roughgas.simulation import protocols
from roughgas.simulation.checkpoint import Checkpoint
from roughgas.simulation.energies import species_names
from roughgas.simulation.energy_averages import R_at_fixed_momentum
from roughgas.simulation.experiment import Experiment
from roughgas.simulation.gas import Costs, Gas
from roughgas.simulation.initial_checks import checked_initial_states
from roughgas.simulation.initial_states import RESEED, InitialState, is_memory_of
from roughgas.simulation.point_trackers import ContactLog, LastStates
from roughgas.simulation.scene_switch import kernel_types
from roughgas.simulation.simulation import Simulation
from roughgas.simulation.steady import LACK_VARIABLE
from roughgas.simulation.tracker import Tracker
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import UNKNOWN, YES
from roughgas.theory.closed_forms import VOLUME, collision_frequency, packing_fraction
from roughgas.theory.mixtures import SPECIES_ATTRIBUTE
from roughgas.theory.rate_equations import FLOWS, LANGEVIN_ATTRIBUTE

if TYPE_CHECKING:
    from roughgas.simulation.flow_tracker import FlowTracker
    from roughgas.simulation.observable_tracker import ObservableTracker

ENERGIES = ("E_trans", "E_rot", "R", "R_ratio_of_means", "R_corrected")
NUMBERS_OF_FLAG = {
    "equilibrated": ENERGIES,
    "R_ci95_trusted": (*ENERGIES, "R_stderr", "R_dof", "R_ci95", "autocorrelation_time"),
}
"""The variables of a point that each of its flags vouches for."""
UNASSUMED_FLOW = "the gas has a flow of its own, which R counts as temperature"
"""Reason why verdicts on R are withdrawn; see `flow_verdict`."""
MIN_LOSS = 0.01  # of energy in a contact: estimates for nearly elastic gases stay finite
MAX_BED_PACKING = 0.6  # estimated packing of a cold bed stays below it


def run_point(
    scene: Scene,
    experiment: Experiment,
    seed: int,
    initial: Sequence[InitialState] = (),
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    trackers: Sequence[Tracker] = (),
    checkpoint: Checkpoint | None = None,
) -> Point:
    """Simulate one point, and return its variables and attributes.

    `scene` is built from `experiment` with roughgas.scene.build, at r and beta. The same settings,
    r, beta and seed give the same numbers to the last bit, except `kernel_seconds`. The run begins
    in the `initial` states, one per replica, or on a lattice; if it continues bit by bit from them,
    it does not depend on the seed. Observables are taken from the settings, and from `functions` of
    frames by name. The `trackers` receive all samples, too. The run resumes from a `checkpoint` of
    the same run, and stores its progress there.

    Raises InputError if the particles do not fit or cannot begin in the initial states,
    CollapseError if contacts accumulate without end, UnusableCheckpoint if the arrays of a
    checkpoint cannot be from this run.
    """
    scene = protocols.initial_scene(scene, experiment)
    _check_not_at_rest(scene, experiment)
    point_trackers = _point_trackers(scene, experiment, functions)
    user_trackers = {f"tracker {number}": tracker for number, tracker in enumerate(trackers)}
    simulation = Simulation({**point_trackers.by_name(), **user_trackers}, checkpoint)
    if initial:
        initial = checked_initial_states(initial, experiment, scene, seed)
    variables = protocols.protocol_of(experiment).run(scene, experiment, seed, simulation, initial)
    variables |= _shared_variables(variables, scene, experiment, simulation.costs)
    attributes = _attributes(scene, experiment, seed, initial)
    if point_trackers.states:
        variables |= point_trackers.states.variables()
        attributes["memory_of"] = point_trackers.states.memory_owner
    if point_trackers.log:
        variables |= point_trackers.log.variables
    observed = _add_observed(variables, point_trackers)
    simulation.finish()
    return Point(observed=observed, variables=variables, attributes=attributes)


class PointTrackers(NamedTuple):
    """The trackers of a point, except the trackers of its protocol; None for absent ones."""

    states: LastStates | None
    log: ContactLog | None
    observing: "ObservableTracker | None"
    flow: "FlowTracker | None"

    def by_name(self) -> dict[str, Tracker]:
        """Return the trackers that are not None, by name."""
        return {name: tracker for name, tracker in self._asdict().items() if tracker is not None}


def _point_trackers(
    scene: Scene, experiment: Experiment, functions: Mapping[str, Callable[[Any], Any]] | None
) -> PointTrackers:
    """Return the trackers that the experiment needs; `functions` are observables by name."""
    observed, observing, flow = functions or experiment.observables, None, None
    if observed or assumes_flow(scene.effects):
        from roughgas.simulation.flow_tracker import flow_tracker_of  # slow to import

        flow = flow_tracker_of(scene, protocols.observed_system(scene, experiment), experiment)
    if observed:
        from roughgas.simulation.observable_tracker import ObservableTracker

        observing = ObservableTracker(scene, experiment, functions)
    return PointTrackers(
        states=LastStates() if experiment.keep_state else None,
        log=ContactLog() if scene.effects.contact_log is not None else None,
        observing=observing,
        flow=flow,
    )


def _shared_variables(
    variables: NamedValues, scene: Scene, experiment: Experiment, costs: Costs
) -> NamedValues:
    """Return the variables that all protocols share, by name.

    They are costs, species names, R_corrected and contact time. `variables` are the variables of
    the point's protocol.
    """
    added: NamedValues = {}
    if "R_ratio_of_means" in variables and conserves_momentum(scene):
        ratio = variables["R_ratio_of_means"]
        added["R_corrected"] = R_at_fixed_momentum(ratio, experiment.particles)
    added |= species_names(experiment)
    added |= {"collisions": costs.collisions, "kernel_seconds": costs.seconds}
    if scene.effects.contact_time is not None:
        added["contact_time"] = scene.effects.contact_time.duration
        added["contact_time_fraction"] = costs.touched / max(1, costs.collisions)
    return added


def _add_observed(variables: NamedValues, point_trackers: PointTrackers) -> dict[str, Variable]:
    """Add the results of observables to `variables`, and withdraw flags without a basis.

    Returns the descriptions of variables that datasets do not define, by name.
    """
    lack = variables.pop(LACK_VARIABLE, "")
    variables |= _withdrawn_verdicts(variables)
    described: dict[str, Variable] = {}
    results: NamedValues = {}
    if point_trackers.observing:
        results, described = point_trackers.observing.results(variables)
    if point_trackers.flow:
        flow = flow_verdict(variables, point_trackers.flow.shift(variables["measured_from"]))
        lack = UNASSUMED_FLOW if "R_ci95_trusted" in flow else lack
        results = results | flow
    variables |= results
    if lack:
        described["R_ci95_trusted"] = POINT["R_ci95_trusted"]._replace(comment=lack)
    return described


def _attributes(
    scene: Scene, experiment: Experiment, seed: int, initial: Sequence[InitialState]
) -> NamedValues:
    """Return the attributes of a point's dataset, by name."""
    from roughgas.compiling.cache_folders import SOURCE_HASH  # only a run needs the compiler

    return {
        "r": scene.restitution,
        "beta": scene.roughness,
        "seed": int(seed),
        "particles": experiment.particles,
        "dimension": len(scene.box),
        **_packing_attribute(scene, experiment, initial),
        **_theory_attributes(scene, experiment),
        **_stage_attributes(experiment),
        **_restitution_attributes(scene),
        **_initial_state_attributes(initial, scene),
        "roughgas_version": __version__,
        "numpy_version": np.__version__,
        "kernel_source_hash": SOURCE_HASH + sources_of(scene.effects),
    }


def _check_not_at_rest(scene, experiment):
    """Raise InputError for a gas that comes to rest on its floor, where contacts never end.

    In single stages it may come to rest.
    """
    effects, floor = scene.effects, scene.effects.floor
    if floor is None or len(hooks.active(effects, "drives")) > 1:
        return
    floors = [
        stage_scene.effects.floor for stage_scene in protocols.scenes_of_run(scene, experiment)
    ]
    floor = max(floors, key=lambda floor: floor.amplitude / floor.period)
    elastic = [
        (surface.restitution, abs(surface.roughness)) == (1.0, 1.0) for surface in (scene, floor)
    ]
    speed = floor.amplitude / floor.period
    if not all(elastic) and speed < LEAST_DEPARTURE:
        legal = (
            f"be {LEAST_DEPARTURE:g} a/T times the period or more where nothing else drives a gas "
            "that loses energy, or it comes to rest: add a drive, or let contacts be elastic"
        )
        raise InputError("effects.floor.amplitude", floor.amplitude, legal)


def _packing_attribute(scene, experiment, initial):
    """Return the packing fraction as the attribute `packing`.

    It is the requested one, or the actual one in a periodic box. The actual packing of a mixture is
    the packing of its initial states.
    """
    packing_setting = experiment.raw.get("packing")
    if packing_setting is None and None in scene.box:
        return {}
    actual_packing = packing(experiment)
    if initial and scene.effects.species is not None:
        volume = np.mean([np.mean(state.radius ** len(scene.box)) for state in initial])
        actual_packing = float(volume) * packing_fraction(experiment.particles, experiment.box)
    return {
        "packing": packing_setting
        if packing_setting and math.isclose(packing_setting, actual_packing)
        else actual_packing
    }


def flow_verdict(variables: Record, shift: Estimate | None) -> NamedValues:
    """Return the shift of R due to an unassumed flow, and the flags that become "not known".

    `variables` are the variables of the point, and `shift` is the increase of R if the local flow
    is subtracted. Above half the width of the confidence interval of R, and significant, it means
    that the energy of a flow counts as temperature.
    """
    if shift is None or "R" not in variables:
        return {}
    has_flow = shift.value > variables["R_ci95"] and shift.is_significant
    names = [name for name in variables if name.endswith(TRUSTED_SUFFIX) or name == "target_met"]
    withdrawn = {
        name: np.where(np.equal(variables[name], YES), UNKNOWN, variables[name])[()]
        for name in names
    }
    return {"R_flow_shift": shift.value, "R_flow_sigma": shift.sigma} | (
        withdrawn if has_flow else {}
    )


def _withdrawn_verdicts(variables):
    """Return the flags to set to UNKNOWN, by name: those for variables that are not finite."""
    numbers_of_flag = {
        flag: [variables[number] for number in NUMBERS_OF_FLAG[flag] if number in variables]
        for flag in NUMBERS_OF_FLAG
    }
    unfounded = (
        flag for flag, numbers in numbers_of_flag.items() if not np.isfinite(numbers).all()
    )
    withdrawn = {flag: UNKNOWN for flag in unfounded if variables.get(flag) == YES}
    for name in (
        flag.removesuffix(TRUSTED_SUFFIX) for flag in variables if flag.endswith(TRUSTED_SUFFIX)
    ):
        if f"{name}_stderr" in variables:
            finite = np.isfinite(variables[name]) & np.isfinite(variables[f"{name}_stderr"])
            flags = variables[f"{name}{TRUSTED_SUFFIX}"]
            withdrawn[f"{name}{TRUSTED_SUFFIX}"] = np.where(
                finite | (flags != YES), flags, UNKNOWN
            )[()]
    return withdrawn


def _initial_state_attributes(initial, scene):
    """Return attributes on the initial states: digests, exact continuation, and fresh noise."""
    if not initial:
        return {}
    fresh = initial[0].noise == RESEED
    exact = not fresh and all(is_memory_of(state, scene) for state in initial)
    digests = ",".join(state.digest() for state in initial)
    origin = {"initial_digest": digests, "initial_exact": int(exact)}
    return origin | ({"reseeded": 1} if fresh else {})


def _theory_attributes(scene, experiment):
    """Return the parameters of effects that R depends on in theory, as attributes by name."""
    effects, attributes = scene.effects, {}
    if effects.spin is not None:
        attributes["inertia"] = effects.spin.inertia
    if effects.friction is not None:
        attributes["mu"] = effects.friction.mu
    if effects.thermostat is not None:
        attributes["spin_share"] = experiment.effects["thermostat"].spin_share
    if effects.langevin is not None:
        medium = {} if effects.shear is None else {FLOWS: True}
        attributes[LANGEVIN_ATTRIBUTE] = json.dumps(experiment.raw["effects"]["langevin"] | medium)
    if experiment.species:
        species_settings = {
            name: experiment.raw.get(name) or [] for name in ("species", "species_pairs")
        }
        sides = [0.0 if side is None else side for side in experiment.lengths]
        attributes[SPECIES_ATTRIBUTE] = json.dumps(species_settings | {"volume": math.prod(sides)})
    return attributes


def _stage_attributes(experiment):
    """Return the number of stages as an attribute; empty without stages."""
    stages = getattr(experiment.schedule, "stages", ())
    return {"stages": len(stages)} if stages else {}


def _restitution_attributes(scene):
    """Return the attribute `r_at_speed` if r depends on the speed of a contact.

    It is the normal speed (a/T) of contacts that have the point's r.
    """
    speed = reference_speed(scene.effects)
    return {} if speed is None else {"r_at_speed": speed}


def expected_collisions(experiment: Experiment, r: float, beta: float) -> float:
    """Return an estimate of the number of collisions in a point, kicks included.

    It serves the order and the progress of jobs. A target error is assumed to be met at once.
    """
    protocol, scene = protocols.protocol_of(experiment), build(experiment, r, beta)
    length = protocol.length(scene, experiment)  # T, or collisions of each particle
    rate = _collision_rate(scene, experiment) + _kick_rate(experiment) if protocol.DRIVEN else 1.0
    return 0.5 * experiment.particles * length * rate


def _kick_rate(experiment):
    """Return the kicks of a particle per T; a kick takes about as long as half a collision."""
    drives = map(experiment.effects.get, ("thermostat", "langevin"))
    return sum(1.0 / drive.interval for drive in drives if drive is not None)


def _collision_rate(scene, experiment):
    """Return an estimate of the collisions of a particle per T in a driven gas.

    Contacts dissipate the power of a dilute gas: viscous heating under shear, the power of random
    kicks, or the power of a floor by V. Kumaran, Phys. Rev. E 57, 5660 (1998), with the mean
    density of the bed. The estimate is right to a factor of two for the paper's gases. A Langevin
    bath gives its temperature, any other drive about 1 m a^2/T^2.
    """
    effects, dimension, loss = scene.effects, len(scene.box), 1.0 - scene.restitution**2
    if effects.spin is not None:  # of tangential velocities, about half as large as normal ones
        q = effects.spin.inertia
        loss += 0.5 * q / (1.0 + q) * (1.0 - scene.roughness**2)
    is_elastic, loss = loss <= 0.0, max(loss, MIN_LOSS)
    if effects.floor is not None and effects.floor.period < math.inf:
        return _collision_rate_of_bed(scene, experiment, loss)
    power, temperature = _kicks(experiment)
    if effects.shear is not None and not power:
        return abs(shear_rate(scene)) * math.sqrt(2.0 / loss)
    if None in experiment.lengths:
        return 1.0 / math.sqrt(loss)
    rate_at_1 = float(collision_frequency(1.0, packing(experiment), dimension))
    if power and not is_elastic:  # a contact costs each of its particles half of the loss times T
        temperature = (2.0 * power / (loss * rate_at_1)) ** (2.0 / 3.0)
    return rate_at_1 * math.sqrt(temperature)


def _kicks(experiment):
    """Return the power per particle of random kicks, 0 if there are none, and a temperature.

    This is the temperature of a Langevin bath, otherwise 1 m a^2/T^2.
    """
    thermostat, bath = (experiment.effects.get(name) for name in ("thermostat", "langevin"))
    power = thermostat.power if thermostat else 0.0
    if bath is None:
        return power, 1.0
    return power + bath.power + bath.spin_power, bath.temperature or bath.spin_temperature or 1.0


def _collision_rate_of_bed(scene, experiment, loss):
    """Return an estimate of the collisions of a particle per T in a bed on a shaken floor.

    `loss` is the share of the energy that a contact dissipates.
    """
    effects, dimension = scene.effects, len(scene.box)
    layers = experiment.particles / math.prod(side for side in experiment.lengths[:-1] if side)
    speed = effects.floor.amplitude / effects.floor.period
    # 0.9 = 4 sqrt(2)/(2 pi) a of disks; spheres collide four times as often at the same n and T
    temperature = 0.9 * speed**2 / (4.0 ** (dimension - 2) * layers * loss)
    weight = -layers * VOLUME[dimension] * effects.gravity.along[dimension - 1]
    is_dense = weight >= 2.0 * MAX_BED_PACKING * temperature
    phi = MAX_BED_PACKING if is_dense else 0.5 * weight / temperature  # averaged over the particles
    return float(collision_frequency(temperature, phi, dimension))


def compile_kernels(experiments: Iterable[Experiment], r: float) -> int:
    """Compile the kernels of experiments into numba's cache, at any `r`; return their number."""
    scenes = kernels(experiments, r)
    for scene, experiment in scenes.values():
        Gas.start(scene, experiment, np.random.default_rng(0)).in_time(1.0, 0)
    return len(scenes)


def kernels(experiments: Iterable[Experiment], r: float) -> dict[Any, tuple[Scene, Experiment]]:
    """Return a scene and its experiment for each kernel that the experiments need, at any `r`.

    The keys are the types in a scene, which determine the machine code of its kernel.
    """
    scenes: dict[Any, tuple[Scene, Experiment]] = {}
    for experiment in experiments:
        scene = protocols.initial_scene(build(experiment, r, -1.0), experiment)
        sources = [text] if (text := sources_of(scene.effects)) else []
        key = (kernel_types(scene.effects), tuple(side is None for side in scene.box), *sources)
        scenes.setdefault(key, (scene, experiment))
    return scenes
