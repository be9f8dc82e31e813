"""Soft spheres and events in the freely cooling gas, one function a kind of job.

Each takes the study's settings, those of the experiment, progress, and the task, (kind, *places),
to which random numbers of its own belong; it returns numbers by name. CPU seconds are those of the
simulation proper, everything compiled before, at equilibrium.
"""

import math
import time
from collections.abc import Callable

import numpy as np
import xarray as xr

from roughgas.kernel.layout import new_state
from roughgas.kernel.state import EXPONENT, STARTED
from roughgas.scene import build, initial_state
from roughgas.simulation.energies import Energies, ratio
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking_stderr, stderr_over_seeds
from roughgas.studies.accuracy.runs import stream, timed
from roughgas.studies.soft_spheres import new_gas, springs
from roughgas.studies.soft_spheres.gas import CONTACTS
from roughgas.studies.soft_spheres.stepping import COLUMNS, step
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
    settling, legs = (
        math.ceil(length / (nu * dt * per_leg))
        for length in (SETTLING, settings["soft_collisions"])
    )
    step(gas, spheres, dt, per_leg, 1.0, np.empty((settling, len(COLUMNS))))
    rows = np.empty((legs, len(COLUMNS)))
    begun, seconds = gas.counts[CONTACTS], time.process_time()
    for done, part in _parts(rows, progress):
        if step(gas, spheres, dt, per_leg, 1.0, part) < len(part):
            raise RuntimeError(f"soft spheres are too crowded after {done} of {legs} legs")
    seconds = time.process_time() - seconds
    vv, ww, contacts = rows.T
    R = ratio(Energies(vv / (2 * number), q * ww / number))
    collisions = 2.0 * (contacts[-1] - begun) / number
    frequency = collisions / (legs * per_leg * dt) / nu
    return _summary(R, collisions, seconds) | {"frequency": frequency, "steps": legs * per_leg}


def _model(settings, cooling, progress, job):
    """The kernel with the contact-time model, t_c nu being held as for soft spheres."""
    duration = settings["model_contact_times"][job[1]] / _frequency(settings)
    gas = _gas(settings, cooling, job, effects={"contact_time": {"duration": duration}})
    per_leg, recorder = gas.count(LEG), gas.recorder
    gas.cool(per_leg)
    settling, legs = (round(length / LEG) for length in (SETTLING, settings["model_collisions"]))
    for _ in range(settling):
        gas.in_collisions(per_leg, 1)
        _heat(gas.state)
    recorder.touched, recorder.seconds, R = 0, 0.0, np.empty(legs)
    for _, part in _parts(R, progress):
        for k in range(len(part)):
            part[k] = ratio(gas.energies(gas.in_collisions(per_leg, 1)))[0]
            _heat(gas.state)
    collisions = 2.0 * legs * per_leg / gas.particles
    touched = recorder.touched / (legs * per_leg)
    return _summary(R, collisions, recorder.seconds) | {"touched": touched}


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
    gas.in_collisions(every, round(SETTLING / SAMPLED_EVERY))
    R, seconds = np.empty(round(length / SAMPLED_EVERY)), time.process_time()
    for _, part in _parts(R, progress):
        part[:] = ratio(gas.energies(gas.in_collisions(every, len(part))))
    found = _summary(R, len(R) * SAMPLED_EVERY, time.process_time() - seconds)
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


def _parts(rows, progress):
    """(number of the first row, part of the rows), each a whole number of refreshed samples."""
    length = max(1, -(-len(rows) // (PARTS * REFRESHED_EVERY))) * REFRESHED_EVERY
    for first in range(0, len(rows), length):
        progress(first, len(rows))
        yield first, rows[first : first + length]


def _summary(R, collisions, seconds):
    found = {"R": R.mean(), "R_stderr": blocking_stderr(R)}
    return found | {"collisions": float(collisions), "cpu_seconds": seconds}
