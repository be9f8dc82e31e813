"""The studies by name, and their tasks: independent jobs, each a file. Loads in no time."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

VARIABLES = Path(__file__).with_name("variables.yaml")
"""What the combined datasets hold."""
STUDIES = ("profiles", "finite_size", "runaway")
SIMULATED = ("dsmc", "events")
"""How the study of runaway spins simulates a gas."""


def corner_name(corner: Mapping[str, Any]) -> str:
    """Return the name of the task for a corner of the study of coverage."""
    return f"{corner['experiment']}_r{corner['r']}_beta{corner['beta']}"


def profile_name(point: Mapping[str, Any]) -> str:
    """Return the name of a point of the study of profiles; its runs add `-0`, `-1` ..."""
    return corner_name(point) + (f"_{point['name']}" if "name" in point else "")


def point_names(settings: Mapping[str, Any]) -> dict[str, tuple[str, str, str]]:
    """Return experiment, r and beta of the points of the study of finite size, by their names."""
    places = [(name, *one) for name, points in settings["points"].items() for one in points]
    return {f"{name}_r{r}_beta{beta}": (name, r, beta) for name, r, beta in places}


def runaway_name(kind: str, particles: int, mu: float) -> str:
    """Return the name of a task of the study of runaway spins."""
    return f"{kind}-n{particles}-mu{mu:g}"


def runaway_gases(settings: Mapping[str, Any]) -> dict[str, tuple[str, float, Mapping[str, Any]]]:
    """Return (kind, mu, particles and lengths) of each gas of that study, by name, the longest
    first."""
    gases = [
        (kind, mu, one) for kind in SIMULATED for one in settings[kind] for mu in settings["mu"]
    ]
    gases += [("example", mu, settings["example"]) for mu in settings["example"]["mu"]]
    gases.sort(key=_collisions, reverse=True)
    return {runaway_name(kind, one["particles"], mu): (kind, mu, one) for kind, mu, one in gases}


def _collisions(gas):
    """Return how many a gas makes at most, one by events counting as much as it takes longer."""
    kind, _, one = gas
    return (20 if kind == "events" else 1) * one["particles"] * one["limit"] * one.get("runs", 1)


def _finite_size(settings):
    names = point_names(settings)
    return [f"{name}-n{n}" for n in sorted(settings["particles"], reverse=True) for name in names]


TASKS = {
    "profiles": lambda settings: [
        f"{profile_name(one)}-{k}" for one in settings["points"] for k in range(settings["runs"])
    ],
    "finite_size": _finite_size,
    "runaway": lambda settings: list(runaway_gases(settings)),
}
"""For each study, what names its tasks by its settings, the longest first."""
