"""The memory of a point does not grow with its replicas, which are simulated one after the other.

Its checkpoint grows by the samples of finished replicas only.
"""

import json
import subprocess
import sys

import pytest
from robustness.conftest import environment

from roughgas.base import sorted_json
from roughgas.data.point import read_point
from roughgas.simulation.checkpoint import INTERVAL_VARIABLE

pytestmark = pytest.mark.slow

FEW_REPLICAS, MANY_REPLICAS = 2, 96
MEMORY_RATIO, SAMPLES_RATIO = 1.2, 1.1
"""Limits on the memory of many replicas over few, and on bytes of their samples over expected."""
NUMBERS_PER_SAMPLE = 5
"""Numbers per sample of a finished replica: two energies, their exponent, collisions and time."""
SCHEDULE = {"kind": "cooling", "thermalise": 0.5, "relaxation_times": 0, "plateau": 2}
SCHEDULE |= {"sample_every": 0.1}
GAS = {"particles": 20_000, "box": [400, 400], "effects": {"spin": {"inertia": 0.5}}}
SCRIPT = """
import json, resource, sys
from roughgas.cli import main
from roughgas.simulation.checkpoint import Checkpoint

kept, contents, files = Checkpoint.write, [], []

def write(self, content):
    kept(self, content)
    contents.append(sum(array.nbytes for array in content.values()))
    files.append(self.path.stat().st_size)

Checkpoint.write = write
assert main(sys.argv[1:]) == 0
peak = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(json.dumps([peak, contents[-1], files[-1], len(files)]))
"""


def measured(folder, replicas, seconds):
    """Measure a process that simulates a point: peak memory, bytes of the arrays in its last
    checkpoint and of that file, number of checkpoints."""
    settings = sorted_json(GAS | {"schedule": SCHEDULE | {"replicas": replicas}})
    line = ["run", "gas", "--r=0.9", "--beta=0.3", "--settings", settings]
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, *line, "-o", f"{replicas}.nc"],
        cwd=folder,
        env=environment(**{INTERVAL_VARIABLE: seconds}),
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


def test_memory_and_checkpoints_do_not_grow_with_replicas_but_by_samples(tmp_path):
    measured(tmp_path, FEW_REPLICAS, "0.5")  # compiles the kernel
    of_few, of_many = (
        measured(tmp_path, FEW_REPLICAS, "0.5"),
        measured(tmp_path, MANY_REPLICAS, "5"),
    )
    samples = read_point(tmp_path / f"{MANY_REPLICAS}.nc").sizes["sample"]
    of_samples = 8 * NUMBERS_PER_SAMPLE * samples * (MANY_REPLICAS - FEW_REPLICAS)
    for replicas, (peak, content, file, writings) in zip(
        (FEW_REPLICAS, MANY_REPLICAS), (of_few, of_many), strict=True
    ):
        print(
            f"{replicas} replicas: {peak / 2**20:.1f} MiB, {writings} checkpoints, "
            f"the last one of {content} bytes in arrays, {file} in all"
        )
    print(f"samples of {MANY_REPLICAS - FEW_REPLICAS} replicas: {of_samples} bytes")
    assert of_many[0] < MEMORY_RATIO * of_few[0]
    assert of_many[3] > 3
    assert of_many[1] - of_few[1] < SAMPLES_RATIO * of_samples
