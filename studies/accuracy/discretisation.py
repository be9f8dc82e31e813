"""Discretisation error of R: soft spheres with time steps against events, in the freely cooling
gas.

A contact of linear springs has the same duration t_c however slow the gas is. So velocities are
scaled back to temperature 1 m a^2/T^2 ten times per collision of a particle, which holds constant
t_c nu, the share of its time that a particle spends in contact; the scaling leaves R unchanged. The
reference is the plain event-driven gas with the same N and box, which is scaled by powers of two
only.

Deviations are (R - R_reference)/R_reference. Two methods are compared at a matched cost: the CPU
seconds after which the statistical error of a run equals its deviation, so that its root mean
square error is sqrt(2) times the deviation.
"""

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base.fields import OwnSettings
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import EXPONENT, STARTED
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings
from roughgas.simulation.energies import Energies, ratio
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking_stderr, period_means, stderr_over_seeds
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.fits import PowerLaw, limit_at_zero, signed_power_law
from roughgas.tasks import (
    dataset,
    markdown,
    read_variables,
    seed_sequence,
    slices_along,
    split_estimates,
    stack_rows,
    table_cell,
    timed,
)
from roughgas.theory import collision_frequency, stationary_theta

from .soft_spheres import COLUMNS, CONTACTS, new_gas, springs, step

VARIABLES = Path(__file__).with_name("variables.yaml")
TARGET_ERRORS = 0.03, 0.01, 0.003  # of R, relative
LARGEST_FITTED_CONTACT_TIME = 0.05  # t_c nu; above, the deviation of R is no power law
CONVERGENCE_SIGMA = 3.0
FINEST_CONTACT_TIME, CONTACT_TIMES_TRIED = 1e-4, 400  # t_c nu, in the search for the cheapest
FEWEST_BLOCKS, SHORTEST_BLOCK = 20, 16  # of a series; samples in a block
RUN_VARIABLES = ("R", "R_stderr", "collisions", "cpu_seconds")
KIND_SPECIFIC = ("frequency", "steps", "touched")
FIT_VARIABLES = ("R", "R_stderr", "deviation", "deviation_stderr", "cpu_seconds", "collisions")
ELASTIC_VARIABLES = ("drift", "drift_stderr", "speed", "frequency")
SETTLING = 100.0  # collisions per particle, before anything is measured
SAMPLING_INTERVAL = 0.5  # collisions per particle, in the event-driven gas
SAMPLES_PER_REFRESH = 4
MODEL_LEG = 1.0  # collisions per particle between two rescalings, contact-time model
SOFT_LEG = 0.1  # the same for soft spheres
SKIN = 1.0  # of the soft spheres' list of neighbours, in a
PROGRESS_REPORTS = 40  # during a run
LOSSLESS_CONTACT = {"r": 1.0, "beta": 1.0}  # conserves the energy
ELASTIC_SAMPLES = 100
STREAM_KEYS = {"reference": 1, "event": 2, "single": 3, "model": 4, "soft": 5, "elastic": 6}


def tasks(settings: OwnSettings) -> list[str]:
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
    """Return R, its error and CPU seconds of one run, and the variables specific to its kind of
    job. Raises InputError."""
    kind, *indices = task.split("-")
    job = {"soft": _soft, "model": _model, "single": _single}.get(kind, _events)
    values = job(settings, experiments["cooling"], progress, (kind, *map(int, indices)))
    return xr.Dataset({name: (("sample",) if np.ndim(x) else (), x) for name, x in values.items()})


def _soft(settings, cooling, progress, job):
    """Run soft spheres with `steps` steps in a contact of t_c nu = contact_times[index]."""
    _, steps, index = job
    scene, *initial = _start(settings, cooling, job)
    nu = _frequency(settings)
    duration = settings["contact_times"][index] / nu
    q = scene.effects.spin.inertia
    forces = springs(settings["r"], settings["beta"], q, duration)
    gas, spheres = new_gas(*initial, scene.box, forces, SKIN)
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
    contacts_before = gas.counts[CONTACTS]
    _, values = _run_chunks(advance, legs, progress)
    collisions = 2.0 * (gas.counts[CONTACTS] - contacts_before) / number
    frequency = collisions / (legs * per_leg * dt) / nu
    return values | {"collisions": collisions, "frequency": frequency, "steps": legs * per_leg}


def _model(settings, cooling, progress, job):
    """Run the kernel with the contact-time model at constant t_c nu, as for soft spheres."""
    duration = settings["model_contact_times"][job[1]] / _frequency(settings)
    gas = _gas(settings, cooling, job, effects={"contact_time": {"duration": duration}})
    per_leg = gas.count(MODEL_LEG)
    gas.cool(per_leg)

    def advance(legs):
        R = np.empty(legs)
        for k in range(legs):
            R[k] = ratio(gas.energies(gas.in_collisions(per_leg, 1)))[0]
            _heat(gas.state)
        return R

    settling, legs = (
        round(length / MODEL_LEG) for length in (SETTLING, settings["model_collisions"])
    )
    advance(settling)
    settled = gas.costs
    _, values = _run_chunks(advance, legs, progress)
    collisions, touched = legs * per_leg, (gas.costs.touched - settled.touched) / (legs * per_leg)
    values |= {"collisions": 2.0 * collisions / gas.particles, "touched": touched}
    return values | {"cpu_seconds": gas.costs.seconds - settled.seconds}


def _single(settings, cooling, progress, job):
    """Run with trajectories and spins in single precision, and measure the drift of an elastic
    gas's energy in single and in double precision."""
    values = _events(settings, cooling, progress, job, np.float32)
    for name, precision in (("single", np.float32), ("double", np.float64)):
        drifting = _drift(settings | LOSSLESS_CONTACT, cooling, precision)
        values |= {f"{key}_{name}": value for key, value in drifting.items()}
    return values


def _events(settings, cooling, progress, job, precision=np.float64):
    """Run the plain event-driven gas; the kind `event` keeps each sample, for its statistical
    error."""
    kind, gas = job[0], _gas(settings, cooling, job, precision)
    every = gas.count(SAMPLING_INTERVAL)
    gas.cool(SAMPLES_PER_REFRESH * every)
    length = settings["reference_collisions" if kind == "reference" else "event_collisions"]

    def advance(samples):
        return ratio(gas.energies(gas.in_collisions(every, samples)))

    advance(round(SETTLING / SAMPLING_INTERVAL))
    R, values = _run_chunks(advance, round(length / SAMPLING_INTERVAL), progress)
    values["collisions"] = len(R) * SAMPLING_INTERVAL
    return values | ({"R_series": R} if kind == "event" else {})


def _drift(settings, cooling, precision):
    """Return the relative change of an elastic gas's energy per collision, its speed and
    frequency."""
    gas = _gas(settings, cooling, ("elastic",), precision)
    every = max(1, round(settings["event_collisions"] * gas.particles / 40 / ELASTIC_SAMPLES))
    gas.in_collisions(every, 1)
    rows, seconds = timed(gas.in_collisions, every, ELASTIC_SAMPLES)
    energies = gas.energies(rows)
    changes = np.diff(np.log(2.0 * energies.translational + energies.rotational)) / every
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
    scene, *initial = _start(settings, cooling, job, effects)
    return Gas(scene, new_state(scene, *initial, precision))


def _start(settings, cooling, job, effects=None):
    """Return scene, positions, velocities and spins; the spins have the temperature of theory.

    The scene has the experiment's particles at the packing in the settings, spin, and `effects`.
    """
    (kind, *indices), number = job, cooling.particles
    r, beta = settings["r"], settings["beta"]
    side = math.sqrt(number * math.pi / settings["packing"])
    spin = {"inertia": cooling.effects["spin"].inertia}
    effects = {"spin": spin} | (effects or {})
    gas = scene_settings({"particles": number, "box": [side, side], "effects": effects})
    rng = np.random.default_rng(seed_sequence(settings, STREAM_KEYS[kind], *indices))
    scene = build(gas, r, beta)
    q = scene.effects.spin.inertia
    theta = stationary_theta(r, beta, len(scene.box), q)
    position, velocity = np.split(initial_state(scene, gas, rng).trajectory[:, :-1], 2, axis=1)
    return scene, position, velocity, math.sqrt(theta / q) * rng.standard_normal((number, 1))


def _heat(state):
    """Scale velocities and spins to temperature 1 just after a refresh, and reset the kernel's
    units."""
    velocity = state.trajectory[:, 2:4]
    factor = math.sqrt(velocity.size / float(np.sum(velocity**2)))
    velocity *= factor
    state.spin[:] *= factor
    state.particle_times.contact_time[:] /= factor
    state.counts[EXPONENT] = 0
    state.counts[STARTED] = 0


def _run_chunks(advance, samples, progress):
    """Return R of all samples; and its mean, error and CPU seconds by name.

    `advance` returns R of the next samples; its chunks end with a refresh of the gas.
    """
    chunk_length = (
        max(1, -(-samples // (PROGRESS_REPORTS * SAMPLES_PER_REFRESH))) * SAMPLES_PER_REFRESH
    )
    chunks, total = [], 0.0
    for first in range(0, samples, chunk_length):
        progress(first, samples)
        chunk, seconds = timed(advance, min(chunk_length, samples - first))
        chunks.append(chunk)
        total += seconds
    progress(samples, samples)
    R = np.concatenate(chunks)
    return R, {"R": R.mean(), "R_stderr": blocking_stderr(R), "cpu_seconds": total}


def combine(task_results: Mapping[str, xr.Dataset], settings: OwnSettings) -> xr.Dataset:
    """Return deviations of R from the reference, orders in t_c, and costs, from all tasks."""
    steps, t = settings["steps"], np.array(settings["contact_times"], float)
    runs = [task_results[f"reference-{k}"] for k in range(settings["reference_runs"])]
    reference = {
        name: np.array([float(reference_run[name]) for reference_run in runs])
        for name in RUN_VARIABLES
    }
    stderr = math.sqrt((reference.pop("R_stderr") ** 2).sum()) / len(runs)
    R = Estimate(reference.pop("R").mean(), stderr)
    sums = {name: values.sum() for name, values in reference.items()}
    jobs = {
        "soft": [[f"soft-{n}-{k}" for k in range(len(t))] for n in steps],
        "model": [f"model-{k}" for k in range(len(settings["model_contact_times"]))],
        "event": "event",
        "single": "single",
    }
    results = {"reference_R": R} | {f"reference_{name}": x for name, x in sums.items()}
    for kind, names in jobs.items():
        results |= {
            f"{kind}_{name}": values
            for name, values in _comparison(task_results, np.array(names), R).items()
        }
    for name in (
        f"{quantity}_{precision}"
        for precision in ("single", "double")
        for quantity in ELASTIC_VARIABLES
    ):
        results[f"elastic_{name}"] = float(task_results["single"][name])
    series = task_results["event"].R_series.values
    lengths, (errors, stderr, _) = statistical_error(series, R.value)
    results["statistical_seconds"] = (
        lengths * float(task_results["event"].cpu_seconds) / len(series)
    )
    results["statistical_error"] = Estimate(errors / R.value, stderr / R.value)
    events = sums["cpu_seconds"] / sums["collisions"]
    values = split_estimates(results)
    rows = [{name: values[f"soft_{name}"][k] for name in FIT_VARIABLES} for k in range(len(steps))]
    results |= stack_rows([_fits(t, row, R, events) for row in rows])
    axes = {"steps": steps, "contact_time": t, "target": list(TARGET_ERRORS)}
    axes["model_contact_time"] = settings["model_contact_times"]
    attributes = {key: settings[key] for key in ("r", "beta", "packing", "seed")}
    descriptions = read_variables(VARIABLES, "discretisation")
    return dataset(descriptions, results | axes, **attributes)


def statistical_error(series, truth) -> tuple[np.ndarray, Estimate]:
    """Return block lengths in samples, and the rms error of block means, from one long series.

    Means over disjoint blocks, K of each length, are compared with `truth`; the error of their rms
    is that rms over sqrt(2 K).
    """
    longest = max(SHORTEST_BLOCK, len(series) // FEWEST_BLOCKS)
    lengths = SHORTEST_BLOCK * 2 ** np.arange(int(math.log2(longest / SHORTEST_BLOCK)) + 1)
    offsets = [period_means(series, int(length)) - truth for length in lengths]
    errors = np.array([math.sqrt(np.mean(block_offsets**2)) for block_offsets in offsets])
    return lengths, Estimate(errors, errors / np.sqrt(2.0 * (len(series) // lengths)))


def slowdown(target: float, t, seconds, deviation: PowerLaw, events: float) -> float:
    """Return the ratio of CPU times, soft spheres over events, for a relative error `target` of R.

    The error is the root mean square of `deviation` and of the statistical error, relative to R;
    t_c is chosen for the least time. `seconds` are the soft spheres' CPU seconds per collision per
    particle at each t_c nu in `t`, interpolated as powers; below the smallest t_c nu they are
    inversely proportional to t_c. `events` are the CPU seconds per collision per particle of the
    event-driven gas.
    """
    fine = np.geomspace(FINEST_CONTACT_TIME, t.max(), CONTACT_TIMES_TRIED)
    order = np.argsort(t)
    log_cost = np.interp(np.log(fine), np.log(t[order]), np.log(seconds[order]))
    cost = np.exp(log_cost) * np.maximum(1.0, t.min() / fine)
    statistical_share = np.asarray(1.0 - (deviation(fine) / target) ** 2)
    return float(
        (cost[statistical_share > 0.0] / statistical_share[statistical_share > 0.0]).min(
            initial=math.inf
        )
        / events
    )


def _comparison(task_results, names, reference):
    """Return variables of the jobs `names`, in the shape of `names`, with deviations from the
    reference and matched CPU seconds."""
    values = {
        key: np.array([float(task_results[name][key]) for name in names.flat]).reshape(names.shape)
        for key in (*RUN_VARIABLES, *KIND_SPECIFIC)
        if key in task_results[names.flat[0]]
    }
    deviation = values["R"] / reference.value - 1.0
    stderr = np.hypot(values["R_stderr"], reference.stderr) / reference.value
    matched = (values["R_stderr"] / (reference.value * deviation)) ** 2
    values["matched_seconds"] = values["cpu_seconds"] * matched
    return values | {"deviation": Estimate(deviation, stderr)}


def _fits(t, row, reference, events):
    """Return order, limit and slowdowns from one number of steps. Slowdowns are NaN where steps are
    so coarse that R does not tend to the reference as t_c goes to 0. At least the two smallest t_c
    nu are fitted."""
    early = t <= max(LARGEST_FITTED_CONTACT_TIME, np.sort(t)[1])
    R, stderr, deviation, deviation_stderr = (row[name][early] for name in FIT_VARIABLES[:4])
    at_zero = Estimate(*limit_at_zero(t[early], R, stderr))
    law = signed_power_law(t[early], deviation, deviation_stderr)
    sigma = (at_zero.value - reference.value) / math.hypot(at_zero.stderr, reference.stderr)
    cost = row["cpu_seconds"] / row["collisions"]
    slower = [slowdown(target, t, cost, law, events) for target in TARGET_ERRORS]
    return {
        "order": Estimate(law.exponent, law.stderr),
        "amplitude": law.prefactor,
        "order_chi_squared": law.chi_squared,
        "limit_R": at_zero,
        "limit_sigma": sigma,
        "slowdown": slower if abs(sigma) < CONVERGENCE_SIGMA else [math.nan] * len(TARGET_ERRORS),
    }


def table(data: xr.Dataset) -> str:
    """Return tables of deviations and costs of soft spheres and of the contact-time model,
    Markdown."""
    soft = slices_along(data, "steps")
    head = ["t_c ν", *(f"soft spheres, {n} steps" for n in data.steps.values)]
    rows = []
    for k, t in enumerate(data.contact_time.values):
        gases = (gas.isel(contact_time=k) for gas in soft)
        rows.append([f"{t:g}", *(table_cell(gas, "soft_deviation", "+.2f", 100) for gas in gases)])
    rows.append(["order in t_c", *(table_cell(gas, "order", ".2f") for gas in soft)])
    rows.append(["R at t_c → 0", *(table_cell(gas, "limit_R", ".4f") for gas in soft)])
    for target in data.target.values:
        slower = data.slowdown.sel(target=target).values
        cells = ("–" if np.isnan(x) else f"{x:.0f} times" for x in slower)
        rows.append([f"slower than events at {target:.1%}", *cells])
    model_head = ["t_c ν", "deviation of R in %", "contacts changed"]
    model = [
        [
            f"{gas.model_contact_time:g}",
            table_cell(gas, "model_deviation", "+.2f", 100),
            f"{gas.model_touched:.2%}",
        ]
        for gas in slices_along(data, "model_contact_time")
    ]
    speed = data.elastic_speed_single / data.elastic_speed_double
    material = f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
    return (
        f"## Discretisation error ({material}, packing {data.attrs['packing']})\n\n"
        f"Deviation of R in % from events, R = {table_cell(data, 'reference_R', '.5f')}:\n\n"
        f"{markdown(head, rows)}\nThe contact-time model:\n\n{markdown(model_head, model)}\n"
        "Trajectories kept in single precision: deviation of R"
        f" {table_cell(data, 'single_deviation', '+.2f', 100)} %, an"
        f" elastic gas's energy drifts by {data.elastic_drift_single:.1e} ±"
        f" {data.elastic_drift_stderr_single:.0e} of itself a collision"
        f" ({data.elastic_drift_double:.0e} in double precision), {speed:.2f} times as fast.\n"
    )
