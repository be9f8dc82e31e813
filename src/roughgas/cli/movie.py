"""`roughgas movie`: a point seen as it moves."""

import argparse
import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from roughgas.base.errors import InputError
from roughgas.cli.parser import examples
from roughgas.cli.run import add_point, point_of

if TYPE_CHECKING:
    from roughgas.scene import Scene
    from roughgas.show.movies.snapshots import Take

EXAMPLE = examples("roughgas movie vibrated --r 0.9 --beta 0.5 -o bed.mp4 bed.gif")
FRAMES = 2, 10_000
RATES = 1.0, 50.0


def add_commands(commands: Any) -> None:
    """Add the subcommand to argparse's `commands`."""
    parser = commands.add_parser(
        "movie",
        help="show a point as it moves",
        description="Simulate a point of an experiment, and draw its particles as they move and "
        "spin, its boundaries, and R(t). It is the trajectory of `roughgas run` with the same "
        "seed. Times are in T, for a cooling gas in collisions per particle.",
        epilog=EXAMPLE,
    )
    add_point(parser)
    parser.add_argument("--seed", default="1", help="of the random generator (default: 1)")
    parser.add_argument("--start", metavar="TIME", help="of the first frame (default: when steady)")
    parser.add_argument("--length", metavar="TIME", help="that is shown (default: by experiment)")
    parser.add_argument("--frames", metavar="NUMBER", help="of frames (default: 125 or 160)")
    parser.add_argument("--fps", default="25", metavar="RATE", help="frames a second (default: 25)")
    parser.add_argument(
        "-o", "--output", required=True, nargs="+", metavar="FILE", help=".mp4 or .gif files"
    )
    parser.set_defaults(command=movie)


def movie(options: argparse.Namespace) -> None:
    """Simulate a point, and write its movie."""
    from roughgas import config
    from roughgas.show.encoding import check_kind

    seed = config.seed(options.seed)
    r, beta, settings = point_of(options)
    fps = _number("--fps", options.fps, *RATES)
    for output in options.output:
        check_kind(output)

    from roughgas.scene import build
    from roughgas.show.movies.drawing import Subject, write
    from roughgas.show.movies.snapshots import snapshots
    from roughgas.simulation.progress import watched

    scene = build(settings, r, beta)
    take = _take(options, settings, scene)
    name = options.experiment
    shots = list(
        watched(
            f"{name}: simulated", take.frames, "frames", snapshots(settings, r, beta, seed, take)
        )
    )
    subject = Subject(name, settings, scene, seed)
    for output in options.output:
        write(
            output, subject, shots, fps, partial(watched, f"{output}: drawn", len(shots), "frames")
        )
        print(f"{output}: {len(shots)} frames", file=sys.stderr)


def _take(options: argparse.Namespace, settings: dict[str, Any], scene: "Scene") -> "Take":
    from roughgas.show.movies.snapshots import usual_take

    take = usual_take(settings, scene)
    if options.start is not None:
        take = take._replace(start=_number("--start", options.start, 0.0, 1e9))
    if options.length is not None:
        take = take._replace(length=_number("--length", options.length, 1e-9, 1e9))
    if options.frames is not None:
        take = take._replace(frames=_frames(options.frames))
    return take


def _frames(text: str) -> int:
    low, high = FRAMES
    if not text.isdecimal() or not low <= int(text) <= high:
        raise InputError("--frames", text, f"be a whole number in [{low}, {high}]")
    return int(text)


def _number(key: str, text: str, low: float, high: float) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not low <= value <= high:  # NaN fails, too
        raise InputError(key, text, f"be a number in [{low:g}, {high:g}]")
    return value
