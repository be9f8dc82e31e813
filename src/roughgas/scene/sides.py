"""The walls of a scene: which go together, and what they mean for its gas."""

from roughgas.base import InputError, NeedsError
from roughgas.effects import Effects
from roughgas.kernel import hooks

OPPOSITE = (("left_wall", "right_wall"), ("front_wall", "back_wall"), ("bottom_wall", "lid"))
PAIRS = ("walls", "shaken_walls")
"""What closes both ends of the first axis at once."""


def check_sides(effects: Effects) -> None:
    """Raise InputError for a side that is closed twice, or an axis that is closed at one end only,
    and for walls where images slide."""
    sheared = {"left_wall": 0, "right_wall": 0, "front_wall": 1, "back_wall": 1}
    for name in (*PAIRS, *sheared, "bottom_wall", "lid"):
        wall = getattr(effects, name)
        if wall is None:
            continue
        if effects.shear is not None and getattr(wall, "axis", 0) < 2:
            legal = "not close the axis that is sheared along"
            if getattr(wall, "axis", 0) == 1:
                legal = "not close the axis along which images slide past each other"
            raise InputError("effects", f"{name} and shear", legal)
        for pair in PAIRS:
            if name not in PAIRS and wall.axis == 0 and getattr(effects, pair) is not None:
                raise InputError("effects", f"{pair} and {name}", "not close the same axis twice")
    for one, other in OPPOSITE:
        _check_opposite(effects, one, other)
        _check_opposite(effects, other, one)


def _check_opposite(effects, name, other):
    there = getattr(effects, other) or (other == "bottom_wall" and effects.floor)
    if getattr(effects, name) is not None and not there:
        raise NeedsError(f"effects.{name}", other)


def moves_along(effects: Effects) -> bool:
    """Return whether walls that close the second axis move along the first, so that gas flows."""
    return any(
        getattr(wall, "axis", 0) == 1 and getattr(wall, "velocity", 0.0) != 0.0
        for wall in _walls(effects).values()
    )


def smooth_walls(effects: Effects) -> Effects:
    """Return the effects with all walls smooth and elastic."""
    smooth = {
        name: wall._replace(restitution=1.0, roughness=-1.0)
        for name, wall in _walls(effects).items()
        if hasattr(wall, "restitution")
    }
    return effects._replace(**smooth)


def has_sides(effects: Effects) -> bool:
    """Return whether there are walls on single sides of the box."""
    return any(hasattr(wall, "place") for wall in _walls(effects).values())


def _walls(effects):
    """Return all that closes an axis, by name."""
    places = (part.place for part in hooks.present(effects, "closes"))
    return {effects._fields[place]: effects[place] for place in places}
