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


AS_LONG_AS = {"point": 1e5, "compile_kernel": 1e7}
"""How many collisions take as long as the rest of a point, and as compiling a kernel."""


class Watch:
    """How far a run is, counted in points, or in jobs where it makes none: a bar in a terminal, a
    line a minute in a pipe. How much of it is done goes by collisions: some points make a hundred
    times as many as others."""

    bar = None

    def begin(self, jobs):
        """`jobs` are those that are to be run."""
        points = {job.jobid: points_in(job.output) for job in jobs}
        if any(points.values()):
            unit, self.counts = "points", {jobid: len(files) for jobid, files in points.items()}
            self.work = {job.jobid: length_of(job, points[job.jobid]) for job in jobs}
        else:
            unit, self.counts = "steps", dict.fromkeys(points, 1)
            self.work = self.counts
        self.running, self.done, self.worked = {}, 0, 0.0
        self.to_do = sum(self.work.values())
        self.bar = Bar(SCALE, sum(self.counts.values()), unit)

    def start(self, record):
        at = record.wildcards.get("experiment", record.rule_name)
        seen = [file for file in record.output if file.endswith((".png", ".md", ".html", ".csv"))]
        self.running[record.jobid] = at, seen

    def finish(self, jobid):
        _, seen = self.running.pop(jobid, ("", ()))
        self.done += self.counts.get(jobid, 0)
        self.worked += self.work.get(jobid, 0.0)
        for file in seen:
            self.bar.say(f"ready: {file}")
        at = {at for job, (at, _) in self.running.items() if self.counts.get(job)}
        # those that run are half done, on average
        running = sum(self.work.get(job, 0.0) for job in self.running)
        share = (self.worked + 0.5 * running) / self.to_do
        self.bar.reach(self.done, ", ".join(sorted(at)), share=share)

    def end(self):
        if self.bar:
            self.bar.__exit__()


def points_in(files):
    return [Path(str(file)) for file in files if Path(str(file)).match("seed*.nc")]


def length_of(job, points):
    """In how many collisions' time a job of a run that makes points is done, about."""
    if not points:
        return AS_LONG_AS.get(job.rule.name, 0.0)
    made = sum(collisions_of_point(job.wildcards, beta_of(file)) for file in points)
    return len(points) * AS_LONG_AS["point"] + made


watch = Watch()


def is_of_use(record):
    """Whether a person is told. How jobs go is shown in place of a paragraph for each; the command of
    a failed job, which repeats all settings of its experiment in some fifty lines, is left out."""
    shown, event = workflow.output_settings, getattr(record, "event", None)
    if shown.verbose or shown.dryrun:
        return True
    if event == LogEvent.RUN_INFO:
        watch.begin(list(workflow.dag.needrun_jobs()))
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
