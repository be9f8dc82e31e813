# What a person reads on the terminal when something goes wrong; Snakemake's own log keeps all of it.
import atexit

from snakemake.logging import DefaultFormatter, logger

SILENT = "(it said nothing: a full disk, or killed for lack of memory?)"
# what the message of the failed job, and the last line, say better
REPEATED = ("RuleException:\nCalledProcessError", "WorkflowError:\nAt least one job did not")


class Brief(DefaultFormatter):
    """Snakemake's messages; of a failed job only what it was to make, and the end of its log.

    A patch (checked with Snakemake 9.27, tests/workflow/test_patches.py): its own message repeats
    the command with all settings of an experiment, some fifty lines, and no option shortens it.
    """

    def format_job_error(self, msg):
        made, said = ", ".join(msg["output"]), "\n".join(map(last_lines, msg["log"]))
        if "roughgas: stopped" in said:
            return f"Stopped on the way: {made}"
        why = (msg["rule_msg"] or "").partition(". ")[0]  # what became of a cluster's job
        return f"Failed: {made}{why and f' ({why})'}\n{said}"


def last_lines(log, most=20):
    """The end of a log, below its name."""
    with suppress(OSError):
        lines = Path(log).read_text(encoding="utf-8", errors="replace").splitlines()
        return "\n    ".join([f"{log}:", *(lines[-most:] or [SILENT])])
    return f"{log}:\n    {SILENT}"


def is_news(record):
    return not record.getMessage().startswith(REPEATED)


def be_brief():
    """Take the terminal's formatter for ours, unless Snakemake was told to say more."""
    settings = workflow.output_settings
    for handler in logger.handlers:
        if handler.name == "DefaultStreamHandler" and not settings.verbose:
            handler.setFormatter(Brief(settings.quiet))
            handler.addFilter(is_news)


def say_how_to_go_on():
    """After all that Snakemake has to say."""
    atexit.register(print, "Stopped: the same command goes on from here.", file=sys.stderr)
