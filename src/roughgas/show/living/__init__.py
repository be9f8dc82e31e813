"""The living page: scenes of the configuration, and the program that simulates them."""

import json
from pathlib import Path
from typing import Any

from roughgas.base import InputError
from roughgas.config import PAPER, experiment, load
from roughgas.scene.initial import check
from roughgas.show import pages

SCENES: dict[str, dict[str, Any]] = {
    "cooling": {"box": [80, 80]},  # closer than the paper's, so that one sees the disks on a phone
    "vibrated": {},
    "sheared": {},
}
"""Experiments that the page has, and what it changes of them."""
KNOWN = {"spin", "gravity", "floor", "shear", "contact_time", "contact_averages"}
"""Effects that its program has, or that only look."""


WAVE = "sawtooth"
PROGRAM = """paths.js gas.js start.js theory.js record.js run.js
drawing.js panel.js questions.js view.js""".split()


def write_living(*, config: str | Path, output: str | Path) -> None:
    """Write the living page of the experiments in SCENES, as the configuration has them.

    Raises InputError for a configuration without them, or with what the page cannot simulate.
    """
    found = scenes(load(config))
    program = "".join(pages.text_of(f"living/{name}") for name in PROGRAM)
    parts = {"scenes": pages.markup(json.dumps(found)), "particles": found["cooling"]["particles"]}
    pages.write_page(output, "living/page.html", ["living/page.css"], [program], **parts)


def scenes(configuration: Any) -> dict[str, dict[str, Any]]:
    """Return what the page's program is given of each scene."""
    return {name: scene_of(name, settings(configuration, name)) for name in SCENES}


def settings(configuration: Any, name: str) -> dict[str, Any]:
    """Return the settings of an experiment at the paper's scale, or else at the usual one, with the
    page's changes."""
    scale = PAPER if PAPER in configuration["scales"] else configuration["scale"]
    return experiment(configuration, name, scale) | SCENES[name]


def scene_of(name: str, settings: dict[str, Any]) -> dict[str, Any]:
    """Return a scene in the units of all scenes: lengths in a, times in T."""
    check(settings)
    effects, (width, height) = settings["effects"], settings["box"]
    floor, model = effects.get("floor"), effects.get("contact_time", {})
    for other in set(effects) - KNOWN:
        raise InputError(f"effects of {name}", other, f"be among {', '.join(sorted(KNOWN))}")
    unlike = floor and (floor.get("wave", WAVE) != WAVE or "particles" in floor.values())
    if unlike or (floor and {"half_stroke", "phase"} & floor.keys()):
        legal = "be a sawtooth of an amplitude, no phase, and a material of its own"
        raise InputError(f"floor of {name}", floor, legal)
    return {
        "particles": settings["particles"],
        "box": [width, None if height == "open" else height],
        "inertia": effects["spin"]["inertia"],
        "gravity": effects.get("gravity", {}).get("acceleration", 0),
        "floor": floor,
        "shear": effects.get("shear", {}).get("velocity", 0),
        "contact_time": model.get("duration", 0),
        "below_r": model.get("below_r", 1 if model else 0),
    }
