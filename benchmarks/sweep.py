"""Cost of planning a large sweep: time and memory of a dry run.

    python -m benchmarks.sweep 100000
    python -m benchmarks.sweep 100000 --betas-per-job 25

The sweep is over r and beta of the sheared gas, with four seeds; nothing is simulated.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

from roughgas.base.reading import read_yaml

ROOT = Path(__file__).parent.parent
LINKED_PATHS = ("Snakefile", "rules", "profiles", "src", "tests")
EXPERIMENT, SEEDS, BETAS = "sheared", 4, 250


class Plan(NamedTuple):
    """Cost of a dry run: jobs by rule, seconds of CPU and wall time, and peak memory in GiB."""

    jobs: dict[str, int]
    cpu: float
    wall: float
    memory: float


def main() -> None:
    """Plan a sweep, and print a row of the table in docs/cluster.md."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("points", type=int, help="a multiple of 1000")
    parser.add_argument("--betas-per-job", type=int, default=1)
    options = parser.parse_args()
    plan = dry_run(options.points, betas_per_job=options.betas_per_job)
    jobs = sum(plan.jobs.values())
    print(
        f"| {options.points:,} | {options.betas_per_job} | {jobs:,} | {plan.cpu:.0f} s"
        f" | {plan.wall:.0f} s | {plan.memory:.2f} GiB |"
    )


def dry_run(points: int, **settings: Any) -> Plan:
    """Plan a sweep of a number of points, with top-level `settings` of config.yaml."""
    with tempfile.TemporaryDirectory() as folder:
        _write_project(Path(folder), points // (BETAS * SEEDS), settings)
        target = f"results/paper/{EXPERIMENT}.nc"
        command = [sys.executable, "-m", "snakemake", "-n", "--quiet", "rules", "--", target]
        begin = time.monotonic()
        with (
            open(Path(folder) / "output", "w+") as output,
            subprocess.Popen(command, cwd=folder, stdout=output, stderr=output) as process,
        ):
            # peak memory includes that of this process at the fork: it must be small
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            wall = time.monotonic() - begin
            output.seek(0)
            text = output.read()
    if process.returncode:
        raise RuntimeError(text)
    table = text.rsplit("Job stats:", 1)[1].split("total")[0]
    jobs = {rule: int(count) for rule, count in re.findall(r"^(\w+) +(\d+)$", table, re.M)}
    return Plan(jobs, usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 2**20)


def _write_project(folder: Path, restitutions: int, settings: dict[str, Any]) -> None:
    """Write a project with links to this one, and a sweep over a number of values of r."""
    for name in LINKED_PATHS:
        (folder / name).symlink_to(ROOT / name)
    config = read_yaml(ROOT / "config.yaml")
    config |= settings
    del config["experiments"][EXPERIMENT]["betas_per_job"]  # so that `settings` count
    config["experiments"][EXPERIMENT]["sweep"] = {
        "r": [f"{0.6 + 0.39 * step / restitutions:.6g}" for step in range(restitutions)],
        "beta": [f"{-0.95 + 1.95 * step / BETAS:.6g}" for step in range(BETAS)],
        "seeds": SEEDS,
    }
    (folder / "config.yaml").write_text(json.dumps(config))  # JSON is YAML


if __name__ == "__main__":
    main()
