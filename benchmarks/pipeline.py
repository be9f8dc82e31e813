"""What a simulation costs besides its kernel: one job, and the pipeline as a whole.

    python -m benchmarks.pipeline
    python -m benchmarks.pipeline --jobs 500 2000 8000

The first takes two minutes or so on two cores, and some more where kernels must be compiled before.
The second says what Snakemake itself costs: its jobs write empty files in place of points.
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
from pathlib import Path
from typing import NamedTuple

import netCDF4

from roughgas import config
from roughgas.show.catalogue import shown_in

ROOT = Path(__file__).parent.parent
COPIED = ("Snakefile", "config.yaml", "rules", "profiles", "src")
CORES = 2
SNAKEMAKE = [sys.executable, "-m", "snakemake", f"-j{CORES}", "--configfile", "fewer.json", "--"]
POINT = "roughgas run"
# in place of `roughgas run ... --output FILES`
EMPTY_POINT = """
while [ "$1" != --output ]; do shift; done
shift
touch "$@"
"""
RUNS = 9
SMALLEST = ("sheared", "small")  # with fewer collisions than any other point that is swept
BETAS = ["-0.7", "0", "0.7"]  # those of the paper's sweep that stand for all


class Cost(NamedTuple):
    """Seconds of CPU and of the clock that something takes besides its kernel, and its kernel's."""

    cpu: float
    wall: float
    kernel: float


def measure() -> dict[str, float]:
    """The cost of a job and the efficiency of the pipeline, in seconds and as a share.

    `job_cpu` and `job_wall`: of a job on the smallest point besides its kernel, medians.
    `pipeline_efficiency`: time in the kernel over cores x wall time, for a part of the sweeps of
    the paper's figures, from the start of Snakemake to the last reduced dataset, kernels compiled
    before; `pipeline_kernel` and `pipeline_wall` are what it is made of, `pipeline_points` how
    many.
    """
    with tempfile.TemporaryDirectory() as folder:
        costs = [cost_of_job(Path(folder)) for _ in range(RUNS + 1)][1:]  # the first may compile
        job = {
            f"job_{name}": statistics.median(getattr(cost, name) for cost in costs)
            for name in ("cpu", "wall")
        }
        return job | efficiency(Path(folder) / "project")


def cost_of_job(folder: Path) -> Cost:
    """Run the smallest point as a rule runs it, writing into `folder`."""
    experiment, scale = SMALLEST
    settings = config.experiment(config.load(ROOT / "config.yaml"), experiment, scale)
    text, output = config.as_text(config.point_settings(settings)), folder / "point.nc"
    command = [Path(sys.executable).parent / "roughgas", "run", experiment, f"--scale={scale}"]
    command += ["--r=0.9", "--beta=0", "--seed=1", "--settings", text, "--checked", "-o", output]
    begin, spent = time.perf_counter(), _cpu_of_children()
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    wall, cpu = time.perf_counter() - begin, _cpu_of_children() - spent
    kernel = _kernel_seconds(output)
    return Cost(cpu - kernel, wall - kernel, kernel)


def efficiency(project: Path) -> dict[str, float]:
    """How much of `CORES` cores the kernel has in a copy of the project at `project`."""
    copy(project)
    shown = shown_in("paper")
    fewer = {"experiments": {name: {"sweep": {"beta": BETAS}} for name in shown}}
    (project / "fewer.json").write_text(json.dumps(fewer))
    everything = config.load(project / "config.yaml", fewer)
    kernels = [
        f"results/paper/{name}/r{r}/compiled.txt"
        for name in shown
        for r in config.experiment(everything, name, "paper")["sweep"]["r"]
    ]
    _snakemake(project, kernels)
    begin = time.perf_counter()
    _snakemake(project, [f"results/paper/{name}.nc" for name in shown])
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
    """What Snakemake's own process takes, in seconds of CPU, for so many jobs of one point each.

    `scheduling_wall` is the time from its start to its end, `scheduling_cpu` that of its process
    without its jobs, which write empty files.
    """
    with tempfile.TemporaryDirectory() as folder:
        project = Path(folder) / "project"
        copy(project)
        (project / "empty.sh").write_text(EMPTY_POINT)
        rules = project / "rules" / "simulate.smk"
        rules.write_text(rules.read_text().replace(POINT, "sh empty.sh"))
        one = {"sweep": {"r": ["0.9"], "beta": ["0"], "seeds": jobs}}
        fewer = {"seeds_per_job": 1, "experiments": {"sheared": one}}
        (project / "fewer.json").write_text(json.dumps(fewer))
        _snakemake(project, ["results/paper/sheared/r0.9/compiled.txt"])
        targets = [f"results/paper/sheared/r0.9/beta0/seed{n}.nc" for n in range(1, jobs + 1)]
        begin = time.perf_counter()
        with subprocess.Popen(
            [*SNAKEMAKE, *targets],
            cwd=project,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as running:
            cpu = 0.0
            while running.poll() is None:
                cpu = _cpu_of(running.pid) or cpu
                time.sleep(0.1)
        wall = time.perf_counter() - begin
        made = sum(path.stat().st_size == 0 for path in project.rglob("seed*.nc"))
        if running.returncode or made != jobs:
            sys.exit(f"Snakemake made {made} of {jobs} empty points")
    return {"scheduling_jobs": jobs, "scheduling_cpu": cpu, "scheduling_wall": wall}


def copy(project: Path) -> None:
    """Make a copy of the project."""
    project.mkdir()
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, project / name)
        else:
            shutil.copy2(ROOT / name, project)


def _cpu_of(process: int) -> float:
    """Seconds of CPU of a process that is alive, without its children; 0 of one that has ended."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _snakemake(project: Path, targets: list[str]) -> None:
    done = subprocess.run([*SNAKEMAKE, *targets], cwd=project, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)


def _cpu_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _kernel_seconds(path: Path) -> float:
    with netCDF4.Dataset(path) as point:
        return float(point["kernel_seconds"][...])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--jobs", type=int, nargs="+", metavar="N", help="cost of Snakemake itself")
    for found in map(scheduling, jobs) if (jobs := parser.parse_args().jobs) else [measure()]:
        for name, value in found.items():
            print(f"{name:20}{value:10.3f}", flush=True)
