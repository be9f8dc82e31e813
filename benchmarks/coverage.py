"""Coverage of trusted intervals of R, in this checkout and in another one: are verdicts right?

    git worktree add ../before COMMIT
    python -m benchmarks.coverage ../before [--jobs 2] [--scenes "bed, N=40"] [--only theirs]

Each checkout simulates the scenes of coverage.yaml in separate processes, with the same settings
and seeds. Among runs called trusted (`R_ci95_trusted` is 1), and among runs that met
their target (`target_met` is 1), the interval R ± `R_ci95` should hold the truth in 95 %: a verdict
must not select lucky runs. The runs are stored in a folder, and a second call simulates only those
missing. Prints tables, which --document writes into docs/trust.md. --pilot prints memories and
target errors for the scenes of coverage.yaml.
"""

import argparse
import hashlib
import inspect
import itertools
import json
import math
import os
import subprocess
import sys
import zlib
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from benchmarks.coverage_tables import (
    COLUMNS,
    OURS,
    THEIRS,
    Comparison,
    Runs,
    Scene,
    tables_of,
    truth_of,
)
from roughgas.simulation.error_target import TARGET_KEY

ROOT = Path(__file__).parent.parent
PLAN, PAGE = Path(__file__).with_suffix(".yaml"), ROOT / "docs" / "trust.md"
BEGIN, END = "<!-- coverage: made by benchmarks/coverage.py -->\n", "<!-- until here -->\n"
TRUTH, LENGTH, TARGET, PILOT = "truth", "length", "target", "pilot"
SETTINGS = ("particles", "box", "effects", "species")
TARGET_LENGTH = 25  # memories of a run whose error is the target


class Task(NamedTuple):
    """Runs of a scene with the same schedule, for instance of 20 memories: kind `length`, 20."""

    scene: str
    kind: str
    number: float  # memories in the measurement, or in its first block; T of a pilot run
    settings: dict[str, Any]
    r: float
    beta: float
    seeds: list[int]

    @property
    def path(self) -> Path:
        """Path of the file of the runs, in the folder of a checkout."""
        words = "".join(c if c.isalnum() or c in "-=." else "_" for c in self.scene)
        return Path(words) / f"{self.kind}_{self.number:g}.json"

    def record(self) -> dict[str, Any]:
        """Return the task as it is read back from JSON."""
        return json.loads(json.dumps(self._asdict()))


# ------------------------------------------------------------------------------------------ tasks


def tasks_of(name: str, plan: Mapping[str, Any]) -> list[Task]:
    """Return the tasks of a scene: the truth, runs of each length, and runs to the target."""
    scene = plan["scenes"][name]
    seeds, truth = scene.get("seeds", plan["seeds"]), scene.get("truth", plan["truth"])
    target = {TARGET_KEY: scene["target_stderr"]}
    lengths = plan["lengths" + gravity_suffix(scene)]
    return [
        task_of(plan, name, TRUTH, truth["memories"], truth["seeds"]),
        *(task_of(plan, name, LENGTH, length, seeds) for length in lengths),
        *(task_of(plan, name, TARGET, block, seeds, target) for block in plan["blocks"]),
    ]


def task_of(
    plan: Mapping[str, Any],
    name: str,
    kind: str,
    number: float,
    seeds: int,
    target: Mapping[str, float] | None = None,
) -> Task:
    """Return a task with a measurement of whole periods, and with unique seeds."""
    scene = plan["scenes"][name]
    schedule, memory = scene["schedule"], 1.0 if kind == PILOT else scene["memory"]
    unit = schedule.get("period", schedule["sample_every"])
    measure = unit * max(1, round(number * memory / unit))
    settings = {key: scene[key] for key in SETTINGS if key in scene}
    settings["schedule"] = {"kind": "steady", **schedule, "measure": measure, **(target or {})}
    key = zlib.crc32(f"{name} {kind} {number:g}".encode())
    seed_words = np.random.SeedSequence([plan["seed"], key]).generate_state(seeds, "u8") >> 1
    r, beta = float(scene["r"]), float(scene["beta"])
    return Task(name, kind, number, settings, r, beta, seed_words.tolist())


def gravity_suffix(scene: Mapping[str, Any]) -> str:
    """Return the suffix of the plan's keys for a scene: scenes with gravity have their keys."""
    return "_under_gravity" if "gravity" in scene["effects"] else ""


# ------------------------------------------------------------------------------------------- runs


def measure() -> None:
    """Simulate the tasks in the lines of input, in the checkout in the current folder."""
    import json
    import sys
    import time

    from roughgas.config import experiment_of
    from roughgas.scene import build
    from roughgas.simulation.point import run_point

    names = ["R", "R_stderr", "R_dof", "R_ci95", "R_ci95_trusted", "equilibrated", "measured_from"]
    names += ["target_met", "target_blocks", "autocorrelation_time", "memory_of_R", "collisions"]
    for line in sys.stdin:
        task = json.loads(line)
        _, _, settings = experiment_of(None, task["settings"])
        scene, begin = build(settings, task["r"], task["beta"]), time.process_time()
        points = [run_point(scene, settings, seed).variables for seed in task["seeds"]]
        runs = {name: [float(point.get(name, "nan")) for point in points] for name in names}
        seconds = time.process_time() - begin
        print(json.dumps({"runs": runs, "seconds": seconds}), flush=True)


# read at import: the file may change while processes start
PROGRAM = f"{inspect.getsource(measure)}\nmeasure()"


class Checkout(NamedTuple):
    """A checkout, ours or theirs, and the folder with the runs of both."""

    side: str
    path: Path
    folder: Path

    def file(self, task: Task) -> Path:
        """Return the path of the runs of a task; both checkouts share the truth."""
        return self.folder / (TRUTH if task.kind == TRUTH else self.side) / task.path

    def stored(self, task: Task) -> dict[str, Any]:
        """Return the content of the file of a task; empty if there is none, or of another task."""
        path = self.file(task)
        content = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        return content if content.get("task") == task.record() else {}

    def runs(self, task: Task) -> Runs | None:
        """Return the stored runs of a task; None without any."""
        content = self.stored(task)
        if not content:
            return None
        variables = {name: np.array(values) for name, values in content["runs"].items()}
        return Runs(task.number, task.settings["schedule"]["measure"], variables)

    def sources(self) -> str:
        """Return a digest of the sources of the package."""
        files = sorted((self.path / "src" / "roughgas").rglob("*.py"))
        return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()

    def missing(self, tasks: Sequence[Task]) -> list[Task]:
        """Return the tasks without stored runs by the present sources; for the truth any sources
        will do."""
        sources, stored = self.sources(), [self.stored(task) for task in tasks]
        stored_flags = [
            bool(content) and (task.kind == TRUTH or content["sources"] == sources)
            for task, content in zip(tasks, stored, strict=True)
        ]
        return [task for task, is_stored in zip(tasks, stored_flags, strict=True) if not is_stored]

    def simulate(self, tasks: Sequence[Task], report: Callable[[str], None]) -> None:
        """Simulate the missing tasks, one after the other, in a process."""
        sources, missing = self.sources(), self.missing(tasks)
        if not missing:
            return
        with self._process() as process:
            assert process.stdin and process.stdout
            for task in missing:
                print(json.dumps(task.record()), file=process.stdin, flush=True)
                line = process.stdout.readline()
                if not line:
                    raise SystemExit(f"{self.side}, {task.scene}: ended early, see above")
                content = {"task": task.record(), "sources": sources, **json.loads(line)}
                _write(self.file(task), json.dumps(content))
                words = f"{task.kind} {task.number:g}, {len(task.seeds)} runs"
                report(f"{self.side}: {task.scene}: {words}, {content['seconds']:.1f} s")

    def _process(self) -> subprocess.Popen[str]:
        environment = os.environ | {"PYTHONPATH": str(self.path / "src")}
        command, pipe = [sys.executable, "-c", PROGRAM], subprocess.PIPE
        return subprocess.Popen(
            command, cwd=self.path, env=environment, stdin=pipe, stdout=pipe, text=True
        )


def _write(path: Path, text: str) -> None:
    """Write a file atomically."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(".unfinished")
    unfinished.write_text(text, encoding="utf-8")
    unfinished.replace(path)


def simulate(checkouts: Sequence[Checkout], tasks: Mapping[str, Sequence[Task]], jobs: int) -> None:
    """Simulate the tasks of all scenes in all checkouts, in `jobs` parallel processes."""
    missing = [len(checkout.missing(scene)) for checkout in checkouts for scene in tasks.values()]
    numbers = itertools.count(1)

    def report(words: str) -> None:
        print(f"[{next(numbers)}/{sum(missing)}] {words}", file=sys.stderr, flush=True)

    with ThreadPoolExecutor(jobs) as pool:
        for checkout in checkouts:  # one after the other: the second reuses the truth
            list(pool.map(checkout.simulate, tasks.values(), itertools.repeat(report)))


def scenes_of(
    checkout: Checkout, tasks: Mapping[str, Sequence[Task]], plan: Mapping[str, Any]
) -> dict[str, Scene]:
    """Return the scenes, by name, with a truth and with some runs in the folder."""
    scenes = {}
    for name, scene_tasks in tasks.items():
        kinds: dict[str, list[Runs]] = {TRUTH: [], LENGTH: [], TARGET: []}
        for task in scene_tasks:
            if runs := checkout.runs(task):
                kinds[task.kind].append(runs)
        if kinds[TRUTH] and (kinds[LENGTH] or kinds[TARGET]):
            settings = plan["scenes"][name]
            min_memories = plan["criteria"]["memories" + gravity_suffix(settings)]
            truth = truth_of(*kinds[TRUTH])
            scenes[name] = Scene(
                settings["memory"], min_memories, truth, kinds[LENGTH], kinds[TARGET]
            )
    return scenes


# ----------------------------------------------------------------------------------------- command


def main() -> None:
    """Simulate the missing runs, and print the tables."""
    plan = yaml.safe_load(PLAN.read_text(encoding="utf-8"))
    options = arguments(list(plan["scenes"]))
    paths = {THEIRS: options.other.resolve(), OURS: ROOT}
    checkouts = {
        side: Checkout(side, path, options.folder.resolve()) for side, path in paths.items()
    }
    if options.pilot:
        for name in options.scenes:
            print_pilot(checkouts[OURS], task_of(plan, name, PILOT, plan["pilot"], 1))
        return
    tasks = {name: tasks_of(name, plan) for name in options.scenes}
    if not options.table:
        sides = [options.only] if options.only else list(COLUMNS)
        simulate([checkouts[side] for side in sides], tasks, options.jobs)
    scenes = {side: scenes_of(checkouts[side], tasks, plan) for side in COLUMNS}
    warn_of_other_sources(checkouts, tasks)
    text = tables_of(Comparison(scenes, plan["criteria"]))
    print(text, end="")
    if options.document:
        document(text)


def arguments(scenes: list[str]) -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("other", type=Path, help="a checkout of another commit")
    parser.add_argument("--folder", type=Path, default=ROOT / "results" / "verdicts")
    parser.add_argument("--jobs", type=int, default=1, help="processes at a time")
    parser.add_argument("--scenes", nargs="+", choices=scenes, default=scenes, metavar="SCENE")
    parser.add_argument("--only", choices=(OURS, THEIRS), help="simulate in one checkout only")
    parser.add_argument("--table", action="store_true", help="simulate nothing")
    parser.add_argument("--document", action="store_true", help="write into docs/trust.md")
    parser.add_argument("--pilot", action="store_true", help="one long run of each scene instead")
    options = parser.parse_args()
    if not (options.other / "src" / "roughgas").is_dir():
        parser.error(f"{options.other} is not a checkout")
    if options.jobs < 1:
        parser.error(f"--jobs = {options.jobs}: must be 1 at least")
    return options


def warn_of_other_sources(
    checkouts: Mapping[str, Checkout], tasks: Mapping[str, Sequence[Task]]
) -> None:
    """Warn of runs in the tables that are by other sources than a checkout has now."""
    for side, checkout in checkouts.items():
        stale = [task for scene in tasks.values() for task in checkout.missing(scene)]
        if number := sum(bool(checkout.stored(task)) for task in stale):
            words = f"{number} files are by other sources than the checkout now has"
            print(f"{side}: {words}", file=sys.stderr)


def print_pilot(checkout: Checkout, task: Task) -> None:
    """Simulate a long run of a scene, and print its memory (T) and the error of its target."""
    checkout.simulate([task], lambda words: None)
    runs = checkout.runs(task)
    assert runs
    memory, stderr = float(runs["autocorrelation_time"][0]), float(runs["R_stderr"][0])
    target = stderr * math.sqrt(runs.measure / (TARGET_LENGTH * memory))
    print(f"{task.scene}: memory: {memory:.2g}, target_stderr: {target:.2g}", flush=True)


def document(text: str) -> None:
    """Write the tables into docs/trust.md, between the two marks."""
    text_before, remainder = PAGE.read_text(encoding="utf-8").split(BEGIN)
    _, text_after = remainder.split(END)
    PAGE.write_text(text_before + BEGIN + text + END + text_after, encoding="utf-8")


if __name__ == "__main__":
    main()
