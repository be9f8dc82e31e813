"""R of single states: of homogeneous gases without positions, and of event-driven gases at other
packings, numbers of particles and kicks.

Times are in units in which a particle collides once by the rate equations. R is T_rot/(T_tr +
T_rot) of the mean temperatures, T_tr with D (N - 1) degrees of freedom.
"""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.gas import Gas, build, scene_settings
from roughgas.tasks import driven_dsmc, dsmc, seed_sequence, timed

DISKS = 2  # dimensions
SAMPLE_EVERY = 1.0  # time between two samples of an event-driven gas
HOMOGENEOUS, KICKS, EVENTS = "homogeneous", "kicks", "events"
"""Kinds of tasks: N varied; the interval of kicks varied; event-driven gases."""


class State(NamedTuple):
    """A material and its drive."""

    r: float  # normal restitution
    beta: float  # roughness
    spin_share: float  # share of rotation in the power of the drive

    @property
    def text(self) -> str:
        """The state as a part of the name of a task."""
        return f"r{self.r:g}-beta{self.beta:g}-share{self.spin_share:g}"


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of all tasks, the longest first."""
    return list(runs_of_tasks(settings))


def runs_of_tasks(settings: Mapping[str, Any]) -> dict[str, list[Callable[..., float]]]:
    """Return for each task by name the functions that return R of a run from its seed.

    The functions are in the order of `homogeneous.particles`, `kicks.intervals` or `events.gases`.
    """
    probe = State(*settings["probe"])
    homogeneous = settings[HOMOGENEOUS]
    by_task = {
        f"{EVENTS}-{probe.text}": [
            partial(by_events, settings[EVENTS], probe, *gas) for gas in settings[EVENTS]["gases"]
        ],
        f"{KICKS}-{probe.text}": [
            partial(without_positions, settings[KICKS], probe, settings[KICKS]["particles"], h)
            for h in settings[KICKS]["intervals"]
        ],
    }
    for state in (State(*row) for row in settings["states"]):
        by_task[f"{HOMOGENEOUS}-{state.text}"] = [
            partial(without_positions, homogeneous, state, number, homogeneous["interval"])
            for number in homogeneous["particles"]
        ]
    return by_task


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return R over (gas, run) of a task, and its CPU time `seconds`."""
    by_task = runs_of_tasks(settings)
    kind, gases = task.partition("-")[0], by_task[task]
    number = settings[kind]["runs"]
    seeds = seed_sequence(settings, list(by_task).index(task)).spawn(len(gases) * number)
    R, spent = np.empty((len(gases), number)), 0.0
    for k, seed in enumerate(seeds):
        gas, repeat = divmod(k, number)
        R[gas, repeat], seconds = timed(gases[gas], seed)
        spent += seconds
        progress(k + 1, len(seeds))
    return xr.Dataset({"R": (("gas", "run"), R), "seconds": spent})


def without_positions(settings, state: State, particles: int, interval: float, seed) -> float:
    """Return R of a homogeneous gas over `settings.work` collisions of all its particles.

    `interval` is the time between two kicks.
    """
    rng = np.random.default_rng(seed)
    model, noise, theta = driven_dsmc.disks_at_unit_temperature(*state, interval)
    gas = dsmc.new_gas(particles, theta, rng)
    driven_dsmc.run(gas, model, noise, rng, round(settings["settle"] / interval))
    steps = round(settings["work"] / particles / interval)
    return driven_dsmc.run(gas, model, noise, rng, steps).R


def by_events(settings, state: State, particles, packing, interval, seed) -> float:
    """Return R of an event-driven gas over `settings.work` collisions of all its particles."""
    theta = float(theory.stationary_theta(state.r, state.beta, spin_share=state.spin_share))
    changes = theory.temperature_changes(1.0, theta, state.r, state.beta, frequency=1.0)
    power = -float(changes[0] + 0.5 * changes[1])  # per time between two collisions
    frequency = float(theory.collision_frequency(1.0, packing))
    side = (particles / float(theory.number_density(packing, DISKS))) ** 0.5
    drive = {
        "power": power * frequency,
        "spin_share": state.spin_share,
        "interval": interval / frequency,
    }
    effects = {
        "spin": {"inertia": theory.moment_of_inertia(DISKS)},
        "thermostat": drive,
    }
    experiment = scene_settings({"particles": particles, "box": [side] * DISKS, "effects": effects})
    scene = build(experiment, r=state.r, beta=state.beta)
    gas = Gas.start(scene, experiment, np.random.default_rng(seed))
    gas.thermalise(5.0)
    gas.in_time(settings["settle"] / frequency, 1)
    samples = round(settings["work"] / particles / SAMPLE_EVERY)
    energies = gas.energies(gas.in_time(SAMPLE_EVERY / frequency, samples))
    T_tr = 2.0 * float(energies.translational.mean()) * particles / (particles - 1)
    T_rot = 2.0 * float(energies.rotational.mean())
    return T_rot / (T_tr + T_rot)
