"""Functions that take settings, for tests that write these as config.yaml has them: as mappings.

Each reads the mappings among its arguments, and passes structs to the function of its name in
roughgas. `protocols`, `steady` and `cooling` are the modules of these names.
"""

import functools
from collections.abc import Mapping
from importlib import import_module

from roughgas import observables, scene
from roughgas.base.fields import read_each
from roughgas.effects import species
from roughgas.scene import initial
from roughgas.scene.settings import scene_settings
from roughgas.simulation import (
    films,
    initial_checks,
    initial_states,
    point,
    run_points,
    trajectory,
    trust,
)
from roughgas.simulation.experiment_reader import read_experiment
from roughgas.simulation.gas import Gas
from roughgas.simulation.simulation import Simulation
from roughgas.tasks import free_cooling


def typed(value):
    """Return the settings of a mapping: of a complete experiment if it has a schedule."""
    if not isinstance(value, Mapping) or "box" not in value:
        return value
    return read_experiment(value) if "schedule" in value else scene_settings(value)


def taking_mappings(function):
    """A function whose settings may be mappings."""

    @functools.wraps(function)
    def call(*arguments, **named):
        named = {name: typed(value) for name, value in named.items()}
        return function(*map(typed, arguments), **named)

    return call


class Room:
    """A module whose functions take settings as mappings."""

    def __init__(self, name):
        self.module = import_module(f"roughgas.{name}")

    def __getattr__(self, name):
        value = getattr(self.module, name)
        return taking_mappings(value) if callable(value) else value


protocols, steady, cooling = (
    Room(f"simulation.{name}") for name in ("protocols", "steady", "cooling")
)
check_schedule, window_of = protocols.check_experiment, taking_mappings(trust.window_of)
build, theory_mixture = map(taking_mappings, (scene.build, scene.theory_mixture))
check, initial_state = map(taking_mappings, (initial.check, initial.initial_state))
mixture_of, packing = map(taking_mappings, (species.mixture_of, species.packing))
run_point, expected_collisions = map(taking_mappings, (point.run_point, point.expected_collisions))
start_gas, state_from = map(taking_mappings, (Gas.start, initial_states.state_from))
provenance, check_initial = map(
    taking_mappings, (run_points.provenance, initial_checks.check_initial_states)
)
chosen, snapshots, variables = map(
    taking_mappings, (trajectory.requested_take, films.snapshots, trajectory.trajectory_variables)
)
FreeCooling = taking_mappings(free_cooling.FreeCooling)


def observed_settings(settings, functions=None):
    """Observables of settings, and functions."""
    return observables.requested_observables(
        read_each(observables.OBSERVABLES, settings, "observables"), functions
    )


def compile_kernels(experiments, r):
    """Compile the kernels of experiments at some r."""
    return point.compile_kernels(map(typed, experiments), r)


def kernels(experiments, r):
    """A scene and its experiment for each kernel of experiments at some r."""
    return point.kernels(map(typed, experiments), r)


def measured(experiment, r, beta, seed=1):
    """The variables that the protocol of an experiment measures, without observables."""
    settings, scene = typed(experiment), build(experiment, r, beta)
    return protocols.protocol_of(settings).run(scene, settings, seed, Simulation())
