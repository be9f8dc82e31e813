"""A target for the standard error of R: a run goes on in blocks until the error is that small.

Blocks are whole: after k of them everything is computed anew from the whole run, which has the bits
of one that was asked for k times the length, or k times the replicas, from the start. To stop when
an estimated error is small selects runs whose error is underestimated; looks are therefore few: a
run goes on by as much as its error says, at most to twice its length.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

from roughgas.statistics.errors import LEAST, NO, UNKNOWN, YES

KEY = "target_stderr"  # of a schedule
MOST_BLOCKS = 100  # so that the error falls by a factor of ten
MOST_SAMPLES = 10_000_000  # of all replicas together: they are kept in memory
LENGTHS = ("equilibrate", "measure", "plateau")

Schedule = Mapping[str, Any]


def samples_of(schedule: Schedule) -> float:
    """Return how many samples a schedule makes, but for those of a transient by theory."""
    lengths = sum(schedule[name] for name in LENGTHS if name in schedule)
    return schedule.get("replicas", 1) * lengths / schedule["sample_every"]


def until_met(
    schedule: Schedule,
    key: str,
    run_to: Callable[[Schedule], tuple[dict[str, Any], bool]],
) -> dict[str, Any]:
    """Return the variables of a run that has been prolonged, in `key`, until its target is met.

    `run_to(schedule)` takes the run on to a longer schedule, and returns its variables and whether
    its error rests on enough to stop. Without a target it is called once.
    """
    if KEY not in schedule:
        return run_to(schedule)[0]
    target, blocks = schedule[KEY], 1
    most = max(1, min(MOST_BLOCKS, int(MOST_SAMPLES / samples_of(schedule))))
    while True:
        found, enough = run_to({**schedule, key: blocks * schedule[key]})
        small, error = found["R_stderr"] <= target, found["R_stderr"]
        still = error == 0.0 and found["measured_collisions"] >= LEAST.collisions  # R never changes
        if blocks == most or (small and (enough or still)):
            known = YES if found["R_ci95_trusted"] == YES else UNKNOWN
            return found | {"target_met": known if small else NO, "target_blocks": blocks}
        blocks = min(most, 2 * blocks if small else _wanted(blocks, error / target))


def _wanted(blocks: int, excess: float) -> int:
    """Return how many blocks to go on to, by how many times the error is larger than its target."""
    needed = blocks * excess**2 if math.isfinite(excess) else math.inf
    return max(blocks + 1, min(2 * blocks, math.ceil(min(needed, 2.0 * blocks))))
