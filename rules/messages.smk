# What a person reads on the terminal when something goes wrong; Snakemake's own log keeps all of it.
import atexit

from snakemake.logging import DefaultFormatter, logger

TARGETS = (
    "A target is a file, such as results/paper/cooling/r0.9/beta0/seed1.nc or figures/fig1a.png, or"
    " one of figures, extensions, movies, showcase, accuracy, coverage, hard_cases, plan,"
    " everything."
)
SILENT = "(it said nothing: a full disk, or killed for lack of memory?)"
# what the message of the failed job, and the last line, say better
REPEATED = ("RuleException:\nCalledProcessError", "WorkflowError:\nAt least one job did not")


class Brief(DefaultFormatter):
    """Snakemake's messages, but of a failed job only what it was to make, and what it said."""

    def format(self, record):
        text = super().format(record)
        return f"{text.strip()}\n{TARGETS}" if "MissingRuleException" in text else text

    def format_job_error(self, msg):
        made, said = ", ".join(msg["output"]), "\n".join(map(last_lines, msg["log"]))
        if "roughgas: stopped" in said:
            return f"Stopped on the way: {made}"
        why = (msg["rule_msg"] or "").partition(". ")[0]  # what became of a cluster's job
        return f"Failed: {made}{why and f' ({why})'}\n{said}"


def last_lines(log, most=20):
    """The end of a log, below its name."""
    try:
        lines = Path(log).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    return "\n    ".join([f"{log}:", *(lines[-most:] or [SILENT])])


def be_brief():
    """Take the terminal's formatter for ours, unless Snakemake was told to say more."""
    settings = workflow.output_settings
    for handler in logger.handlers:
        if handler.name == "DefaultStreamHandler" and not settings.verbose:
            handler.setFormatter(Brief(settings.quiet))
            handler.addFilter(lambda record: not record.getMessage().startswith(REPEATED))


def say_how_to_go_on():
    """After all that Snakemake has to say."""
    atexit.register(print, "Stopped: the same command goes on from here.", file=sys.stderr)
