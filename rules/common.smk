# What the rules share. Bad input ends the workflow with one line, before anything is run.
import fcntl
import functools
import os
import sys
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import roughgas.config
    from roughgas.base import sources
    from roughgas.base.errors import InputError, not_one_of
    from roughgas.base.layout import in_rst
    from roughgas.show import catalogue
    from roughgas.studies.figures import DATASETS, FIGURES
except ModuleNotFoundError as error:
    sys.exit(f"roughgas: error: no module {error.name}: `make setup`, then .venv/bin/snakemake")

# where the Snakefile is: this folder, or another one, or, of a module, a site from which Snakemake
# fetches what it needs
SOURCE = Path(os.path.relpath(Path(workflow.current_basedir.get_path_or_uri(True)).parent))
# the configuration of this folder, or else the one beside the Snakefile
CONFIG = next(
    (str(p / "config.yaml") for p in (Path(), SOURCE) if (p / "config.yaml").exists()), None
)
CONFIG = CONFIG or workflow.source_path("../config.yaml")
IMAGE = str((SOURCE / "roughgas.sif").absolute())
PACKAGE = os.path.relpath(sources.PACKAGE)  # so that a folder may be moved with its results
KERNEL = "results/{scale}/{experiment}/r{r}/compiled.txt"
POINT = "results/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.nc"
PILOT = "results/{scale}/{experiment}/r{r}/beta{beta}/pilot.json"
SEEDS = "results/{scale}/{experiment}/r{r}/beta{beta}/seeds"  # as many as a target needs
REDUCED = "results/{scale}/{experiment}.nc"
FIRST = 10**12  # priority: more urgent than any point
# An experiment as a whole, or one of its variants: as wildcards, not what has rules of its own, nor
# the folders of points.
STUDY_FIGURE = "|".join(FIGURES)
NAME = r"[\w+.-]+"  # nothing that means something to a shell: wildcards become parts of commands
EXPERIMENT = rf"(?!(?:{STUDY_FIGURE})\.|(?:studies|showcase|hard_cases)/){NAME}"
VARIANT = rf"(?:/(?!(?:r|beta|seed)[-+.\d]){NAME})?"
# rules call the `roughgas` beside this snakemake, wherever it was started from
os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"


@contextmanager
def one_line(place=None):
    """End the workflow with one line where the input turns out to be bad."""
    try:
        yield
    except InputError as error:
        sys.exit(f"roughgas: error: {place}: {error}" if place else f"roughgas: error: {error}")
    except OSError as error:
        sys.exit(f"roughgas: error: {error.filename}: {error.strerror}")


def checked_config(path, changes):
    """The configuration at `path`, with the changes that the command line makes to it."""
    with one_line():
        return roughgas.config.load(path, changes)


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
    """The datasets of all points in the sweep of an experiment, or the folders that hold them."""
    found = settings(scale, experiment)
    if "target_stderr" in found:
        return swept(SEEDS, scale, experiment)
    return [
        POINT.format(scale=scale, experiment=variant, r=r, beta=beta, seed=seed)
        for variant in variants(scale, experiment)
        for r, beta, seed in roughgas.config.sweep(found)
    ]


def swept(pattern, scale, experiment):
    """A file, or a folder, for each variant and each (r, beta) in the sweep of an experiment."""
    axes = settings(scale, experiment)["sweep"]
    return [
        pattern.format(scale=scale, experiment=variant, r=r, beta=beta)
        for variant in variants(scale, experiment)
        for r in axes["r"]
        for beta in axes["beta"]
    ]


def reduced(scale, experiments):
    """The reduced datasets of experiments; ends the workflow for one that does not exist."""
    for experiment in experiments:
        settings(scale, experiment)
    return [REDUCED.format(scale=scale, experiment=experiment) for experiment in experiments]


def scale_of(folder):
    """The scale of what is drawn into a folder of figures/: `paper` where it is figures/ itself."""
    return Path(folder).name or "paper"


def drawn(figures, kinds=(".pdf", ".png")):
    """The files of figures at the scale of this run: in figures/, or in a folder below it."""
    folder = "" if SCALE == "paper" else f"{SCALE}/"
    return [f"figures/{folder}{figure}{kind}" for figure in figures for kind in kinds]


def code_of(*modules, alone=()):
    """A param for the code that a result depends on: a hash of these modules, such as
    "simulation.point", and of all that they import. Of those in `alone` their imports do not count.

    As a param it makes Snakemake redo what an edit may change. Lists of files would rerun after an
    edit of a comment, and at every step the scheduler looks at every input of every job.
    """

    def code(wildcards):
        return sources.code_of(*modules, alone=alone)

    return code


def be_alone():
    """Hold a lock of the system's for as long as this process lives, so that no second Snakemake
    works in this folder. Snakemake's own locks outlive a process that is killed: see `nolock` in
    the profiles."""
    global alive
    alive = open(".snakemake/alive", "w")
    with suppress(OSError):  # such as on a disk without such locks
        try:
            fcntl.flock(alive, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            sys.exit("roughgas: error: another Snakemake is at work in this folder")
