"""Checks of a whole configuration, of one experiment in it, and of settings.

The schema (schema.yaml) says what each part may hold; here is what it cannot say, and how what
jsonschema finds wrong becomes one InputError whose text a newcomer understands. All functions raise
it for the first illegal thing, with the file and the key in it.
"""

import functools
import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas import config as settings_of
from roughgas.base import RESTITUTION, ROUGHNESS, InputError, not_one_of, shown
from roughgas.config.labels import (
    LEGAL_LEVEL,
    SPECIES,
    holder,
    level,
    names_of,
    numbers_of,
    restitution,
    roughness,
)
from roughgas.config.reading import read_yaml

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator, ValidationError

RESERVED = frozenset(
    """
    accuracy accuracy_data accuracy_figure accuracy_limits accuracy_table accuracy_task article
    article_pdf catalogue claims codemeta compile_kernel config coverage crate deposit document
    effective_config everything evidence explore explore_extensions extensions family fig1a fig1b
    fig2a fig2b figure figure_of_evidence figures front hard_cases hard_cases_chaos
    hard_cases_collapse hard_cases_cooling living living_page movie movies numbers page
    page_of_evidence picture_for_talks pictures plot point quoted_by_documentation quoted_numbers
    reduce report rows_of_evidence run_times run_times_extensions study_claims study_data
    study_evidence study_figure study_movie study_page study_slides study_table study_task table
    """.split()
)
"""Names that no experiment may have, those of rules and products of the workflow."""
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
    is_file = part is None or source.endswith(".yaml")
    _refuse(_validator(part), instance, source, ": " if is_file else ".")


def check_by(schema: Any, instance: Any, source: str, called: str) -> None:
    """Raise an InputError for the first place where `instance` is not what a schema of its own
    says, which is `called` so; it may refer to $defs of the schema of config.yaml."""
    from jsonschema import Draft202012Validator, SchemaError
    from referencing.exceptions import Unresolvable

    legal = "be a JSON schema, with references to $defs of its own or of config.yaml's schema"
    try:
        Draft202012Validator.check_schema(schema)
        whole = {**schema, "$defs": _schema()["$defs"] | schema.get("$defs", {})}
        _refuse(_validator_of(whole), instance, source, ".")
    except (SchemaError, Unresolvable, TypeError) as error:
        raise InputError(called, str(error).partition("\n")[0], legal) from error


def _refuse(validator: "Draft202012Validator", instance: Any, source: str, separator: str) -> None:
    errors = list(validator.iter_errors(instance))
    if errors:
        first = min(errors, key=lambda error: _position(error.absolute_path, instance))
        raise _input_error(first, source, separator)


@functools.cache
def _validator(part: str | None) -> "Draft202012Validator":
    schema = _schema()
    if part is not None:
        schema = {"$ref": f"#/$defs/{part}", "$defs": schema["$defs"]}
    return _validator_of(schema)


def _validator_of(schema: dict[str, Any]) -> "Draft202012Validator":
    # imported here, since a job whose settings have been checked can do without
    from jsonschema import Draft202012Validator, FormatChecker
    from jsonschema.validators import extend

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
    """Return the whole schema: of config.yaml, accuracy, the effects, and the observables."""
    from roughgas import effects, observables

    schema = read_yaml(Path(__file__).with_name("schema.yaml"))
    accuracy = read_yaml(settings_of.OF_ACCURACY / "schema.yaml")
    schema["$defs"] |= accuracy["$defs"]
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
    said = (say(schema) for keyword, say in SAID.items() if keyword in schema)
    return next(said, "be what its schema says")


def _legal_type(schema: Mapping[str, Any]) -> str:
    kind = schema["type"] if isinstance(schema["type"], str) else schema["type"][0]
    if kind in NOT_A_NUMBER:
        return NOT_A_NUMBER[kind]
    if kind == "array":
        few, many = schema.get("minItems", 0), schema.get("maxItems")
        least = "a list that is not empty" if few == 1 else f"a list of at least {few} entries"
        return f"be a list of {few} to {many} entries" if many else f"be {least}"
    noun = "a whole number" if kind == "integer" else "a number"
    low, closed = schema.get("minimum", schema.get("exclusiveMinimum")), "minimum" in schema
    if low is None:
        return f"be {noun}"
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


def read(
    path: str | Path, overrides: Mapping[str, Any] | None = None
) -> tuple[dict[str, Any], str]:
    """Return the unchecked configuration at `path`, `overrides` merged into it, and what messages
    call it."""
    source = Path(path).name
    config = read_yaml(path)
    if not isinstance(config, dict):
        raise InputError(source, shown(config), "hold the key experiments")
    config = {"scale": settings_of.PAPER} | config
    config = {"scales": {str(config["scale"]): {}}} | config
    if not overrides:
        return config, source
    return _changed(config, overrides), f"{source} with the command line's changes"


def _changed(config: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return a configuration with `overrides` merged in.

    What these remove of an experiment stays, as None: it may be a study's, or inherited.
    """
    changes, found = dict(overrides), {}
    for key, depth in {"experiments": 1, "scales": 2}.items():
        if isinstance(changes.get(key), Mapping):
            found[key] = _noted(config.get(key), changes.pop(key), depth)
    return settings_of.merged(config, changes) | found


def _noted(base: Any, changes: Mapping[str, Any], depth: int) -> dict[str, Any]:
    """Return `base` with `changes` merged in, which remove keys of the outer `depth` mappings."""
    base = base if isinstance(base, Mapping) else {}
    if not depth:
        return settings_of.merged(base, changes, removing=False)
    inner = {
        key: _noted(base.get(key), one, depth - 1)
        for key, one in changes.items()
        if isinstance(one, Mapping)
    }
    outer = {key: one for key, one in changes.items() if key not in inner}
    return settings_of.merged(base, outer) | inner


def check(config: Mapping[str, Any], source: str = "config.yaml") -> None:
    """Check a configuration: its form, and every experiment, variant and study at every scale."""
    check_file(config, source)
    check_merged(config, source)


def check_merged(config: Mapping[str, Any], source: str) -> None:
    """Check what the form cannot say; experiments of studies have been checked as they joined."""
    for name in config["experiments"]:
        check_ancestors(name, config["experiments"], source)
    for scale in config["scales"]:
        if settings_of.ACCURACY in config:
            where = f"{source}: accuracy at scale {scale}"
            check_schema(settings_of.accuracy(config, scale), where, "accuracy_in_full")
        for name in config["experiments"]:
            if "." not in name or config.get("complete"):
                check_one(config, name, scale, source)


def check_file(config: Mapping[str, Any], source: str) -> None:
    """Check the form of a configuration: what can be said without merging anything."""
    added = (settings_of.FOLDERS, settings_of.BROKEN)  # by studies that have joined
    check_schema({key: part for key, part in config.items() if key not in added}, source)
    known, scales = config["experiments"], config["scales"]
    settings_of.one_of(f"{source}: scale", config.get("scale", ""), scales)  # `scale=` removes it
    for name in known:
        if name in RESERVED:
            legal = "be another name: the workflow has a rule or a product of this one"
            raise InputError(f"{source}: key of experiments", name, legal)
    changeable = [*known, settings_of.ACCURACY]
    for scale, changes in scales.items():
        for name in changes:
            if "." not in name or config.get("complete"):
                settings_of.one_of(f"{source}: key of scales.{scale}", name, changeable)


def check_one(config: Mapping[str, Any], name: str, scale: str, source: str) -> None:
    """Check an experiment and its variants at one scale, all that they extend merged."""
    settings = settings_of.experiment(config, name, scale)
    at_scale = "" if scale == config["scale"] else f" at scale {scale}"
    where = f"{source}: experiments.{name}{at_scale}"
    _check_axis(settings, where)
    for one, chosen in settings_of.every_variant(name, settings).items():
        for part in ("experiment", "point") if one != name else ("point",):
            check_schema(chosen, f"{source}: experiments.{one}{at_scale}", part)
    check_schema(settings, where, "swept")
    for key, value_of in (("r", restitution), ("beta", roughness)):
        numbers_of(f"{where}.sweep.{key}", settings["sweep"][key], value_of)


def _check_axis(settings: Mapping[str, Any], where: str) -> None:
    """Refuse two third axes, one of an effect that the experiment does not list or of a length that
    its schedule does not have, and a value given twice. Whether a value is legal is left to the
    check of its variant."""
    keys = [key for key in settings.get("sweep", {}) if key not in settings_of.GRID]
    for key in keys[1:]:
        raise InputError(f"{where}.sweep: key", shown(key), f"not stand beside {keys[0]}")
    for key in keys:
        part, _, parameter = key.rpartition(".")
        listed, timed = settings.get("effects", {}), settings.get("schedule", {})
        if part == "schedule" and parameter not in timed:
            legal = f"name a length of this schedule: {', '.join(sorted(timed))}"
            raise InputError(f"{where}.sweep: key", shown(key), legal)
        if part.startswith(SPECIES):
            if holder(settings, part) is None:
                legal = f"name one of species: {', '.join(names_of(settings)) or 'there are none'}"
                raise InputError(f"{where}.sweep: key", shown(key), legal)
        elif part not in ("", "schedule", *listed):
            legal = f"begin with an effect of this experiment: {', '.join(sorted(listed))}"
            raise InputError(f"{where}.sweep: key", shown(key), legal)
        if key == "box" and "packing" in settings:
            raise InputError(f"{where}.sweep: key", shown(key), "not be swept beside packing")
        if key == settings_of.CASE:
            continue
        if not part and key not in settings and (key, "box" in settings) != ("packing", True):
            raise InputError(f"{where}.{key}", "(nothing)", "be given, as it is swept")
        numbers_of(f"{where}.sweep.{key}", settings["sweep"][key], level)


def check_ancestors(name: str, known: Mapping[str, Any], source: str) -> None:
    """Refuse a chain of `extends` that breaks or runs in a circle."""
    seen = [name]
    while parent := known[seen[-1]].get("extends"):
        key = f"{source}: experiments.{seen[-1]}.extends"
        settings_of.one_of(key, parent, known)
        if parent in seen:
            raise InputError(key, parent, "be an experiment that does not itself build on this one")
        seen.append(parent)
