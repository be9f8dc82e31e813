"""Reads YAML 1.2 with ruamel.yaml, and refuses what can only be a mistake or an attack.

A key that is given twice, keys that are no text, explicit tags, and files that are large, deeply
nested, or would be once their aliases are written out.
"""

import functools
from collections.abc import Iterable, Iterator
from io import StringIO
from pathlib import Path
from typing import Any, NoReturn

from ruamel.yaml import YAML
from ruamel.yaml.constructor import DuplicateKeyError, SafeConstructor
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    Event,
    NodeEvent,
)
from ruamel.yaml.parser import Parser

from roughgas.base.errors import LONGEST, InputError, shown

LARGEST = 1_000_000  # bytes
DEEPEST = 40
MOST = 100_000  # values, with aliases written out


class Constructor(SafeConstructor):
    """The library's safe constructor, whose errors say where they are. Dates are text."""

    def construct_object(self, node: Any, deep: bool = False) -> Any:
        """Return what a node stands for; raise InputError where it stands for nothing."""
        try:
            return super().construct_object(node, deep)
        except ValueError as error:
            if isinstance(error, InputError):
                raise
            _refuse(node.start_mark, shown(node.value), "be a number that can be read")

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:
        """Return a mapping; raise InputError for a key that is no text."""
        found = super().construct_mapping(node, deep)
        for key in found:
            if not isinstance(key, str):
                _refuse(node.start_mark, f"key {shown(key)}", "be text: write it in quotes")
        return found


Constructor.add_constructor("tag:yaml.org,2002:timestamp", SafeConstructor.construct_yaml_str)


def read_yaml(path: str | Path) -> Any:
    """Return what the YAML file at `path` holds.

    Raises InputError where it is not YAML or not allowed (see above), OSError where it cannot be
    read.
    """
    name = Path(path).name
    try:
        content = Path(path).read_bytes()
        if len(content) > LARGEST:
            raise InputError(name, f"{len(content)} bytes", f"be of {LARGEST} at most")
        text = content.decode("utf-8")
    except FileNotFoundError as error:
        hint = f"{error.strerror}; without --config there is the one that comes with roughgas"
        raise FileNotFoundError(error.errno, hint, str(path)) from error
    except UnicodeDecodeError as error:
        raise InputError(name, "(not text)", "be YAML in UTF-8") from error
    return parse_yaml(text, name)


def parse_yaml(text: str, name: str) -> Any:
    """Return what YAML holds that messages call `name`; raise InputError as `read_yaml`."""
    try:
        events = list(_checked(_reader().parse(_named(text, name))))
        return _reader(events).load(_named(text, name))
    except DuplicateKeyError as error:
        _refuse(error.problem_mark, repr(error.problem.split('"')[1]), "be given once")
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = "".join(text.splitlines()[mark.line : mark.line + 1])
        tab = r"'\t'" in error.problem
        legal = "be indented with spaces, not with a tab" if tab else f"be YAML: {error.problem}"
        _refuse(mark, repr(line[:LONGEST]), legal)
    except YAMLError as error:
        raise InputError(name, "(not text)", "be YAML in UTF-8") from error


class Parsed(Parser):
    """The library's parser of a text that has been parsed before, which takes long."""

    def __init__(self, events: Iterable[Event], loader: YAML) -> None:
        self._events = iter(events)
        super().__init__(loader)

    def reset_parser(self) -> None:
        """Begin with the next event."""
        self.current_event, self.state = None, lambda: next(self._events, None)


def _reader(events: Iterable[Event] | None = None) -> YAML:
    """Return a reader of any text, or of that which has been parsed to `events`."""
    yaml = YAML(typ="safe", pure=True)
    yaml.Constructor = Constructor
    if events is not None:
        yaml.Parser = functools.partial(Parsed, events)
    return yaml


def _named(text: str, name: str) -> StringIO:
    """Return the text as a file whose name is that of its marks."""
    stream = StringIO(text)
    stream.name = name
    return stream


def _checked(events: Iterable[Event]) -> Iterator[Event]:
    """Generate the events, and refuse tags, versions, and values nested too deeply or too many
    with aliases written out."""
    sizes: dict[str, int] = {}
    opened: list[tuple[str | None, int]] = []  # anchors of the collections, and values before them
    anchors: set[str] = set()
    values = 0
    for event in events:
        mark = event.start_mark
        if getattr(event, "tag", None) is not None:
            _refuse(mark, getattr(event, "tag", ""), "have no tag")
        if getattr(event, "version", None):
            _refuse(mark, "%YAML", "not be there: this is YAML 1.2")
        if isinstance(event, CollectionEndEvent):
            anchor, before = opened.pop()
            sizes[anchor or ""] = values - before
        elif isinstance(event, NodeEvent):
            if not isinstance(event, AliasEvent) and event.anchor in anchors:
                _refuse(mark, f"&{event.anchor}", "be given once")
            anchors |= {event.anchor} - {None}
            if isinstance(event, AliasEvent) and event.anchor in (anchor for anchor, _ in opened):
                _refuse(mark, f"*{event.anchor}", "be no part of itself")
            values += sizes.get(event.anchor or "", 1) if isinstance(event, AliasEvent) else 1
        if isinstance(event, CollectionStartEvent):
            opened.append((event.anchor, values))
        if len(opened) > DEEPEST:
            _refuse(mark, "brackets", f"be nested {DEEPEST} deep at most")
        if values > MOST:
            _refuse(mark, f"{values} values", f"be {MOST} at most")
        yield event


def _refuse(mark: Any, value: str, legal: str) -> NoReturn:
    raise InputError(f"{mark.name}: line {mark.line + 1}", value, legal)
