# What arrays of jobs need on a Slurm cluster beyond Snakemake's plugin.
import argparse

ALL_JOBS = 100_000  # at a time, as the profile says


def become_own_task():
    """In a task of an array, run what this task is for, in place of this process.

    The plugin would run it below the job of the array's first task, and then look for the outputs
    of that one: missing, as long as that one runs, they would be removed
    (snakemake-executor-plugin-slurm, issue 447).
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--slurm-jobstep-array-execs")
    calls = parser.parse_known_args()[0].slurm_jobstep_array_execs
    task, first = (os.environ.get(f"SLURM_ARRAY_TASK_{name}") for name in ("ID", "MIN"))
    if calls and task != first:
        from snakemake_executor_plugin_slurm_jobstep import _decompress_array_task_call

        os.execvp("sh", ["sh", "-c", _decompress_array_task_call(calls, int(task))])


def refuse_limit_of_jobs():
    """End a run that could wait without end: while Snakemake holds jobs of a rule back, the plugin
    sends none of those that it was given."""
    if not workflow.local_exec and workflow.nodes < ALL_JOBS:
        sys.exit(
            f"roughgas: error: --jobs = {workflow.nodes}: must be {ALL_JOBS} or more, since on a"
            " cluster none may be held back (docs/cluster.md)"
        )
