"""JSON schemas: of configurations, made of the structs of settings, and of claims and tasks.

Experiments are checked by structs (roughgas.config.forms), files without structs by schemas:
claims.yaml, and the settings of a study's tasks, by the study's schema.yaml. Editors and the tables
of the documentation use the schema of configurations. Errors of jsonschema are turned into one
InputError in plain words. An instance is the value that a schema checks.
"""

import functools
import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.base import RESTITUTION, ROUGHNESS, InputError, short_repr, unknown_name_error
from roughgas.base.fields import (
    NAME,
    TAG,
    OwnSettings,
    Schema,
    Settings,
    changes_of,
    docstring_of,
    nested_key,
    schema_of,
)
from roughgas.base.labels import LEGAL_LEVEL, level, restitution, roughness
from roughgas.base.reading import read_yaml
from roughgas.config.packaged import STUDIES_FOLDER, STUDIES_OF_ACCURACY, shipped_path

if TYPE_CHECKING:
    from jsonschema import Draft202012Validator, ValidationError

DIALECT = "https://json-schema.org/draft/2020-12/schema"
FORMATS = {
    "restitution": (restitution, RESTITUTION.legal),
    "roughness": (roughness, ROUGHNESS.legal),
    "level": (level, LEGAL_LEVEL),
}
"""Parser and legal values of each format in the schemas."""


# ---------------------------------------------------------------------- the schema


def schema() -> Schema:
    """Return the JSON schema of a configuration; `$defs` defines nested mappings."""
    from roughgas import effects, observables

    return _schema_of(tuple(effects.EFFECTS.items()), tuple(observables.OBSERVABLES.items()))


@functools.cache
def _schema_of(*_kinds: Any) -> Schema:
    """Return the schema of a configuration, cached by the effects and observables registered."""
    from roughgas.config.forms import ConfigurationForm

    form = schema_of(ConfigurationForm) | {"type": "object", "required": ["experiments"]}
    head = {
        "$schema": DIALECT,
        "title": "Configuration of roughgas",
        "description": ConfigurationForm.__doc__,
    }
    return head | form | {"$defs": _definitions()}


def text() -> str:
    """Return the schema of a configuration as JSON, the content of config.schema.json."""
    return json.dumps(schema(), indent=1) + "\n"


def _definitions() -> dict[str, Schema]:
    """Return the definitions for nested mappings in the schema of a configuration, by name."""
    from roughgas import effects, observables
    from roughgas.config import forms, shaken_layer
    from roughgas.simulation.stages import StageSettings

    name = {"type": "string", "pattern": NAME.pattern, "description": NAME.description}
    case = {"description": "The changes in this case.", "$ref": "#/$defs/case"}
    sweep = schema_of(forms.SweepForm)
    sweep["properties"]["case"] |= {"additionalProperties": case, "type": ["object", "null"]}
    axes: Schema = {}
    for (pattern, description), title in zip(
        PATTERNS_OF_AXES.items(), forms.TITLES_OF_AXES, strict=True
    ):
        labels = sweep["properties"]["packing"]
        axes[pattern] = labels | {"title": title, "description": description}
    named: dict[str, type[Settings]] = {
        "experiment": forms.ExperimentForm,
        "change": forms.ChangeForm,
        "case": forms.CaseForm,
        "layer": shaken_layer.LayerSettings,
        "stage": StageSettings,
    }
    definitions: dict[str, Schema] = {
        key: {"description": docstring_of(kind)} | schema_of(kind) for key, kind in named.items()
    }
    experiment = definitions["experiment"]["properties"]
    definitions["experiment"]["properties"] = {"extends": experiment["extends"], **experiment}
    definitions |= {
        "name": name,
        "sweep": {"description": docstring_of(forms.SweepForm)}
        | sweep
        | {"patternProperties": axes},
        "schedule": _schedule(),
        "effects": effects.schema(),
        "observables": observables.schema(),
        "experiments": _mapping_of(
            "experiment",
            "The experiments by name, before changes of a scale; STUDY.EXPERIMENT changes an "
            "experiment of a study.",
        ),
        "scales": _mapping_of(
            "changes",
            "Changes to experiments at each scale; by default there is a single scale, without "
            "changes.",
        ),
        "changes": _mapping_of("change", "Changes by the name of the experiment.")
        | {"properties": {"accuracy": {"$ref": "#/$defs/accuracy"}}}
        | {"patternProperties": {"[.]tasks$": {"type": "object"}}},
    }
    definitions |= read_yaml(Path(__file__).with_name("json_schema.yaml"))["$defs"]
    return definitions | _definitions_of_accuracy()


def _definitions_of_accuracy() -> dict[str, Schema]:
    """Return the definition `accuracy` of legal changes in a configuration, and all it refers to.

    Any setting of the tasks of the studies of accuracy may be absent.
    """
    definitions: dict[str, Schema] = {}
    modules: Schema = {}
    for name in STUDIES_OF_ACCURACY:
        path = shipped_path(STUDIES_FOLDER) / name / "schema.yaml"
        if path.exists():  # absent in a package without studies
            of_study = read_yaml(path)
            definitions |= of_study["$defs"]
            modules |= {
                module: {"$ref": settings["$ref"]}
                for module, settings in of_study["properties"].items()
            }
    description = "Changes to the settings of the studies `accuracy` and `coverage`."
    accuracy = {"description": description, "type": "object", "additionalProperties": False}
    return {"accuracy": {**accuracy, "properties": modules}} | definitions


PATTERNS_OF_AXES = {
    "^species[.][a-z0-9_]+[.][a-z][a-z0-9_]*$": (
        "A third axis. Values of one quantity of the species of that name (or index), such as "
        "species.heavy.mass; of spread radii also their mean and deviation."
    ),
    "^[a-z][a-z0-9_]*[.][a-z][a-z0-9_]*$": (
        "A third axis. Values of one parameter of one effect that the experiment lists, such as "
        "spin.inertia, or of one length of its schedule, such as schedule.equilibrate; numbers, in "
        "paths of the same form as r, or words. A sweep has one third axis at most; null removes "
        "an inherited one. Each value makes a variant of the experiment."
    ),
}
"""Descriptions of third axes with a dot, by the pattern of the key."""


def _mapping_of(definition: str, description: str) -> Schema:
    """Return the schema of a mapping of any names to values of the schema `definition`."""
    contents: Schema = {"additionalProperties": {"$ref": f"#/$defs/{definition}"}}
    return {"description": description, "type": "object"} | contents


def _schedule() -> Schema:
    """Return the schema of a schedule of any kind; descriptions name the kinds of a key."""
    from roughgas.simulation.protocols import PROTOCOLS

    kinds = {name: kind.SETTINGS for name, kind in PROTOCOLS.items()}
    fields = schema_of(changes_of(*kinds.values())) | {"type": "object"}
    properties = fields["properties"]
    for key, content in properties.items():
        users = [name for name, kind in kinds.items() if key in kind.__struct_fields__]
        if users and len(users) < len(kinds):
            content["description"] = f"({', '.join(users)}) {content['description']}"
    properties[TAG]["description"] = (
        "A driven gas in a steady state (steady), a freely cooling gas (cooling), or a gas, driven "
        "or not, whose settings change from stage to stage (stages)."
    )
    if "stages" in properties:
        properties["stages"]["items"] = {"$ref": "#/$defs/stage"}
    description = "How long to simulate and measure; the keys depend on the kind."
    return {"description": description} | fields


# ---------------------------------------------------------------------- checks


def check_schema(instance: Any, source: str, definition: str) -> None:
    """Raise InputError for the first value of `instance` that violates the schema `definition`.

    `definition` is a name in `$defs` of the schema of configurations. `source`, such as
    "studies/NAME/claims.yaml", precedes the key.
    """
    separator = ": " if source.endswith(".yaml") else "."
    _refuse(_validator(definition), instance, source, separator)


def check_by(schema_of_study: Any, instances: Mapping[str, OwnSettings], name: str) -> None:
    """Raise InputError for the first value of `instances` that violates a study's JSON schema.

    `instances` have their sources as keys, which precede the key of the value; messages call the
    schema `name`. It may refer to definitions of the schema of configurations. Raises InputError
    also for a schema that is none.
    """
    from jsonschema import Draft202012Validator, SchemaError
    from referencing.exceptions import Unresolvable

    legal = "be a JSON schema, with references to $defs of its own or of config.yaml's schema"
    try:
        Draft202012Validator.check_schema(schema_of_study)
        definitions = schema()["$defs"] | schema_of_study.get("$defs", {})
        validator = _validator_of({**schema_of_study, "$defs": definitions})
        for source, instance in instances.items():
            _refuse(validator, instance, source, ".")
    except (SchemaError, Unresolvable, TypeError) as error:
        raise InputError(name, str(error).partition("\n")[0], legal) from error


def _refuse(validator: "Draft202012Validator", instance: Any, source: str, separator: str) -> None:
    """Raise InputError for the first value of `instance` that the validator rejects.

    `source` and `separator` precede the key of the value. The first is in reading order.
    """
    errors = list(validator.iter_errors(instance))
    if errors:
        first = min(errors, key=lambda error: _position(error.absolute_path, instance))
        raise _input_error(first, source, separator)


@functools.cache
def _validator(definition: str) -> "Draft202012Validator":
    """Return the validator, which is cached, of a definition in the schema of configurations."""
    definitions = schema()["$defs"]
    return _validator_of({"$ref": f"#/$defs/{definition}", "$defs": definitions})


def _validator_of(complete_schema: Schema) -> "Draft202012Validator":
    """Return a validator of a schema, with the FORMATS, and with finite numbers only."""
    # imported here, since most commands do not need it
    from jsonschema import Draft202012Validator, FormatChecker
    from jsonschema.validators import extend

    formats = FormatChecker(formats=())
    for name, (value_of, _) in FORMATS.items():
        formats.checks(name, raises=InputError)(lambda label, f=value_of: f(label) is not None)
    types = Draft202012Validator.TYPE_CHECKER.redefine("number", _is_finite)
    types = types.redefine("integer", lambda _, value: type(value) is int)
    kind: Any = extend(Draft202012Validator, type_checker=types)  # type: ignore[no-untyped-call]
    validator: Draft202012Validator = kind(complete_schema, format_checker=formats)
    return validator


def _is_finite(_checker: Any, value: Any) -> bool:
    """Return whether a value is a number of JSON; the validator passes itself as first argument."""
    return isinstance(value, int | float) and type(value) is not bool and math.isfinite(value)


def _position(path: Iterable[Any], instance: Any) -> list[int]:
    """Return the indices, within their mappings and lists, of the keys in a path into `instance`.

    They sort errors in the reading order of the file.
    """
    position = []
    for step in path:
        position.append(list(instance).index(step) if isinstance(instance, Mapping) else step)
        instance = instance[step]
    return position


def _input_error(error: "ValidationError", source: str, separator: str) -> InputError:
    """Return jsonschema's error as an InputError; `source` and `separator` precede the key."""
    refused: Any = error.schema
    instance: Any = error.instance
    violated: Any = error.validator_value
    path = ""
    for step in error.absolute_path:  # such as cooling.sweep.r[1]
        path = nested_key(path, step)
    key = f"{source}{separator}{path}" if path else source
    if "propertyNames" in error.absolute_schema_path:
        return InputError(f"{key}: key", short_repr(instance), legal_values(refused))
    if error.validator == "additionalProperties":
        unknown = next(name for name in instance if name not in refused["properties"])
        return unknown_name_error(f"{key}: key", short_repr(unknown), sorted(refused["properties"]))
    if error.validator == "required":
        missing = next(name for name in violated if name not in instance)
        return InputError(f"{key}.{missing}", "(nothing)", "be given")
    return InputError(key, short_repr(instance), legal_values(refused))


# ---------------------------------------------------------------------- words


def legal_values(schema_of_value: Schema) -> str:
    """Return the legal values of a schema as text, to complete a sentence "it must ..."."""
    words = (
        describe(schema_of_value) for key, describe in DESCRIBERS.items() if key in schema_of_value
    )
    return next(words, "be what its schema says")


def _legal_type(schema_of_value: Schema) -> str:
    """Return the legal values of a schema with the keyword `type`, such as "be a number > 0"."""
    kind = schema_of_value["type"]
    kind = kind if isinstance(kind, str) else kind[0]
    if kind in LEGAL_TYPES:
        return LEGAL_TYPES[kind]
    if kind == "array":
        min_items, max_items = schema_of_value.get("minItems", 0), schema_of_value.get("maxItems")
        if max_items:
            return f"be a list of {min_items} to {max_items} entries"
        return (
            "be a list that is not empty"
            if min_items == 1
            else f"be a list of at least {min_items} entries"
        )
    noun = "a whole number" if kind == "integer" else "a number"
    closed = "minimum" in schema_of_value
    low = schema_of_value.get("minimum", schema_of_value.get("exclusiveMinimum"))
    if low is None:
        return f"be {noun}"
    if "maximum" in schema_of_value:
        return f"be {noun} in {'[' if closed else '('}{low}, {schema_of_value['maximum']}]"
    return f"be {noun} {'>=' if closed else '>'} {low}"


LEGAL_TYPES = {
    "string": "be text",
    "object": "be a mapping of keys to values",
    "boolean": "be true or false",
}
DESCRIBERS = {
    "anyOf": lambda schema: " or ".join(map(legal_values, schema["anyOf"])),
    "const": lambda schema: f"be {schema['const']}",
    "enum": lambda schema: (
        f"be one of {', '.join(schema['enum'])}" if schema["enum"] else "not be given here"
    ),
    "format": lambda schema: FORMATS[schema["format"]][1],
    "minLength": lambda _: "be text that is not empty",
    "pattern": lambda _: "consist of lower-case letters, digits and _, a letter first",
    "type": _legal_type,
}
"""Describes legal values by a keyword of their schema; of several the first here is used."""
