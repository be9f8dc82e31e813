# How Snakemake starts jobs, and what a person reads of a run: how far it is, and what is ready to be
# looked at. `--verbose` has all that Snakemake says.
import atexit
import re
import sys
from pathlib import Path

from snakemake_interface_logger_plugins.common import LogEvent

from roughgas.simulation.progress import Bar

NOISE = (
    *("Select jobs", "Execute ", "Touching ", "RuleException:\nCalledProcessError"),
    "WorkflowError:\nAt least one job did not",
)
"""How messages begin that the lines of jobs say better."""
REFUSED = re.compile(r"Traceback .*\n\w+: \[Errno \d+\] ([^\n]*): '([^\n]*)'", re.DOTALL)
"""A traceback that ends in a place that cannot be read or written: what is wrong, and where."""


class Watch:
    """How far a run is, counted in points, or in jobs where it makes none: a bar in a terminal, a
    line a minute in a pipe."""

    bar = None

    def begin(self, jobs):
        """`jobs` has the output of each job that is to be run."""
        self.running, self.done = {}, 0
        points = sum(map(self.points, jobs))
        self.points_alone = points > 0
        self.bar = Bar(SCALE, points or len(jobs), "points" if points else "steps")

    @staticmethod
    def points(files):
        return sum(Path(str(file)).match("seed*.nc") for file in files)

    def start(self, record):
        at = record.wildcards.get("experiment", record.rule_name)
        size = self.points(record.output) if self.points_alone else 1
        seen = [file for file in record.output if file.endswith((".png", ".md", ".html", ".csv"))]
        self.running[record.jobid] = at, size, seen

    def finish(self, jobid):
        _, size, seen = self.running.pop(jobid, ("", 0, ()))
        self.done += size
        for file in seen:
            self.bar.say(f"ready: {file}")
        at = ", ".join(sorted({at for at, size, _ in self.running.values() if size}))
        self.bar.reach(self.done, at)

    def end(self):
        if self.bar:
            self.bar.__exit__()


watch = Watch()


def is_of_use(record):
    """Whether a person is told. How jobs go is shown in place of a paragraph for each; the command of
    a failed job, which repeats all settings of its experiment in some fifty lines, is left out."""
    shown, event = workflow.output_settings, getattr(record, "event", None)
    if shown.verbose or shown.dryrun:
        return True
    if event == LogEvent.RUN_INFO:
        watch.begin([job.output for job in workflow.dag.needrun_jobs()])
    elif watch.bar is None:  # before, or in a job on a cluster, of whose run another process tells
        return not record.getMessage().startswith(NOISE)
    elif event == LogEvent.PROGRESS:
        if record.done == record.total:
            watch.end()
        return record.done == record.total
    elif event == LogEvent.JOB_INFO:
        watch.start(record)
    elif event == LogEvent.JOB_FINISHED:
        watch.finish(record.job_id)
    elif event == LogEvent.JOB_ERROR:
        watch.end()
        record.shellcmd = None
        return not any(map(was_stopped, record.log))
    hidden = (LogEvent.RUN_INFO, LogEvent.JOB_INFO, LogEvent.JOB_FINISHED)
    return event not in hidden and not record.getMessage().startswith(NOISE)


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
