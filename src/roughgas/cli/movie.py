"""`roughgas movie`: a point seen as it moves."""

import sys
from argparse import Namespace
from functools import partial

from roughgas import config
from roughgas.base.legal import Interval
from roughgas.cli.options import number
from roughgas.cli.run import point_of
from roughgas.cli.trajectory import chosen_take
from roughgas.show.encoding import check_kind
from roughgas.show.movies.drawing import MovieSubject, write
from roughgas.simulation.progress import watched
from roughgas.simulation.snapshots import snapshots

RATES = Interval("[1, 50]")


def movie(options: Namespace) -> None:
    """Simulate a point, and write its movie."""
    name, seed = options.experiment, config.seed(options.seed)
    scene, settings = point_of(options, options.beta)
    fps = number("--fps", options.fps, RATES)
    for output in options.output:
        check_kind(output)
    take = chosen_take(options, settings, scene)
    simulated = snapshots(settings, float(options.r), float(options.beta), seed, take)
    shots = list(watched(f"{name}: simulated", take.frames, "frames", simulated))
    subject = MovieSubject(name, settings, scene, seed)
    for output in options.output:
        shown = partial(watched, f"{output}: drawn", len(shots), "frames")
        write(output, subject, shots, fps, shown)
        print(f"{output}: {len(shots)} frames", file=sys.stderr)
