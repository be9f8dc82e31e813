"""Internals of Snakemake: the display of a run, and how jobs start and stop.

The only file that uses parts of Snakemake outside its public interface: `dag.needrun_jobs`, the
fields of log records, of a scheduler `job_rate_limiter` and `exit_gracefully`, of a workflow
`current_basedir`, `modifier`, `config_settings`, `deployment_settings`, `default_target`,
`executor_plugin` and `is_main_process`. If any of these changes, Snakemake runs as it does without
this file, with a warning if the display is affected. `--verbose` shows all messages of Snakemake.

Parameters: `workflow` is Snakemake's workflow, `job` a job in it, `record` a record of its log.
"""

import atexit
import logging
import re
import signal
import sys
import threading
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from roughgas.base import NamedValues, folder_lock
from roughgas.simulation.progress import ProgressBar
from roughgas.workflow.figures import unknown_with_suggestions
from roughgas.workflow.paths import labels_of_point
from roughgas.workflow.sweeps import Sweeps

REDUNDANT_MESSAGES = (
    *("Select jobs", "Execute ", "Touching ", "RuleException:\nCalledProcessError"),
    "WorkflowError:\nAt least one job did not",
)
"""Beginnings of messages that are redundant beside the lines on jobs."""
UNWRITABLE_PATH = re.compile(r"Traceback .*\n\w+: \[Errno \d+\] ([^\n]*): '([^\n]*)'", re.DOTALL)
"""A traceback that ends with an OSError, with its message and path."""
POINT_OVERHEAD, STEP_EFFORT = 1e5, 1e6
"""Overhead of a point, and time of a step that makes no points, in collisions that take as long."""
LONG_STEPS = {"compile_kernel": 1e7, "task": 1e7}
"""Typical times of longer steps, in collisions, by rule."""
UNEXPECTED = (AttributeError, TypeError, KeyError, ImportError, ValueError)
"""Exceptions to expect from a Snakemake with different internals."""
LOCK_FILE = ".snakemake/alive"


class Run:
    """Progress of a run in a terminal as a bar, in a pipe as a line every minute.

    It counts points, or jobs if the run makes no points. The share of work done is measured in
    collisions, since some points have a hundred times more than others.
    """

    def __init__(self, sweeps: Sweeps, jobs: Iterable[Any]) -> None:
        """Count the points, or else the jobs, and the work of `jobs`, all jobs of the run."""
        self._sweeps = sweeps
        self._running: dict[int, tuple[str, list[str]]] = {}
        self._done, self._worked = 0, 0.0
        all_jobs = list(jobs)
        points = {job.jobid: _points(job.output) for job in all_jobs}
        if any(points.values()):
            unit, self._counts = "points", {jobid: len(files) for jobid, files in points.items()}
        else:
            unit, self._counts = "steps", dict.fromkeys(points, 1)
        self._work = {job.jobid: self._length(job, points[job.jobid]) for job in all_jobs}
        self._total = sum(self._work.values())
        self._bar = ProgressBar(sweeps.configuration.scale, sum(self._counts.values()), unit)

    def _length(self, job: Any, points: list[Path]) -> float:
        """Return an estimate of a job's run time, in collisions; `points` are those it makes.

        Values of r are read from the paths, since a job of several r has none of its own.
        """
        if not points:
            return LONG_STEPS.get(job.rule.name, STEP_EFFORT)
        scale, experiment = job.wildcards["scale"], job.wildcards["experiment"]
        collisions = 0.0
        for r, beta, _ in map(labels_of_point, points):
            collisions += self._sweeps.collisions(scale, experiment, r, beta)
        return len(points) * POINT_OVERHEAD + collisions

    def start(self, record: Any) -> None:
        """Note that the job of a log record has started, and its viewable files."""
        name = record.wildcards.get("experiment", record.rule_name)
        pictures = [
            file for file in record.output if file.endswith((".png", ".md", ".html", ".csv"))
        ]
        self._running[record.jobid] = name, pictures

    def finish(self, jobid: int) -> None:
        """Print the viewable files of the finished job with this id, and update the bar."""
        _, pictures = self._running.pop(jobid, ("", []))
        self._done += self._counts.get(jobid, 0)
        self._worked += self._work.get(jobid, 0.0)
        for file in pictures:
            self._bar.say(f"ready: {file}")
        names = {name for job, (name, _) in self._running.items() if self._counts.get(job)}
        # a running job is half done, on average
        running = sum(self._work.get(job, 0.0) for job in self._running)
        share = (self._worked + 0.5 * running) / self._total
        self._bar.reach(self._done, ", ".join(sorted(names)), share=share)

    def end(self) -> None:
        """End the bar of progress."""
        self._bar.__exit__()


class Display:
    """Filter of Snakemake's log that shows progress in place of a paragraph for each job."""

    def __init__(self, workflow: Any, sweeps: Sweeps, logger: logging.Logger) -> None:
        """Prepare a filter of `logger`, Snakemake's, for a run of `workflow`."""
        self._workflow, self._sweeps, self._logger = workflow, sweeps, logger
        self._run: Run | None = None

    def install(self) -> None:
        """Replace Snakemake's own display by a filter of its log."""
        self._logger.addFilter(self.is_shown)

    def is_shown(self, record: Any) -> bool:
        """Return whether to show a log record; after an unexpected exception, show all."""
        try:
            return self._is_shown(record)
        except UNEXPECTED as error:
            self._logger.removeFilter(self.is_shown)
            self._end()
            reason = f"{type(error).__name__}: {error}"
            print(f"roughgas: this Snakemake shows its run itself ({reason})", file=sys.stderr)
            return True

    def _is_shown(self, record: Any) -> bool:
        """Return whether to show a log record; update the progress from hidden records."""
        from snakemake_interface_logger_plugins.common import LogEvent

        settings, event = self._workflow.output_settings, getattr(record, "event", None)
        if settings.verbose or settings.dryrun:
            return True
        if event == LogEvent.RUN_INFO:
            self._run = Run(self._sweeps, self._workflow.dag.needrun_jobs())
        elif self._run is None:  # before the run, or in a job on a cluster, which shows none
            return not record.getMessage().startswith(REDUNDANT_MESSAGES)
        elif event == LogEvent.PROGRESS:
            if record.done == record.total:
                self._end()
            return bool(record.done == record.total)
        elif event == LogEvent.JOB_INFO:
            self._run.start(record)
        elif event == LogEvent.JOB_FINISHED:
            self._run.finish(record.job_id)
        elif event == LogEvent.JOB_ERROR:
            self._end()
            record.shellcmd = None  # fifty lines with all settings of its experiment
            return not any(map(_was_stopped, record.log))
        hidden = (LogEvent.RUN_INFO, LogEvent.JOB_INFO, LogEvent.JOB_FINISHED)
        return event not in hidden and not record.getMessage().startswith(REDUNDANT_MESSAGES)

    def _end(self) -> None:
        """End the bar of progress, if there is a run."""
        if self._run:
            self._run.end()

    def add_remedy(self, record: Any) -> bool:
        """Add a remedy to a log record of an error; return True.

        For an unknown target these are the most similar names, for Snakemake's lock the process
        that holds it; for a path that cannot be written a line replaces the traceback.
        """
        message = record.getMessage()
        if unwritable := UNWRITABLE_PATH.fullmatch(message.strip()):
            record.msg, record.args = "roughgas: error: {1}: {0}".format(*unwritable.groups()), ()
        if "Directory cannot be locked" in message:
            advice = folder_lock.advice_on_snakemakes_lock(LOCK_FILE)
            record.msg, record.args = f"{message}\nroughgas: error: {advice}", ()
        if missed := re.search(r"No rule to produce (\S+) \(", message):
            targets = [rule.name for rule in self._workflow.rules if not rule.has_wildcards()]
            category = "a path of a file, or a name of `snakemake --list`"
            hint = unknown_with_suggestions("target", missed[1], category, targets)
            record.msg, record.args = f"{message}\n{hint}", ()
        return True


def _points(files: Iterable[Any]) -> list[Path]:
    """Return the paths of points among the output files of a job."""
    return [Path(str(file)) for file in files if Path(str(file)).match("seed*.nc")]


def _was_stopped(log: str) -> bool:
    """Return whether the log of a job, at the path `log`, says that a signal stopped the job."""
    return Path(log).is_file() and b"roughgas: stopped" in Path(log).read_bytes()


def print_resume_hint() -> None:
    """Print, at exit, that the same command resumes the run."""
    atexit.register(print, "Stopped: the same command goes on from here.", file=sys.stderr)


def remove_job_rate_limit(workflow: Any) -> None:
    """Remove the limit of jobs per second, whose timers take a quarter of all CPU in a long run.

    Each pass of the scheduler starts a timer that starts another pass, in endless chains
    (Snakemake's issue 2354, its pull request 3744); no setting turns the limit off. It is kept for
    jobs on a cluster, which it is meant for, and if Snakemake implements it differently.
    """
    scheduler: Any = getattr(workflow, "scheduler", None)
    if getattr(workflow, "local_exec", False) and hasattr(scheduler, "job_rate_limiter"):
        scheduler.job_rate_limiter = None


def stop_on_sigterm(workflow: Any) -> None:
    """Handle SIGTERM in a thread that stops the scheduler.

    Snakemake's own handler waits in the main thread for the scheduler's lock: a deadlock if the
    main thread holds it. Without `exit_gracefully` in the scheduler, that handler stays.
    """
    exit_gracefully = getattr(getattr(workflow, "scheduler", None), "exit_gracefully", None)

    def stop(*_: object) -> None:
        """Stop the scheduler in a thread; the arguments are a signal handler's."""
        threading.Thread(target=exit_gracefully).start()

    if exit_gracefully and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, stop)


_locked_files: list[Any] = []
"""The locked file, open for the life of the process."""


def lock_workdir() -> None:
    """Lock the present folder for the life of this process: no second Snakemake may run in it.

    This is a lock of the operating system. Snakemake's own lock, which `nolock` in the profiles
    turns off, outlives a killed process. Ends the workflow with one line if another Snakemake holds
    the folder.
    """
    try:
        _locked_files.append(folder_lock.lock(LOCK_FILE))
    except folder_lock.HeldError as error:
        sys.exit(f"roughgas: error: {error}")
    except OSError as error:
        sys.exit(f"roughgas: error: {error.filename}: {error.strerror}")


def rules_of(workflow: Any) -> str:
    """Return the folder of the rules of a workflow, or its address for a remote module."""
    try:
        return str(workflow.current_basedir.get_path_or_uri(True))
    except UNEXPECTED:
        return str(Path(workflow.basedir, "rules"))  # beside the main Snakefile


def is_module(workflow: Any) -> bool:
    """Return whether another workflow uses this workflow as a module."""
    modifier = getattr(workflow, "modifier", None)
    return getattr(modifier, "namespace", None) is not None


def is_main_process(workflow: Any) -> bool:
    """Return whether this process runs the workflow, rather than a job in it."""
    return bool(getattr(workflow, "is_main_process", True))


def configuration_files(workflow: Any) -> list[Path]:
    """Return the paths of the files of --configfile."""
    return list(getattr(getattr(workflow, "config_settings", None), "configfiles", ()))


def options_of_configuration(workflow: Any) -> NamedValues:
    """Return the values of the options of --config, by key."""
    options: NamedValues = getattr(getattr(workflow, "config_settings", None), "config", {})
    return options


def uses_apptainer(workflow: Any) -> bool:
    """Return whether jobs run in a container of Apptainer."""
    settings = getattr(workflow, "deployment_settings", None)
    methods = getattr(settings, "deployment_method", ())
    return any(str(method).upper().endswith("APPTAINER") for method in methods)


def executor_of(workflow: Any) -> str:
    """Return the name of the executor that starts jobs, such as "slurm"; "" if it is unknown."""
    return str(getattr(getattr(workflow, "executor_plugin", None), "name", ""))


class ReplaceableDefault(str):
    """Name of a default rule that is false as a bool, so that the host's first rule replaces it."""

    def __bool__(self) -> bool:
        """Return False: Snakemake then takes it for no default."""
        return False


def default_of(workflow: Any) -> str | None:
    """Return the name of the default rule of a workflow; None before any rule is defined."""
    return getattr(workflow, "default_target", None)


def leave_default_to_host(workflow: Any, default: str | None, rule: str) -> None:
    """Keep the `default` rule of a module's host, or let its next rule become the default.

    This is the host's first rule after the module. The `rule` of the module is the default of a
    host without rules.
    """
    if hasattr(workflow, "default_target"):
        workflow.default_target = default if default else ReplaceableDefault(rule)
