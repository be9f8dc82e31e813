"""Turns what jsonschema finds wrong into one InputError, whose text a newcomer understands."""

import functools
import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, not_one_of, shown
from roughgas.config.labels import LEGAL_LEVEL, level, restitution, roughness

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator, ValidationError

FORMATS = {
    "restitution": (restitution, RESTITUTION.legal),
    "roughness": (roughness, ROUGHNESS.legal),
    "level": (level, LEGAL_LEVEL),
}
"""For each format of the schema, what reads a value of it, and what is legal."""


def check_schema(instance: Any, source: str, part: str | None = None) -> None:
    """Raise an InputError for the first place where `instance` is not what the schema says.

    `part` names the definition of the schema that is meant, by default its whole. `source` goes
    before the key, such as "config.yaml: experiments".
    """
    errors = list(_validator(part).iter_errors(instance))
    if errors:
        first = min(errors, key=lambda error: _position(error.absolute_path, instance))
        is_file = part is None or source.endswith(".yaml")
        raise _input_error(first, source, ": " if is_file else ".")


@functools.cache
def _validator(part: str | None) -> "Draft202012Validator":
    # imported here, since a job whose settings have been checked can do without
    from jsonschema import Draft202012Validator, FormatChecker
    from jsonschema.validators import extend

    schema = _schema()
    if part is not None:
        schema = {"$ref": f"#/$defs/{part}", "$defs": schema["$defs"]}
    formats = FormatChecker(formats=())
    for name, (value_of, _) in FORMATS.items():
        formats.checks(name, raises=InputError)(lambda label, f=value_of: f(label) is not None)
    types = Draft202012Validator.TYPE_CHECKER.redefine("number", _is_finite)
    types = types.redefine("integer", lambda _, value: type(value) is int)
    return extend(Draft202012Validator, type_checker=types)(schema, format_checker=formats)


def keys(part: str | None = None) -> list[str]:
    """Return the keys that a configuration, or a definition of the schema, may have."""
    return list((_schema() if part is None else _schema()["$defs"][part])["properties"])


@functools.cache
def _schema() -> dict[str, Any]:
    """Return the whole schema: of config.yaml, its studies, the effects, and the observables."""
    from roughgas import effects, observables
    from roughgas.config.reading import read_yaml

    schema, studies = (
        read_yaml(Path(__file__).with_name(name)) for name in ("schema.yaml", "studies.yaml")
    )
    schema["$defs"] |= studies["$defs"]
    schema["$defs"] |= {"effects": effects.schema(), "effects_in_full": effects.required()}
    schema["$defs"]["observables"] = observables.schema()
    return schema


def _is_finite(_checker: Any, value: Any) -> bool:
    return isinstance(value, int | float) and type(value) is not bool and math.isfinite(value)


def _position(path: Iterable[Any], instance: Any) -> list[int]:
    """Return where in the file `path` is, so that the first error in reading order comes first."""
    position = []
    for step in path:
        position.append(list(instance).index(step) if isinstance(instance, Mapping) else step)
        instance = instance[step]
    return position


def _input_error(error: "ValidationError", source: str, separator: str) -> InputError:
    schema: Any = error.schema
    instance: Any = error.instance
    missed: Any = error.validator_value
    # a path is written as in cooling.sweep.r[1]
    steps = (f"[{x}]" if isinstance(x, int) else f".{x}" for x in error.absolute_path)
    path = "".join(steps).removeprefix(".")
    key = f"{source}{separator}{path}" if path else source
    if "propertyNames" in error.absolute_schema_path:
        return InputError(f"{key}: key", shown(instance), _legal(schema))
    if error.validator == "additionalProperties":
        known, patterns = schema["properties"], schema.get("patternProperties", {})
        legal = re.compile("|".join([*map(re.escape, known), *patterns]))
        unknown = next(name for name in instance if not legal.fullmatch(name))
        titles = (about["title"] for about in patterns.values())
        refused = not_one_of(f"{key}: key", shown(unknown), [*sorted(known), *titles])
        if place := _place_of(unknown, instance[unknown], known):
            refused.legal += f"; did you mean it under `{place}`?"
        return refused
    if error.validator == "required":
        missing = next(name for name in missed if name not in instance)
        return InputError(f"{key}.{missing}", "(nothing)", "be given")
    return InputError(key, shown(instance), _legal(schema))


def _place_of(name: str, value: Any, known: Mapping[str, Any]) -> str:
    """Return where in an experiment a key belongs that stands in the wrong place; "" if nowhere.

    `known` are the keys that are legal where it stands.
    """
    parts = _schema()["$defs"]
    experiment = parts["experiment"]
    if "experiments" in known:
        looks_like_one = isinstance(value, Mapping) and set(value) & set(experiment["properties"])
        return "experiments:" if looks_like_one else ""
    places = {"experiments: NAME:": experiment}
    places |= {f"{part}:": parts[part] for part in ("sweep", "schedule", "effects")}
    every = parts["effects"]["properties"].items()
    places |= {f"effects: {effect}:": about for effect, about in every}
    found = [place for place, about in places.items() if name in about["properties"]]
    return found[0] if found else ""


def _legal(schema: Mapping[str, Any]) -> str:
    """Return what `schema` allows, as the end of a sentence that begins "it must"."""
    return next(say(schema) for keyword, say in SAID.items() if keyword in schema)


def _legal_type(schema: Mapping[str, Any]) -> str:
    kind = schema["type"] if isinstance(schema["type"], str) else schema["type"][0]
    if kind in NOT_A_NUMBER:
        return NOT_A_NUMBER[kind]
    if kind == "array":
        few, many = schema["minItems"], schema.get("maxItems")
        least = "a list that is not empty" if few == 1 else f"a list of at least {few} entries"
        return f"be a list of {few} to {many} entries" if many else f"be {least}"
    noun = "a whole number" if kind == "integer" else "a number"
    low, closed = schema.get("minimum", schema.get("exclusiveMinimum")), "minimum" in schema
    if "maximum" in schema:
        return f"be {noun} in {'[' if closed else '('}{low}, {schema['maximum']}]"
    return f"be {noun} {'>=' if closed else '>'} {low}"


NOT_A_NUMBER = {
    "string": "be text",
    "object": "be a mapping of keys to values",
    "boolean": "be true or false",
}
SAID = {
    "anyOf": lambda schema: " or ".join(map(_legal, schema["anyOf"])),
    "const": lambda schema: f"be {schema['const']}",
    "enum": lambda schema: (
        f"be one of {', '.join(schema['enum'])}" if schema["enum"] else "not be given here"
    ),
    "format": lambda schema: FORMATS[schema["format"]][1],
    "minLength": lambda _: "be text that is not empty",
    "pattern": lambda _: "consist of lower-case letters, digits and _, a letter first",
    "type": _legal_type,
}
"""What is legal by the keyword of a schema that decides, the most telling keyword first."""
