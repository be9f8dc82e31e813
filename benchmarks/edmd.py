"""Speed of the kernel relative to EDMD, in C: elastic smooth spheres at packing 0.2.

    git clone https://github.com/FSmallenburg/EDMD
    python -m benchmarks.edmd EDMD/Single

Compiles EDMD by its Makefile, without a thermostat. EDMD and the kernel run in turns, on one core.
"""

import argparse
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
from roughgas.kernel.state import COLLISIONS
from roughgas.scene import build
from roughgas.scene.initial import initial_state
from roughgas.scene.settings import scene_settings

NUMBERS = (10_976, 97_556)  # four per cell of a crystal
PACKING = 0.2
# simulated time x particles of EDMD; runs; collisions per particle
PARTICLE_TIMES, RUNS, WARM_UP = 50 * 10_976, 5, 3
SETTINGS = {  # of mdSingle.c
    "int initialconfig": "1",
    "double packfrac": f"{PACKING}",
    "const int usethermostat": "0",
}
PRINT_CLOCK = 'fprintf(stderr, "%f %u\\\\n", (double)clock() / CLOCKS_PER_SEC, colcounter);'


def main() -> None:
    """Print a row of the table for each number of particles."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path, help="its folder Single")
    source = parser.parse_args().source
    print("| spheres | roughgas / EDMD | roughgas | EDMD |\n| --- | --- | --- | --- |")
    for number in NUMBERS:
        with tempfile.TemporaryDirectory() as folder:
            program = compile_edmd(source, Path(folder), number)
            rates = [(rate_of_kernel(number), rate_of(program)) for _ in range(RUNS)]
        ours, theirs = (statistics.median(column) for column in zip(*rates, strict=True))
        print(f"| {number:,} | {ours / theirs:.2f} | {ours:.3g} | {theirs:.3g} |", flush=True)


def compile_edmd(source: Path, folder: Path, number: int) -> Path:
    """Compile EDMD for a number of particles, and return the path of the program.

    It prints CPU time and collisions after each unit of time.
    """
    for file in source.iterdir():
        shutil.copy(file, folder)
    code = folder / "mdSingle.c"
    text = "#include <time.h>\n" + code.read_text()
    parameters = {"int N": str(number), "double maxtime": f"{PARTICLE_TIMES / number:.0f}"}
    for name, value in (SETTINGS | parameters).items():
        text, matches = re.subn(rf"^{name} *= *[^;]+;", f"{name} = {value};", text, flags=re.M)
        if matches != 1:
            raise SystemExit(f"{code}: no line sets {name}")
    code.write_text(re.sub(r'^ *printf\("Simtime: ', rf"{PRINT_CLOCK}\n\g<0>", text, flags=re.M))
    subprocess.run(["make", "-s", "-B"], cwd=folder, check=True)
    return folder / "md"


def rate_of(program: Path) -> float:
    """Run EDMD; return its collisions per second of CPU time, without the first fifth."""
    process = subprocess.run(
        [program], cwd=program.parent, check=True, capture_output=True, text=True
    )
    lines = [line.split() for line in process.stderr.splitlines()]
    begin, end = (np.array(lines[k], float) for k in (max(1, len(lines) // 5), -1))
    return float((end - begin)[1] / (end - begin)[0])


def rate_of_kernel(number: int) -> float:
    """Return the collisions per second of CPU time of this kernel, for the same collisions."""
    side = (number * 4.0 / 3.0 * math.pi / PACKING) ** (1.0 / 3.0)
    experiment = scene_settings({"particles": number, "box": [side] * 3, "effects": {}})
    scene = build(experiment, 1.0, -1.0)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    advance(scene, state, collisions=WARM_UP * number)
    begin, collisions_before = time.process_time(), state.counts[COLLISIONS]
    advance(scene, state, collisions=2 * PARTICLE_TIMES)
    return float(state.counts[COLLISIONS] - collisions_before) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
