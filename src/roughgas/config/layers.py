"""A shaken layer by the numbers of the field, in place of lengths and times.

With the amplitude A of a sine (half a stroke), its frequency f, gravity g, and the depth H that the
layer has at rest,

    Gamma = A (2 pi f)^2/g,    f* = f sqrt(H/g)

as C. Bizon et al., Phys. Rev. Lett. 80, 57 (1998) have them. Depth and width are given in diameters
(2 a), lengths of the schedule in cycles of the drive. Settings keep `layer`; what follows from it
is added to them, and leaves them again before they are changed.
"""

import math
from collections.abc import Mapping
from typing import Any

from roughgas.base import InputError

LAYER = "layer"
DIAMETER = 2.0  # a
ROUNDING = 1e-12
NEEDED = ("gamma", "f_star", "depth")
LENGTHS = ("equilibrate", "measure")


def said_by_layer(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the layer of settings says of others: floor, box and schedule, in a and T.

    Nothing where there is none, or where it or gravity is not known in full, which is left to the
    schema.
    """
    layer = settings.get(LAYER) or {}
    gravity = (settings.get("effects", {}).get("gravity") or {}).get("acceleration")
    if not all(isinstance(x, int | float) and x > 0 for x in (gravity, *map(layer.get, NEEDED))):
        return {}
    frequency = layer["f_star"] / math.sqrt(DIAMETER * layer["depth"] / gravity)
    amplitude = layer["gamma"] * gravity / (2.0 * math.pi * frequency) ** 2
    period = 1.0 / frequency
    floor = {"amplitude": 2.0 * amplitude, "period": period, "wave": "sine"}
    found: dict[str, Any] = {"effects": {"floor": floor}, "neighbours": "lists"}
    if "width" in layer:
        found["box"] = [DIAMETER * layer["width"]] * 2 + ["open"]
    cycles = layer.get("cycles") or {}
    lengths = {key: cycles[key] * period for key in LENGTHS if key in cycles}
    if "samples" in cycles:
        lengths["sample_every"] = period / cycles["samples"]
    if cycles:
        lengths["period"] = cycles.get("repeat", 1) * period
    return found | ({"schedule": lengths} if lengths else {})


def with_layer(settings: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return settings with what their layer says; raise InputError where they say otherwise."""
    return _added(settings, said_by_layer(settings), where)


def without_layer(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings without what their layer has said, but with the layer."""
    return _taken(settings, said_by_layer(settings))


def _added(settings, said, where):
    found = dict(settings)
    for key, value in said.items():
        there = found.get(key)
        if isinstance(value, Mapping):
            found[key] = _added(there or {}, value, f"{where}.{key}")
        elif there is not None and not _same(there, value):
            legal = f"not be given beside layer, which makes it {value}"
            raise InputError(f"{where}.{key}", there, legal)
        else:
            found[key] = value
    return found


def _taken(settings, said):
    found = dict(settings)
    for key, value in said.items():
        if isinstance(value, Mapping):
            found[key] = _taken(found.get(key, {}), value)
        else:
            found.pop(key, None)
    return found


def _same(one, other):
    if isinstance(other, float) and isinstance(one, int | float):
        return math.isclose(one, other, rel_tol=ROUNDING)
    return one == other
