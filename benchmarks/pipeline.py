"""What a simulation costs besides its kernel: one job, and the pipeline as a whole.

    python -m benchmarks.pipeline

Two minutes or so on two cores, and some more where kernels must be compiled before.
"""

import json
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
    project.mkdir()
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, project / name)
        else:
            shutil.copy2(ROOT / name, project)
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


def _snakemake(project: Path, targets: list[str]) -> None:
    command = [sys.executable, "-m", "snakemake", f"-j{CORES}", "--configfile", "fewer.json", "--"]
    done = subprocess.run([*command, *targets], cwd=project, capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)


def _cpu_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _kernel_seconds(path: Path) -> float:
    with netCDF4.Dataset(path) as point:
        return float(point["kernel_seconds"][...])


if __name__ == "__main__":
    for name, value in measure().items():
        print(f"{name:20}{value:10.3f}")
