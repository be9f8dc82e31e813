"""What time steps and springs do to R: soft spheres against events, in the freely cooling gas.

A contact of linear springs has the same duration t_c however slow the gas is. So the velocities are
scaled back to temperature 1 m a^2/T^2 ten times per collision of a particle, which holds t_c nu,
the share of its time that a particle spends in contact; R does not depend on that. The reference is
the plain event-driven gas with the same N and box, which is scaled by powers of two only.

Deviations are (R - R_reference)/R_reference. Two methods are compared at a matched cost: the CPU
seconds after which the statistical error of a run is as large as its deviation, so that it is off
by sqrt(2) times the deviation, root mean square.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughgas.accuracy import VARIABLES
from roughgas.accuracy.soft_spheres import COLUMNS, CONTACTS, new_gas, springs, step
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import EXPONENT, STARTED
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.simulation.energies import Energies, ratio
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import Estimate, blocking_stderr, period_means, stderr_over_seeds
from roughgas.statistics.fits import PowerLaw, limit_at_zero, signed_power_law
from roughgas.tasks import along, cell, dataset, flat, markdown, stacked, stream, timed, variables
from roughgas.theory import collision_frequency, stationary_theta

TARGETS = 0.03, 0.01, 0.003  # relative errors of R
EARLY = 0.05  # t_c nu up to which orders and limits are fitted: above, R is no power of it
CONVERGED = 3.0  # sigma
FINE = 1e-4, 400  # least t_c nu that the cheapest is sought from, and how many are tried
FEWEST_PARTS, SHORTEST = 20, 16  # of a series: parts, and samples in each
MEASURED = ("R", "R_stderr", "collisions", "cpu_seconds")
SPECIAL = ("frequency", "steps", "touched")  # measured by jobs of one kind
FITTED = ("R", "R_stderr", "deviation", "deviation_stderr", "cpu_seconds", "collisions")
ELASTIC = ("drift", "drift_stderr", "speed", "frequency")
SETTLING = 100.0  # collisions per particle, before anything is measured
SAMPLED_EVERY = 0.5  # collisions per particle, in the event-driven gas
REFRESHED_EVERY = 4  # samples
LEG = 1.0  # collisions per particle between two rescalings with the contact-time model
SOFT_LEG = 0.1  # and with soft spheres
SKIN = 1.0  # of the soft spheres' list of neighbours, in a
PARTS = 40  # that a long run is cut into, to tell how far it is
LOSSLESS = {"r": 1.0, "beta": 1.0}  # conserves the energy
ELASTIC_SAMPLES = 100
STREAMS = {"reference": 1, "event": 2, "single": 3, "model": 4, "soft": 5, "elastic": 6}


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the tasks, the longest first."""
    times = settings["contact_times"]
    soft = {f"soft-{n}-{k}": n / t for n in settings["steps"] for k, t in enumerate(times)}
    return [
        *sorted(soft, key=lambda name: -soft[name]),  # by steps per collision
        *(f"reference-{k}" for k in range(settings["reference_runs"])),
        "event",
        "single",
        *(f"model-{k}" for k in range(len(settings["model_contact_times"]))),
    ]


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
        drifting = _drift(settings | LOSSLESS, cooling, precision)
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


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return deviations of R from the reference, orders and costs, from all tasks."""
    steps, t = settings["steps"], np.array(settings["contact_times"], float)
    runs = [parts[f"reference-{k}"] for k in range(settings["reference_runs"])]
    reference = {name: np.array([float(one[name]) for one in runs]) for name in MEASURED}
    stderr = math.sqrt((reference.pop("R_stderr") ** 2).sum()) / len(runs)
    R = Estimate(reference.pop("R").mean(), stderr)
    sums = {name: values.sum() for name, values in reference.items()}
    jobs = {
        "soft": [[f"soft-{n}-{k}" for k in range(len(t))] for n in steps],
        "model": [f"model-{k}" for k in range(len(settings["model_contact_times"]))],
        "event": "event",
        "single": "single",
    }
    found = {"reference_R": R} | {f"reference_{name}": x for name, x in sums.items()}
    for kind, names in jobs.items():
        found |= {
            f"{kind}_{name}": values
            for name, values in _compared(parts, np.array(names), R).items()
        }
    for name in (f"{one}_{precision}" for precision in ("single", "double") for one in ELASTIC):
        found[f"elastic_{name}"] = float(parts["single"][name])
    series = parts["event"].R_series.values
    lengths, (errors, stderr, _) = statistical_error(series, R.value)
    found["statistical_seconds"] = lengths * float(parts["event"].cpu_seconds) / len(series)
    found["statistical_error"] = Estimate(errors / R.value, stderr / R.value)
    events = sums["cpu_seconds"] / sums["collisions"]
    values = flat(found)
    rows = [{name: values[f"soft_{name}"][k] for name in FITTED} for k in range(len(steps))]
    found |= stacked([_fits(t, row, R, events) for row in rows])
    axes = {"steps": steps, "contact_time": t, "target": list(TARGETS)}
    axes["model_contact_time"] = settings["model_contact_times"]
    about = {key: settings[key] for key in ("r", "beta", "packing", "seed")}
    known = variables(VARIABLES, "discretisation")
    return dataset(known, found | axes, **about)


def statistical_error(series, truth) -> tuple[np.ndarray, Estimate]:
    """Return lengths in samples, and the rms errors of means over them, from one long series.

    Disjoint parts of the series, K of each length, are compared with `truth`; the error of their
    rms is that over sqrt(2 K).
    """
    most = max(SHORTEST, len(series) // FEWEST_PARTS)
    lengths = SHORTEST * 2 ** np.arange(int(math.log2(most / SHORTEST)) + 1)
    offsets = [period_means(series, int(length)) - truth for length in lengths]
    errors = np.array([math.sqrt(np.mean(one**2)) for one in offsets])
    return lengths, Estimate(errors, errors / np.sqrt(2.0 * (len(series) // lengths)))


def slowdown(target: float, t, seconds, deviation: PowerLaw, events: float) -> float:
    """Return how many times the CPU time of events soft spheres take for an error of R of `target`.

    The error is the root mean square of `deviation` and of the statistical error, relative to R;
    t_c is chosen for the least time. `seconds` are the soft spheres' CPU seconds per collision per
    particle at each t_c nu in `t`, interpolated as powers; below the least they are inversely
    proportional to t_c. `events` is the same of the event-driven gas.
    """
    fine = np.geomspace(FINE[0], t.max(), FINE[1])
    order = np.argsort(t)
    known = np.interp(np.log(fine), np.log(t[order]), np.log(seconds[order]))
    cost = np.exp(known) * np.maximum(1.0, t.min() / fine)
    left = np.asarray(1.0 - (deviation(fine) / target) ** 2)
    return float((cost[left > 0.0] / left[left > 0.0]).min(initial=math.inf) / events)


def _compared(parts, names, reference):
    """Return what the jobs `names` measured, in the shape of these, and how it compares."""
    found = {
        key: np.array([float(parts[name][key]) for name in names.flat]).reshape(names.shape)
        for key in (*MEASURED, *SPECIAL)
        if key in parts[names.flat[0]]
    }
    deviation = found["R"] / reference.value - 1.0
    stderr = np.hypot(found["R_stderr"], reference.stderr) / reference.value
    matched = (found["R_stderr"] / (reference.value * deviation)) ** 2
    found["matched_seconds"] = found["cpu_seconds"] * matched
    return found | {"deviation": Estimate(deviation, stderr)}


def _fits(t, row, reference, events):
    """Return order, limit and slowdowns; these are NaN for steps so coarse that R does not tend to
    the reference as t_c goes to 0. At least the two smallest t_c nu are fitted."""
    early = t <= max(EARLY, np.sort(t)[1])
    R, stderr, deviation, its_error = (row[name][early] for name in FITTED[:4])
    at_zero = Estimate(*limit_at_zero(t[early], R, stderr))
    law = signed_power_law(t[early], deviation, its_error)
    sigma = (at_zero.value - reference.value) / math.hypot(at_zero.stderr, reference.stderr)
    cost = row["cpu_seconds"] / row["collisions"]
    slower = [slowdown(target, t, cost, law, events) for target in TARGETS]
    return {
        "order": Estimate(law.exponent, law.stderr),
        "amplitude": law.prefactor,
        "order_chi_squared": law.chi_squared,
        "limit_R": at_zero,
        "limit_sigma": sigma,
        "slowdown": slower if abs(sigma) < CONVERGED else [math.nan] * len(TARGETS),
    }


def table(data: xr.Dataset) -> str:
    """Return deviations of soft spheres and of the contact-time model, and what they cost."""
    soft = along(data, "steps")
    head = ["t_c ν", *(f"soft spheres, {n} steps" for n in data.steps.values)]
    rows = []
    for k, t in enumerate(data.contact_time.values):
        at = (one.isel(contact_time=k) for one in soft)
        rows.append([f"{t:g}", *(cell(one, "soft_deviation", "+.2f", 100) for one in at)])
    rows.append(["order in t_c", *(cell(one, "order", ".2f") for one in soft)])
    rows.append(["R at t_c → 0", *(cell(one, "limit_R", ".4f") for one in soft)])
    for target in data.target.values:
        slower = data.slowdown.sel(target=target).values
        cells = ("–" if np.isnan(x) else f"{x:.0f} times" for x in slower)
        rows.append([f"slower than events at {target:.1%}", *cells])
    model_head = ["t_c ν", "deviation of R in %", "contacts changed"]
    model = [
        [
            f"{one.model_contact_time:g}",
            cell(one, "model_deviation", "+.2f", 100),
            f"{one.model_touched:.2%}",
        ]
        for one in along(data, "model_contact_time")
    ]
    speed = data.elastic_speed_single / data.elastic_speed_double
    material = f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
    return (
        f"## Discretisation error ({material}, packing {data.attrs['packing']})\n\n"
        f"Deviation of R in % from events, R = {cell(data, 'reference_R', '.5f')}:\n\n"
        f"{markdown(head, rows)}\nThe contact-time model:\n\n{markdown(model_head, model)}\n"
        "Trajectories kept in single precision: deviation of R"
        f" {cell(data, 'single_deviation', '+.2f', 100)} %, an"
        f" elastic gas's energy drifts by {data.elastic_drift_single:.1e} ±"
        f" {data.elastic_drift_stderr_single:.0e} of itself a collision"
        f" ({data.elastic_drift_double:.0e} in double precision), {speed:.2f} times as fast.\n"
    )
