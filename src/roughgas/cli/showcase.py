"""The showcase: `roughgas clustering` films a large cooling gas, `roughgas film` draws the film."""

import argparse
import shlex
import sys
from pathlib import Path
from typing import Any

from roughgas.cli.parser import examples
from roughgas.cli.settings import add_settings

EXAMPLE = examples("roughgas clustering --scale small -o clustering.nc")
FILM_EXAMPLE = examples("roughgas film clustering.nc -o clustering.png clustering.mp4")


def add_commands(commands: Any) -> None:
    """Add the two subcommands to argparse's `commands`."""
    parser = commands.add_parser(
        "clustering",
        help="film a large cooling gas until it forms clusters",
        description="Film a large cooling gas until it forms clusters. A run that was interrupted"
        " or killed goes on from its last checkpoint, FILE.checkpoint.npz, when the same command"
        " is given again; the result is the same to the last bit.",
        epilog=EXAMPLE,
    )
    add_settings(parser)
    parser.add_argument("--checkpoint-every", default="10", metavar="FRAMES", help="default: 10")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="dataset to write")
    parser.set_defaults(command=clustering)

    parser = commands.add_parser(
        "film",
        help="draw the picture and the movie of a film",
        description="Draw what `roughgas clustering` has seen, as a picture or as a movie.",
        epilog=FILM_EXAMPLE,
    )
    parser.add_argument("input", metavar="FILM", help="dataset of a film")
    parser.add_argument(
        "-o", "--output", required=True, nargs="+", metavar="FILE", help=".pdf, .png, .mp4 files"
    )
    parser.set_defaults(command=film)


def clustering(options: argparse.Namespace) -> None:
    """Film the gas, from the last checkpoint on where there is one."""
    settings, every = _settings(options), _frames(options.checkpoint_every)

    from roughgas.data.checkpoint import discard
    from roughgas.data.film import write_film
    from roughgas.simulation.clustering import run
    from roughgas.simulation.progress import FilmProgress

    checkpoint = Path(f"{options.output}.checkpoint.npz")
    with FilmProgress(checkpoint, settings["frames"]) as progress:
        try:
            variables, attributes = run(settings, checkpoint, every, progress)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(progress.how_to_go_on()) from None
    write_film(options.output, variables, _provenance(options, settings) | attributes)
    discard(checkpoint)
    took = f"{variables['collisions']:,} collisions in {variables['kernel_seconds']:.1f} s"
    print(f"{options.output}: {settings['frames']} frames, {took}", file=sys.stderr)


def film(options: argparse.Namespace) -> None:
    """Draw a film."""
    from roughgas.show.figures.clustering import draw

    draw(options.input, options.output)


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    from roughgas import config

    if options.settings is not None:
        return config.from_text(
            options.settings, "--settings", options.checked, parts=("showcase", "filmed")
        )
    return config.showcase(config.load(options.config), options.scale)


def _frames(text: str) -> int:
    from roughgas.base.errors import InputError

    if not text.isdecimal() or int(text) < 1:
        raise InputError("--checkpoint-every", text, "be a whole number of frames >= 1")
    return int(text)


def _provenance(options: argparse.Namespace, settings: dict[str, Any]) -> dict[str, Any]:
    """The attributes of a film that say how to make it again."""
    from roughgas.config import as_text

    command = ["roughgas", "clustering", "--scale", options.scale]
    command += ["--settings", as_text(settings), "--output", options.output]
    return {
        "title": f"A cooling gas of {settings['particles']} disks",
        "scale": options.scale,
        "command": shlex.join(command),
    }
