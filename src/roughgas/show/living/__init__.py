"""The living page: scenes of the configuration, and a program that simulates them.

Units: particle radius a = particle mass m = time unit T = 1.
"""

import json
from pathlib import Path
from typing import Any

from roughgas.base import InputError, NamedValues
from roughgas.config import PAPER, Configuration, WrittenExperiment, load
from roughgas.scene.initial import check
from roughgas.scene.settings import scene_settings
from roughgas.show import pages

SCENES: dict[str, dict[str, Any]] = {
    "cooling": {"box": [80, 80]},  # smaller than the paper's: disks stay visible on a phone
    "vibrated": {},
    "sheared": {},
}
"""Experiments on the page, and changes to their settings."""
SIMULATED_EFFECTS = {"spin", "gravity", "floor", "shear", "contact_time", "contact_averages"}
"""Effects that the program simulates, and passive ones, which it may ignore."""


WAVE = "sawtooth"
PROGRAM = """paths.js gas.js start.js theory.js record.js run.js
drawing.js panel.js questions.js view.js""".split()


def write_living(*, config: str | Path, output: str | Path) -> None:
    """Write the living page of the experiments in SCENES, with settings from a configuration.

    Raises InputError if the configuration lacks them, or has settings that the page cannot run.
    """
    records = scenes(load(config))
    program = "".join(pages.text_of(f"living/{name}") for name in PROGRAM)
    variables = {
        "scenes": pages.markup(json.dumps(records)),
        "particles": records["cooling"]["particles"],
    }
    pages.write_page(output, "living/page.html", ["living/page.css"], [program], **variables)


def scenes(configuration: Configuration) -> dict[str, NamedValues]:
    """Return the settings of each scene for the page's program (see `scene_of`), by name of the
    scene."""
    return {name: scene_of(name, experiment_of(configuration, name)) for name in SCENES}


def experiment_of(configuration: Configuration, name: str) -> WrittenExperiment:
    """Return the experiment `name` at the paper's scale, or else at the default one, with the
    changes of SCENES."""
    scale = PAPER if PAPER in configuration.scales else configuration.scale
    return WrittenExperiment({**configuration.experiment(name, scale).raw, **SCENES[name]})


def scene_of(name: str, experiment: WrittenExperiment) -> NamedValues:
    """Return the settings of the scene `name` for the page's program: lengths in a, times in T, the
    moment of inertia in m a^2.

    A value of 0 or None stands for an effect that the experiment lacks; an open side of the box is
    None. Raises InputError for settings that the page cannot run.
    """
    settings = experiment.raw
    check(scene_settings(settings))
    effects, (width, height) = settings["effects"], settings["box"]
    floor, model = effects.get("floor"), effects.get("contact_time", {})
    for effect in set(effects) - SIMULATED_EFFECTS:
        raise InputError(
            f"effects of {name}", effect, f"be among {', '.join(sorted(SIMULATED_EFFECTS))}"
        )
    is_unsupported = floor and (floor.get("wave", WAVE) != WAVE or "particles" in floor.values())
    if "direction" in effects.get("gravity", {}):
        raise InputError(f"gravity of {name}", effects["gravity"], "be without a direction")
    if is_unsupported or (floor and {"half_stroke", "phase"} & floor.keys()):
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
