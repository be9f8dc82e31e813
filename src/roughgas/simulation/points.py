"""One point or several, from keyword arguments: each r with each beta and each seed."""

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from roughgas import config
from roughgas.base.errors import InputError, shown
from roughgas.config.provenance import provenance
from roughgas.data.point import Point
from roughgas.scene import build
from roughgas.simulation.ends import Initial
from roughgas.simulation.point import run_point
from roughgas.simulation.progress import Progress


class Place(NamedTuple):
    """What names a point: its labels, and the numbers that these stand for."""

    labels: tuple[str, str, str]
    r: float
    beta: float
    seed: int


def is_several(*given: Any) -> bool:
    """Return whether any of these is a list, or an array, of values."""
    return any(not isinstance(one, str) and hasattr(one, "__len__") for one in given)


def places(r: Any, beta: Any, seed: Any) -> list[Place]:
    """Return the places of values of r, of beta and of the seed, each one or several.

    Raises InputError for an illegal value, for one that is given twice, and for none.
    """
    axes = [_values(name, one) for name, one in (("r", r), ("beta", beta), ("seed", seed))]
    found = []
    for values in itertools.product(*axes):
        a, b, c = values
        numbers = config.restitution(a), config.roughness(b), config.seed(c)
        found.append(Place((str(a), str(b), str(c)), *numbers))
    return found


def _values(name, given):
    if not is_several(given):
        return [given]
    values = list(getattr(given, "tolist", lambda: given)())
    if not values or len({str(one) for one in values}) < len(values):
        raise InputError(name, shown(values), "be one value or several, each of them once")
    return values


def points(
    name: str,
    settings: Mapping[str, Any],
    at: Iterable[Place],
    scale: str,
    initial: list[Initial] | None = None,
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    quiet: bool = False,
) -> Iterator[Point]:
    """Simulate the points of an experiment, and yield each with its attributes.

    Messages and attributes call it `name`. Raises InputError and CollapseError as `run_point`.
    """
    told = [] if initial is None else ["--from", "start.nc"]
    at = list(at)
    for labels, r, beta, seed in at:
        scene = build(settings, r, beta)
        one = name if len(at) == 1 else f"{name}, r = {labels[0]}, beta = {labels[1]}, seed {seed}"
        about = provenance(name, settings, labels, scale, "point.nc", told=told)
        with Progress(one, scene, settings, quiet=quiet) as bar:
            found = run_point(scene, settings, seed, bar, initial or (), functions)
        yield found._replace(attributes=about | found.attributes)
