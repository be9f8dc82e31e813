"""Speed of the kernel relative to a program in C: a layer of rough spheres on a shaken floor.

    python -m benchmarks.layer PROGRAM [--runs 12] [--widths 30 100]

The layer is case b of Bizon et al., Phys. Rev. Lett. 80, 57 (1998), Fig. 1: acceleration 3 g,
frequency 0.44 (g/H)^(1/2), depth H of 5.42 diameters, 30 and 100 diameters wide. PROGRAM is
called as PROGRAM FILE CYCLES 1 FRAMES. FILE has doubles: number, width, amplitude and angular
frequency of the floor, friction, beta, time, then position, velocity and spin of each sphere, with
a = m = g = 1. After each cycle it prints lines with the sums "cpu SECONDS" and "col CONTACTS". The
program and the kernel run in turns, from the same states, on one core. The states of different
pairs of runs differ by PERTURBATION, so that chaos makes the numbers of contacts scatter.
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
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings

WIDTHS = (30, 100)  # diameters
SETTLED_WIDTH = 30  # of the simulated layer; copies of it make wider ones
SETTLING, CYCLES, RUNS = 6, 2, 3
PERTURBATION = 1e-9
KICK = 0.02  # a/T, so that copies take different paths
ACCELERATION, FREQUENCY, DEPTH = 3.0, 0.44, 2 * 5.42
PERIOD = math.sqrt(DEPTH) / FREQUENCY
OMEGA = 2.0 * math.pi / PERIOD
AMPLITUDE = ACCELERATION / OMEGA**2
FRICTION, BETA = 0.5, 0.35
MIN_RESTITUTION = 0.7  # r is 1 - 0.3 v^(3/4), v in (g D)^(1/2), or at least this
REFERENCE_SPEED = math.sqrt(2.0)


def main() -> None:
    """Print a row of the table for each width."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--runs", type=int, default=RUNS)
    parser.add_argument("--widths", type=int, nargs="+", default=WIDTHS, help="diameters")
    options = parser.parse_args()
    program, settled_rows, rng = options.program.resolve(), settle(), np.random.default_rng(3)
    table_head = "spheres | roughgas / C | roughgas | C | contacts | of C | bytes a sphere"
    print(f"| {table_head} |\n|" + " --- |" * 7)
    for width in options.widths:
        rows = tiled(settled_rows, width)
        runs: list = [[], []]
        for _ in range(options.runs):
            perturbed = rows.copy()
            perturbed[:, 3:6] *= 1.0 + PERTURBATION * rng.standard_normal((len(rows), 3))
            runs[0].append(run_kernel(perturbed, width))
            runs[1].append(run_program(program, perturbed, width))
        ours, theirs = (statistics.median(n / s for n, s in column) for column in runs)
        ratio = statistics.median(a[0] / a[1] * b[1] / b[0] for a, b in zip(*runs, strict=True))
        contacts = [mean_text([n for n, _ in column]) for column in runs]
        size = sum(memory_of(state_of(rows, width)[1]))
        line = f"{len(rows):,} | {ratio:.2f} | {ours:.3g} | {theirs:.3g}"
        line += f" | {contacts[0]} | {contacts[1]} | {size:.0f}"
        print(f"| {line} |", flush=True)


def experiment(number: int, width: float) -> dict:
    """Return the settings of a layer of a width in diameters."""
    material = {"restitution": "particles", "roughness": "particles"}
    floor = {"amplitude": 2.0 * AMPLITUDE, "period": PERIOD, "wave": "sine"}
    effects = {
        "spin": {"inertia": 0.4},
        "gravity": {"acceleration": 1.0},
        "floor": floor | material,
        "friction": {"mu": FRICTION},
        "power_law": {"speed": REFERENCE_SPEED, "exponent": 0.75, "least": MIN_RESTITUTION},
    }
    sides = {f"{side}_wall": material for side in ("left", "right", "front", "back")}
    box = [2.0 * width, 2.0 * width, "open"]
    settings = {"particles": number, "box": box, "neighbours": "lists"}
    return settings | {"effects": effects | sides}


def settle() -> np.ndarray:
    """Return a settled layer after whole cycles: rows of position, velocity and spin."""
    settings = scene_settings(experiment(6 * SETTLED_WIDTH**2, SETTLED_WIDTH))
    scene = build(settings, MIN_RESTITUTION, BETA)
    state = initial_state(scene, settings, np.random.default_rng(1))
    advance(scene, state, time=SETTLING * PERIOD)
    return np.hstack(present(scene, state))


def tiled(settled_rows: np.ndarray, width: float) -> np.ndarray:
    """Return copies of a layer side by side, cut at a width: position, velocity and spin."""
    rng, rows = np.random.default_rng(2), []
    copies = math.ceil(width / SETTLED_WIDTH)
    for shift in np.ndindex(copies, copies):
        copy = settled_rows.copy()
        copy[:, :2] += 2.0 * SETTLED_WIDTH * np.array(shift)
        copy[:, 3:6] += KICK * rng.standard_normal((len(copy), 3))
        rows.append(copy[(copy[:, :2] < 2.0 * width - 1.0).all(axis=1)])
    return np.concatenate(rows)


def state_of(rows, width):
    """Return the scene and the state of a layer."""
    scene = build(scene_settings(experiment(len(rows), width)), MIN_RESTITUTION, BETA)
    return scene, new_state(scene, *np.hsplit(rows, 3))


def mean_text(contacts: list[float]) -> str:
    """Return the mean number of contacts and its standard error, as text."""
    error = statistics.stdev(contacts) / math.sqrt(len(contacts)) if len(contacts) > 1 else math.nan
    return f"{statistics.fmean(contacts):.5g} +- {error:.1g}"


def run_kernel(rows: np.ndarray, width: float) -> tuple[float, float]:
    """Return the contacts, and the seconds of CPU time, of the kernel in CYCLES."""
    scene, state = state_of(rows, width)
    begin = time.process_time()
    advance(scene, state, time=CYCLES * PERIOD)
    return float(state.counts[COLLISIONS]), time.process_time() - begin


def run_program(program: Path, rows: np.ndarray, width: float) -> tuple[float, float]:
    """Return the contacts, and the seconds of CPU time, of the program in CYCLES."""
    header = [len(rows), 2.0 * width, AMPLITUDE, OMEGA, FRICTION, BETA, 0.0]
    with tempfile.TemporaryDirectory() as folder:
        np.concatenate([header, rows.ravel()]).tofile(Path(folder) / "layer")
        command = [program, "layer", str(CYCLES), "1", "frames"]
        process = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    seconds, contacts = re.findall(r"cpu (\S+) col (\d+)", process.stdout)[-1]
    return float(contacts), float(seconds)


if __name__ == "__main__":
    main()
