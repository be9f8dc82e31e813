# What a person reads on the terminal; src/snakemake_logger_plugin_roughgas/ shows it, and Snakemake's
# own log keeps all of it.
import atexit

try:
    from snakemake_logger_plugin_roughgas import POINTS
except ModuleNotFoundError:  # not in a wheel, which has one module
    POINTS = {}

POINTS |= {"point": 1, "reach": 1, "pilot": 1}  # blocks of points: simulate.smk


def say_how_to_go_on():
    """After all that Snakemake has to say."""
    atexit.register(print, "Stopped: the same command goes on from here.", file=sys.stderr)
