"""Runs that are prolonged until the standard error of R meets a target.

Such a run is prolonged by blocks. After k blocks all results are recomputed from the total run,
which is bitwise equal to a run of k times the length, or k times the replicas. Stopping at a small
estimated error selects runs whose error is underestimated; the error is therefore tested rarely:
its size determines the next length, which is at most twice the present one.
"""

import math
from collections.abc import Callable

from msgspec.structs import replace

from roughgas.base import NamedValues
from roughgas.simulation.experiment import Schedule
from roughgas.statistics.sample_sizes import MINIMUM_SAMPLE_SIZE, NO, UNKNOWN, YES

TARGET_KEY = "target_stderr"  # of a schedule
BLOCK_LIMIT = 100  # so that the error falls by a factor of ten
SAMPLE_LIMIT = 10_000_000  # summed over replicas: all samples are in memory
LENGTH_KEYS = ("equilibrate", "measure", "plateau")
"""Keys of schedules that are lengths of sampled time."""


def samples_of(schedule: Schedule) -> float:
    """Return the number of samples that a schedule plans, summed over replicas and stages.

    A transient that theory predicts is not included.
    """
    lengths = sum(getattr(schedule, name, 0.0) for name in LENGTH_KEYS)
    samples = getattr(schedule, "replicas", 1) * lengths / schedule.sample_every
    stages = getattr(schedule, "stages", ())
    return samples + sum(stage.samples(schedule.sample_every) for stage in stages)


def prolonged_until_met(
    schedule: Schedule, key: str, run_to: Callable[[Schedule], tuple[NamedValues, bool]]
) -> NamedValues:
    """Prolong a run until R_stderr meets the schedule's target error, and return its variables.

    The length grows by multiples of the schedule's value of `key`, such as `measure` or `replicas`.
    `run_to(schedule)` continues the run to a longer schedule; it returns the variables, and whether
    the evidence for their error suffices to stop. Returns the last variables, and `target_met` and
    `target_blocks`. Without a target, `run_to` is called once.
    """
    if getattr(schedule, TARGET_KEY, None) is None:
        return run_to(schedule)[0]
    target, blocks = getattr(schedule, TARGET_KEY), 1
    most_blocks = max(1, min(BLOCK_LIMIT, int(SAMPLE_LIMIT / samples_of(schedule))))
    while True:
        variables, enough = run_to(replace(schedule, **{key: blocks * getattr(schedule, key)}))
        error = variables["R_stderr"]
        small = error <= target
        collisions = variables["measured_collisions"]
        constant = error == 0.0 and collisions >= MINIMUM_SAMPLE_SIZE.collisions  # R never changes
        if blocks == most_blocks or (small and (enough or constant)):
            verdict = YES if variables["R_ci95_trusted"] == YES else UNKNOWN
            return variables | {"target_met": verdict if small else NO, "target_blocks": blocks}
        blocks = min(
            most_blocks, 2 * blocks if small else _next_block_count(blocks, error / target)
        )


def _next_block_count(blocks: int, excess: float) -> int:
    """Return the number of blocks to prolong a run to, from its present number `blocks`.

    `excess` is the ratio of the present error to the target. The result is at most twice `blocks`.
    """
    required_blocks = blocks * excess**2 if math.isfinite(excess) else math.inf
    return max(blocks + 1, min(2 * blocks, math.ceil(min(required_blocks, 2.0 * blocks))))
