"""Blocks of points that jobs make, and the run time and memory that jobs request on a cluster.

The attempt counts from 1; Snakemake repeats a failed job with more time and memory.
"""

import math
import re
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from roughgas.config import Configuration
from roughgas.workflow.paths import NAME, POINT, alternatives

COLLISIONS_PER_SECOND = 2e5
"""Of a slow core: a few times less than measured on ours."""
SHORT_SWEEP = 1e7
"""Collisions of a sweep whose points at all r a job makes: some seven seconds of a quick core."""
COLLISIONS_OF_POINT = 1e4
"""Collisions in the time that a point takes apart from these: writing its file."""
OVERHEAD = 5.0
"""Minutes of a job apart from collisions: starting, loading a kernel, writing."""
MEGABYTES, MEGABYTES_PER_PARTICLE = 700.0, 0.005
"""Memory of a process with its libraries, and of a particle with its events and replicas."""


class Block(NamedTuple):
    """Output of a job: points of an experiment, or of each variant, at any r or at several.

    `name` is the name of its rule, `outputs` the paths of the points with wildcards, `log` the end
    of the path of its log, `constraints` the regular expressions of the wildcards. `at_each_r` has
    the value of r that no wildcard gives, by name, for each r.
    """

    name: str
    outputs: list[str]
    log: str
    constraints: Mapping[str, str]
    at_each_r: tuple[Mapping[str, str], ...] = ({},)


def blocks(
    configuration: Configuration, scale: str, last: str, is_short: Callable[[str], bool]
) -> Iterator[Block]:
    """Yield the blocks of all sweeps at a scale, and finally a block of any single point.

    The number of outputs of a rule is fixed, and sweeps differ in seeds, so each block has a rule.
    A job for each seed would make the paper take a third longer, since starting a process takes as
    long as some points. A job makes the points at all r of an experiment, given by its name, that
    `is_short`. The names, EXPERIMENT_block1 and so on, do not depend on other experiments. `last`
    is the experiment that runs last.

    Each point matches only one rule: Snakemake would otherwise create a job by each rule for each
    file before it chooses. Constraints look ahead in the path: `experiment` at r, `scale` at all of
    it.
    """
    sizes = configuration.betas_per_job, configuration.seeds_per_job
    points_in_blocks = ["(?!)"]  # matches no point
    for experiment in configuration.experiments:
        written = configuration.experiment(experiment, scale)
        variants = alternatives(written.variants(experiment))
        labels_of_r = alternatives(written.labels("r"))
        short = len(written.labels("r")) > 1 and is_short(experiment)
        divided = written.blocks(*sizes, last=experiment == last, is_short=short)
        for number, block in enumerate(divided, start=1):
            r, betas, seeds = block
            constraints = {
                "scale": re.escape(scale),
                "experiment": f"(?:{variants})(?=/r(?:{labels_of_r})/)",
                "beta": alternatives(written.labels("beta") if betas == ["{beta}"] else betas),
            }
            yield Block(
                f"{experiment}_block{number}",
                [
                    POINT.replace("{r}", label).replace("{beta}", beta).replace("{seed}", seed)
                    for label, beta, seed in block.points
                ],
                f"r{_span(r, 'to')}/beta{_span(betas, 'to')}/seeds{_span(seeds, '-')}",
                constraints,
                ({},) if r == ["{r}"] else tuple({"r": label} for label in r),
            )
            points_in_blocks.append(_points(constraints | {"r": NAME, "seed": alternatives(seeds)}))
    elsewhere = f"(?!{'|'.join(points_in_blocks)}){NAME}"
    yield Block("point", [POINT], "r{r}/beta{beta}/seed{seed}", {"scale": elsewhere})


def _span(labels: list[str], between: str) -> str:
    """Return the first and the last label, with `between`, for the name of a log.

    A single r or beta stands alone; `between` is "to" for these, "-" for seeds.
    """
    if len(labels) == 1 and between == "to":
        return labels[0]
    return f"{labels[0]}{between}{labels[-1]}"


def _points(constraints: Mapping[str, str]) -> str:
    """Return the regular expression of the paths of points, from the scale on.

    `constraints` are the regular expressions of all wildcards.
    """
    path = POINT.format(**{name: f"(?:{pattern})" for name, pattern in constraints.items()})
    return path.removeprefix("results/")


def minutes(collisions: float, attempt: int) -> int:
    """Return the limit of a job's run time in minutes, the estimate times the attempt.

    `collisions` is an estimate of the collisions of all its points.
    """
    return math.ceil((OVERHEAD + collisions / COLLISIONS_PER_SECOND / 60.0) * attempt)


def megabytes(particles: int, attempt: int) -> int:
    """Return the memory that a job requests in MB, the estimate times the attempt.

    `particles` is the number of particles of the gas.
    """
    return math.ceil((MEGABYTES + MEGABYTES_PER_PARTICLE * particles) * attempt)
