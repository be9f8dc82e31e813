"""Reads YAML as a person means it: 1e-5 is a number, and a key that is given twice is a mistake."""

import re
from pathlib import Path
from typing import Any

import yaml

from roughgas.base.errors import InputError

# YAML 1.1 reads 1e-5 as text, since it has no decimal point
SCIENTIFIC = re.compile(r"[-+]?[0-9]+(\.[0-9]*)?[eE][-+]?[0-9]+")


class Loader(yaml.SafeLoader):
    """PyYAML's safe loader, with the two differences named above."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """Return a mapping; raise InputError where a key is given twice."""
        seen = set()
        for key in (key for key, _ in node.value if isinstance(key, yaml.ScalarNode)):
            if key.value in seen:
                raise InputError(_place(key.start_mark), repr(key.value), "be given once")
            seen.add(key.value)
        return super().construct_mapping(node, deep)


Loader.add_implicit_resolver("tag:yaml.org,2002:float", SCIENTIFIC, list("-+0123456789"))


def read_yaml(path: str | Path) -> Any:
    """Return what the YAML file at `path` holds.

    Raises InputError where it is not YAML, OSError where it cannot be read.
    """
    name = Path(path).name
    try:
        text = Path(path).read_text(encoding="utf-8")
        loader = Loader(text)
    except FileNotFoundError as error:
        hint = f"{error.strerror}; go to the project's folder, where config.yaml is"
        raise FileNotFoundError(error.errno, hint, str(path)) from error
    except (UnicodeDecodeError, yaml.reader.ReaderError) as error:
        raise InputError(name, "(not text)", "be YAML in UTF-8") from error
    loader.name = name
    try:
        return loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = "".join(text.splitlines()[mark.line : mark.line + 1])
        legal = f"be YAML: {error.problem}"
        if r"'\t'" in error.problem:
            legal = "be indented with spaces, not with a tab"
        raise InputError(_place(mark), repr(line), legal) from error
    finally:
        loader.dispose()


def _place(mark: yaml.Mark) -> str:
    return f"{mark.name}: line {mark.line + 1}"
