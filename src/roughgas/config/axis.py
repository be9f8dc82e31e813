"""What a third axis changes: a quantity of a species, under species.NAME.KEY, or a box."""

from collections.abc import Iterable, Mapping
from typing import Any

SPECIES = "species."
OF_RADII = "mean", "deviation"
"""Keys of a distribution of radii."""


def species_called(settings: Mapping[str, Any], part: str) -> dict[str, Any] | None:
    """Return the species that `part`, such as species.heavy, names by name or by index; or None."""
    named = dict(zip(names_of(settings), settings.get("species") or [], strict=True))
    return named.get(part.removeprefix(SPECIES))


def names_of(settings: Mapping[str, Any]) -> list[str]:
    """Return what the species are called: by their index where they have no name."""
    return [str(one.get("name", k)) for k, one in enumerate(settings.get("species") or [])]


def changed(species: Iterable[Mapping[str, Any]], part: str, key: str, value: Any) -> list[Any]:
    """Return a list of species in which one quantity of one of them has another value."""
    changed = [dict(one) for one in species]
    mine = species_called({"species": changed}, part)
    if mine is not None:
        if isinstance(mine.get("radius"), Mapping):
            mine["radius"] = dict(mine["radius"])
        _holder(mine, key)[key] = value
    return changed


def _holder(one: dict[str, Any], key: str) -> dict[str, Any]:
    """Return what of a species has this key: its distribution of radii, or itself."""
    radius = one.get("radius")
    return radius if key in OF_RADII and isinstance(radius, dict) else one


def value_of(settings: Mapping[str, Any], part: str, key: str) -> Any:
    """Return what the settings of a variant have under this key of this species; or None."""
    one = species_called(settings, part)
    return None if one is None else _holder(one, key).get(key)


def scaled(box: Iterable[float | str], width: Any) -> Any:
    """Return a box of another width and of the same proportions; no width: what was given."""
    if isinstance(width, str):
        return width
    sides = list(box)
    return [width, *(x if x == "open" else x * width / sides[0] for x in sides[1:])]
