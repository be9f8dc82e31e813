"""The command `roughgas`: one subcommand for each step of the pipeline.

Bad input ends a command with one line on stderr and exit status 2, a failing disk and the like with
status 1; neither leaves a file behind.
"""

import argparse
import gc
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

from roughgas import __version__
from roughgas.cli import crate, export, planning, products, run, showcase, studies
from roughgas.errors import CollapseError, InputError

BAD_INPUT, FAILED, INTERRUPTED = 2, 1, 130


class Parser(argparse.ArgumentParser):
    """A parser that refuses in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"roughgas: error: {message} (see `{self.prog} --help`)\n")


def process() -> NoReturn:
    """The process `roughgas`: `main`, without what would slow down a short process.

    Of a job that takes half a second, a sixth went into taking its memory apart at the end, and as
    much into threads for linear algebra that has nothing for them to do (and whose sums would
    depend on the number of cores).
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(100_000)  # imports make few cycles and many objects
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line `arguments` (by default the process's own); its exit status."""
    options = _parser().parse_args(arguments)
    try:
        options.command(options)
    except InputError as error:
        return _fail(BAD_INPUT, str(error))
    except CollapseError as error:
        return _fail(FAILED, str(error))
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return _fail(FAILED, f"{where}{error.strerror or error}")
    except KeyboardInterrupt as stop:
        return _fail(INTERRUPTED, f"interrupted, {stop if stop.args else 'nothing half-written'}")
    return 0


def _fail(status: int, message: str) -> int:
    print(f"roughgas: error: {message}", file=sys.stderr)
    return status


def _parser() -> Parser:
    parser = Parser(
        prog="roughgas",
        description="Event-driven simulation of gases of rough, inelastic disks and spheres.",
        epilog="`roughgas COMMAND --help` explains a command, with an example.",
    )
    parser.add_argument("--version", action="version", version=f"roughgas {__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    run.add_commands(commands)
    planning.add_commands(commands)
    products.add_commands(commands)
    showcase.add_commands(commands)
    studies.add_commands(commands)
    export.add_commands(commands)
    crate.add_commands(commands)
    return parser
