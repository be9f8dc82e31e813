"""A large sweep is planned in little memory, and in as many jobs as are asked for."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent
pytestmark = pytest.mark.slow
POINTS = 10_000
MEMORY = 0.15 + 4 * POINTS / 100_000  # GiB: what Snakemake takes, and 4 for a hundred thousand

PROGRAM = """
import json
from benchmarks.sweep import dry_run
print(json.dumps(dry_run({points}, betas_per_job={betas})))
"""


def planned(points, betas):
    """Jobs by rule, and peak memory, told by a small process: what a large one starts counts the
    memory of that one, too."""
    command = [sys.executable, "-c", PROGRAM.format(points=points, betas=betas)]
    jobs, *_, memory = json.loads(subprocess.check_output(command, cwd=ROOT))
    return jobs, memory


def test_batches_of_betas():
    jobs, memory = planned(POINTS, betas=25)
    blocks = {rule: count for rule, count in jobs.items() if "block" in rule}
    assert jobs == blocks | {"compile_kernel": 10, "reduce": 1}
    assert len(blocks) == 10 and set(blocks.values()) == {10}  # each r is a job of the block
    assert memory < MEMORY
