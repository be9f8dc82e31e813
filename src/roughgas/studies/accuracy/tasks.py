"""The studies by name, and their tasks: independent jobs, each a file. Loads in no time."""

from collections.abc import Mapping
from typing import Any

from roughgas.base.errors import InputError, not_one_of

PANELS = ("statistical", "models", "discretisation")
"""The studies that the work-precision figure shows, one a panel."""
STUDIES = (*PANELS, "coverage")
SCENES = ("vibrated", "sheared", "cooling")
WAYS = ("length", "seeds")
PARTS = ("reference", *WAYS)

Settings = Mapping[str, Any]


def tasks(study: str, settings: Settings) -> list[str]:
    """Return the names of a study's tasks, the longest first; InputError for an unknown study."""
    if study not in STUDIES:
        raise not_one_of("study", study, STUDIES)
    return {
        "statistical": _statistical,
        "models": _models,
        "discretisation": _discretisation,
        "coverage": lambda settings: [corner_name(one) for one in settings["corners"]],
    }[study](settings)


def check_task(study: str, task: str, settings: Settings) -> None:
    """Raise InputError where a study has no such task."""
    known = tasks(study, settings)
    if task not in known:
        raise InputError("task", task, f"be one of {', '.join(known)}")


def corner_name(corner: Settings) -> str:
    """Return the name of the task for a corner of the study of coverage."""
    return f"{corner['experiment']}_r{corner['r']}_beta{corner['beta']}"


def _statistical(_):
    return [f"{scene}-{part}" for part in PARTS for scene in SCENES]


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
