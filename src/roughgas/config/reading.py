"""Reads YAML 1.2 with ruamel.yaml, which refuses keys and anchors that are given twice and tags.

What it lacks is here: limits of size, of depth, and of aliases written out; keys are text.
"""

import warnings
from io import StringIO
from pathlib import Path
from typing import Any, NoReturn

from ruamel.yaml import YAML
from ruamel.yaml.constructor import DuplicateKeyError, SafeConstructor
from ruamel.yaml.error import MarkedYAMLError, ReusedAnchorWarning, YAMLError

from roughgas.base import LONGEST, InputError, shown

LARGEST = 1_000_000  # bytes
DEEPEST = 40
MOST = 100_000  # values, with aliases written out


class Constructor(SafeConstructor):
    """The library's safe constructor; dates are text."""


Constructor.add_constructor("tag:yaml.org,2002:timestamp", SafeConstructor.construct_yaml_str)


def read_yaml(path: str | Path, name: str = "") -> Any:
    """Return what the YAML file at `path` holds; messages call it `name`, by default its own.

    Raises InputError where it is not YAML or not allowed (see above), OSError where it cannot be
    read.
    """
    name = name or Path(path).name
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
    yaml = YAML(typ="safe", pure=True)
    yaml.Constructor, yaml.version = Constructor, (1, 2)
    try:
        with warnings.catch_warnings(action="error", category=ReusedAnchorWarning):
            found = yaml.load(StringIO(text))
        _check(found, name)
    except DuplicateKeyError as error:
        _refuse(name, error.problem_mark, repr(error.problem.split('"')[1]), "be given once")
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = "".join(text.splitlines()[mark.line : mark.line + 1])
        tab = r"'\t'" in error.problem
        legal = "be indented with spaces, not with a tab" if tab else f"be YAML: {error.problem}"
        _refuse(name, mark, repr(line[:LONGEST]), legal)
    except YAMLError as error:
        raise InputError(name, "(not text)", "be YAML in UTF-8") from error
    except (ValueError, LookupError, TypeError, AttributeError, ReusedAnchorWarning) as error:
        # as of the number 0o9, and of `!!bool 3`
        if isinstance(error, InputError):
            raise
        raise InputError(name, "(not YAML)", f"be YAML: {' '.join(str(error).split())}") from error
    except RecursionError as error:
        raise InputError(name, "brackets", f"be nested {DEEPEST} deep at most") from error
    return found


def _check(found: Any, name: str) -> None:
    """Raise InputError for keys that are no text, and for values nested too deeply or too many."""
    todo, count = [(found, 1)], 0
    while todo:
        value, depth = todo.pop()
        if depth > DEEPEST:
            raise InputError(name, "brackets", f"be nested {DEEPEST} deep at most")
        if not isinstance(value, dict | list):
            continue
        for key in value if isinstance(value, dict) else ():
            if not isinstance(key, str):
                raise InputError(name, f"key {shown(key)}", "be text: write it in quotes")
        inner = value.values() if isinstance(value, dict) else value
        todo += ((one, depth + 1) for one in inner)
        if (count := count + len(value)) > MOST:
            raise InputError(name, f"{count} values", f"be {MOST} at most")


def _refuse(name: str, mark: Any, value: str, legal: str) -> NoReturn:
    raise InputError(f"{name}: line {mark.line + 1}", value, legal)
