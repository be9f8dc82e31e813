"""What every dataset of the pipeline says of itself, in the terms of the CF conventions.

UDUNITS, whose units CF asks for, reads T as tesla and a as a year. A quantity in a gas's own units
has no dimension there: its `units` are 1, and `reduced_units` says what it is a multiple of.
"""

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.version import __version__

SCHEMA_VERSION = 2
COMMON_ATTRIBUTES = {
    "Conventions": "CF-1.11",
    "schema_version": SCHEMA_VERSION,
    "source": f"roughgas {__version__}, event-driven simulation of rough, inelastic particles",
    "history": f"written by roughgas {__version__}; undated: the same run gives the same bytes",
    "references": "S. McNamara and S. Luding, Phys. Rev. E 58, 2247 (1998), "
    "doi:10.1103/PhysRevE.58.2247",
    "comment": "Particle radius a = particle mass m = time unit T = 1; reduced_units of a variable "
    "are in terms of these, of collisions per particle, or of an energy at the start.",
}
UDUNITS = ("1", "s", "1/s")
QUALITIES = ("stderr", "dof", "ci95", "ci95_trusted")
"""Variables <name>_stderr, ... say how sure <name> is: they are its ancillary variables."""


def unit_attributes(unit: str) -> dict[str, str]:
    """Return the attributes that tell a unit, such as "T", "1" or "s/T"; none for "", of words.

    CPU time in terms of a gas's own units is in seconds.
    """
    if not unit:
        return {}
    if unit in UDUNITS:
        return {"units": unit}
    return {"units": "s" if unit.startswith("s/") else "1", "reduced_units": unit}


def unit_of(attributes: Mapping[str, str]) -> str:
    """Return the unit that `unit_attributes` tell; "" for words."""
    return attributes.get("reduced_units", attributes.get("units", ""))


def ancillary(name: str, names: Collection[str]) -> dict[str, str]:
    """Return the attribute that lists those of `names` that say how sure the variable `name` is."""
    found = [f"{name}_{quality}" for quality in QUALITIES if f"{name}_{quality}" in names]
    return {"ancillary_variables": " ".join(found)} if found else {}


def check_schema(attributes: Mapping[str, Any], path: str | Path) -> None:
    """Raise InputError if the file at `path`, which has these global attributes, is of a newer
    schema than this program knows. Files of older ones are read."""
    version = attributes.get("schema_version", SCHEMA_VERSION)
    if version > SCHEMA_VERSION:
        legal = f"be at most {SCHEMA_VERSION}: a newer roughgas has written the file"
        raise InputError(f"schema_version of {path}", version, legal)
