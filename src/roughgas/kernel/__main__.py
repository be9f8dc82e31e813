"""`python -m roughgas.kernel --show FUNCTION --scene EXPERIMENT`: a function as it is compiled.

All that the types of a scene decide is decided (compiling/jit.py): what the scene lacks is not
there. The experiment is one of config.yaml here, or of roughgas's own. Nothing imports this file.
"""

import argparse
import sys

import numpy as np

from roughgas import config
from roughgas.base import InputError
from roughgas.compiling.jit import texts_of
from roughgas.kernel.record import Sampling, columns, record
from roughgas.scene import build
from roughgas.scene.initial import initial_state


def main(arguments=None):
    parser = argparse.ArgumentParser("python -m roughgas.kernel", description=__doc__)
    parser.add_argument("--show", metavar="FUNCTION", required=True)
    parser.add_argument("--scene", metavar="EXPERIMENT", required=True)
    options = parser.parse_args(arguments)
    try:
        experiment = config.load_experiment(config.in_use(), options.scene, config.PAPER)
        scene = build(experiment, 0.9, -1.0)
        state = initial_state(scene, experiment, np.random.default_rng(0))
        samples = np.empty((0, len(columns(scene))))
        found = texts_of(options.show, record, state, scene, Sampling(np.inf, 1, 0), samples)
        if not any(found.values()):
            unneeded = "compiled for this scene, which does without it"
            legal = unneeded if found else "a compiled function, such as collide or list_by_sweep"
            raise InputError("--show", options.show, f"be {legal}")
    except InputError as error:
        print(f"roughgas: error: {error}", file=sys.stderr)
        sys.exit(2)
    for module, texts in found.items():
        if texts:
            print(f"# {module}", *texts, sep="\n\n")


if __name__ == "__main__":
    main()
