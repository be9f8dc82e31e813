"""`roughgas movie`: a point seen as it moves."""

import sys
from argparse import Namespace
from functools import partial
from typing import Any

from roughgas.base.legal import Interval
from roughgas.cli.options import number
from roughgas.cli.run import points_of
from roughgas.cli.trajectory import chosen_take
from roughgas.config import Place
from roughgas.scene import build
from roughgas.show.encoding import check_kind
from roughgas.show.movies.drawing import MovieSubject, Panel, write
from roughgas.simulation.progress import watched
from roughgas.simulation.snapshots import snapshots

RATES = Interval("[1, 50]")


def movie(options: Namespace) -> None:
    """Simulate a point, or several, and write their movie, side by side."""
    fps = number("--fps", options.fps, RATES)
    for output in options.output:
        check_kind(output)
    at, settings = points_of(options)
    panels = [_panel(options, place, settings) for place in at]
    for output in options.output:
        shown = partial(watched, f"{output}: drawn", len(panels[0][1]), "frames")
        write(output, panels, fps, shown)
        print(f"{output}: {len(panels[0][1])} frames", file=sys.stderr)


def _panel(options: Namespace, place: Place, settings: dict[str, Any]) -> Panel:
    """Simulate a point; return it with what is to be seen of it."""
    name, scene = options.experiment, build(settings, place.r, place.beta)
    take = chosen_take(options, settings, scene)
    simulated = snapshots(scene, settings, place.seed, take)
    shots = list(watched(f"{name}: simulated", take.frames, "frames", simulated))
    by_species = options.colour == "species"
    return MovieSubject(name, settings, scene, place.seed, by_species), shots
