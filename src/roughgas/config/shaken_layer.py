"""A shaken layer by its dimensionless parameters, in place of lengths and times.

With the amplitude A of a sine (half a stroke), its frequency f, gravity g, and the depth H of the
layer at rest,

    Gamma = A (2 pi f)^2/g,    f* = f sqrt(H/g)

as defined by C. Bizon et al., Phys. Rev. Lett. 80, 57 (1998). Depth and width are given in
diameters (2 a), lengths of the schedule in cycles of the drive. Settings keep `layer`; the settings
that follow from it are added, and removed again before changes are merged.
"""

import math
from typing import Annotated, Any

from roughgas.base.fields import Settings, number, whole

LAYER = "layer"
DIAMETER = 2.0  # a
RELATIVE_TOLERANCE = 1e-12  # relative
SettingPath = tuple[str, ...]
"""Keys from the top of an experiment to a setting, such as ("effects", "floor", "period")."""


class CyclesSettings(Settings, frozen=True, kw_only=True):
    """Lengths of the schedule in periods of the floor; by default of `schedule`."""

    equilibrate: Annotated[float, number("[0, inf)", "Cycles before the measurement.")] | None = (
        None
    )
    measure: Annotated[float, number("(0, inf)", "Cycles of the measurement.")] | None = None
    samples: Annotated[int, whole(1, None, "Samples in a cycle.")] | None = None
    repeat: (
        Annotated[
            int,
            whole(
                1, None, "Cycles after which the pattern repeats, schedule.period; 1 by default."
            ),
        ]
        | None
    ) = None


class LayerSettings(Settings, frozen=True, kw_only=True):
    """A layer of spheres on a sinusoidal floor, by its dimensionless parameters.

    They determine the amplitude and the period of the floor, and, if given, the box and the lengths
    of the schedule.
    """

    gamma: Annotated[
        float,
        number("(0, inf)", "Gamma = A (2 pi f)^2/g, with half a stroke, A, and the frequency f."),
    ]
    f_star: Annotated[
        float, number("(0, inf)", "f* = f sqrt(H/g), with the depth H of the layer at rest.")
    ]
    depth: Annotated[float, number("(0, inf)", "H in diameters (2 a).")]
    width: (
        Annotated[
            float,
            number("(0, inf)", "Sides of the square box in diameters; by default those of `box`."),
        ]
        | None
    ) = None
    cycles: CyclesSettings | None = None


def implied(layer: LayerSettings, gravity: float) -> dict[SettingPath, Any]:
    """Return the settings that a layer implies, by their paths; lengths in a, times in T.

    `gravity` is the acceleration in a/T^2. The settings belong to the floor, the box and the
    schedule.
    """
    frequency = layer.f_star / math.sqrt(DIAMETER * layer.depth / gravity)
    amplitude = layer.gamma * gravity / (2.0 * math.pi * frequency) ** 2
    period = 1.0 / frequency
    settings: dict[SettingPath, Any] = {
        ("effects", "floor", "amplitude"): 2.0 * amplitude,
        ("effects", "floor", "period"): period,
        ("effects", "floor", "wave"): "sine",
        ("neighbours",): "lists",
    }
    if layer.width is not None:
        settings["box",] = [DIAMETER * layer.width] * 2 + ["open"]
    cycles = layer.cycles
    if cycles is None or cycles == CyclesSettings():
        return settings
    lengths = {"equilibrate": cycles.equilibrate, "measure": cycles.measure}
    for key, number_of_cycles in lengths.items():
        if number_of_cycles is not None:
            settings["schedule", key] = number_of_cycles * period
    if cycles.samples is not None:
        settings["schedule", "sample_every"] = period / cycles.samples
    settings["schedule", "period"] = (cycles.repeat or 1) * period
    return settings


def agree(value: Any, implied_value: Any) -> bool:
    """Return whether the value of a setting equals the value implied by a layer, up to rounding."""
    if isinstance(implied_value, float) and isinstance(value, int | float):
        return math.isclose(value, implied_value, rel_tol=RELATIVE_TOLERANCE)
    return bool(value == implied_value)
