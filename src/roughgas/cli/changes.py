"""What `--set KEY=VALUE` changes of an experiment's settings."""

import re
from collections.abc import Iterable, Mapping
from typing import Any

from roughgas import config
from roughgas.base import InputError
from roughgas.config.labels import SPECIES, names_of, species_called

NOT_TO_SET = (*config.NOT_OF_A_POINT, config.SWEPT, "extends")


def changed_by(settings: Mapping[str, Any], told: Iterable[str]) -> dict[str, Any]:
    """Return settings with what `told` changes, each KEY=VALUE, VALUE in YAML; null removes a key.

    A KEY is dotted, as schedule.measure; as in a sweep `effects.` may be left out, a species be
    named, and `box` be a width alone. Raises InputError for another form, and for a key given
    twice; whether keys and values are legal is left to the schema.
    """
    from roughgas.config.reading import parse_yaml

    found, seen = dict(settings), set()
    for one in told:
        key, _, text = one.partition("=")
        if not key or not text:
            raise InputError("--set", one, "be KEY=VALUE, such as particles=80")
        if key in seen:
            raise InputError("--set", key, "be given once")
        if key.partition(".")[0] in NOT_TO_SET:
            raise InputError("--set", key, "be a setting of one point")
        seen.add(key)
        found = config.changed_by(found, _change(found, key, parse_yaml(text, f"--set {key}")))
    return found


def _change(settings: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    """Return the change to settings that gives a dotted key this value."""
    from roughgas import effects

    part = key.rpartition(".")[0]
    if part.startswith(SPECIES):
        if species_called(settings, part) is None:
            known = ", ".join(names_of(settings)) or "there are none"
            raise InputError("--set", key, f"name one of species: {known}")
        return config.swept_to(settings, key, value)
    if key == "box" and isinstance(value, int | float):
        return config.swept_to(settings, key, value)
    names = key.split(".")
    if names[0] in effects.schema()["properties"]:
        names.insert(0, "effects")
    for name in reversed(names):
        value = {name: value}
    return value


def as_label(told: Iterable[str]) -> list[str]:
    """Return what `told` changes as parts of a file's name: mu0.3 for effects.friction.mu=0.3."""
    pairs = (one.partition("=") for one in told)
    return [re.sub(r"[^\w.+-]", "", f"{key.rpartition('.')[2]}{text}") for key, _, text in pairs]
