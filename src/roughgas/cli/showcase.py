"""`roughgas clustering` films a large cooling gas."""

import shlex
import sys
from argparse import Namespace
from pathlib import Path
from typing import Any

from roughgas.cli.options import whole_number


def clustering(options: Namespace) -> None:
    """Film the gas, from the last checkpoint on if there is one."""
    settings = _settings(options)
    every = whole_number("--checkpoint-every", options.checkpoint_every, 1, of="of frames ")

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


def _settings(options: Namespace) -> dict[str, Any]:
    from roughgas import config

    if options.settings is not None:
        return config.from_text(
            options.settings, "--settings", options.checked, parts=("showcase", "filmed")
        )
    return config.showcase(config.load(options.config), options.scale)


def _provenance(options: Namespace, settings: dict[str, Any]) -> dict[str, Any]:
    """Return the attributes of a film that say how to make it again."""
    from roughgas.config import as_text

    command = ["roughgas", "clustering", "--scale", options.scale]
    command += ["--settings", as_text(settings), "--output", options.output]
    return {
        "title": f"A cooling gas of {settings['particles']} disks",
        "scale": options.scale,
        "command": shlex.join(command),
    }
