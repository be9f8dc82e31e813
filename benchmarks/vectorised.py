"""Which vector instructions the machine code of the sweep and of its decisions is made of.

    python -m benchmarks.vectorised

Both loops are compiled alone, as the kernel of a scene has them, and the instructions that compute
with several numbers at once are counted, by the registers that they use: xmm holds four single or
two double precision numbers, ymm twice and zmm four times as many.
"""

import re
from collections import Counter

import numpy as np

from benchmarks.scenes import CASES, settings
from roughgas.compiling.jit import entry
from roughgas.kernel.prediction import decide
from roughgas.kernel.sweep import list_by_sweep
from roughgas.scene import Scene, build
from roughgas.scene.initial import initial_state

ARITHMETIC = re.compile(
    r"^\s+v?((?:add|sub|mul|div|sqrt|fn?m(?:add|sub)\d*)p[sd])\s.*%([xyz]mm)", re.MULTILINE
)


@entry
def sweep(state, scene, i, number):
    """Which of all particles may be met soon: single precision (`ps`)."""
    return list_by_sweep(state, scene, i, 0, 0.0)


@entry
def decisions(state, scene, i, number):
    """When so many that may be met are: double precision (`pd`)."""
    decide(state, scene, i, 0, number, 0.0)


def packed_instructions(loop, scene: Scene, state) -> Counter:
    """How often each (instruction, register) stands in the machine code of `loop` for a scene."""
    loop(state, scene, 0, 3)
    (code,) = loop.dispatcher.inspect_asm().values()
    loop.dispatcher.overloads.clear()
    return Counter(ARITHMETIC.findall(code))


def scenes():
    """(title, scene, state) of each kernel that is timed, as few particles have it."""
    for case in {case.experiment: case for case in CASES}.values():
        experiment = settings(case, 160)
        scene = build(experiment, case.r, case.beta)
        yield case.experiment, scene, initial_state(scene, experiment, np.random.default_rng(1))


def main() -> None:
    """Print the counts."""
    for title, scene, state in scenes():
        for loop in (sweep, decisions):
            found = packed_instructions(loop, scene, state)
            counts = [f"{count} {name} {register}" for (name, register), count in found.items()]
            print(f"{title}, {loop.__name__}: {', '.join(sorted(counts))}")


if __name__ == "__main__":
    main()
