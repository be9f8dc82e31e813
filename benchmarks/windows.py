"""Upper bound of the gain by time windows in a large gas, whose memory fits no cache.

    python -m benchmarks.windows [--gases 100] [--particles 10000]

In a conservative scheme of time windows the events of a block of a gas are carried out for a short
time before the events of the next block. Here the blocks are gases of their own, which saves all
synchronisation: no such scheme can gain more. Prints contacts per second of CPU time for windows of
several lengths, in contacts per particle, beside a single block, and beside one gas of all
particles. A window may be as long as no news from outside reaches most of a block.
"""

import argparse
import statistics
import time

import numpy as np

from benchmarks.scenes import advance
from benchmarks.schemes import Gas, rows_of
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS
from roughgas.scene.initial import initial_state

PACKING, SETTLING = 0.2, 3
WINDOWS = (0.01, 0.03, 0.1, 0.3, 1.0)  # contacts per particle
TURNS, CONTACTS_OF_TURN = 5, 0.5  # per particle of all
KICK = 0.1  # relative change of velocities, so that blocks take different paths


def main() -> None:
    """Print a row for each length of the windows."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--gases", type=int, default=100)
    parser.add_argument("--particles", type=int, default=10_000, help="of each")
    options = parser.parse_args()
    scene, blocks = blocks_of(options.gases, options.particles)
    whole_scene, whole = gas_of(options.gases * options.particles)
    total = options.gases * options.particles
    print("| window, contacts a particle | contacts per CPU second |\n| --- | --- |")
    print(f"| one block alone | {rate(scene, blocks[:1], 1.0, total):.3g} |", flush=True)
    for window in WINDOWS:
        print(f"| {window:g} | {rate(scene, blocks, window, total):.3g} |", flush=True)
    print(f"| one gas of all particles | {rate(whole_scene, [whole], 1.0, total):.3g} |")


def gas_of(number: int):
    """Return scene and state of a smooth elastic gas of disks."""
    scene, settings = Gas(2, PACKING, number, 1.0).scene()
    state = initial_state(scene, settings, np.random.default_rng(1))
    advance(scene, state, collisions=SETTLING * number)
    return scene, state


def blocks_of(gases: int, particles: int):
    """Return the scene and the states of several gases, with different velocities."""
    scene, state = gas_of(particles)
    rng = np.random.default_rng(2)
    states = []
    for _ in range(gases):
        position, velocity, spin, _ = rows_of(scene, state)
        velocity = velocity * (1.0 + KICK * rng.standard_normal(velocity.shape))
        states.append(new_state(scene, position, velocity, spin))
    return scene, states


def rate(scene, states, window: float, total: int) -> float:
    """Return the median contacts per second of CPU time over TURNS, without the first.

    `window` is in contacts per particle; a turn has CONTACTS_OF_TURN for each of `total` particles.
    """
    number = len(states[0].changes)
    contacts_of_window = max(1, round(window * number / 2.0))
    rounds = max(1, round(CONTACTS_OF_TURN * total / 2.0 / contacts_of_window / len(states)))
    rates = []
    for _ in range(TURNS + 1):
        before, begin = sum(int(state.counts[COLLISIONS]) for state in states), time.process_time()
        for _ in range(rounds):
            for state in states:
                advance(scene, state, collisions=contacts_of_window)
        contacts = sum(int(state.counts[COLLISIONS]) for state in states) - before
        rates.append(contacts / (time.process_time() - begin))
    return statistics.median(rates[1:])


if __name__ == "__main__":
    main()
