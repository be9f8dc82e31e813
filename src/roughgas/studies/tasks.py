"""The studies by name, and their tasks: independent jobs, each a file. Loads in no time."""

from collections.abc import Mapping
from typing import Any

PANELS = ("statistical", "models", "discretisation")
"""The studies that the work-precision figure shows, one a panel."""
STUDIES = (*PANELS, "coverage", "profiles", "finite_size")
SCENES = ("vibrated", "sheared", "cooling")
WAYS = ("length", "seeds")
PARTS = ("reference", *WAYS)


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


def _finite_size(settings):
    names = point_names(settings)
    return [f"{name}-n{n}" for n in sorted(settings["particles"], reverse=True) for name in names]


def _models(settings):
    return [
        *(f"reference-{k}" for k in range(settings["reference"]["jobs"])),
        *(f"map-r{r}" for r in settings["map"]["r"]),
        *(f"density-r{r}-beta{beta}" for r, beta in settings["density"]["points"]),
        "event_driven",
        "dsmc",
        "theory",
    ]


def _discretisation(settings):
    times = settings["contact_times"]
    soft = {f"soft-{n}-{k}": n / t for n in settings["steps"] for k, t in enumerate(times)}
    return [
        *sorted(soft, key=lambda name: -soft[name]),  # by steps per collision
        *(f"reference-{k}" for k in range(settings["reference_runs"])),
        "event",
        "single",
        *(f"model-{k}" for k in range(len(settings["model_contact_times"]))),
    ]


TASKS = {
    "statistical": lambda _: [f"{scene}-{part}" for part in PARTS for scene in SCENES],
    "models": _models,
    "discretisation": _discretisation,
    "coverage": lambda settings: [corner_name(one) for one in settings["corners"]],
    "profiles": lambda settings: [
        f"{profile_name(one)}-{k}" for one in settings["points"] for k in range(settings["runs"])
    ],
    "finite_size": _finite_size,
}
"""For each study, what names its tasks by its settings, the longest first."""
