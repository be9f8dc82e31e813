# How Snakemake starts jobs, and what a person reads of a run, a line for each job that starts;
# `--verbose` has all of it.
import atexit
import re
import sys
from pathlib import Path

from snakemake_interface_logger_plugins.common import LogEvent

NOISE = (
    *("Select jobs", "Execute ", "Touching ", "RuleException:\nCalledProcessError"),
    "WorkflowError:\nAt least one job did not",
)
"""How messages begin that the lines of jobs say better."""
REFUSED = re.compile(r"Traceback .*\n\w+: \[Errno \d+\] ([^\n]*): '([^\n]*)'", re.DOTALL)
"""A traceback that ends in a place that cannot be read or written: what is wrong, and where."""
STEPS = {"done": 0, "total": 0}


def is_of_use(record):
    """Turn what starts a job into a line; leave out what others say, and the command of a failed job,
    which repeats all settings of its experiment in some fifty lines."""
    shown, event = workflow.output_settings, getattr(record, "event", None)
    if shown.verbose or shown.dryrun:
        return True
    if event == LogEvent.RUN_INFO:
        STEPS.update(done=0, total=record.stats["total"])
    elif event == LogEvent.PROGRESS:
        STEPS.update(done=record.done)
        return record.done == record.total
    elif event == LogEvent.JOB_INFO:
        told = f"{STEPS['done']} of {STEPS['total']} done. {record.rule_msg or record.rule_name}"
        record.event, record.msg, record.args = None, told, ()
    elif event == LogEvent.JOB_ERROR:
        record.shellcmd = None
        return not any(map(was_stopped, record.log))
    return event != LogEvent.JOB_FINISHED and not record.getMessage().startswith(NOISE)


def was_stopped(log):
    """Whether a job says in its log that it was told to stop."""
    return Path(log).is_file() and b"roughgas: stopped" in Path(log).read_bytes()


def say_what_was_meant(record):
    """Where Snakemake says that nothing makes a target, add those whose names are most like it; where
    a place cannot be written, a line in place of the traceback."""
    if refused := REFUSED.fullmatch(record.getMessage().strip()):
        record.msg, record.args = "roughgas: error: {1}: {0}".format(*refused.groups()), ()
    missed = re.search(r"No rule to produce (\S+) \(", record.getMessage())
    if missed:
        known = [rule.name for rule in workflow.rules if not rule.has_wildcards()]
        hint = nearest(
            "target", missed[1], "a path of a file, or a name of `snakemake --list`", known
        )
        record.msg, record.args = f"{record.getMessage()}\n{hint}", ()
    return True


def say_how_to_go_on():
    """After all that Snakemake has to say."""
    atexit.register(print, "Stopped: the same command goes on from here.", file=sys.stderr)


def start_jobs_at_once(workflow):
    """Take away the limit of jobs per second, whose timers take a quarter of all CPU in a long run.

    Each pass of the scheduler starts a timer that starts another pass, and these chains never end
    (Snakemake's issue 2354, its pull request 3744); no setting turns the limit off. It is kept where
    jobs go to a cluster, for which it was made.
    """
    if workflow.local_exec:
        workflow.scheduler.job_rate_limiter = None
