"""The kernel beside an event-driven program in C: a layer of rough spheres on a shaken floor.

    python -m benchmarks.layer PROGRAM [--runs 12] [--widths 30 100]

The layer is case b of Bizon et al., Phys. Rev. Lett. 80, 57 (1998), Fig. 1: acceleration 3 g,
frequency 0.44 (g/H)^(1/2), depth H of 5.42 diameters, 30 and 100 diameters wide. PROGRAM is
called as PROGRAM FILE CYCLES 1 FRAMES. FILE has doubles: number, width, amplitude and angular
frequency of the floor, friction, beta, time, then position, velocity and spin of each sphere, with
a = m = g = 1. After each cycle it prints, among others, "cpu SECONDS" and "col CONTACTS" so far.
It and the kernel run in turns, from the same states, on one core. Each pair has another state, with
velocities that differ by TOUCH, so that numbers of contacts scatter as far as chaos lets them.
"""

import argparse
import math
import re
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.kernel import memory_of
from benchmarks.scenes import advance, present
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state

WIDTHS = (30, 100)  # diameters
SETTLED = 30  # width of the layer that the others are made of
SETTLING, CYCLES, RUNS = 6, 2, 3
TOUCH = 1e-9
KICK = 0.02  # a/T, so that copies go different ways
ACCELERATION, FREQUENCY, DEPTH = 3.0, 0.44, 2 * 5.42
PERIOD = math.sqrt(DEPTH) / FREQUENCY
OMEGA = 2.0 * math.pi / PERIOD
AMPLITUDE = ACCELERATION / OMEGA**2
FRICTION, BETA, SLOWEST = 0.5, 0.35, 0.7  # r is 1 - 0.3 v^(3/4), v in (g D)^(1/2), or SLOWEST
FASTEST = math.sqrt(2.0)


def main() -> None:
    """Print a line for each width."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--widths", type=int, nargs="+", default=WIDTHS, help="diameters")
    options = parser.parse_args()
    program, settled, rng = options.program.resolve(), settle(), np.random.default_rng(3)
    head = "spheres | roughgas / C | roughgas | C | contacts | of C | bytes a sphere"
    print(f"| {head} |\n|" + " --- |" * 7)
    for width in options.widths:
        rows = widened(settled, width)
        runs: list = [[], []]
        for _ in range(options.runs):
            touched = rows.copy()
            touched[:, 3:6] *= 1.0 + TOUCH * rng.standard_normal((len(rows), 3))
            runs[0].append(run_here(touched, width))
            runs[1].append(run_in(program, touched, width))
        ours, theirs = (statistics.median(n / s for n, s in column) for column in runs)
        ratio = statistics.median(a[0] / a[1] * b[1] / b[0] for a, b in zip(*runs, strict=True))
        contacts = [mean_of([n for n, _ in column]) for column in runs]
        size = sum(memory_of(state_of(rows, width)[1]))
        line = f"{len(rows):,} | {ratio:.2f} | {ours:.3g} | {theirs:.3g}"
        line += f" | {contacts[0]} | {contacts[1]} | {size:.0f}"
        print(f"| {line} |", flush=True)


def experiment(number: int, width: float) -> dict:
    """The settings of a layer so many diameters wide."""
    material = {"restitution": "particles", "roughness": "particles"}
    floor = {"amplitude": 2.0 * AMPLITUDE, "period": PERIOD, "wave": "sine"}
    effects = {
        "spin": {"inertia": 0.4},
        "gravity": {"acceleration": 1.0},
        "floor": floor | material,
        "friction": {"mu": FRICTION},
        "power_law": {"speed": FASTEST, "exponent": 0.75, "least": SLOWEST},
    }
    sides = {f"{side}_wall": material for side in ("left", "right", "front", "back")}
    box = [2.0 * width, 2.0 * width, "open"]
    about = {"particles": number, "box": box, "neighbours": "lists"}
    return about | {"effects": effects | sides}


def settle() -> np.ndarray:
    """A row of position, velocity and spin of each sphere, after whole cycles."""
    settings = experiment(6 * SETTLED**2, SETTLED)
    scene = build(settings, SLOWEST, BETA)
    state = initial_state(scene, settings, np.random.default_rng(1))
    advance(scene, state, time=SETTLING * PERIOD)
    return np.hstack(present(scene, state))


def widened(settled: np.ndarray, width: float) -> np.ndarray:
    """The same of copies side by side, as far as they fit into that width."""
    rng, rows = np.random.default_rng(2), []
    copies = math.ceil(width / SETTLED)
    for place in np.ndindex(copies, copies):
        moved = settled.copy()
        moved[:, :2] += 2.0 * SETTLED * np.array(place)
        moved[:, 3:6] += KICK * rng.standard_normal((len(moved), 3))
        rows.append(moved[(moved[:, :2] < 2.0 * width - 1.0).all(axis=1)])
    return np.concatenate(rows)


def state_of(rows, width):
    """(scene, state) of a layer."""
    scene = build(experiment(len(rows), width), SLOWEST, BETA)
    return scene, new_state(scene, *np.hsplit(rows, 3))


def mean_of(contacts: list[float]) -> str:
    """Their mean, with its standard error."""
    error = statistics.stdev(contacts) / math.sqrt(len(contacts)) if len(contacts) > 1 else math.nan
    return f"{statistics.fmean(contacts):.5g} +- {error:.1g}"


def run_here(rows: np.ndarray, width: float) -> tuple[float, float]:
    """Contacts, and seconds of CPU time, of CYCLES."""
    scene, state = state_of(rows, width)
    begin = time.process_time()
    advance(scene, state, time=CYCLES * PERIOD)
    return float(state.counts[COLLISIONS]), time.process_time() - begin


def run_in(program: Path, rows: np.ndarray, width: float) -> tuple[float, float]:
    """The same of the program."""
    head = [len(rows), 2.0 * width, AMPLITUDE, OMEGA, FRICTION, BETA, 0.0]
    with tempfile.TemporaryDirectory() as folder:
        np.concatenate([head, rows.ravel()]).tofile(Path(folder) / "layer")
        command = [program, "layer", str(CYCLES), "1", "frames"]
        ran = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    seconds, contacts = re.findall(r"cpu (\S+) col (\d+)", ran.stdout)[-1]
    return float(contacts), float(seconds)


if __name__ == "__main__":
    main()
