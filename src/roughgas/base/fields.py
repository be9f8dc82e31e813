"""Settings as frozen structs, whose annotations hold each field's meaning and legal values.

A struct is read once, from a mapping of YAML, JSON or Python. An illegal value raises one
InputError with its key, the value and the legal values. JSON schemas come from the same
annotations.

`kind` is a class of settings, `field_type` msgspec's description of a field's type
(msgspec.inspect), and `key` the name of a value in messages, such as "effects.spin".
"""

import functools
import sys
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Literal, NamedTuple, TypeVar

import msgspec
import numpy as np
from msgspec import Meta, Struct, inspect

from roughgas.base import InputError, Interval, short_repr, unknown_name_error

LARGEST_NUMBER = sys.float_info.max
"""Largest number in settings: all of them are finite."""
TAG = "kind"
"""Key that selects the struct of a union."""
RawSettings = Mapping[str, Any]
"""Unchecked settings as read from YAML, JSON or Python."""
OwnSettings = Mapping[str, Any]
"""Settings of a study, which its own schema.yaml checks."""
Schema = dict[str, Any]
"""A JSON schema."""
SettingsClasses = Mapping[str, Any]
"""Classes of effects, or of observables, by name; each has the struct of its `settings`."""
NAME = Meta(
    pattern="^[a-z][a-z0-9_]*$(?!\n)",
    description="Lower-case letters, digits and underscores, since it becomes part of a path.",
)
"""Metadata of an `Annotated[str, ...]` that is a name."""


class Settings(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True):
    """Settings of an effect, an observable, ... Subclasses repeat `frozen=True, kw_only=True`."""


class UnknownKeyError(InputError):
    """An unknown key `name` of the settings called `key`, whose value is `content`.

    The error holds `name`, `content` and the list `legal_keys`; its text suggests a similar key.
    """

    def __init__(self, key: str, name: str, content: Any, legal_keys: Iterable[str]) -> None:
        """Store the arguments; without `legal_keys` the text says that there are none."""
        legal_keys = list(legal_keys)
        super().__init__(
            *unknown_name_error(f"{key}: key", short_repr(name), legal_keys or ["(none)"]).args
        )
        self.name, self.content, self.legal_keys = name, content, legal_keys


S = TypeVar("S", bound=Settings)


def number(interval: str, description: str | None = None) -> Meta:
    """Return the metadata of an `Annotated[float, ...]` in an interval such as `(0, 1]`.

    A round bracket excludes the end; `inf` stands for LARGEST_NUMBER. The description is for
    schemas and tables.
    """
    ends = Interval(interval)
    bounds: dict[str, Any] = {"ge" if interval[0] == "[" else "gt": ends.low}
    bounds["lt" if interval[-1] == ")" and ends.high < LARGEST_NUMBER else "le"] = min(
        ends.high, LARGEST_NUMBER
    )
    return Meta(description=description, **bounds)


def whole(lowest: int, highest: int | None, description: str) -> Meta:
    """Return the metadata of an `Annotated[int, ...]` from `lowest` to `highest`, both legal.

    Without `highest` the integer has no upper bound. The description is for schemas and tables.
    """
    return Meta(ge=lowest, le=highest, description=description)


def numbers(min_length: int, max_length: int | None, description: str) -> Meta:
    """Return the metadata of an `Annotated[tuple[..., ...], ...]` with bounds of its length.

    Both bounds are legal; without `max_length` the tuple may be arbitrarily long. The description
    is for schemas and tables.
    """
    return Meta(min_length=min_length, max_length=max_length, description=description)


def described(description: str) -> Meta:
    """Return the metadata of a field whose type needs no bounds: its description alone."""
    return Meta(description=description)


def reference(name: str, description: str | None = None) -> Meta:
    """Return the metadata of an `Annotated[dict[str, Any], ...]` with a separate JSON schema.

    The schema is the definition `name` of the complete schema. The description is for schemas and
    tables.
    """
    return Meta(description=description, extra_json_schema={"$ref": f"#/$defs/{name}"})


def read(kind: type[S], raw: Any, key: str) -> S:
    """Return the mapping `raw` as a struct of class `kind`; a key that is None counts as absent.

    Raises InputError, whose key begins with `key`, the name of the mapping in messages, for the
    first illegal value, unknown key or missing field.
    """
    settings: S = converted(kind, raw, key)
    return settings


def read_each(kinds: SettingsClasses, raw: RawSettings, key: str) -> dict[str, Any]:
    """Return the structs of settings of several effects, or observables, by name.

    `raw` maps their names to mappings of settings, where None counts as empty; `kinds` has all
    classes. Raises InputError, whose key begins with `key`, for a name that is not among the
    `kinds` and for illegal settings.
    """
    for name, settings in raw.items():
        if name not in kinds:
            raise UnknownKeyError(key, name, settings, kinds)
    return {
        name: read(kinds[name].settings, {} if settings is None else settings, f"{key}.{name}")
        for name, settings in raw.items()
    }


def converted(kind: Any, raw: Any, key: str) -> Any:
    """Return `raw` as a value of the type `kind`, any type that annotations of settings may have.

    Raises InputError as `read` does.
    """
    plain = _json_types(raw)
    try:
        return msgspec.convert(plain, kind)
    except msgspec.ValidationError as error:
        raise _refusal(kind, plain, key, str(error)) from None


def _json_types(raw: Any) -> Any:
    """Return nested values as JSON types, without keys that are None and without numpy's types."""
    if isinstance(raw, Mapping):
        return {str(key): _json_types(value) for key, value in raw.items() if value is not None}
    if isinstance(raw, list | tuple):
        return [_json_types(value) for value in raw]
    return raw.item() if isinstance(raw, np.generic) else raw


def _refusal(kind: type[Settings], raw: Any, key: str, message: str) -> InputError:
    """Return the InputError for settings `raw` of class `kind`, which msgspec refuses.

    `message` is msgspec's, `key` the name of the settings in ours.
    """
    message, _, path = message.partition(" - at `$")
    field_type: Any = inspect.type_info(kind)
    for step in _steps(path.rstrip("`")):
        field_type, raw = _inner(field_type, raw, step), raw[step]
        key = nested_key(key, step)
    name = message.split("`")[1] if "`" in message else ""
    if message.startswith("Object contains unknown field"):
        legal_keys = sorted(field.encode_name for field in _struct(field_type, raw).fields)
        return UnknownKeyError(key, name, raw.get(name), legal_keys)
    if message.startswith("Object missing required field"):
        return InputError(nested_key(key, name), "(nothing)", _legal(_inner(field_type, raw, name)))
    return InputError(key, short_repr(raw), _legal(field_type))


def nested_key(key: str, step: str | int) -> str:
    """Return the dotted key of the entry `step` in the mapping, or in the list, called `key`.

    A prefix such as "config.yaml: " or "" takes no dot; an index stands in brackets.
    """
    if isinstance(step, int):
        return f"{key}[{step}]"
    return f"{key}{step}" if not key or key.endswith(": ") else f"{key}.{step}"


def _steps(path: str) -> Iterator[str | int]:
    """Yield the keys and indices in msgspec's path of a value, such as `.stages[2].duration`."""
    for step in path.replace("[", ".[").split(".")[1:]:
        yield int(step[1:-1]) if step.startswith("[") else step


def _options(field_type: Any) -> list[Any]:
    """Return the types in nested unions of msgspec's types, without None and metadata.

    Of a type that is no union, the list holds this type alone.
    """
    if isinstance(field_type, inspect.Metadata):
        return _options(field_type.type)
    members = _members(field_type)
    return (
        members
        if members == [field_type]
        else [option for member in members for option in _options(member)]
    )


def _members(field_type: Any) -> list[Any]:
    """Return the types in a union with their metadata, without None; of another type, itself."""
    types = field_type.types if isinstance(field_type, inspect.UnionType) else [field_type]
    return [member for member in types if not isinstance(member, inspect.NoneType)]


def _struct(field_type: Any, raw: Any) -> inspect.StructType:
    """Return the struct type that describes the mapping `raw`: in a union the struct of its tag.

    Without a known tag it is the first struct of the union.
    """
    structs = [option for option in _options(field_type) if isinstance(option, inspect.StructType)]
    return next((struct for struct in structs if struct.tag == raw.get(TAG)), structs[0])


def _tags(field_type: Any) -> list[str]:
    """Return the tags of the structs in a union; no tags for another type."""
    return [str(option.tag) for option in _options(field_type) if getattr(option, "tag", None)]


def _inner(field_type: Any, raw: Any, step: str | int) -> Any:
    """Return the type of the field `step` of a struct, its tag included, or of a list's entries.

    `raw` is the value of the struct, whose tag selects the struct of a union.
    """
    if step == TAG and (tags := _tags(field_type)):
        return inspect.LiteralType(values=tuple(tags))
    if isinstance(step, str):
        fields = _struct(field_type, raw).fields
        return next(field.type for field in fields if field.encode_name == step)
    return next(option.item_type for option in _options(field_type) if _is_list(option))


def _is_list(field_type: Any) -> bool:
    """Return whether msgspec's type is a list or a tuple of any length."""
    return isinstance(field_type, inspect.VarTupleType | inspect.ListType)


def _legal(field_type: Any) -> str:
    """Return the legal values of msgspec's type as text, to complete a sentence "it must ..."."""
    return " or ".join(map(_legal_option, _options(field_type)))


def _legal_option(option: Any) -> str:
    """Return the legal values of a type that is no union, such as "be true or false"."""
    if isinstance(option, inspect.IntType | inspect.FloatType):
        return _legal_number(option)
    if isinstance(option, inspect.LiteralType):
        words = ", ".join(map(str, option.values))
        return f"be {words}" if len(option.values) == 1 else f"be one of {words}"
    if isinstance(option, inspect.StrType) and option.pattern:
        return "consist of lower-case letters, digits and _, a letter first"
    if isinstance(option, inspect.StrType):
        return "be text that is not empty" if option.min_length else "be text"
    if isinstance(option, inspect.BoolType):
        return "be true or false"
    if _is_list(option):
        return _legal_list(option)
    return "be a mapping of keys to values"


def _legal_number(option: Any) -> str:
    """Return the legal values of an integer or float type, such as "be a number in [0, 1]"."""
    noun = "whole number" if isinstance(option, inspect.IntType) else "number"
    low = option.gt if option.ge is None else option.ge
    high = option.lt if option.le is None else option.le
    if low is None:
        return f"be a {noun}"
    if high is None or high >= LARGEST_NUMBER:
        return f"be a {noun} {'>' if option.ge is None else '>='} {_bound(low)}"
    left, right = "(" if option.ge is None else "[", ")" if option.le is None else "]"
    return f"be a {noun} in {left}{_bound(low)}, {_bound(high)}{right}"


def _bound(value: float) -> str:
    """Return a bound of an interval as text, an integer with all its digits."""
    return str(value) if type(value) is int else f"{value:g}"


def _legal_list(option: Any) -> str:
    """Return the legal lengths of a list type, such as "be a list of at least 2 entries"."""
    min_length, max_length = option.min_length or 0, option.max_length
    if max_length is not None:
        return f"be a list of {min_length} to {max_length} entries"
    if min_length > 1:
        return f"be a list of at least {min_length} entries"
    return "be a list that is not empty" if min_length else "be a list"


@functools.cache
def changes_of(*kinds: type[Settings]) -> type[Settings]:
    """Return a struct class of changes to settings of the classes `kinds`: any field may be absent.

    It has the fields of all `kinds`; if these have tags, also the key `kind` with any of the tags.
    """
    fields: dict[str, Any] = {}
    tags = [str(kind.__struct_config__.tag) for kind in kinds if kind.__struct_config__.tag]
    if tags:
        fields[TAG] = Literal[tuple(tags)]
    for kind in kinds:
        fields |= {field.name: field.type for field in msgspec.structs.fields(kind)}
    changes: type[Settings] = msgspec.defstruct(  # type: ignore[assignment]
        f"ChangesOf{'Or'.join(kind.__name__ for kind in kinds)}",
        [(name, field_type | None, None) for name, field_type in fields.items()],
        bases=(Settings,),
        kw_only=True,
        frozen=True,
    )
    return changes


class Field(NamedTuple):
    """Description of a field of settings, for tables of the documentation."""

    name: str
    legal: str
    """Legal values, such as "be a number in [0, 1]"."""
    default: Any
    """None also for a required field."""
    required: bool
    description: str


def fields_of(kind: type[Settings]) -> list[Field]:
    """Return the descriptions of the fields of a settings class, in order of definition."""
    fields = inspect.type_info(kind).fields  # type: ignore[attr-defined]
    return [
        Field(
            field.encode_name,
            _legal(field.type),
            None if field.required else field.default,
            field.required,
            _description(field.type),
        )
        for field in fields
    ]


def _description(field_type: Any) -> str:
    """Return the description of a field with this type; of a union the first among its types.

    It is "" if there is none.
    """
    if isinstance(field_type, inspect.Metadata):
        description = dict(field_type.extra_json_schema or {}).get("description", "")
        return str(description) or _description(field_type.type)
    options = _members(field_type)
    return "" if options == [field_type] else next(filter(None, map(_description, options)), "")


def has_numbers_and_words(kind: type[Settings]) -> bool:
    """Return whether all fields of a settings class are numbers, enumerated words, or such lists.

    Raises TypeError or AttributeError for types that are illegal in settings.
    """
    fields = inspect.type_info(kind).fields  # type: ignore[attr-defined]
    return all(_is_number_or_word(field.type) for field in fields)


def _is_number_or_word(field_type: Any) -> bool:
    """Return whether a type allows only numbers, enumerated words, and lists of these."""
    plain = inspect.IntType | inspect.FloatType | inspect.LiteralType
    return all(
        _is_number_or_word(option.item_type) if _is_list(option) else isinstance(option, plain)
        for option in _options(field_type)
    )


def schema_of(kind: type[Settings]) -> Schema:
    """Return the JSON schema of changes to settings of the class `kind`: any field may be absent.

    null stands for an absent mapping.
    """
    fields = inspect.type_info(kind).fields  # type: ignore[attr-defined]
    return {
        "type": ["object", "null"],
        "additionalProperties": False,
        "properties": {field.encode_name: _schema(field.type) for field in fields},
    }


def schema_of_kinds(description: str, kinds: SettingsClasses) -> Schema:
    """Return the JSON schema of a mapping from names of `kinds` to changes of their settings.

    The docstring of each class describes its settings; null removes inherited settings.
    """
    properties = {
        name: {"description": kind.__doc__} | schema_of(kind.settings)
        for name, kind in kinds.items()
    }
    closed = {"type": "object", "additionalProperties": False}
    return {"description": description} | closed | {"properties": properties}


def required_by(kind: type[Settings]) -> list[str]:
    """Return the names of the fields of a settings class that have no default."""
    return [field.name for field in fields_of(kind) if field.required]


def _schema(field_type: Any) -> Schema:
    """Return the JSON schema of msgspec's description of a type.

    A type with a reference to a separate schema gives only this reference.
    """
    if isinstance(field_type, inspect.Metadata):
        extra = dict(field_type.extra_json_schema or {})
        return extra if "$ref" in extra else extra | _schema(field_type.type)
    if isinstance(field_type, inspect.UnionType):
        first_option, *further_options = map(_schema, _members(field_type))
        return (
            _with_description_outside([first_option, *further_options])
            if further_options
            else first_option
        )
    if isinstance(field_type, inspect.LiteralType):
        words = list(field_type.values)
        return {"const": words[0]} if len(words) == 1 else {"enum": words}
    if isinstance(field_type, inspect.StructType):
        kind: Any = field_type.cls
        return {"description": docstring_of(kind)} | schema_of(kind)
    if _is_list(field_type):
        size = {"minItems": field_type.min_length, "maxItems": field_type.max_length}
        sizes = {key: length for key, length in size.items() if length is not None}
        return {"type": "array", "items": _schema(field_type.item_type)} | sizes
    if isinstance(field_type, inspect.StrType):
        legal = {"pattern": field_type.pattern, "minLength": field_type.min_length}
        return {"type": "string"} | {key: bound for key, bound in legal.items() if bound}
    if isinstance(field_type, inspect.BoolType):
        return {"type": "boolean"}
    if isinstance(field_type, inspect.DictType):
        return {"type": "object"}
    if isinstance(field_type, inspect.AnyType):
        return {}
    return _schema_of_number(field_type)


def docstring_of(kind: type) -> str:
    """Return the docstring of a class as a single line."""
    return " ".join((kind.__doc__ or "").split())


def _with_description_outside(options: list[Schema]) -> Schema:
    """Return the schema of a union of options, described as its first option is.

    The description is removed from that option, in place.
    """
    description = options[0].pop("description", None)
    return ({"description": description} if description else {}) | {"anyOf": options}


def _schema_of_number(option: Any) -> Schema:
    """Return the JSON schema of an integer or float type; LARGEST_NUMBER is no bound in it."""
    bounds = {
        "minimum": option.ge,
        "exclusiveMinimum": option.gt,
        "maximum": option.le,
        "exclusiveMaximum": option.lt,
    }
    kind = "integer" if isinstance(option, inspect.IntType) else "number"
    ends = {key: _integer_if_exact(end) for key, end in bounds.items() if end is not None}
    return {"type": kind} | {key: end for key, end in ends.items() if end != LARGEST_NUMBER}


def _integer_if_exact(end: float) -> int | float:
    """Return a whole bound as an integer, so that the schema reads 1 and not 1.0."""
    return int(end) if end == int(end) and abs(end) < LARGEST_NUMBER else end
