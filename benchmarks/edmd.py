"""The kernel beside another event-driven code in C: spheres at packing 0.2, elastic and smooth.

    git clone https://github.com/FSmallenburg/EDMD
    python -m benchmarks.edmd EDMD/Single

Compiles EDMD as its Makefile says, with its thermostat off; it and the kernel run in turns, on one
core.
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

NUMBERS = (10_976, 97_556)  # four in each cell of a crystal
PACKING = 0.2
UNTIL, RUNS, WARM_UP = 50 * 10_976, 5, 3  # of EDMD: its time, times particles; collisions each
SETTINGS = {  # of mdSingle.c
    "int initialconfig": "1",
    "double packfrac": f"{PACKING}",
    "const int usethermostat": "0",
}
CLOCK = 'fprintf(stderr, "%f %u\\\\n", (double)clock() / CLOCKS_PER_SEC, colcounter);'


def main() -> None:
    """Print a line for each number of particles."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source", type=Path, help="its folder Single")
    source = parser.parse_args().source
    print("| spheres | roughgas / EDMD | roughgas | EDMD |\n| --- | --- | --- | --- |")
    for number in NUMBERS:
        with tempfile.TemporaryDirectory() as folder:
            program = compiled(source, Path(folder), number)
            rates = [(rate_of_kernel(number), rate_of(program)) for _ in range(RUNS)]
        ours, theirs = (statistics.median(column) for column in zip(*rates, strict=True))
        print(f"| {number:,} | {ours / theirs:.2f} | {ours:.3g} | {theirs:.3g} |", flush=True)


def compiled(source: Path, folder: Path, number: int) -> Path:
    """EDMD with so many particles; it writes CPU time and collisions after each unit of time."""
    for file in source.iterdir():
        shutil.copy(file, folder)
    code = folder / "mdSingle.c"
    text = "#include <time.h>\n" + code.read_text()
    chosen = {"int N": str(number), "double maxtime": f"{UNTIL / number:.0f}"}
    for name, value in (SETTINGS | chosen).items():
        text, found = re.subn(rf"^{name} *= *[^;]+;", f"{name} = {value};", text, flags=re.M)
        if found != 1:
            raise SystemExit(f"{code}: no line sets {name}")
    code.write_text(re.sub(r'^ *printf\("Simtime: ', rf"{CLOCK}\n\g<0>", text, flags=re.M))
    subprocess.run(["make", "-s", "-B"], cwd=folder, check=True)
    return folder / "md"


def rate_of(program: Path) -> float:
    """Collisions per second of CPU time, without the first fifth."""
    ran = subprocess.run([program], cwd=program.parent, check=True, capture_output=True, text=True)
    lines = [line.split() for line in ran.stderr.splitlines()]
    begin, end = (np.array(lines[k], float) for k in (max(1, len(lines) // 5), -1))
    return float((end - begin)[1] / (end - begin)[0])


def rate_of_kernel(number: int) -> float:
    """The same of this kernel, as many collisions."""
    side = (number * 4.0 / 3.0 * math.pi / PACKING) ** (1.0 / 3.0)
    experiment = {"particles": number, "box": [side] * 3, "effects": {}}
    scene = build(experiment, 1.0, -1.0)
    state = initial_state(scene, experiment, np.random.default_rng(1))
    advance(scene, state, collisions=WARM_UP * number)
    begin, made = time.process_time(), state.counts[COLLISIONS]
    advance(scene, state, collisions=2 * UNTIL)
    return float(state.counts[COLLISIONS] - made) / (time.process_time() - begin)


if __name__ == "__main__":
    main()
