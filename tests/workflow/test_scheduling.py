"""Snakemake's timers of jobs per second, which a long run must not accumulate."""

import re
import shlex
import subprocess
import sys

import pytest

JOBS = 40
WORKFLOW = """
import threading
from roughgas.workflow.internals import remove_job_rate_limit
rule all:
    input: expand("{{job}}.done", job=range({jobs}))
rule one:
    output: "{{job}}.done"
    shell: "touch {{output}}"
onstart:
    {start}
onsuccess:
    print("threads:", threading.active_count(), file=sys.stderr)
"""


def threads_at_the_end(folder, start):
    """Return the number of threads that Snakemake has after JOBS short jobs.

    The jobs run one after another: a pass of the scheduler takes all that end together.
    """
    (folder / "Snakefile").write_text("import sys\n" + WORKFLOW.format(jobs=JOBS, start=start))
    command = [sys.executable, "-m", "snakemake", "-j1", "--quiet", "all"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return int(re.search(r"threads: (\d+)", done.stderr)[1])


@pytest.mark.slow
def test_timers_do_not_accumulate(tmp_path):
    assert threads_at_the_end(tmp_path, "remove_job_rate_limit(workflow)") < 10


@pytest.mark.slow
def test_timers_accumulate_in_the_installed_snakemake(tmp_path):
    """Once this fails, Snakemake has mended it: `remove_job_rate_limit` may go."""
    assert threads_at_the_end(tmp_path, "pass") > JOBS / 2


@pytest.mark.slow
def test_a_run_lists_the_files_that_are_ready(project, tmp_path):
    ran = project.copy_to(tmp_path / "project")
    arguments = ("-c1", "--config", "scale=tiny", "--", "results/tiny/config.html")
    lines = ran.succeed(*arguments).splitlines()
    assert "ready: results/tiny/config.html" in lines and len(lines) < 20
    assert not any("localrule" in line or "jobid" in line for line in lines)


@pytest.mark.slow
def test_a_run_counts_its_points(project, tmp_path):
    """In a terminal, for which the progress bar is drawn."""
    ran = project.copy_to(tmp_path / "project")
    point = "results/tiny/cooling/r0.9/beta0/seed7.nc"
    command = [sys.executable, "-m", "snakemake", "-j1", "--config", "scale=tiny", "--", point]
    typed = f"stty cols 100 rows 40; {shlex.join(command)}"
    terminal = ["script", "--quiet", "--return", "--command", typed, "/dev/null"]
    done = subprocess.run(terminal, cwd=ran.folder, capture_output=True, text=True, check=True)
    assert re.search(r"tiny: 100%\|.*1 of 1 points", done.stdout)
    assert re.search(r"tiny: +[1-9]\d?%\|[^|]*\| 0 of 1 points", done.stdout)  # a kernel is done
