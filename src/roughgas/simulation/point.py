"""One point of an experiment: from its settings to the dataset's variables."""

import json
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from roughgas.base import InputError, __version__
from roughgas.data.point import Point
from roughgas.data.variables import POINT, TRUSTED, Variable
from roughgas.effects import speed_of_r
from roughgas.effects.species import packing
from roughgas.effects.walls import LEAST_DEPARTURE
from roughgas.kernel import hooks
from roughgas.scene import Scene, assumes_flow, build, conserves_momentum, shear_rate
from roughgas.simulation import schedule
from roughgas.simulation.contact_log import logged
from roughgas.simulation.energies import free_of_momentum, species_names
from roughgas.simulation.gas import Gas
from roughgas.simulation.journal import Journal
from roughgas.simulation.recorder import Recorder
from roughgas.simulation.restart import RESEED, Initial, final_states, is_memory_of, owner
from roughgas.simulation.starts import prepared
from roughgas.simulation.steady import LACK
from roughgas.statistics.errors import UNKNOWN, YES, Estimate
from roughgas.theory.closed_forms import VOLUME, collision_frequency, packing_fraction
from roughgas.theory.mixtures import SPECIES
from roughgas.theory.rate_equations import LANGEVIN

ENERGIES = ("E_trans", "E_rot", "R", "R_ratio_of_means", "R_corrected")
VOUCHED = {
    "equilibrated": ENERGIES,
    "R_ci95_trusted": (*ENERGIES, "R_stderr", "R_dof", "R_ci95", "autocorrelation_time"),
}
"""The numbers that each flag of a point vouches for."""
FLOW = "the gas has a flow of its own, which R counts as temperature"
"""What takes back a verdict on R; see `flow_verdict`."""
LEAST_LOSS = 0.01  # of a contact, where it is less: elastic gases are not infinitely hot
DENSEST = 0.6  # packing of a bed, where it would be more: a cold one does not collapse to a point


def run_point(
    scene: Scene,
    experiment: Mapping[str, Any],
    seed: int,
    tell: Callable[[float, int], None] | None = None,
    initial: Sequence[Initial] = (),
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    journal: Journal | None = None,
) -> Point:
    """Simulate one point and measure it.

    `experiment` holds settings as roughgas.config.experiment gives them, and `scene` is what
    roughgas.scene.build makes of them at r and beta. The same settings, r, beta and seed give the
    same numbers to the last bit, but for `kernel_seconds`. `tell(time, collisions)` is called as
    the simulation goes on. It begins in the `initial` states, one per replica, or else on a
    lattice; where it goes on from them to the last bit, nothing depends on the seed. Its
    observables are those of the settings, and `functions` of frames by name. It goes on from where
    a `journal` of the same run is, and keeps there how far it is.
    Raises InputError if the particles do not fit or could not begin so, CollapseError if contacts
    accumulate without end.
    """
    from roughgas.compiling.compiler import IMPORTED  # only a run needs the compiler

    _refuse_rest(scene)
    keep, number = experiment.get("keep_state", False), experiment["particles"]
    watching = _watching(scene, experiment, functions)
    logs = scene.effects.contact_log is not None
    kept = math.inf if keep else int(logs)  # the log is that of the first gas
    recorder = Recorder(tell, kept, watching.begin if watching else None, journal)
    if initial:
        initial = prepared(initial, experiment, scene, seed)
    found = schedule.of(experiment).run(scene, experiment, seed, recorder, initial)
    if keep:
        found |= final_states(recorder.gases)
    if logs and (log := recorder.gases[0].state.log):
        found |= logged(recorder.gases[0], log)
    if "R_ratio_of_means" in found and conserves_momentum(scene):
        found["R_corrected"] = free_of_momentum(found["R_ratio_of_means"], number)
    found |= species_names(experiment)
    found |= {"collisions": recorder.collisions, "kernel_seconds": recorder.seconds}
    if scene.effects.contact_time is not None:
        found["contact_time"] = scene.effects.contact_time.duration
        found["contact_time_fraction"] = recorder.touched / max(1, recorder.collisions)
    lack = found.pop(LACK, "")
    found |= _withdrawn(found)
    observed: dict[str, Variable] = {}
    if watching:
        values, observed = watching.results(found)
        flow = flow_verdict(found, watching.flow_shift(found["measured_from"]))
        lack = FLOW if "R_ci95_trusted" in flow else lack
        found |= values | flow
    if lack:
        observed["R_ci95_trusted"] = POINT["R_ci95_trusted"]._replace(comment=lack)
    if journal:
        journal.end(recorder)
    return Point(
        observed=observed,
        variables=found,
        attributes={
            "r": scene.restitution,
            "beta": scene.roughness,
            "seed": int(seed),
            "particles": number,
            "dimension": len(scene.box),
            **_packing(scene, experiment, initial),
            **_known_to_theory(scene, experiment),
            **_about_stages(experiment),
            **_about_restitution(scene),
            **({"memory_of": owner(recorder.gases[-1].scene)} if keep else {}),
            **_about_start(initial, scene),
            "roughgas_version": __version__,
            "numpy_version": np.__version__,
            "kernel_source_hash": IMPORTED,
        },
    )


def _refuse_rest(scene):
    """Refuse a gas that comes to rest on its floor, where contacts no longer end."""
    effects, floor = scene.effects, scene.effects.floor
    if floor is None or len(hooks.present(effects, "drives")) > 1:
        return
    elastic = [(one.restitution, abs(one.roughness)) == (1.0, 1.0) for one in (scene, floor)]
    speed = floor.amplitude / floor.period
    if not all(elastic) and speed < LEAST_DEPARTURE:
        legal = (
            f"be {LEAST_DEPARTURE:g} a/T times the period or more where nothing else drives a gas "
            "that loses energy, or it comes to rest: add a drive, or let contacts be elastic"
        )
        raise InputError("effects.floor.amplitude", floor.amplitude, legal)


def _packing(scene, experiment, initial):
    """Return the packing that was asked for, or that of a periodic box: of the particles in the
    initial states, where they differ."""
    asked = experiment.get("packing")
    if asked is None and None in scene.box:
        return {}
    found = packing(experiment)
    if initial and scene.effects.species is not None:
        volume = np.mean([np.mean(state.radius ** len(scene.box)) for state in initial])
        found = float(volume) * packing_fraction(experiment["particles"], experiment["box"])
    return {"packing": asked if asked and math.isclose(asked, found) else found}


def _watching(scene, experiment, functions):
    """Return the observables that settings list, or that R needs; None if there are none."""
    listed = functions or experiment.get("observables")
    if not (listed or assumes_flow(scene.effects)):
        return None
    from roughgas.simulation.flow import has_flow  # imported where it is wanted
    from roughgas.simulation.observing import Observers

    if not (listed or has_flow(scene, schedule.system_of(scene, experiment), experiment)):
        return None
    return Observers(scene, experiment, functions)


def flow_verdict(variables: Mapping[str, Any], shift: Estimate | None) -> dict[str, Any]:
    """Return by how much R is larger over the local flow, and verdicts that this takes back.

    Where it is so by more than half the interval of R, and significantly, the gas has a flow of its
    own, whose energy passes for temperature.
    """
    if shift is None or "R" not in variables:
        return {}
    flows = shift.value > variables["R_ci95"] and shift.real
    names = [name for name in variables if name.endswith(TRUSTED) or name == "target_met"]
    withdrawn = {
        name: np.where(np.equal(variables[name], YES), UNKNOWN, variables[name])[()]
        for name in names
    }
    return {"R_flow_shift": shift.value, "R_flow_sigma": shift.sigma} | (withdrawn if flows else {})


def _withdrawn(found):
    """Return verdicts that are not known, since a number that they vouch for is not finite."""
    given = {flag: [found[one] for one in VOUCHED[flag] if one in found] for flag in VOUCHED}
    wrong = (flag for flag, numbers in given.items() if not np.isfinite(numbers).all())
    withdrawn = {flag: UNKNOWN for flag in wrong if found.get(flag) == YES}
    for name in (flag.removesuffix(TRUSTED) for flag in found if flag.endswith(TRUSTED)):
        if f"{name}_stderr" in found:
            finite = np.isfinite(found[name]) & np.isfinite(found[f"{name}_stderr"])
            flags = found[f"{name}{TRUSTED}"]
            withdrawn[f"{name}{TRUSTED}"] = np.where(finite | (flags != YES), flags, UNKNOWN)[()]
    return withdrawn


def _about_start(initial, scene):
    """Return which states a run began in, whether it went on to the last bit, and whether with
    fresh noise."""
    if not initial:
        return {}
    fresh = initial[0].noise == RESEED
    exact = not fresh and all(is_memory_of(state, scene) for state in initial)
    digests = ",".join(state.digest() for state in initial)
    origin = {"initial_digest": digests, "initial_exact": int(exact)}
    return origin | ({"reseeded": 1} if fresh else {})


def _known_to_theory(scene, experiment):
    """Return the parameters of effects that R depends on in theory."""
    effects, found = scene.effects, {}
    if effects.spin is not None:
        found["inertia"] = effects.spin.inertia
    if effects.friction is not None:
        found["mu"] = effects.friction.mu
    if effects.thermostat is not None:
        found["spin_share"] = float(experiment["effects"]["thermostat"]["spin_share"])
    if effects.langevin is not None:
        found[LANGEVIN] = json.dumps(experiment["effects"]["langevin"])
    if experiment.get("species"):
        known = {name: experiment.get(name) or [] for name in ("species", "species_pairs")}
        sides = [0.0 if side == "open" else float(side) for side in experiment["box"]]
        found[SPECIES] = json.dumps(known | {"volume": math.prod(sides)})
    return found


def _about_stages(experiment):
    """Return how many stages there are, of a gas whose settings change."""
    stages = experiment["schedule"].get("stages", ())
    return {"stages": len(stages)} if stages else {}


def _about_restitution(scene):
    """Return at which normal speed (a/T) contacts have the point's r, where it depends on that."""
    speed = speed_of_r(scene.effects)
    return {} if speed is None else {"r_at_speed": speed}


def effort(experiment: Mapping[str, Any], r: float, beta: float) -> float:
    """Return about how many collisions a point makes, by which jobs are ordered and time is told.

    A point with a target is taken for one that meets it at once.
    """
    kind, scene = schedule.of(experiment), build(experiment, r, beta)
    passed = kind.length(scene, experiment)  # T, or collisions of each particle
    rate = _collision_rate(scene, experiment) if kind.DRIVEN else 1.0
    return 0.5 * experiment["particles"] * passed * rate


def _collision_rate(scene, experiment):
    """Return about how often a particle of a driven gas collides in a T.

    So often that contacts lose what a dilute gas gets: by viscosity where it is sheared, from its
    floor as in V. Kumaran, Phys. Rev. E 57, 5660 (1998), where a bed is as dense as it is on
    average. Right to a factor of two for the paper's gases. Any other drive counts as one that
    heats each particle by about 1 m a^2/T^3.
    """
    effects, dimension, loss = scene.effects, len(scene.box), 1.0 - scene.restitution**2
    if effects.spin is not None:  # of tangential velocities, about half as large as normal ones
        q = effects.spin.inertia
        loss += 0.5 * q / (1.0 + q) * (1.0 - scene.roughness**2)
    loss = max(loss, LEAST_LOSS)
    if effects.shear is not None:
        return abs(shear_rate(scene)) * math.sqrt(2.0 / loss)
    if effects.gravity is None or effects.floor is None or effects.floor.period == math.inf:
        return 1.0 / math.sqrt(loss)
    layers = experiment["particles"] / math.prod(float(side) for side in experiment["box"][:-1])
    speed = effects.floor.amplitude / effects.floor.period
    # 0.9 = 4 sqrt(2)/(2 pi) a of disks; spheres collide four times as often at the same n and T
    temperature = 0.9 * speed**2 / (4.0 ** (dimension - 2) * layers * loss)
    weight = layers * VOLUME[dimension] * effects.gravity.acceleration
    dense = weight >= 2.0 * DENSEST * temperature
    phi = DENSEST if dense else 0.5 * weight / temperature  # averaged over the particles
    return float(collision_frequency(temperature, phi, dimension))


def compile_kernels(experiments: Iterable[Mapping[str, Any]], r: float) -> int:
    """Compile, into numba's cache, the kernels of experiments at some r; return how many."""
    needed = kernels(experiments, r)
    for scene, experiment in needed.values():
        Gas.start(scene, experiment, np.random.default_rng(0)).in_time(1.0, 0)
    return len(needed)


def kernels(
    experiments: Iterable[Mapping[str, Any]], r: float
) -> dict[Any, tuple[Scene, Mapping[str, Any]]]:
    """Return a scene and its experiment for every kernel that the experiments need at some r.

    The keys are what decides which machine code a scene runs: the types in it.
    """
    needed: dict[Any, tuple[Scene, Mapping[str, Any]]] = {}
    for experiment in experiments:
        scene = build(experiment, r, -1.0)
        effects = tuple(None if effect is None else type(effect) for effect in scene.effects)
        key = effects, tuple(side is None for side in scene.box)
        needed.setdefault(key, (scene, experiment))
    return needed
