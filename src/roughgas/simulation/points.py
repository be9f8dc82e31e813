"""Several points of an experiment, one after the other."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from roughgas.config import Place
from roughgas.config.provenance import provenance
from roughgas.data.point import Point
from roughgas.scene import build
from roughgas.simulation.ends import Initial
from roughgas.simulation.point import run_point
from roughgas.simulation.progress import Progress


def points(
    name: str,
    settings: Mapping[str, Any],
    at: Sequence[Place],
    scale: str,
    outputs: Sequence[str],
    initial: Sequence[Initial] = (),
    functions: Mapping[str, Callable[[Any], Any]] | None = None,
    told: Sequence[str] = (),
    quiet: bool = False,
) -> Iterator[Point]:
    """Simulate the points of an experiment, and yield each with its attributes.

    Messages and attributes call it `name`, and attributes say that a command which is `told` more
    writes it to one of `outputs`. Raises InputError and CollapseError as `run_point`, those of an
    illegal scene before anything is simulated.
    """
    scenes = {(r, beta): build(settings, r, beta) for r, beta, *_ in at}
    for place, output in zip(at, outputs, strict=True):
        r, beta, seed, labels = place
        one = name if len(at) == 1 else f"{name}, r = {labels[0]}, beta = {labels[1]}, seed {seed}"
        about = provenance(name, settings, labels, scale, output, told=told)
        with Progress(one, scenes[r, beta], settings, quiet=quiet) as bar:
            found = run_point(scenes[r, beta], settings, seed, bar, initial, functions)
        yield found._replace(attributes=about | found.attributes)
