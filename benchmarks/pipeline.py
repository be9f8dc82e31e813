"""Costs of simulations outside of the kernel: of a job, and of the pipeline.

    python -m benchmarks.pipeline
    python -m benchmarks.pipeline --jobs 500 2000 8000

The first takes some two minutes on two cores, and longer if kernels must be compiled. The second
measures the cost of Snakemake itself: its jobs write empty files in place of points.
"""

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import netCDF4

from roughgas import config

ROOT = Path(__file__).parent.parent
COPIED_PATHS = ("Snakefile", "config.yaml", "rules", "profiles", "src")
CORES = 2
SNAKEMAKE = [sys.executable, "-m", "snakemake", f"-j{CORES}", "--configfile", "fewer.json", "--"]
RUN_COMMAND = "roughgas run"
# in place of `roughgas run ... --output FILES`
EMPTY_POINT = """
while [ "$1" != --output ]; do shift; done
shift
touch "$@"
"""
RUNS = 9
SMALLEST_POINT = ("sheared", "small")  # the point with the fewest collisions in all sweeps
BETAS = ["-0.7", "0", "0.7"]  # a selection from the paper's sweep


class Cost(NamedTuple):
    """Seconds of CPU and wall time outside of the kernel, and CPU seconds of the kernel."""

    cpu: float
    wall: float
    kernel: float


def measure() -> dict[str, float]:
    """Return the cost of a job (s), and the efficiency of the pipeline.

    `job_cpu` and `job_wall`: of a job on the smallest point, without its kernel; medians.
    `pipeline_efficiency`: kernel time over cores x wall time, for a part of the paper's sweeps,
    from the start of Snakemake to the last reduced dataset, with compiled kernels;
    `pipeline_kernel` and `pipeline_wall`: the two times (s); `pipeline_points`: number of points.
    """
    with tempfile.TemporaryDirectory() as folder:
        costs = [cost_of_job(Path(folder)) for _ in range(RUNS + 1)][1:]  # the first may compile
        job = {
            f"job_{name}": statistics.median(getattr(cost, name) for cost in costs)
            for name in ("cpu", "wall")
        }
        return job | efficiency(Path(folder) / "project")


def cost_of_job(folder: Path) -> Cost:
    """Run the smallest point by the command of a rule, writing into `folder`; return its cost."""
    experiment, scale = SMALLEST_POINT
    text = config.load(ROOT / "config.yaml").experiment(experiment, scale).text
    output = folder / "point.nc"
    command = [Path(sys.executable).parent / "roughgas", "run", experiment, f"--scale={scale}"]
    command += ["--r=0.9", "--beta=0", "--seed=1", "--settings", text, "-o", output]
    begin, cpu_before = time.perf_counter(), _cpu_of_children()
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    wall, cpu = time.perf_counter() - begin, _cpu_of_children() - cpu_before
    kernel = _kernel_seconds(output)
    return Cost(cpu - kernel, wall - kernel, kernel)


def efficiency(project: Path) -> dict[str, float]:
    """Return the efficiency of the pipeline on CORES cores, in a copy of the project at `project`:
    see `measure`."""
    copy_project(project)
    experiments = config.load(project / "config.yaml").studies["paper"].experiments
    changes = {"experiments": {name: {"sweep": {"beta": BETAS}} for name in experiments}}
    (project / "fewer.json").write_text(json.dumps(changes))
    configuration = config.load(project / "config.yaml", changes)
    kernels = [
        f"results/paper/{name}/r{r}/compiled.txt"
        for name in experiments
        for r in configuration.experiment(name, "paper").labels("r")
    ]
    _snakemake(project, kernels)
    begin = time.perf_counter()
    _snakemake(project, [f"results/paper/{name}.nc" for name in experiments])
    wall = time.perf_counter() - begin
    points = list(project.glob("results/paper/*/*/*/*.nc"))
    kernel = sum(_kernel_seconds(path) for path in points)
    return {
        "pipeline_points": len(points),
        "pipeline_kernel": kernel,
        "pipeline_wall": wall,
        "pipeline_efficiency": kernel / (CORES * wall),
    }


def scheduling(jobs: int) -> dict[str, float]:
    """Return the cost (s) of Snakemake for a number of jobs that write an empty file each.

    `scheduling_wall` is the time from its start to its end, `scheduling_cpu` the CPU time of its
    process, without its jobs.
    """
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder) / "project"
        copy_project(project)
        (project / "empty.sh").write_text(EMPTY_POINT)
        rules = project / "rules" / "simulate.smk"
        rules.write_text(rules.read_text().replace(RUN_COMMAND, "sh empty.sh"))
        experiment = {"sweep": {"r": ["0.9"], "beta": ["0"], "seeds": jobs}}
        changes = {"seeds_per_job": 1, "experiments": {"sheared": experiment}}
        (project / "fewer.json").write_text(json.dumps(changes))
        _snakemake(project, ["results/paper/sheared/r0.9/compiled.txt"])
        targets = [f"results/paper/sheared/r0.9/beta0/seed{n}.nc" for n in range(1, jobs + 1)]
        begin = time.perf_counter()
        with subprocess.Popen(
            [*SNAKEMAKE, *targets],
            cwd=project,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as process:
            cpu = 0.0
            while process.poll() is None:
                cpu = _cpu_of(process.pid) or cpu
                time.sleep(0.1)
        wall = time.perf_counter() - begin
        empty_points = sum(path.stat().st_size == 0 for path in project.rglob("seed*.nc"))
        if process.returncode or empty_points != jobs:
            sys.exit(f"Snakemake made {empty_points} of {jobs} empty points")
    return {"scheduling_jobs": jobs, "scheduling_cpu": cpu, "scheduling_wall": wall}


def copy_project(project: Path, checkout: Path = ROOT, names: Iterable[str] = COPIED_PATHS) -> None:
    """Copy files and folders of a checkout, given by their names, to the new folder `project`."""
    project.mkdir()
    for name in names:
        if (checkout / name).is_dir():
            shutil.copytree(checkout / name, project / name)
        else:
            shutil.copy2(checkout / name, project)


def _cpu_of(process: int) -> float:
    """Return the CPU seconds of a live process, without its children; 0 if it has ended."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _snakemake(project: Path, targets: list[str]) -> None:
    process = subprocess.run([*SNAKEMAKE, *targets], cwd=project, capture_output=True, text=True)
    if process.returncode:
        sys.exit(process.stdout + process.stderr)


def _cpu_of_children() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _kernel_seconds(path: Path) -> float:
    with netCDF4.Dataset(path) as point:
        return float(point["kernel_seconds"][...])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--jobs", type=int, nargs="+", metavar="N", help="cost of Snakemake itself")
    for measurement in map(scheduling, jobs) if (jobs := parser.parse_args().jobs) else [measure()]:
        for name, value in measurement.items():
            print(f"{name:20}{value:10.3f}", flush=True)
