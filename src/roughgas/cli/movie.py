"""`roughgas movie`: a point seen as it moves."""

import sys
from argparse import Namespace
from functools import partial
from typing import Any

from roughgas import config
from roughgas.base.legal import Interval
from roughgas.cli.options import number, whole_number
from roughgas.cli.run import point_of
from roughgas.scene import Scene
from roughgas.show.encoding import check_kind
from roughgas.show.movies.drawing import MovieSubject, write
from roughgas.show.movies.snapshots import Take, snapshots, usual_take
from roughgas.simulation.progress import watched

FRAMES = 2, 10_000
RATES = Interval("[1, 50]")
TIMES = {"start": Interval("[0, 1e9]"), "length": Interval("(0, 1e9]")}
"""In T, or in collisions per particle."""


def movie(options: Namespace) -> None:
    """Simulate a point, and write its movie."""
    name, seed = options.experiment, config.seed(options.seed)
    scene, settings = point_of(options, options.beta)
    fps = number("--fps", options.fps, RATES)
    for output in options.output:
        check_kind(output)
    take = _take(options, settings, scene)
    simulated = snapshots(settings, float(options.r), float(options.beta), seed, take)
    shots = list(watched(f"{name}: simulated", take.frames, "frames", simulated))
    subject = MovieSubject(name, settings, scene, seed)
    for output in options.output:
        shown = partial(watched, f"{output}: drawn", len(shots), "frames")
        write(output, subject, shots, fps, shown)
        print(f"{output}: {len(shots)} frames", file=sys.stderr)


def _take(options: Namespace, settings: dict[str, Any], scene: Scene) -> Take:
    """Return what is filmed: by default, what suits the experiment."""
    asked: dict[str, Any] = {}
    for name, legal in TIMES.items():
        if (text := getattr(options, name)) is not None:
            asked[name] = number(f"--{name}", text, legal)
    if options.frames is not None:
        asked["frames"] = whole_number("--frames", options.frames, *FRAMES)
    return usual_take(settings, scene)._replace(**asked)
