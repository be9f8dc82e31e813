"""`roughgas clustering` films a large cooling gas."""

import shlex
import sys
from argparse import Namespace
from pathlib import Path

from roughgas import config
from roughgas.cli.options import whole_number
from roughgas.data.checkpoint import discard
from roughgas.data.film import write_film
from roughgas.simulation.clustering import run
from roughgas.simulation.progress import FilmProgress

PARTS = ("showcase", "filmed")  # of the schema


def clustering(options: Namespace) -> None:
    """Film the gas, from the last checkpoint on if there is one."""
    if options.settings is None:
        settings = config.showcase(config.load(options.config), options.scale)
    else:
        settings = config.from_text(options.settings, "--settings", options.checked, PARTS)
    every = whole_number("--checkpoint-every", options.checkpoint_every, 1, of="of frames ")
    checkpoint = Path(f"{options.output}.checkpoint.npz")
    with FilmProgress(checkpoint, settings["frames"]) as progress:
        try:
            variables, attributes = run(settings, checkpoint, every, progress)
        except KeyboardInterrupt:
            raise KeyboardInterrupt(progress.how_to_go_on()) from None
    again = ["roughgas", "clustering", "--scale", options.scale]
    again += ["--settings", config.as_text(settings), "--output", options.output]
    about = {
        "title": f"A cooling gas of {settings['particles']} disks",
        "scale": options.scale,
        "command": shlex.join(again),
    }
    write_film(options.output, variables, about | attributes)
    discard(checkpoint)
    took = f"{variables['collisions']:,} collisions in {variables['kernel_seconds']:.1f} s"
    print(f"{options.output}: {settings['frames']} frames, {took}", file=sys.stderr)
