"""The third axis of a sweep: one parameter of one effect, besides r and beta.

It stands in the sweep as EFFECT.PARAMETER with its labels, such as `spin.inertia: ["1", "0.1"]`.
One label of it makes a variant of the experiment, named EXPERIMENT/PARAMETERLABEL, such as
vibrated_inertia/inertia0.1: an experiment like any other, whose effects have that value.
"""

from collections.abc import Mapping
from typing import Any

from roughgas.base.errors import InputError
from roughgas.config.labels import level
from roughgas.config.schema import first_repeated, shown

SWEPT = "swept"
"""Key in the settings of a variant: what its experiment sweeps, such as spin.inertia."""


def third_axis(settings: Mapping[str, Any]) -> str | None:
    """The key of the third axis in the sweep of an experiment, or None."""
    return next(iter(_keys(settings)), None)


def variants(name: str, settings: Mapping[str, Any]) -> list[str]:
    """The names of all variants in an experiment's sweep; [name] where it has no third axis."""
    key = third_axis(settings)
    if key is None:
        return [name]
    _, parameter = key.split(".")
    return [f"{name}/{parameter}{label}" for label in settings["sweep"][key]]


def every_variant(name: str, settings: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The settings of all these variants by name; those given where there is no third axis."""
    if third_axis(settings) is None:
        return {name: dict(settings)}
    return {one: variant(one, settings) for one in variants(name, settings)}


def variant(name: str, settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of the variant `name`, in the sweep or not, from those of its experiment.

    Raises InputError where the experiment has no third axis, or `name` no label on it.
    """
    base, _, folder = name.partition("/")
    key = third_axis(settings)
    if key is None:
        raise InputError("experiment", shown(name), f"be {base} alone, which has no third axis")
    _, parameter = key.split(".")
    if not folder.startswith(parameter):
        legal = f"name a value of {parameter}, such as {variants(base, settings)[0]}"
        raise InputError("experiment", shown(name), legal)
    value = level(folder.removeprefix(parameter), f"{base}: {key}")
    swept = {one: labels for one, labels in settings["sweep"].items() if one != key}
    return _changed(settings, key, {parameter: value}) | {"sweep": swept, SWEPT: key}


def common(settings: Mapping[str, Any]) -> dict[str, Any]:
    """The settings of an experiment without the parameter that it sweeps."""
    key = third_axis(settings)
    return dict(settings) if key is None else _changed(settings, key, {})


def check_one_variant(name: str, settings: Mapping[str, Any]) -> None:
    """Raise an InputError where a point of `name` must say which variant it belongs to."""
    if third_axis(settings) is not None:
        legal = f"be followed by a variant, such as {variants(name, settings)[0]}"
        raise InputError("experiment", shown(name), legal)


def check_axis(settings: Mapping[str, Any], where: str) -> None:
    """Raise an InputError where the sweep has two third axes, one of an effect that the experiment
    does without, or a value twice. Whether a value is legal is for the check of its variant."""
    keys = _keys(settings)
    for key in keys[1:]:
        raise InputError(f"{where}.sweep: key", shown(key), f"not stand beside {keys[0]}")
    for key in keys:
        effect, _ = key.split(".")
        listed = settings.get("effects", {})
        if effect not in listed:
            legal = f"begin with an effect of this experiment: {', '.join(sorted(listed))}"
            raise InputError(f"{where}.sweep: key", shown(key), legal)
        repeated = first_repeated(settings["sweep"][key], level)
        if repeated is not None:
            raise InputError(f"{where}.sweep.{key}", shown(repeated), "be given once")


def _keys(settings: Mapping[str, Any]) -> list[str]:
    return [key for key in settings.get("sweep", {}) if "." in key]


def _changed(settings: Mapping[str, Any], key: str, value: Mapping[str, Any]) -> dict[str, Any]:
    """Settings with `value` in place of the parameter `key`."""
    effect, parameter = key.split(".")
    rest = {one: kept for one, kept in settings["effects"][effect].items() if one != parameter}
    return dict(settings) | {"effects": settings["effects"] | {effect: rest | value}}
