# What a person reads on the terminal; src/snakemake_logger_plugin_roughgas/ shows it, and Snakemake's
# own log keeps all of it.
import atexit

try:
    from snakemake_logger_plugin_roughgas import POINTS
except ModuleNotFoundError:  # not in a wheel, which has one module
    POINTS = {}

POINTS |= {"point": 1}  # blocks of points: simulate.smk


def say_what_was_meant(record):
    """Where Snakemake says that nothing makes a target, add those whose names are most like it."""
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
