"""Recorders of outputs that depend on settings: each takes an empty work folder, and returns texts
by item.

They use commands and the workflow, as a rebuild may move functions; only `settings` calls functions
that a rebuild may have to replace here.
"""

import contextlib
import hashlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from unittest import mock

import netCDF4
import numpy as np
from tests.bits import CLOCKS

from roughgas import cli, config, steps
from roughgas.base import InputError, sorted_json

ROOT = Path(__file__).parents[2]
CONFIGURATIONS = ("config.yaml",)
SCALES = ("small", "paper")
JOBS = Path(__file__).with_name("jobs.py")
UNSTABLE_ATTRIBUTES = (
    "roughgas_version",
    "numpy_version",
    "kernel_source_hash",
    "source",
    "history",
)
"""Attributes that change with versions, or with any edit of a kernel."""
TIMED_STEM = "run_times"
"""Start of the names of products that contain run times."""
TEXT_SUFFIXES = (".csv", ".html", ".json", ".md", ".txt", ".yaml")
STEADY = {"kind": "steady", "equilibrate": 20, "measure": 400, "sample_every": 0.5}
COOLING = {"kind": "cooling", "replicas": 4, "thermalise": 2, "relaxation_times": 2}
COOLING |= {"plateau": 20, "sample_every": 1}
STAGES = {"kind": "stages", "sample_every": 0.5}
STAGES["stages"] = [
    {"duration": 20, "effects": {"thermostat": {"power": 2.0}}},
    {"duration": 60, "measure": True},
]
BOX_OBSERVABLES = ("cumulants", "histograms", "spin_correlation", "pair_correlation", "stress")
BOX_OBSERVABLES += ("heat_flux", "local_flow", "contacts", "mean_square_displacement")
BOX_OBSERVABLES += ("autocorrelation", "flux_autocorrelation")
ILLEGAL_TARGETS = (
    ("results/paper/cooling/r1.5/beta0/seed1.nc",),
    ("results/paper/cooling/r0.9/beta2/seed1.nc",),
    ("results/paper/heating/r0.9/beta0/seed1.nc",),
    ("results/large/cooling.nc",),
    ("figures/fig9.png",),
    ("figures/movies/flow.gif",),
    ("figg2a",),
    ("--config", "n_particles=5"),
    ("--config", "scale=large"),
    ("--config", "experiments={cooling: {particles: 100000}}"),
)


# ---------------------------------------------------------------------- settings


def settings(folder):
    """Record the settings of every experiment and variant at every scale, as in rules and datasets;
    the settings of its kernels, its sweep, and the complete configuration of a scale."""
    texts = {}
    for path in CONFIGURATIONS:
        configuration = config.load(ROOT / path)
        for scale in configuration.scales:
            for name in configuration.experiments:
                texts |= settings_of(configuration, f"{path}/{scale}", name, scale)
            output = folder / "config.yaml"
            arguments = ["effective_config", str(ROOT / path), "--scale", scale, "-o", str(output)]
            output_of_step = output_of(steps.main, arguments)
            texts[f"{path}/{scale}: complete"] = output_of_step + output.read_text("utf-8")
            output.unlink()
    return texts


def settings_of(configuration, prefix, name, scale):
    """Return the texts of an experiment of a configuration."""
    experiment = configuration.experiment(name, scale)
    texts = {
        f"{prefix}/{name}: experiment": sorted_json(experiment.raw),
        f"{prefix}/{name}: kernels": experiment.kernel_text,
    }
    for variant, variant_experiment in experiment.every_variant(name).items():
        texts[f"{prefix}/{variant}"] = variant_experiment.text
    return texts


# ---------------------------------------------------------------------- refusals


def refusals(folder):
    """Record the messages of all rows of refusals.txt, and of Snakemake for illegal targets."""
    from tests.test_refusals import NAMES, ROWS

    texts = {call: refusal_of(call, NAMES) for call, _ in ROWS}
    return texts | {
        f"snakemake {' '.join(w)}": workflow_refusal(w, folder) for w in ILLEGAL_TARGETS
    }


def refusal_of(call, names):
    """Return the error of a call, made in an empty folder."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        try:
            eval(call, names)
        except InputError as error:
            return str(error).replace(folder, "FOLDER")
        except Exception as error:
            return f"{type(error).__name__}: {error}".replace(folder, "FOLDER")
    return "(nothing)"


def workflow_refusal(arguments, folder):
    """Return the errors of Snakemake for its arguments, without the rest of its log."""
    from tests.snakemakes import run

    project = copy_of_project(folder / "project")
    status, output = run(project, environment(project), ["-n", *arguments])
    lines = [line for line in output.splitlines() if "error" in line.lower() or " must " in line]
    return "\n".join([f"exit status {status}", *lines])


# ---------------------------------------------------------------------- help


def help_texts(folder):
    """Record the help of `roughgas`, of its commands, and of the steps of the workflow."""
    with mock.patch.dict(os.environ, {"COLUMNS": "80", "NO_COLOR": "1"}):
        texts = {"roughgas": output_of(cli.main, ["--help"])}
        texts |= {
            f"roughgas {name}": output_of(cli.main, [name, "--help"]) for name in cli.COMMANDS
        }
        texts["steps"] = output_of(steps.main, ["--help"])
        return texts | {
            f"steps {name}": output_of(steps.main, [name, "--help"]) for name in steps.STEPS
        }


def output_of(main, arguments):
    """Return the output of a command, and its exit status unless that is 0."""
    stream = io.StringIO()
    with contextlib.redirect_stdout(stream), contextlib.redirect_stderr(stream):
        try:
            status = main(arguments)
        except SystemExit as end:
            status = end.code
    return stream.getvalue() + (f"exit status {status}\n" if status else "")


# ---------------------------------------------------------------------- workflow


def workflow(folder):
    """Record all jobs of all targets of the workflow (see jobs.py), by scale and first output, or
    by rule for targets. The inputs of jobs tell the jobs of each target."""
    project = copy_of_project(folder / "project")
    processes = {scale: start_graph(project, scale) for scale in SCALES}
    jobs = {}
    for scale, process in processes.items():
        output, _ = process.communicate()
        if process.returncode:
            raise RuntimeError(f"Snakemake has failed at the scale {scale}: {output}")
        for line in output.splitlines():
            job = json.loads(line)
            name = f"{scale}/{(job['output'] or [job['rule']])[0]}"
            assert name not in jobs, name
            jobs[name] = line
    return jobs


def start_graph(project, scale):
    """Start Snakemake, which prints the jobs of all targets at a scale; return the process."""
    changes = ["--config", f"scale={scale}"]
    options = {"cwd": project, "env": environment(project), "text": True, "stdout": subprocess.PIPE}
    quiet = ["--quiet", "all", *changes]
    command = [sys.executable, "-m", "snakemake", "--list-target-rules", *quiet]
    targets = subprocess.run(command, **options, check=True).stdout.split()
    return subprocess.Popen([sys.executable, str(JOBS), "-D", *quiet, "--", *targets], **options)


def environment(project):
    """Return the environment of a process that imports the package of a copy of the project."""
    return os.environ | {"PYTHONPATH": str(project / "src")}


def copy_of_project(folder):
    """Copy all files of this checkout that git does not ignore, unless the folder is there."""
    if folder.exists():
        return folder
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        source, target = ROOT / name, folder / name
        if (source.is_symlink() and source.is_dir()) or not source.exists():
            continue  # a link to an environment, or a deleted file
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, target, follow_symlinks=False)
    return folder


# ---------------------------------------------------------------------- datasets


def datasets(folder):
    """Record names, types, dimensions, attributes and values of points (of each kind of schedule,
    of a mixture, with each observable), and of reduced datasets of two seeds."""
    with contextlib.chdir(folder):
        return {
            item: text
            for name, (gas_settings, observables) in simulations().items()
            for item, text in records_of_simulation(name, gas_settings, observables)
        }


def simulations():
    """Return (settings, observables) of small gases by name; other tests compile their kernels."""
    from brute_force.scenes import settings as scene
    from warm import TWO

    gas, bed = scene("gas", 20, [20, 20]), scene("bed", 20, [12, "open"])
    of_bed = STEADY | {"period": 1, "sample_every": 0.25}
    of_layer = STEADY | {"measure": 40, "period": 2}
    heated = scene("heated", 20, [20, 20])
    return {
        "cooling": (gas | {"schedule": COOLING}, ["cumulants"]),
        "mixture": (gas | {"species": TWO, "schedule": COOLING}, []),
        "spheres": (scene("spheres", 20, [12, 12, 12]) | {"schedule": COOLING}, []),
        "sheared": (scene("sheared", 20, [25, 25]) | {"schedule": STEADY}, ["stress"]),
        "bed": (bed | {"schedule": of_bed}, ["profiles", "layer", "contacts", "wall_forces"]),
        "pattern": (scene("layer", 40) | {"schedule": of_layer}, ["pattern"]),
        "heated": (heated | {"schedule": STEADY}, BOX_OBSERVABLES),
        "stages": (heated | {"schedule": STAGES}, []),
    }


def records_of_simulation(name, gas_settings, observables):
    """Yield the items of a gas: its points, and their reduced dataset."""
    points, reduced = [f"{name}_seed{seed}.nc" for seed in (1, 2)], f"{name}.nc"
    options = ["run", name, "--scale=small", f"--settings={json.dumps(gas_settings)}", "--r=0.9"]
    options += ["--beta=0.3", "--seed", "1", "2"]
    options += ["--observe", *observables] if observables else []
    for command in ([*options, "-o", *points], ["reduce", *points, "-o", reduced]):
        output = output_of(cli.main, command)
        if "exit status" in output:
            yield f"{name}: roughgas {command[0]}", output
            return
    yield from ((path, description_of(path)) for path in (*points, reduced))


def description_of(path):
    """Return the content of a dataset as JSON, with hashes of values, but not of CPU times."""
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)
        content = {
            "dimensions": {name: len(axis) for name, axis in file.dimensions.items()},
            "attributes": attributes(file),
            "variables": {name: variable(file[name]) for name in sorted(file.variables)},
        }
    return json.dumps(content)


def variable(array):
    """Return the dimensions, type and attributes of a variable, and a hash of its values."""
    names = {"dimensions": array.dimensions, "type": str(array.dtype)}
    names |= {"attributes": attributes(array)}
    return names if array.name in CLOCKS else names | {"values": hash_of(np.asarray(array[...]))}


def hash_of(values):
    """Return a hash of an array of numbers or words."""
    content = "|".join(map(str, values.flat)).encode() if values.dtype.hasobject else b""
    return hashlib.sha256(content or values.tobytes()).hexdigest()[:16]


def attributes(holder):
    """Return the attributes of a dataset or variable that do not change with versions."""
    names = [name for name in holder.ncattrs() if name not in UNSTABLE_ATTRIBUTES]
    return {name: as_text_value(holder.getncattr(name)) for name in names}


def as_text_value(value):
    """Return the value of an attribute as text, since JSON has no nan."""
    return value if isinstance(value, str) else repr(np.asarray(value).tolist())


# ---------------------------------------------------------------------- files


def files(folder):
    """Record all files of results and figures at the small scale: texts, contents of datasets, and
    hashes of other files."""
    project = copy_of_project(folder / "project")
    command = [sys.executable, "-m", "snakemake", "-j2", "--config", "scale=small", "--", "figures"]
    run = subprocess.run(
        command,
        cwd=project,
        env=environment(project),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    if run.returncode:
        return {"snakemake figures": run.stdout}
    paths = [
        path for top in ("results", "figures") for path in (project / top / "small").rglob("*")
    ]
    return {str(path.relative_to(project)): content(path) for path in paths if path.is_file()}


def content(path):
    """Return the content of a file as text: see `files`."""
    if path.stem.startswith(TIMED_STEM):
        return "(seconds)"
    if path.suffix == ".nc":
        return description_of(path)
    if path.suffix in TEXT_SUFFIXES:
        return path.read_text(encoding="utf-8")
    return hashlib.sha256(path.read_bytes()).hexdigest()


RECORDERS = {
    "settings": settings,
    "refusals": refusals,
    "help": help_texts,
    "workflow": workflow,
    "datasets": datasets,
    "files": files,
}
"""Recorders by name."""
