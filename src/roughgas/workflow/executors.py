"""Executors of Snakemake: checks that this machine has the programs which they start jobs by."""

import shutil

from roughgas.base import InputError

PROGRAMS = {"slurm": ("sbatch", "sacct", "squeue", "scancel")}
"""Programs of an executor to start, follow and cancel jobs, and to guess an account. Without them
its plugin reports a missing file for each attempt of each job."""


def check_executor(executor: str) -> None:
    """Raise InputError if programs of an executor of Snakemake, such as `slurm`, are missing.

    Only executors in PROGRAMS are checked.
    """
    missing = [name for name in PROGRAMS.get(executor, ()) if shutil.which(name) is None]
    if missing:
        legal = f"be on this machine, which lacks {', '.join(missing)}"
        raise InputError("executor", executor, f"{legal}: start where jobs are submitted")
