"""Speed of the kernel relative to EDMD, in C: elastic smooth spheres from dilute to dense.

    git clone https://github.com/FSmallenburg/EDMD
    python -m benchmarks.edmd EDMD [--packings .05 .2 .5] [--numbers 10976] [--variants Single Cell]

Compiles two variants of EDMD by their Makefiles, without a thermostat: Single keeps one event of a
particle and neighbour lists, Cell all events and cells. Programs and kernel run in turns, on
one core, from a face-centred cubic crystal; a first fifth of each run is not counted.
"""

import argparse
import itertools
import math
import re
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.scenes import advance
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.settings import scene_settings

NUMBERS = (10_976, 97_556)  # four per cell of a crystal
PACKINGS = (0.05, 0.2, 0.4, 0.5, 0.55)
VARIANTS = ("Single", "Cell")
COLLISIONS_OF_RUN, RUNS = 1_000_000, 3
PRINTED_LINES = 20  # of a run of EDMD
FIXED_SETTINGS = {"int initialconfig": "1", "const int usethermostat": "0"}
PRINT_CLOCK = 'fprintf(stderr, "%f %u\\\\n", (double)clock() / CLOCKS_PER_SEC, colcounter);'
FCC = np.array([[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]])
"""Sites of a face-centred cubic crystal, in sides of its cell."""


def main() -> None:
    """Print a row of the table for each packing and number of particles."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path, help="its folder, with Single and Cell")
    parser.add_argument("--packings", type=float, nargs="+", default=PACKINGS)
    parser.add_argument("--numbers", type=int, nargs="+", default=NUMBERS)
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=VARIANTS)
    options = parser.parse_args()
    header = ["packing", "spheres", "roughgas"]
    header += [column for name in options.variants for column in (name, f"roughgas / {name}")]
    print("| " + " | ".join(header) + " |\n|" + " --- |" * len(header))
    for packing, number in itertools.product(options.packings, options.numbers):
        with tempfile.TemporaryDirectory() as folder:
            programs = [
                compile_edmd(options.source / name, name, Path(folder) / name, number, packing)
                for name in options.variants
            ]
            rates = [
                [rate_of_kernel(number, packing), *(rate_of(program) for program in programs)]
                for _ in range(RUNS)
            ]
        row = [f"{packing:g}", f"{number:,}", f"{statistics.median(run[0] for run in rates):.3g}"]
        for k in range(1, len(programs) + 1):
            row += [f"{statistics.median(run[k] for run in rates):.3g}"]
            row += [f"{statistics.median(run[0] / run[k] for run in rates):.2f}"]
        print("| " + " | ".join(row) + " |", flush=True)


def duration(number: int, packing: float) -> float:
    """Return the time in which Enskog's theory expects COLLISIONS_OF_RUN in EDMD's units.

    These are the diameter and the thermal velocity; the contact value is Carnahan's and Starling's.
    """
    contact_value = (1.0 - 0.5 * packing) / (1.0 - packing) ** 3
    collisions_of_particle = 24.0 * packing * contact_value / math.sqrt(math.pi)
    return 2.0 * COLLISIONS_OF_RUN / (number * collisions_of_particle)


def compile_edmd(source: Path, variant: str, folder: Path, number: int, packing: float) -> Path:
    """Compile a variant of EDMD for a gas of spheres in `folder`; return the path of the program.

    The program prints CPU time and collisions PRINTED_LINES times.
    """
    shutil.copytree(source, folder)
    code = folder / f"md{variant}.c"
    text = "#include <time.h>\n" + code.read_text()
    time_of_run = duration(number, packing)
    parameters = {
        "int N": str(number),
        "double packfrac": f"{packing}",
        "double maxtime": f"{time_of_run}",
        "double writeinterval": f"{time_of_run / PRINTED_LINES}",
    }
    for name, value in (FIXED_SETTINGS | parameters).items():
        text, matches = re.subn(rf"^{name} *= *[^;]+;", f"{name} = {value};", text, flags=re.M)
        if matches != 1:
            raise SystemExit(f"{code}: no line sets {name}")
    code.write_text(re.sub(r'^ *printf\("Simtime: ', rf"{PRINT_CLOCK}\n\g<0>", text, flags=re.M))
    subprocess.run(["make", "-s", "-B"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
    return folder / "md"


def rate_of(program: Path) -> float:
    """Run EDMD; return its collisions per second of CPU time, without the first fifth."""
    process = subprocess.run(
        [program], cwd=program.parent, check=True, capture_output=True, text=True
    )
    lines = [line.split() for line in process.stderr.splitlines()]
    begin, end = (np.array(lines[k], float) for k in (max(1, len(lines) // 5), -1))
    return float((end - begin)[1] / (end - begin)[0])


def rate_of_kernel(number: int, packing: float) -> float:
    """Return the collisions per second of CPU time of the kernel, without the first fifth."""
    side = (number * 4.0 / 3.0 * math.pi / packing) ** (1.0 / 3.0)
    settings = scene_settings({"particles": number, "box": [side] * 3, "effects": {}})
    scene, cells = build(settings, 1.0, -1.0), round((number / 4) ** (1.0 / 3.0))
    corners = np.stack(np.meshgrid(*[np.arange(cells)] * 3), axis=-1).reshape(-1, 1, 3)
    position = (corners + FCC).reshape(-1, 3) * (side / cells)
    velocity = np.random.default_rng(1).standard_normal((number, 3))
    state = new_state(scene, position, velocity - velocity.mean(axis=0), np.zeros((number, 3)))
    advance(scene, state, collisions=COLLISIONS_OF_RUN // 5)
    begin, collisions_before = time.process_time(), state.counts[COLLISIONS]
    advance(scene, state, collisions=4 * COLLISIONS_OF_RUN // 5)
    return float(state.counts[COLLISIONS] - collisions_before) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
