"""What a person sees of a run of Snakemake: a plugin of its loggers, which the profiles choose.

On a terminal there is one bar: points done, time left, and what runs. In a pipe, and with
--verbose, every step is told. Either way a job that fails is told in a few lines, and Snakemake's
own log, in .snakemake/log/, has all of it.
"""

import re
import sys
import time
from logging import WARNING, LogRecord
from pathlib import Path
from typing import Any

from snakemake.logging import ColorizingTextHandler, DefaultFormatter
from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

POINTS: dict[str, int] = {}
"""How many points a job of a rule makes; the rules fill it in."""
MOST_LINES = 20
SILENT = "(it said nothing: a full disk, or killed for lack of memory?)"
REPEATED = ("RuleException:\nCalledProcessError", "WorkflowError:\nAt least one job did not")
"""What the message of the failed job, and the last line, say better."""
STEPS = {
    *(LogEvent.RUN_INFO, LogEvent.WORKFLOW_STARTED, LogEvent.SHELLCMD, LogEvent.JOB_INFO),
    *(LogEvent.JOB_STARTED, LogEvent.JOB_FINISHED, LogEvent.RESOURCES_INFO, LogEvent.PROGRESS),
    LogEvent.RULEGRAPH,
}
"""What the bar stands for."""
NOISE = (
    *("Assuming unrestricted", "Building DAG", "Using shell", "Provided ", "Rules claiming"),
    *("Select jobs", "Conda environments", "Singularity containers", "Group jobs", "Elapsed time"),
    *("Updating jobs", "Job stats", "Touching output file"),
)
END = "Complete log(s): "
REFUSED = re.compile(r"Traceback .*\n\w+: \[Errno \d+\] ([^\n]*): '([^\n]*)'", re.DOTALL)
"""A traceback that ends in a place that cannot be read or written: what is wrong, and where."""


class Brief(DefaultFormatter):
    """Snakemake's messages; of a failed job only what it was to make, and the end of its log.

    Its own message (Snakemake 9.27) repeats the command with all settings of an experiment, some
    fifty lines, and no option shortens it.
    """

    def format_job_error(self, msg: dict[str, Any]) -> str:
        """Return what a failed job was to make, why it failed, and what its log says last."""
        made, said = ", ".join(msg["output"]), "\n".join(map(last_lines, msg["log"]))
        if "roughgas: stopped" in said:
            return f"Stopped on the way: {made}"
        why = (msg["rule_msg"] or "").partition(". ")[0]  # what became of a cluster's job
        return f"Failed: {made}{why and f' ({why})'}\n{said}"


class LogHandler(LogHandlerBase):
    """Tells how far a run is: on a terminal by a bar, else in lines."""

    writes_to_stream = True
    writes_to_file = has_filter = has_formatter = needs_rulegraph = False

    def __post_init__(self) -> None:
        """Choose between the bar and lines."""
        told, stream = self.common_settings, self._stream()
        brief = Brief(told.quiet)
        plain = DefaultFormatter(told.quiet, told.show_failed_logs)
        self._lines = ColorizingTextHandler(
            told.nocolor, stream, formatter=plain if told.verbose else brief
        )
        self._brief = None if told.verbose else brief
        self._shows_bar = stream.isatty() and not told.verbose and not told.dryrun
        self._bar: Any = None
        self._running: dict[int, tuple[str, int]] = {}
        self._counts_points, self._done, self._begun = False, 0, time.monotonic()

    def emit(self, record: LogRecord) -> None:
        """Show a message of Snakemake's."""
        if self._brief and (refused := REFUSED.fullmatch(record.getMessage().strip())):
            self._say(refusal(*refused.groups()))
            return
        if self._brief and record.getMessage().startswith(REPEATED):
            return
        if self._shows_bar:
            self._show(record)
        else:
            self._lines.emit(record)

    def close(self) -> None:
        """Clear the bar."""
        self._clear()
        super().close()

    def _clear(self) -> None:
        if self._bar is not None:
            self._bar.__exit__()
        self._bar = None

    def _stream(self) -> Any:
        return sys.stdout if self.common_settings.stdout else sys.stderr

    def _show(self, record: Any) -> None:
        event, text = getattr(record, "event", None), record.getMessage()
        if event == LogEvent.RUN_INFO:
            self._begin(record.stats)
        elif event == LogEvent.JOB_INFO:
            self._running[record.jobid] = self._named(record)
            self._reach()
        elif event in (LogEvent.JOB_FINISHED, LogEvent.JOB_ERROR):
            job = record.job_id if event == LogEvent.JOB_FINISHED else record.jobid
            _, weight = self._running.pop(job, ("", 0))
            self._done += weight * (event == LogEvent.JOB_FINISHED)
            self._reach()
        if text.startswith(END):
            self._end(text.removeprefix(END))
        elif record.levelno >= WARNING or not (event in STEPS or text.startswith(NOISE)):
            self._say(self._brief.format(record) if self._brief else text)

    def _begin(self, stats: dict[str, int]) -> None:
        """Show a bar of points, or of steps where no points are made."""
        from roughgas.simulation.progress import Bar

        points = sum(count * POINTS.get(rule, 0) for rule, count in stats.items())
        self._counts_points = points > 0
        total, unit = (points, "points") if points else (stats["total"], "steps")
        self._bar = Bar("roughgas", total, unit, self._stream())

    def _named(self, record: Any) -> tuple[str, int]:
        """Return what a job does, and how much of the bar that is."""
        weight = POINTS.get(record.rule_name, 0) if self._counts_points else 1
        return record.rule_msg or record.rule_name, weight

    def _reach(self) -> None:
        if self._bar is not None:
            names = [name for name, _ in self._running.values()]
            others = f" and {len(names) - 1} more" if len(names) > 1 else ""
            self._bar.reach(self._done, names[-1] + others if names else "")

    def _say(self, text: str) -> None:
        if text in ("", "None"):
            return
        if self._bar is None:
            print(text, file=self._stream(), flush=True)
        else:
            self._bar.say(text)

    def _end(self, log: str) -> None:
        """Say what was done, and where all of it is told."""
        if self._bar is None:
            return
        unit, seconds = "points" if self._counts_points else "steps", time.monotonic() - self._begun
        self._clear()
        took = f"{seconds:.0f} s" if seconds < 100 else f"{seconds / 60:.0f} min"
        self._say(f"{self._done} {unit} in {took}. Every step of the run: {log}")


def refusal(why: str, path: str) -> str:
    """Return the line for a place that cannot be read or written."""
    other = "; XDG_CACHE_HOME may name another folder" if ".cache" in Path(path).parts else ""
    return f"roughgas: error: {path}: {why}{other}"


def last_lines(log: str | Path) -> str:
    """Return the end of a log, below its name."""
    lines = []
    if Path(log).is_file():
        lines = Path(log).read_text(encoding="utf-8", errors="replace").splitlines()
    return "\n    ".join([f"{log}:", *(lines[-MOST_LINES:] or [SILENT])])
