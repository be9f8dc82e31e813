"""`python -m roughgas.kernel --show FUNCTION --scene EXPERIMENT`: a function as it is compiled.

It is specialised for the types of the scene (compiling/jit.py): code of absent effects is removed.
The experiment is from ./config.yaml, or built into roughgas. Nothing imports this file.
"""

import argparse
import sys

import numpy as np

from roughgas import config
from roughgas.base import InputError
from roughgas.compiling.jit import specialised_source
from roughgas.kernel.record import Sampling, allocate_frames, columns, record
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings


def main(command_line=None):
    """Print the source of a kernel function as it is specialised for the scene of an experiment.

    `command_line` is a list of arguments, by default the process's. Exits with status 2 for an
    illegal argument.
    """
    parser = argparse.ArgumentParser("python -m roughgas.kernel", description=__doc__)
    parser.add_argument("--show", metavar="FUNCTION", required=True)
    parser.add_argument("--scene", metavar="EXPERIMENT", required=True)
    options = parser.parse_args(command_line)
    try:
        configured = config.load_experiment(
            config.active_config_path(), options.scene, config.PAPER
        )
        experiment = scene_settings(configured.raw)
        scene = build(experiment, 0.9, -1.0)
        state = initial_state(scene, experiment, np.random.default_rng(0))
        samples = np.empty((0, len(columns(scene))))
        frames = allocate_frames(state, 0)
        arguments = state, scene, Sampling(np.inf, 1, 0), samples, frames
        sources = specialised_source(options.show, record, *arguments)
        if not any(sources.values()):
            unneeded = "compiled for this scene, which does without it"
            legal = unneeded if sources else "a compiled function, such as collide or list_by_sweep"
            raise InputError("--show", options.show, f"be {legal}")
    except InputError as error:
        print(f"roughgas: error: {error}", file=sys.stderr)
        sys.exit(2)
    for module, texts in sources.items():
        if texts:
            print(f"# {module}", *texts, sep="\n\n")


if __name__ == "__main__":
    main()
