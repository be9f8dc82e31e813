"""Soft spheres and events in the freely cooling gas, one function a kind of job.

Each takes the study's settings, those of the experiment, progress, and the task, (kind, *places),
to which random numbers of its own belong; it returns numbers by name. CPU seconds are those of the
simulation proper, everything compiled before, at equilibrium.
"""

import math
from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas.kernel.memory import new_state
from roughgas.kernel.state import EXPONENT, STARTED
from roughgas.scene import build, initial_state
from roughgas.simulation.energies import Energies, ratio
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking_stderr, stderr_over_seeds
from roughgas.studies.soft_spheres import new_gas, springs
from roughgas.studies.soft_spheres.gas import CONTACTS
from roughgas.studies.soft_spheres.stepping import COLUMNS, step
from roughgas.tasks import stream, timed
from roughgas.theory import collision_frequency, stationary_theta

SETTLING = 100.0  # collisions per particle, before anything is measured
SAMPLED_EVERY = 0.5  # collisions per particle, in the event-driven gas
REFRESHED_EVERY = 4  # samples
LEG = 1.0  # collisions per particle between two rescalings with the contact-time model
SOFT_LEG = 0.1  # and with soft spheres
SKIN = 1.0  # of the soft spheres' list of neighbours, in a
PARTS = 40  # that a long run is cut into, to tell how far it is
ELASTIC = {"r": 1.0, "beta": 1.0}  # conserves the energy
ELASTIC_SAMPLES = 100
STREAMS = {"reference": 1, "event": 2, "single": 3, "model": 4, "soft": 5, "elastic": 6}


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return R of one run, and what else its kind of job measures. Raises InputError."""
    kind, *places = task.split("-")
    job = {"soft": _soft, "model": _model, "single": _single}.get(kind, _events)
    found = job(settings, experiments["cooling"], progress, (kind, *map(int, places)))
    return xr.Dataset({name: (("sample",) if np.ndim(x) else (), x) for name, x in found.items()})


def _soft(settings, cooling, progress, job):
    """Soft spheres that make `steps` steps in a contact of t_c nu = contact_times[place]."""
    _, steps, place = job
    scene, *where = _start(settings, cooling, job)
    nu = _frequency(settings)
    duration = settings["contact_times"][place] / nu
    q = scene.effects.spin.inertia
    forces = springs(settings["r"], settings["beta"], q, duration)
    gas, spheres = new_gas(*where, scene.box, forces, SKIN)
    dt, number = duration / steps, len(gas.position)
    per_leg = max(1, round(SOFT_LEG / (nu * dt)))

    def advance(legs):
        rows = np.empty((legs, len(COLUMNS)))
        if step(gas, spheres, dt, per_leg, 1.0, rows) < legs:
            raise RuntimeError("soft spheres are too crowded")
        vv, ww, _ = rows.T
        return ratio(Energies(vv / (2 * number), q * ww / number))

    settling, legs = (
        math.ceil(length / (nu * dt * per_leg))
        for length in (SETTLING, settings["soft_collisions"])
    )
    advance(settling)
    begun = gas.counts[CONTACTS]
    _, found = _measured(advance, legs, progress)
    collisions = 2.0 * (gas.counts[CONTACTS] - begun) / number
    frequency = collisions / (legs * per_leg * dt) / nu
    return found | {"collisions": collisions, "frequency": frequency, "steps": legs * per_leg}


def _model(settings, cooling, progress, job):
    """The kernel with the contact-time model, t_c nu being held as for soft spheres."""
    duration = settings["model_contact_times"][job[1]] / _frequency(settings)
    gas = _gas(settings, cooling, job, effects={"contact_time": {"duration": duration}})
    per_leg, recorder = gas.count(LEG), gas.recorder
    gas.cool(per_leg)

    def advance(legs):
        R = np.empty(legs)
        for k in range(legs):
            R[k] = ratio(gas.energies(gas.in_collisions(per_leg, 1)))[0]
            _heat(gas.state)
        return R

    settling, legs = (round(length / LEG) for length in (SETTLING, settings["model_collisions"]))
    advance(settling)
    recorder.touched, recorder.seconds = 0, 0.0
    _, found = _measured(advance, legs, progress)
    collisions, touched = legs * per_leg, recorder.touched / (legs * per_leg)
    found |= {"collisions": 2.0 * collisions / gas.particles, "touched": touched}
    return found | {"cpu_seconds": recorder.seconds}


def _single(settings, cooling, progress, job):
    """Trajectories and spins in single precision, and how an elastic gas's energy then drifts."""
    found = _events(settings, cooling, progress, job, np.float32)
    for name, precision in (("single", np.float32), ("double", np.float64)):
        drifting = _drift(settings | ELASTIC, cooling, precision)
        found |= {f"{key}_{name}": value for key, value in drifting.items()}
    return found


def _events(settings, cooling, progress, job, precision=np.float64):
    """The plain event-driven gas; the kind `event` keeps each sample, for its statistical error."""
    kind, gas = job[0], _gas(settings, cooling, job, precision)
    every = gas.count(SAMPLED_EVERY)
    gas.cool(REFRESHED_EVERY * every)
    length = settings["reference_collisions" if kind == "reference" else "event_collisions"]

    def advance(samples):
        return ratio(gas.energies(gas.in_collisions(every, samples)))

    advance(round(SETTLING / SAMPLED_EVERY))
    R, found = _measured(advance, round(length / SAMPLED_EVERY), progress)
    found["collisions"] = len(R) * SAMPLED_EVERY
    return found | ({"R_series": R} if kind == "event" else {})


def _drift(settings, cooling, precision):
    """Relative change of an elastic gas's energy per collision, its speed and frequency."""
    gas = _gas(settings, cooling, ("elastic",), precision)
    every = max(1, round(settings["event_collisions"] * gas.particles / 40 / ELASTIC_SAMPLES))
    gas.in_collisions(every, 1)
    rows, seconds = timed(gas.in_collisions, every, ELASTIC_SAMPLES)
    found = gas.energies(rows)
    changes = np.diff(np.log(2.0 * found.translational + found.rotational)) / every
    elapsed = rows["time"][-1] - rows["time"][0]
    return {
        "drift": changes.mean(),
        "drift_stderr": stderr_over_seeds(changes),
        "speed": every * len(rows["time"]) / seconds,
        "frequency": 2.0 * every * len(changes) / gas.particles / elapsed,
    }


def _frequency(settings):
    """Enskog's nu at temperature 1, in 1/T."""
    return float(collision_frequency(1.0, settings["packing"]))


def _gas(settings, cooling, job, precision=np.float64, effects=None):
    scene, *where = _start(settings, cooling, job, effects)
    return Gas(scene, new_state(scene, *where, precision))


def _start(settings, cooling, job, effects=None):
    """Scene, positions, velocities and spins, the latter at the temperature of theory.

    The experiment's particles at the packing that the settings ask for, with spin and `effects`.
    """
    (kind, *places), number = job, cooling["particles"]
    r, beta = settings["r"], settings["beta"]
    side = math.sqrt(number * math.pi / settings["packing"])
    effects = {"spin": cooling["effects"]["spin"]} | (effects or {})
    gas = {"particles": number, "box": [side, side], "effects": effects}
    rng = np.random.default_rng(stream(settings, STREAMS[kind], *places))
    scene = build(gas, r, beta)
    q = scene.effects.spin.inertia
    theta = stationary_theta(r, beta, len(scene.box), q)
    position, velocity = np.split(initial_state(scene, gas, rng).trajectory[:, :-1], 2, axis=1)
    return scene, position, velocity, math.sqrt(theta / q) * rng.standard_normal((number, 1))


def _heat(state):
    """Scale a gas that has just been refreshed to temperature 1, and let it forget its units."""
    velocity = state.trajectory[:, 2:4]
    factor = math.sqrt(velocity.size / float(np.sum(velocity**2)))
    velocity *= factor
    state.spin[:] *= factor
    state.moments.contact_time[:] /= factor
    state.counts[EXPONENT] = 0
    state.counts[STARTED] = 0


def _measured(advance, samples, progress):
    """Return R of all samples, its mean and error, and CPU seconds.

    `advance` returns R of the next samples; it is called for a whole number of refreshed ones.
    """
    length = max(1, -(-samples // (PARTS * REFRESHED_EVERY))) * REFRESHED_EVERY
    parts, total = [], 0.0
    for first in range(0, samples, length):
        progress(first, samples)
        part, seconds = timed(advance, min(length, samples - first))
        parts.append(part)
        total += seconds
    R = np.concatenate(parts)
    return R, {"R": R.mean(), "R_stderr": blocking_stderr(R), "cpu_seconds": total}
