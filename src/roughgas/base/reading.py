"""Reads YAML 1.2 with ruamel.yaml, which refuses tags and repeated keys and anchors.

Added here are limits of size, of depth and of expanded aliases, and the check that keys are text.
"""

import warnings
from io import StringIO
from pathlib import Path
from typing import Any, NoReturn

from ruamel.yaml import YAML
from ruamel.yaml.constructor import DuplicateKeyError, SafeConstructor
from ruamel.yaml.error import MarkedYAMLError, ReusedAnchorWarning, YAMLError

from roughgas.base import MAX_QUOTED_LENGTH, InputError, short_repr
from roughgas.base.files import content_of

MAX_DEPTH = 40  # of nested brackets
MAX_VALUES = 100_000  # with aliases expanded


class Constructor(SafeConstructor):
    """The constructor of values of the YAML library that runs no code; dates stay text."""


Constructor.add_constructor("tag:yaml.org,2002:timestamp", SafeConstructor.construct_yaml_str)


def read_yaml(path: str | Path, name: str = "", *, pipes: bool = True) -> Any:
    """Return the content of the YAML file at `path`; messages call it `name`, by default its own.

    `pipes` allows a pipe, as for a path from the user, but not for files found in folders. Raises
    InputError for other formats and for content beyond the limits above, OSError where the file
    cannot be read.
    """
    name = name or Path(path).name
    try:
        text = content_of(path, name, pipes=pipes).decode("utf-8")
    except FileNotFoundError as error:
        hint = f"{error.strerror}; without --config there is the one that comes with roughgas"
        raise FileNotFoundError(error.errno, hint, str(path)) from error
    except UnicodeDecodeError as error:
        raise InputError(name, "(not text)", "be YAML in UTF-8") from error
    return parse_yaml(text, name)


def parse_yaml(text: str, name: str) -> Any:
    """Return the content of YAML `text`; raise InputError as `read_yaml`, which names `name`."""
    yaml = YAML(typ="safe", pure=True)
    yaml.Constructor, yaml.version = Constructor, (1, 2)
    try:
        with warnings.catch_warnings(action="error", category=ReusedAnchorWarning):
            content = yaml.load(StringIO(text))
        _check(content, name)
    except DuplicateKeyError as error:
        _refuse(name, error.problem_mark, repr(error.problem.split('"')[1]), "be given once")
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = "".join(text.splitlines()[mark.line : mark.line + 1])
        tab = r"'\t'" in error.problem
        legal = "be indented with spaces, not with a tab" if tab else f"be YAML: {error.problem}"
        _refuse(name, mark, repr(line[:MAX_QUOTED_LENGTH]), legal)
    except YAMLError as error:
        raise InputError(name, "(not text)", "be YAML in UTF-8") from error
    except (ValueError, LookupError, TypeError, AttributeError, ReusedAnchorWarning) as error:
        # as of the number 0o9, and of `!!bool 3`
        if isinstance(error, InputError):
            raise
        raise InputError(name, "(not YAML)", f"be YAML: {' '.join(str(error).split())}") from error
    except RecursionError as error:
        raise InputError(name, "brackets", f"be nested {MAX_DEPTH} deep at most") from error
    return content


def _check(content: Any, name: str) -> None:
    """Raise InputError for YAML content beyond the limits of depth and size.

    Keys other than text are refused, too. `name` is the name of the content in messages.
    """
    remaining, count = [(content, 1)], 0
    while remaining:
        value, depth = remaining.pop()
        if depth > MAX_DEPTH:
            raise InputError(name, "brackets", f"be nested {MAX_DEPTH} deep at most")
        if not isinstance(value, dict | list):
            continue
        for key in value if isinstance(value, dict) else ():
            if not isinstance(key, str):
                raise InputError(name, f"key {short_repr(key)}", "be text: write it in quotes")
        inner = value.values() if isinstance(value, dict) else value
        remaining += ((nested, depth + 1) for nested in inner)
        if (count := count + len(value)) > MAX_VALUES:
            raise InputError(name, f"{count} values", f"be {MAX_VALUES} at most")


def _refuse(name: str, mark: Any, value: str, legal: str) -> NoReturn:
    """Raise InputError for a `value` in the YAML called `name`; `mark` has its line, from 0."""
    raise InputError(f"{name}: line {mark.line + 1}", value, legal)
