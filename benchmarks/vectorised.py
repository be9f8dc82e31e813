"""Counts of vector instructions in the machine code of the sweep and of its decisions.

    python -m benchmarks.vectorised

Both loops are compiled alone, with the types of a scene, and their packed arithmetic instructions
are counted by register: xmm holds four numbers in single or two in double precision, ymm eight or
four, zmm sixteen or eight.
"""

import re
from collections import Counter

import numpy as np

from benchmarks.scenes import CASES, settings
from roughgas.compiling.jit import entry
from roughgas.kernel.prediction import predict_contacts
from roughgas.kernel.sweep import list_by_sweep
from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state

PACKED_ARITHMETIC = re.compile(
    r"^\s+v?((?:add|sub|mul|div|sqrt|fn?m(?:add|sub)\d*)p[sd])\s.*%([xyz]mm)", re.MULTILINE
)


@entry
def sweep(state, scene, i, number):
    """List the candidates among all particles: single precision (`ps`)."""
    return list_by_sweep(state, scene, i, 0, 0.0)


@entry
def decisions(state, scene, i, number):
    """Compute the contact times of `number` candidates: double precision (`pd`)."""
    predict_contacts(state, scene, i, 0, number, 0.0)


def packed_instructions(loop, scene: Scene, state) -> Counter:
    """Return the count of each (instruction, register) in the machine code of `loop`."""
    loop(state, scene, 0, 3)
    (code,) = loop.dispatcher.inspect_asm().values()
    loop.dispatcher.overloads.clear()
    return Counter(PACKED_ARITHMETIC.findall(code))


def scenes():
    """Yield title, scene and state of each experiment of the benchmarks, with few particles."""
    for case in {case.experiment: case for case in CASES}.values():
        experiment = settings(case, 160)
        scene = build(experiment, case.r, case.beta)
        yield case.experiment, scene, initial_state(scene, experiment, np.random.default_rng(1))


def main() -> None:
    """Print the counts."""
    for title, scene, state in scenes():
        for loop in (sweep, decisions):
            instructions = packed_instructions(loop, scene, state)
            counts = [
                f"{count} {name} {register}" for (name, register), count in instructions.items()
            ]
            print(f"{title}, {loop.__name__}: {', '.join(sorted(counts))}")


if __name__ == "__main__":
    main()
