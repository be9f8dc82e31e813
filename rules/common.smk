# What the rules share. Bad input ends the workflow with one line, before anything is run.
import gc

gc.set_threshold(100_000)  # a fifth of Snakemake's own time goes into looking for what nobody uses
import difflib
import fcntl
import functools
import hashlib
import json
import os
import re
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

from snakemake.logging import logger
from snakemake.settings.types import DeploymentMethod

try:
    import roughgas.config
    from roughgas.config import schema
    from roughgas.base.files import PACKAGE as PACKAGE_FOLDER, code_in, code_of as hash_of_code
    from roughgas.base import InputError, not_one_of, shown
    from roughgas.base import in_rst
    from roughgas.config.reading import read_yaml
    from roughgas.config.schema import keys
    from roughgas.show import catalogue
except ModuleNotFoundError as error:
    sys.exit(f"roughgas: error: no module {error.name}: `make setup`, then .venv/bin/snakemake")

# where the Snakefile is: this folder, or another one, or, of a module, a site from which Snakemake
# fetches what it needs
SOURCE = Path(os.path.relpath(Path(workflow.current_basedir.get_path_or_uri(True)).parent))
PACKAGE = os.path.relpath(PACKAGE_FOLDER)  # so that a folder may be moved with its results
# a module leaves the configuration of this folder to its host; so does what includes the Snakefile
IS_MODULE = workflow.modifier.namespace is not None
# the configuration of this folder, or else the one beside the Snakefile
CONFIG = next(
    (
        str(folder / "config.yaml")
        for folder in ([] if IS_MODULE else [Path()]) + [SOURCE]
        if (folder / "config.yaml").exists()
    ),
    None,
)
CONFIG = CONFIG or workflow.source_path("../config.yaml")
IMAGE = str(SOURCE / "roughgas.sif")
KERNEL = "results/{scale}/{experiment}/r{r}/compiled.txt"
POINT = "results/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.nc"
REDUCED = "results/{scale}/{experiment}.nc"
FIRST = 10**12  # priority: more urgent than any point
# An experiment as a whole, or one of its variants: as wildcards, not what has rules of its own, nor
# the folders of points.
RESERVED = "|".join(schema.RESERVED)
NAME = r"[\w+.-]+"  # nothing that means something to a shell: wildcards become parts of commands
EXPERIMENT = rf"(?!(?:{RESERVED})[./]){NAME}"
VARIANT = rf"(?:/(?!(?:r|beta|seed)[-+.\d]){NAME})?"
# rules call the `roughgas` beside this snakemake, wherever it was started from
os.environ |= {"PATH": os.pathsep.join([str(Path(sys.executable).parent), *os.get_exec_path()])}


@contextmanager
def one_line(place=None):
    """End the workflow with one line where the input turns out to be bad."""
    try:
        yield
    except InputError as error:
        sys.exit(f"roughgas: error: {place}: {error}" if place else f"roughgas: error: {error}")
    except OSError as error:
        sys.exit(f"roughgas: error: {error.filename}: {error.strerror}")


def check_folders():
    """End the workflow with one line where Snakemake would take a folder's name for a pattern."""
    for folder in (str(SOURCE), PACKAGE):
        with one_line():
            if set("{}") & set(folder):
                legal = "have no { or }, Snakemake's signs of a wildcard, or be where you work"
                raise InputError("folder", os.path.abspath(folder), legal)


def image():
    """The container of --sdm apptainer. Snakemake takes it for part of a command, used or not."""
    if re.fullmatch(r"[\w./+@%:,=-]+", IMAGE, re.ASCII):
        return IMAGE
    with one_line():
        if DeploymentMethod.APPTAINER in workflow.deployment_settings.deployment_method:
            legal = "be a path without spaces, quotes and brackets for apptainer"
            raise InputError("container", os.path.abspath(IMAGE), legal)
    return None


def of_project(*paths):
    """Files beside the Snakefile, or of the package: none of them lies below a module's prefix, and
    none begins as an option does."""
    return [local(os.path.abspath(p) if str(p).startswith("-") else str(p)) for p in paths]


def own_config(changes):
    """What the command line, or the host of a module, changes. A host's own keys are no mistake."""
    known = keys()
    foreign = [key for key in changes if key not in known] if IS_MODULE else []
    if foreign:
        logger.warning(f"roughgas: of the host's config these are not read: {', '.join(foreign)}")
    return {key: value for key, value in changes.items() if key not in foreign}


def checked_config(path, changes):
    """The configuration at `path`, with the changes that the command line makes to it."""
    with one_line():
        return roughgas.config.load(path, changes)


def nearest(key, name, kind, known):
    """The error of a name that is not known, with the known ones that are most like it."""
    found = difflib.get_close_matches(name, sorted(known), 3, 0.0)
    return InputError(key, shown(name), f"be {kind}, such as {', '.join(found)}")


def content_of_files(settings):
    """The hashes of files that settings take radii from, wherever in them."""
    if isinstance(settings, dict):
        if settings.get("distribution") == "file":
            return [hash_of_file(settings["file"])]
        settings = list(settings.values())
    found = map(content_of_files, settings) if isinstance(settings, list) else ()
    return [one for some in found for one in some]


def with_files(code, settings):
    """The hash of code, and those of files that settings, as JSON, take radii from."""
    files = content_of_files(json.loads(settings)) if '"file"' in settings else []
    return " ".join([code, *files])


@functools.cache
def hash_of_file(path):
    with one_line():
        return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


@functools.cache
def settings(scale, experiment):
    """The settings of an experiment, or of a variant, at a scale, checked."""
    with one_line(f"results/{scale}/{experiment}"):
        found = roughgas.config.experiment(config, experiment, scale)
    for name, variant in roughgas.config.every_variant(experiment, found).items():
        with one_line(f"config.yaml: experiments.{name} at scale {scale}"):
            from roughgas.simulation.schedule import check

            check(variant)
    return found


def variants(scale, experiment):
    """The names of an experiment's variants: its own where its sweep has no third axis."""
    return roughgas.config.variants(experiment, settings(scale, experiment))


def points(scale, experiment):
    """The datasets of all points in the sweep of an experiment."""
    return [
        POINT.format(scale=scale, experiment=variant, r=r, beta=beta, seed=seed)
        for variant in variants(scale, experiment)
        for r, beta, seed in roughgas.config.sweep(settings(scale, experiment))
    ]


def reduced(scale, experiments):
    """The reduced datasets of experiments; ends the workflow for one that does not exist."""
    for experiment in experiments:
        settings(scale, experiment)
    return [REDUCED.format(scale=scale, experiment=experiment) for experiment in experiments]


def scale_of(folder):
    """The scale of what is drawn into a folder of figures/: `paper` where it is figures/ itself."""
    return Path(folder).name or "paper"


def one_of(labels):
    """The wildcard constraint for one of these labels; without any, for nothing."""
    return "|".join(re.escape(str(label)) for label in labels) or "(?!)"


def folder_of(scale):
    """The folder of figures/ for what is drawn at a scale: figures/ itself for `paper`."""
    return "" if scale == "paper" else f"{scale}/"


def kept(product):
    """A product of this run, and its copy beside the figures, which the documentation reads."""
    return [f"results/{SCALE}/{product}", f"figures/{folder_of(SCALE)}{product}"]


def drawn(figures, kinds=(".pdf", ".png"), scale=None):
    """The files of figures at a scale, by default that of this run."""
    folder = folder_of(scale or SCALE)
    return [f"figures/{folder}{figure}{kind}" for figure in figures for kind in kinds]


def code_of(*modules, alone=(), settings=None):
    """A param for the code that a result depends on: a hash of these modules, such as
    "simulation.point", and of all that they import. Of those in `alone` their imports do not count.
    Files count that settings name which the function `settings` returns as JSON.

    As a param it makes Snakemake redo what an edit may change. With lists of files as inputs the
    scheduler would look at every file for every job, at every step.
    """

    def code(wildcards):
        found = hash_of_code(*modules, alone=alone)
        return with_files(found, settings(wildcards)) if settings else found

    return code


def be_alone():
    """Hold a lock of the system's for as long as this process lives, so that no second Snakemake
    works in this folder. Snakemake's own locks outlive a process that is killed: see `nolock` in
    the profiles."""
    global alive
    with one_line():
        alive = open(".snakemake/alive", "w")
    with suppress(OSError):  # such as on a disk without such locks
        try:
            fcntl.flock(alive, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            sys.exit("roughgas: error: another Snakemake is at work in this folder")
