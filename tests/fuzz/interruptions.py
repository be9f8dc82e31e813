"""Runs that are disturbed, and what is there afterwards: `python -m tests.fuzz.interruptions`.

--kills: SIGKILL at random moments, of Snakemake, of its children, or of both. --full-disks: a disk
of a random size, which is then enlarged. --edits: config.yaml or a source is edited in the midst of
a run. --pairs: two runs in one folder at once. After each, the same command must end, and all
files must be those of a run that nothing disturbed: datasets to the last bit but for the time that
they took, pictures byte for byte, and no file besides. The exit status is 1 if any are not.

Disks are mounted in a namespace of their own, which takes no rights; where it is not allowed, a
limit on the size of files stands for the disk.
"""

import argparse
import hashlib
import json
import os
import random
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import snakemakes
from bits import digest
from project import Project

FILES = ("results/tiny/cooling.nc", "figures/tiny/fig2b.png")
COMMAND = ("-j2", "--config", "scale=tiny", "--", *FILES)
BETAS = ["-0.5", "0", "0.5"]
LONGEST = 300  # seconds that a run may take
FEW = 8  # kills until what is there is looked at
EDITS = {
    "a comment": ("src/roughgas/scene/initial.py", "\n# a comment\n"),
    "a source": ("src/roughgas/simulation/energies.py", "\nADDED = 1\n"),
    "config.yaml": (None, None),
}


class Disturbed:
    """A project in which a run is disturbed, and what it should come to."""

    def __init__(self, folder):
        self.folder = folder
        (folder / "plain").mkdir(parents=True)
        self.plain = Project(folder / "plain")
        self.plain.configure(_sweep_wider)
        self.expected, self.seconds, self.size = self._reference("reference", None)
        self.edited, *_ = self._reference("edited", _run_longer)
        self.faults = []

    def fresh(self):
        """A project in which nothing has been run."""
        shutil.rmtree(self.folder / "disturbed", ignore_errors=True)
        return self.plain.copy_to(self.folder / "disturbed")

    def check(self, what, project, expected=None):
        """Run the command to its end, and note how the files differ from what they should be."""
        try:
            status, said = project.snakemake(*COMMAND)
            found = contents(project.folder)
        except Exception as error:
            status, said, found = 1, repr(error), {}
        wanted = self.expected if expected is None else expected
        wrong = [
            name for name in wanted.keys() | found.keys() if wanted.get(name) != found.get(name)
        ]
        if status or wrong:
            self.faults.append(f"{what}: exit status {status}, {sorted(wrong)}: {said[-300:]!r}")

    def _reference(self, name, change):
        project = self.plain.copy_to(self.folder / name)
        before = _size_of(project.folder)
        if change:
            project.configure(change)
        begun = time.monotonic()
        project.succeed(*COMMAND)
        took = time.monotonic() - begun
        return contents(project.folder), took, (before, _size_of(project.folder))


class Forked:
    """A run in a fork of this process."""

    def __init__(self, project):
        self.pid = os.fork()
        if not self.pid:
            try:
                place = str(project.folder), project.environment()
                snakemakes.become_snakemake(*place, [*COMMAND], os.devnull)
            finally:
                os._exit(0)  # what this process would clean up is not the child's

    def is_over(self):
        return os.waitpid(self.pid, os.WNOHANG)[0] != 0

    def wait(self):
        os.waitpid(self.pid, 0)


def contents(folder):
    """What is in each file of results and figures, as a digest, by its path."""
    found = {}
    for top in ("results", "figures"):
        for path in (folder / top).rglob("*"):
            if path.is_file():
                read = digest if path.suffix == ".nc" else _bytes_of
                found[str(path.relative_to(folder))] = read(path)
    return found


def _bytes_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _size_of(folder):
    files = (path for path in folder.rglob("*") if path.is_file())
    return 4096 * sum(-(-path.stat().st_size // 4096) for path in files)


def _sweep_wider(config):
    sweep = {"r": ["0.9"], "beta": BETAS, "seeds": 4}
    config["scales"]["tiny"]["cooling"]["sweep"] = sweep
    config["seeds_per_job"] = 2


def _run_longer(config):
    config["scales"]["tiny"]["cooling"]["schedule"]["plateau"] = 25


def kill(disturbed, rng, outcomes):
    """Kill at random moments until a run gets to its end in between, or FEW times."""
    project, kills = disturbed.fresh(), 0
    while kills < FEW:
        whom = rng.choice(["Snakemake", "its children", "both"])
        running = Forked(project)
        time.sleep(rng.uniform(0.1, 1.0) * disturbed.seconds)
        if running.is_over():
            break
        _kill(running, whom)
        outcomes[f"kills of {whom}"] += 1
        kills += 1
    disturbed.check(f"{kills} kills", project)
    return kills


def _kill(running, whom):
    if whom == "both":
        os.killpg(running.pid, signal.SIGKILL)
    elif whom == "Snakemake":
        os.kill(running.pid, signal.SIGKILL)
    else:
        for child in _descendants(running.pid):
            try:
                os.kill(child, signal.SIGKILL)
            except ProcessLookupError:
                pass
    running.wait()


def _descendants(pid):
    parents = {}
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        parents[int(path.parent.name)] = int(fields[1])
    found = {pid}
    while more := {one for one, parent in parents.items() if parent in found} - found:
        found |= more
    return found - {pid}


def fill_disk(disturbed, rng, outcomes):
    """Run on a disk of a random size, then on the same disk once it is larger."""
    before, after = disturbed.size
    room = round(rng.uniform(0.0, 1.3) * (after - before)) + 4096
    project = disturbed.fresh()
    disk = disturbed.folder / "disk"
    disk.mkdir(exist_ok=True)
    again = [sys.executable, "-m", "tests.fuzz.interruptions", "--within", str(disk)]
    script = (
        f"mount -t tmpfs -o size={before + room} none {shlex.quote(str(disk))}"
        f" && cp -r {shlex.quote(str(project.folder))} {shlex.quote(str(disk / 'run'))}"
        f" && exec {shlex.join(again)}"
    )
    command = ["unshare", "--mount", "--map-root-user", "sh", "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=3 * LONGEST)
    try:
        status, found = json.loads(done.stdout.splitlines()[-1])
    except (IndexError, ValueError):
        outcomes["disks that could not be mounted"] += 1
        return _limit_files(disturbed, project, rng, outcomes)
    outcomes["disks that were full" if status else "disks that were large enough"] += 1
    if found != disturbed.expected:
        disturbed.faults.append(f"disk with {room} bytes free: {done.stderr[-300:]!r}")
    return 1


def _within(disk):
    """Run twice on a disk, and print the first exit status and the files."""
    project = Project.__new__(Project)
    project.folder = disk / "run"
    command = [sys.executable, "-m", "snakemake", *COMMAND]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    here = {"cwd": project.folder, "env": project.environment()} | quiet
    first = subprocess.run(command, **here).returncode
    subprocess.run(["mount", "-o", "remount,size=1g", "none", str(disk)], check=True)
    subprocess.run(command, **here, check=True)
    print(json.dumps([first, contents(project.folder)]))


def _limit_files(disturbed, project, rng, outcomes):
    """Run while no file may be larger than some size; then without that limit."""
    largest = max(path.stat().st_size for path in (disturbed.folder / "reference").rglob("*.*"))
    most = rng.randrange(largest)

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

    command = [sys.executable, "-m", "snakemake", *COMMAND]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    here = {"cwd": project.folder, "env": project.environment()} | quiet
    done = subprocess.run(command, **here, preexec_fn=limit, timeout=LONGEST)
    outcomes["runs with a limit: failed" if done.returncode else "runs with a limit: done"] += 1
    disturbed.check(f"files of up to {most} bytes", project)
    return 1


def edit(disturbed, rng, outcomes):
    """Edit a file in the midst of a run, let that end, and run the command again."""
    project, what = disturbed.fresh(), rng.choice(sorted(EDITS))
    running = project.start(*COMMAND)
    time.sleep(rng.uniform(0.2, 1.0) * disturbed.seconds)
    path, text = EDITS[what]
    if path is None:
        project.configure(_run_longer)
    else:
        project.append(path, text)
    running.wait(LONGEST)
    outcomes[f"edits of {what}"] += 1
    disturbed.check(f"edit of {what}", project, None if path else disturbed.edited)
    return 1


def pair(disturbed, rng, outcomes):
    """Start two runs in one folder."""
    project = disturbed.fresh()
    runs = [project.start(*COMMAND)]
    time.sleep(rng.uniform(0.0, 1.0) * disturbed.seconds)
    runs.append(project.start(*COMMAND))
    ends = [run.wait(LONGEST) for run in runs]
    outcomes[f"pairs of which {ends.count(0)} got to the end"] += 1
    disturbed.check("two runs at once", project)
    return 1


WAYS = {"kills": kill, "full_disks": fill_disk, "edits": edit, "pairs": pair}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, way in WAYS.items():
        number = f"--{name.replace('_', '-')}"
        parser.add_argument(number, type=int, default=0, help=way.__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--within", type=Path, help=argparse.SUPPRESS)
    options = vars(parser.parse_args())
    if within := options.pop("within"):
        return _within(within)
    rng = random.Random(options.pop("seed"))
    snakemakes.prepare()
    with tempfile.TemporaryDirectory() as folder:
        disturbed, outcomes = Disturbed(Path(folder)), Counter()
        print(
            f"undisturbed: {disturbed.seconds:.0f} s, {len(disturbed.expected)} files", flush=True
        )
        for name, wanted in options.items():
            done = 0
            while done < wanted:
                done += WAYS[name](disturbed, rng, outcomes)
                so_far = ", ".join(f"{count} {what}" for what, count in sorted(outcomes.items()))
                print(f"{so_far}; faults: {len(disturbed.faults)}", flush=True)
        print("\n".join(disturbed.faults))
        return 1 if disturbed.faults else 0


if __name__ == "__main__":
    sys.exit(main())
