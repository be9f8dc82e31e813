"""What time steps and springs do to R: soft spheres against events, in the freely cooling gas.

A contact of linear springs has the same duration t_c however slow the gas is. So the velocities are
scaled back to temperature 1 m a^2/T^2 ten times per collision of a particle, by which t_c nu, the
share of its time that a particle spends in contact, stays what it is chosen to be; R does not know.
The reference is the plain event-driven gas with the same N and box, which is never scaled but by
powers of two. All jobs have random numbers of their own. CPU seconds are those of the simulation
proper, everything compiled before, at equilibrium.
"""

from collections.abc import Callable, Mapping
from typing import Any


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Names of the independent jobs, the longest first."""
    soft = [f"soft-{n}-{k}" for n in settings["steps"] for k in _places(settings["contact_times"])]
    reference = [f"reference-{k}" for k in range(settings["reference_runs"])]
    models = [f"model-{k}" for k in _places(settings["model_contact_times"])]
    soft.sort(key=lambda name: -_steps(name, settings))
    return [*soft, *reference, "event", "single", *models]


def run(task: str, settings: Mapping[str, Any], experiments, progress: Callable[[int, int], None]):
    """One job: R of one run (xarray.Dataset). Raises InputError for illegal settings."""
    import numpy as np
    import xarray as xr

    from roughgas.studies.accuracy.discretisation_runs import JOBS

    kind, *places = task.split("-")
    found = JOBS[kind](settings, experiments["cooling"], progress, *map(int, places))
    return xr.Dataset({name: (("sample",) if np.ndim(x) else (), x) for name, x in found.items()})


def combine(parts, settings: Mapping[str, Any]):
    """All jobs as one xarray.Dataset: deviations of R from the reference, orders, costs."""
    from roughgas.studies.accuracy.discretisation_group import together

    return together(parts, settings)


def _places(values):
    return range(len(values))


def _steps(name, settings):
    """Time steps per collision that the job makes."""
    _, steps, place = name.split("-")
    return int(steps) / settings["contact_times"][int(place)]
