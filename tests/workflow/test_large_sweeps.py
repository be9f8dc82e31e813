"""A large sweep is planned in little memory, and in as many jobs as are asked for."""

import pytest
from benchmarks.sweep import dry_run

pytestmark = pytest.mark.slow
POINTS = 10_000
MEMORY = 0.15 + 4 * POINTS / 100_000  # GiB: what Snakemake takes, and 4 for a hundred thousand


def test_batches_of_betas():
    plan = dry_run(POINTS, betas_per_job=25)
    blocks = {rule: count for rule, count in plan.jobs.items() if "block" in rule}
    assert plan.jobs == blocks | {"compile_kernel": 10, "reduce": 1}
    assert len(blocks) == 10 and set(blocks.values()) == {10}  # each r is a job of the block
    assert plan.memory < MEMORY
