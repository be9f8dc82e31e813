# Definitions shared by the rules. Bad input ends the workflow with one line, before any job runs.
import gc

gc.set_threshold(100_000)  # garbage collection takes a fifth of Snakemake's own time
import os
import re
import sys
from pathlib import Path

from snakemake.logging import logger
from snakemake.utils import min_version

min_version("9.27")  # as pyproject.toml says

try:
    import roughgas.config
    from roughgas.base import InputError, sorted_json
    from roughgas.base.files import PACKAGE as PACKAGE_FOLDER, code_of as hash_of_code
    from roughgas.show import catalogue
    from roughgas.workflow import changes, executors, hard_cases, internals, paths, products
    from roughgas.workflow.figures import Figures
    from roughgas.workflow.fingerprints import CHECKING
    from roughgas.workflow.hard_cases import HardCases
    from roughgas.workflow.paths import COMBINED, EXPERIMENT, KERNEL, NAME, POINT, REDUCED, TASK
    from roughgas.workflow.paths import VARIANT, alternatives
    from roughgas.workflow.products import Products
    from roughgas.workflow.studies import Studies, experiments_in_order
    from roughgas.workflow.sweeps import URGENT, Sweeps, points_of_job
    from roughgas.workflow.tasks import Tasks
    from roughgas.workflow.wildcards import exit_on_bad_input, from_wildcards, per_attempt
    from roughgas.workflow.wildcards import unrecorded
except ModuleNotFoundError as error:
    sys.exit(f"roughgas: error: no module {error.name}: `make setup`, then .venv/bin/snakemake")

# the location of the rules: a folder, or the address of a remote module
BASE = internals.rules_of(workflow)
IS_REMOTE = "://" in BASE
PACKAGE = os.path.relpath(PACKAGE_FOLDER)  # relative, so that the folder can be moved
SOURCE = Path(PACKAGE) if IS_REMOTE else Path(os.path.relpath(Path(BASE).parent))
# a module, or an included Snakefile, leaves the configuration of this folder to its host
IS_MODULE = internals.is_module(workflow)
DEFAULT = internals.default_of(workflow)  # default rule of a module's host, if already defined
# the configuration in this folder, or else beside the Snakefile, or of the package
CONFIG = next(
    str(folder / "config.yaml")
    for folder in [*([] if IS_MODULE else [Path()]), SOURCE, Path(PACKAGE)]
    if (folder / "config.yaml").exists()
)
# rules call the `roughgas` in the environment of this snakemake
os.environ |= {"PATH": os.pathsep.join([str(Path(sys.executable).parent), *os.get_exec_path()])}


def image():
    """The container for --sdm apptainer. Snakemake puts its path into commands, used or not."""
    path = str(SOURCE / "roughgas.sif")
    if re.fullmatch(r"[\w./+@%:,=-]+", path, re.ASCII):
        return path
    with exit_on_bad_input():
        if internals.uses_apptainer(workflow):
            legal = "be a path without spaces, quotes and brackets for apptainer"
            raise InputError("container", os.path.abspath(path), legal)
    return None


def of_project(*files):
    """Files beside the Snakefile, or of the package, as paths without the prefix of a module that
    cannot be taken for options."""
    return [local(os.path.abspath(f) if str(f).startswith("-") else str(f)) for f in files]


def of_pages(*files):
    """Templates and scripts of pages in the package."""
    return of_project(*(f"{PACKAGE}/show/{file}" for file in files))


def of_checkout(folder, pattern="*.*"):
    """An input: files of a folder in a checkout of the project, which a package lacks."""
    files = from_wildcards(
        products.files_of_checkout, source=SOURCE, folder=folder, pattern=pattern
    )
    return lambda wildcards: of_project(*files(wildcards))


def code_of(*modules, alone=()):
    """A param: the hash of modules, and of all that they import. Imports of modules in `alone` do
    not count."""
    return lambda wildcards: hash_of_code(*modules, alone=alone)


def extensions_of_run(wildcards):
    """The products of all studies beyond the paper; studies with unreadable code are left out."""
    files, refused = run_products.extensions()
    for error in refused:
        logger.warning(f"roughgas: error: {error} (left out; all else can be made)")
    return files


for folder in (str(SOURCE), PACKAGE):
    with exit_on_bad_input():
        if set("{}") & set(folder):
            legal = "have no { or }, Snakemake's signs of a wildcard, or be where you work"
            raise InputError("folder", os.path.abspath(folder), legal)

with exit_on_bad_input():
    files = internals.configuration_files(workflow)
    if IS_MODULE:
        CHANGES, foreign = changes.of_host(config)
        if foreign:
            logger.warning(
                f"roughgas: of the host's config these are not read: {', '.join(foreign)}"
            )
    elif files:
        CHANGES = changes.of_command_line(files, internals.options_of_configuration(workflow))
    else:
        CHANGES = config
    CONFIGURATION = roughgas.config.load(CONFIG, CHANGES)
SCALE = CONFIGURATION.scale
config = {**config, "scale": SCALE}  # for captions of the report

sweeps = Sweeps(CONFIGURATION, experiments_in_order(CONFIGURATION))
with exit_on_bad_input():
    studies = Studies(CONFIGURATION, sweeps)
tasks = Tasks(studies)
drawings = Figures(studies)
run_products = Products(studies, tasks)
cases = HardCases(SOURCE)

if internals.is_main_process(workflow):
    for line in studies.refused.values():
        logger.warning(f"roughgas: error: {line} (left out; all else can be made)")
