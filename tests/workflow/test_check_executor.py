"""On machines without Slurm, `check_executor` refuses it in one line."""

import pytest

from roughgas.base import InputError
from roughgas.workflow.executors import PROGRAMS, check_executor

REFUSAL = (
    "executor = slurm: must be on this machine, which lacks sacct, scancel: "
    "start where jobs are submitted"
)


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Return a function that puts programs of these names, and no others, on PATH."""
    monkeypatch.setenv("PATH", str(tmp_path))

    def install(names):
        for name in names:
            (tmp_path / name).write_text("#!/bin/sh\n")
            (tmp_path / name).chmod(0o755)

    return install


def test_a_machine_without_slurm_is_refused_in_one_line(install):
    install(["sbatch", "squeue"])
    with pytest.raises(InputError) as caught:
        check_executor("slurm")
    assert str(caught.value) == REFUSAL


def test_a_machine_with_slurm_is_accepted(install):
    install(PROGRAMS["slurm"])
    check_executor("slurm")


@pytest.mark.parametrize("executor", ["local", "dryrun", "kubernetes", "cluster-generic"])
def test_other_executors_need_no_programs_of_slurm(executor, install):
    check_executor(executor)
