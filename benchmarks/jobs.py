"""CPU time of `roughgas run` in this checkout and in another one, in turns.

    git worktree add ../before COMMIT
    python -m benchmarks.jobs ../before sheared --r 0.9 --beta -1:1:0.1
    python -m benchmarks.jobs --turns 4 ../before

The arguments after the other checkout are for `roughgas run`, without --seed: each turn has another
seed. Without any, it is the CPU time of the workflow that makes the figures at the scale `small`,
with compiled kernels. Prints the median of the ratios of both in a turn, and their quartiles.
"""

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.pipeline import COPIED_PATHS, copy_project

ROOT = Path(__file__).parent.parent
FIGURES = [sys.executable, "-m", "snakemake", "-j2", "figures", "--config", "scale=small"]


def main() -> None:
    """Print the ratio of the CPU times, and the median time of each checkout."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--turns", type=int, default=16)
    parser.add_argument("other", type=Path, help="a checkout of another commit")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, help="of `roughgas run`")
    options = parser.parse_args()
    if not (options.other / "src" / "roughgas").is_dir():
        parser.error(f"{options.other} is not a checkout")
    checkouts = ROOT, options.other.resolve()
    for checkout in checkouts:  # compile
        cpu_time(checkout, options.arguments, 1)
    times = []
    for seed in range(1, options.turns + 1):
        order = checkouts if seed % 2 else checkouts[::-1]
        by_checkout = {path: cpu_time(path, options.arguments, seed) for path in order}
        times.append([by_checkout[path] for path in checkouts])
    low, ratio, high = statistics.quantiles([ours / theirs for ours, theirs in times], n=4)
    ours, theirs = (statistics.median(column) for column in zip(*times, strict=True))
    print("| ratio | quartiles | CPU s | of the other |\n|" + " --- |" * 4)
    print(f"| {ratio:.3f} | {low:.3f} to {high:.3f} | {ours:.3g} | {theirs:.3g} |")


def cpu_time(checkout: Path, arguments: list[str], seed: int) -> float:
    """Return the CPU time (s) of a run in an empty folder, with the sources of a checkout.

    Without arguments it is the CPU time of the workflow. Raises SystemExit if it fails.
    """
    command, names = FIGURES, (*COPIED_PATHS, "studies")
    if arguments:
        command = [sys.executable, "-P", "-m", "roughgas", "run", *arguments, "--seed", str(seed)]
        names = ("src",)
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder) / "project"
        copy_project(project, checkout, names)
        environment = os.environ | {"PYTHONPATH": str(project / "src")}
        cpu_before = _cpu_of_children()
        run = subprocess.run(command, cwd=project, env=environment, capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(f"{checkout}: {run.stderr}")
    return _cpu_of_children() - cpu_before


def _cpu_of_children() -> float:
    """Return the CPU time (s) of all child processes that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


if __name__ == "__main__":
    main()
