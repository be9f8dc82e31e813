"""`roughgas movie` and `roughgas trajectory`: particles of a point as they move."""

import sys
from argparse import Namespace
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from roughgas.base import Interval
from roughgas.cli.options import number, whole_number
from roughgas.cli.run import initial_in, points_of
from roughgas.config import Place
from roughgas.config.provenance import provenance
from roughgas.data.trajectory import as_trajectory, check_format, write_trajectory
from roughgas.scene import Scene, build
from roughgas.simulation.ends import Initial
from roughgas.simulation.progress import watched
from roughgas.simulation.snapshots import LEGAL, NUMBERS, Take, chosen, snapshots
from roughgas.simulation.trajectory import variables

if TYPE_CHECKING:
    from roughgas.show.movies.drawing import Panel

RATES = Interval("[1, 50]")  # frames a second


def trajectory(options: Namespace) -> None:
    """Simulate a point, and write its trajectory."""
    name, ((place,), settings) = options.experiment, points_of(options)
    scene = build(settings, place.r, place.beta)
    for output in options.output:
        check_format(output)
    initial = initial_in(options)
    take = chosen_take(options, settings, scene, initial)
    simulated = snapshots(scene, settings, place.seed, take, initial)
    shots = list(watched(name, take.frames, "frames", simulated))
    told = take.options()
    if initial:
        told += ["--from", options.start_from]
    for output in options.output:
        about = provenance(name, settings, place.labels, options.scale, output, "trajectory", told)
        found = as_trajectory(variables(scene, settings, shots), about)
        write_trajectory(output, found)
        print(f"{output}: {len(shots)} frames", file=sys.stderr)


def chosen_take(
    options: Namespace, settings: dict[str, Any], scene: Scene, initial: Sequence[Initial] = ()
) -> Take:
    """Return what is shown: by default, what suits the experiment."""
    asked: dict[str, Any] = {}
    for name in ("start", "length"):
        if (text := getattr(options, name)) is not None:
            asked[name] = number(f"--{name}", text, LEGAL[name])
    if options.frames is not None:
        asked["frames"] = whole_number("--frames", options.frames, NUMBERS[0], NUMBERS[-1])
    if (texts := getattr(options, "times", None)) is not None:
        asked["times"] = [number("--times", text) for text in texts]
    return chosen(settings, scene, **asked, initial=initial)


def movie(options: Namespace) -> None:
    """Simulate a point, or several, and write their movie, side by side."""
    from roughgas.show.encoding import check_kind
    from roughgas.show.movies.drawing import write

    fps = number("--fps", options.fps, RATES)
    for output in options.output:
        check_kind(output)
    at, settings = points_of(options)
    panels = [_panel(options, place, settings) for place in at]
    for output in options.output:
        shown = partial(watched, f"{output}: drawn", len(panels[0][1]), "frames")
        write(output, panels, fps, shown)
        print(f"{output}: {len(panels[0][1])} frames", file=sys.stderr)


def _panel(options: Namespace, place: Place, settings: dict[str, Any]) -> "Panel":
    """Simulate a point; return it with what is to be seen of it."""
    from roughgas.show.movies.drawing import MovieSubject

    name, scene = options.experiment, build(settings, place.r, place.beta)
    take = chosen_take(options, settings, scene)
    simulated = snapshots(scene, settings, place.seed, take)
    shots = list(watched(f"{name}: simulated", take.frames, "frames", simulated))
    by_species = options.colour == "species"
    return MovieSubject(name, settings, scene, place.seed, by_species), shots
