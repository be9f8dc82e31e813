"""The kernels that several tests run, each compiled by one process before the first test begins.

Workers would else compile the same ones at the same time, since neighbouring tests need the same.
"""

import sys
from multiprocessing import get_context
from pathlib import Path

from accuracy.soft_spheres.pair import collide, shot
from brute_force.scenes import KERNELS, RARE, begin, run, settings
from numba.core.registry import cpu_target

TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5}]
SOFT = "soft disks"

SCENES = {  # the longest compilations first
    "sheared, in cells": settings("sheared", 800, [100, 100]),
    "walled, on lists": settings("walled", 800, [100, "open"]) | {"neighbours": "lists"},
    **{name: settings(name) for name in KERNELS if name not in RARE},
    "gas of two species": settings("gas") | {"species": TWO},
}


def compile_kernels(claimed):
    """Compile the kernels that no other worker has claimed in the shared folder `claimed`.

    Numba first registers all that it can compile, here once for all children.
    """
    cpu_target.typing_context.refresh()
    cpu_target.target_context.refresh()
    for name in [SOFT, *SCENES]:
        if claims(claimed / name):
            in_a_child(compile_one, name)


def compile_one(name):
    """Compile the kernel of a scene, or of soft particles."""
    if name == SOFT:
        collide(0.7, 0.3, 0.3, 3, shot(0.8, 2, 0.01))
        return
    scene, state = begin(SCENES[name], 0.9, -1.0)
    run(state, scene, 0)


def in_a_child(work, *arguments):
    """Call `work` in a child process, since a compiler never gives back its memory."""
    process = get_context("fork").Process(target=work, args=arguments)
    process.start()
    process.join()
    if process.exitcode:
        sys.exit(process.exitcode)


def claims(path):
    try:
        path.touch(exist_ok=False)
    except FileExistsError:
        return False
    return True


if __name__ == "__main__":
    compile_kernels(Path(sys.argv[1]))
