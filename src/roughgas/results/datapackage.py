"""What programs need to know of CSV tables, beside them: a tabular data package (Frictionless)."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from roughgas.base.files import write_text
from roughgas.base.layout import as_json

NO_NAME = re.compile(r"[^a-z0-9._-]+")
PROFILE = "tabular-data-"
Field = Mapping[str, str]
"""Of a column `name` and `type`, and where they are known `title` and `unit`."""


def write_package(output: Path, title: str, tables: Iterable[tuple[Path, list[Field]]]) -> Path:
    """Write bed.datapackage.json for `output`, bed.csv, and for tables beside it; return its path.

    Raises OSError if it cannot be written.
    """
    path = output.with_name(f"{output.stem}.datapackage.json")
    resources = [_resource(file, fields) for file, fields in tables]
    about = {"name": _name(output), "title": title, "profile": f"{PROFILE}package"}
    write_text(path, f"{as_json(about | {'resources': resources})}\n")
    return path


def field(name: str, kind: str, title: str = "", unit: str = "") -> Field:
    """Return a column; `kind` is that of numpy: i, u, f, U, O, or another where it is mixed."""
    known = {"i": "integer", "u": "integer", "f": "number", "U": "string", "O": "string"}
    told = {"title": title, "unit": unit}
    about = {key: text for key, text in told.items() if text}
    return {"name": name, "type": known.get(kind, "any")} | about


def _resource(file: Path, fields: list[Field]) -> dict[str, Any]:
    return {
        "name": _name(file),
        "path": file.name,
        "profile": f"{PROFILE}resource",
        "format": "csv",
        "encoding": "utf-8",
        "schema": {"fields": fields, "missingValues": [""]},
    }


def _name(file: Path) -> str:
    return NO_NAME.sub("-", file.stem.lower())
