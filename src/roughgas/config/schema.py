"""Turns what jsonschema finds wrong into one InputError, whose text a newcomer understands."""

import functools
import math
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.base.errors import InputError, not_one_of
from roughgas.base.legal import RESTITUTION, ROUGHNESS
from roughgas.config.labels import LEGAL_LEVEL, level, restitution, roughness

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator, ValidationError

SCHEMA, STUDIES = (Path(__file__).with_name(name) for name in ("schema.yaml", "studies.yaml"))
LONGEST = 60
FORMATS = {"restitution": restitution, "roughness": roughness, "level": level}
LEGAL_FORMATS = {
    "restitution": RESTITUTION.legal,
    "roughness": ROUGHNESS.legal,
    "level": LEGAL_LEVEL,
}


def check_schema(instance: Any, source: str, part: str | None = None) -> None:
    """Raise an InputError for the first place where `instance` is not what the schema says.

    `part` names the definition of the schema that is meant, by default its whole. `source` goes
    before the key, such as "config.yaml: experiments".
    """
    errors = sorted(
        _validator(part).iter_errors(instance),
        key=lambda error: _position(error.absolute_path, instance),
    )
    if errors:
        raise _input_error(errors[0], source, ": " if part is None else ".")


def shown(value: Any) -> str:
    """How a value is quoted in a message: as Python writes it, on one line, not too long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."


def first_repeated(values: Iterable[Any], key: Callable[[Any], Any]) -> Any:
    """The first of `values` whose `key` an earlier one has, or None."""
    seen = set()
    for value in values:
        if key(value) in seen:
            return value
        seen.add(key(value))
    return None


@functools.cache
def _validator(part: str | None) -> "Draft202012Validator":
    # imported here, since a job whose settings have been checked can do without
    import yaml
    from jsonschema import Draft202012Validator, FormatChecker
    from jsonschema.validators import extend

    from roughgas import effects

    schema, studies = (
        yaml.safe_load(file.read_text(encoding="utf-8")) for file in (SCHEMA, STUDIES)
    )
    schema["$defs"] |= studies["$defs"]
    schema["$defs"] |= {"effects": effects.schema(), "effects_in_full": effects.required()}
    if part is not None:
        schema = {"$ref": f"#/$defs/{part}", "$defs": schema["$defs"]}
    formats = FormatChecker(formats=())
    for name, value_of in FORMATS.items():
        formats.checks(name, raises=InputError)(lambda label, f=value_of: f(label) is not None)
    types = Draft202012Validator.TYPE_CHECKER.redefine("number", _is_finite)
    types = types.redefine("integer", lambda _, value: type(value) is int)
    return extend(Draft202012Validator, type_checker=types)(schema, format_checker=formats)


def _is_finite(_checker: Any, value: Any) -> bool:
    return isinstance(value, int | float) and type(value) is not bool and math.isfinite(value)


def _position(path: Iterable[Any], instance: Any) -> list[int]:
    """Where in the file `path` is, so that the first error in reading order comes first."""
    position = []
    for step in path:
        position.append(list(instance).index(step) if isinstance(instance, Mapping) else step)
        instance = instance[step]
    return position


def _input_error(error: "ValidationError", source: str, separator: str) -> InputError:
    path = _path(error.absolute_path)
    key = f"{source}{separator}{path}" if path else source
    if "propertyNames" in error.absolute_schema_path:
        return InputError(f"{key}: key", shown(error.instance), _legal(error.schema))
    if error.validator == "additionalProperties":
        known, patterns = error.schema["properties"], error.schema.get("patternProperties", {})
        unknown = next(
            name
            for name in error.instance
            if name not in known and not any(re.search(pattern, name) for pattern in patterns)
        )
        legal = [*sorted(known), *(about["title"] for about in patterns.values())]
        return not_one_of(f"{key}: key", shown(unknown), legal)
    if error.validator == "required":
        missing = next(name for name in error.validator_value if name not in error.instance)
        return InputError(f"{key}.{missing}", "(nothing)", "be given")
    return InputError(key, shown(error.instance), _legal(error.schema))


def _path(steps: Iterable[Any]) -> str:
    """As a person writes it: cooling.sweep.r[1]"""
    text = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    return text.removeprefix(".")


def _legal(schema: Mapping[str, Any]) -> str:
    """What `schema` allows, as the end of a sentence that begins "it must"."""
    if "anyOf" in schema:
        return " or ".join(_legal(option) for option in schema["anyOf"])
    if "const" in schema:
        return f"be {schema['const']}"
    if "enum" in schema:
        return f"be one of {', '.join(schema['enum'])}" if schema["enum"] else "not be given here"
    if "format" in schema:
        return LEGAL_FORMATS[schema["format"]]
    if "pattern" in schema:
        return "be made of lower-case letters, digits and _, a letter first"
    return _legal_type(schema)


def _legal_type(schema: Mapping[str, Any]) -> str:
    kind = schema["type"] if isinstance(schema["type"], str) else schema["type"][0]
    if kind == "array":
        few, many = schema["minItems"], schema.get("maxItems")
        return f"be a list of {few} to {many} entries" if many else f"be a list of at least {few}"
    if kind in ("number", "integer"):
        return _legal_number(schema, "a whole number" if kind == "integer" else "a number")
    return "be text" if kind == "string" else "be a mapping of keys to values"


def _legal_number(schema: Mapping[str, Any], noun: str) -> str:
    low, closed = schema.get("exclusiveMinimum"), "minimum" in schema
    low = schema["minimum"] if closed else low
    if "maximum" in schema:
        return f"be {noun} in {'[' if closed else '('}{low}, {schema['maximum']}]"
    return f"be {noun} {'>=' if closed else '>'} {low}"
