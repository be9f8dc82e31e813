"""`python -m roughgas.kernel --show FUNCTION --scene EXPERIMENT`: a function as it is compiled.

All that the types of a scene decide is decided (compiling/jit.py): what the scene lacks is not
there. The experiment is one of config.yaml here, or of roughgas's own. Nothing imports this file.
"""

import argparse
import ast
import sys
from pathlib import Path

import numpy as np

from roughgas import config
from roughgas.base import InputError
from roughgas.compiling.jit import Compiled, Entry
from roughgas.kernel.record import Sampling, columns, record
from roughgas.scene import build
from roughgas.scene.initial import initial_state

HERE = Path("config.yaml")


def written(name, scene, state):
    """Return the texts of all functions of a name as they are compiled for a scene, by their file.

    In a process that has compiled nothing yet. Raises InputError where there is none.
    """
    modules = [m for key, m in sorted(sys.modules.items()) if key.startswith("roughgas.")]
    kernel = Entry(record.py_func)  # not from the cache
    known = [kernel, *(one for m in modules for one in vars(m).values() if type(one) is Compiled)]
    named = [one for one in known if one.__name__ == name]
    if not named:
        raise InputError("--show", name, "be a compiled function, such as collide or list_by_sweep")
    kernel(state, scene, Sampling(np.inf, 1, 0), np.empty((0, len(columns(scene)))))
    found = {}
    for one in named:
        texts = found.setdefault(one.__module__, {})  # in order, and each once
        texts |= dict.fromkeys(map(ast.unparse, one.written.values()))
    if not any(found.values()):
        raise InputError("--show", name, "be compiled for this scene, which does without it")
    return found


def main(arguments=None):
    parser = argparse.ArgumentParser("python -m roughgas.kernel", description=__doc__)
    parser.add_argument("--show", metavar="FUNCTION", required=True)
    parser.add_argument("--scene", metavar="EXPERIMENT", required=True)
    options = parser.parse_args(arguments)
    try:
        path = HERE if HERE.exists() else config.SHIPPED
        experiment = config.load_experiment(path, options.scene, config.PAPER)
        scene = build(experiment, 0.9, -1.0)
        state = initial_state(scene, experiment, np.random.default_rng(0))
        found = written(options.show, scene, state)
    except InputError as error:
        print(f"roughgas: error: {error}", file=sys.stderr)
        sys.exit(2)
    for module, texts in found.items():
        if texts:
            print(f"# {module}", *texts, sep="\n\n")


if __name__ == "__main__":
    main()
