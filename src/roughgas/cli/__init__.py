"""The command `roughgas`: one subcommand for each step of the pipeline.

Bad input ends a command with one line on stderr and exit status 2, a failing disk and the like with
status 1, Ctrl-C and SIGTERM with 130; none of them leaves half a file behind.
"""

import argparse
import gc
import logging
import os
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

from roughgas.base.errors import CollapseError, InputError
from roughgas.base.files import check_place
from roughgas.base.version import __version__
from roughgas.cli.parser import BAD_INPUT, Commands, Formatter, Parser
from roughgas.cli.streams import mend_streams

FAILED, INTERRUPTED, NOBODY_READS = 1, 130, 141
GO_ON = "nothing is half-written; the same command begins anew"
FOR_PEOPLE = {
    "run": "run",
    "movie": "movie",
    "show": "show",
    "theory": "theory",
    "plan": "planning",
    "bench": "bench",
    "export": "export",
    "crate": "crate",
    "doctor": "doctor",
    "completion": "completion",
}
"""Commands that people give, in the order of help, and the module here that has each."""
OF_THE_WORKFLOW = {
    "compile": "run",
    "pilot": "planning",
    "reach": "planning",
    "costs": "planning",
    "reduce": "products",
    "table": "products",
    "figure": "products",
    "claims": "products",
    "page": "page",
    "html": "page",
    "times": "page",
    "config": "page",
    "clustering": "showcase",
    "film": "showcase",
    "study": "studies",
    "combine": "studies",
    "tables": "studies",
}
"""The same of those that the rules give."""


def process() -> NoReturn:
    """The process `roughgas`: `main`, without what would slow down a short process.

    Of a job that takes half a second, a sixth went into taking its memory apart at the end, and as
    much into threads for linear algebra that has nothing for them to do (and whose sums would
    depend on the number of cores).
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(100_000)  # imports make few cycles and many objects
    for number in (signal.SIGINT, signal.SIGTERM):  # of a person, of a cluster
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)
    mend_streams()
    os.environ["MPLBACKEND"] = "agg"  # whatever it was: nothing is shown on a screen
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # such as on folders it cannot write
    try:
        status = main()
    except SystemExit as end:  # argparse has said what there is to say
        status = end.code
    os._exit(_flush(status))


def _stop(*_: object) -> NoReturn:
    """End the command as Ctrl-C does, and do not let an impatient second one disturb that."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def _flush(status: int) -> int:
    """Get out what has been printed; the exit status after that."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except BrokenPipeError:
        return NOBODY_READS
    except OSError as error:
        return _fail(FAILED, f"standard output: {error.strerror}")
    return status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line `arguments` (by default the process's own); its exit status."""
    try:
        options = _options(sys.argv[1:] if arguments is None else arguments)
        options.command(options)
    except InputError as error:
        return _fail(BAD_INPUT, str(error))
    except CollapseError as error:
        return _fail(FAILED, str(error))
    except BrokenPipeError:  # such as of `| head`, which has seen enough
        return NOBODY_READS
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return _fail(FAILED, f"{where}{error.strerror or error}")
    except MemoryError as error:
        return _fail(FAILED, f"out of memory. {error}".strip())
    except ImportError as error:
        return _fail(FAILED, f"{error}: `roughgas doctor` says what is wrong")
    except KeyboardInterrupt as stop:
        print(f"roughgas: stopped: {stop if stop.args else GO_ON}", file=sys.stderr)
        return INTERRUPTED
    return 0


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    """What the command line says; raises OSError where what it is to write could not be."""
    parser = _parser(*arguments[:1])
    if "_ARGCOMPLETE" in os.environ:  # a shell asks how its line may go on
        from argcomplete import autocomplete

        autocomplete(parser)
    options = parser.parse_args(arguments)
    for place in _outputs(options):
        check_place(place)
    return options


def _outputs(options: argparse.Namespace) -> list[str]:
    """The files, or folders, that a command is to write."""
    named = getattr(options, "output", None) or []
    return [named] if isinstance(named, str) else named


def _fail(status: int, message: str) -> int:
    print(f"roughgas: error: {message}", file=sys.stderr)
    return status


def _parser(command: str = "") -> Parser:
    """The parser of `command`, whose module alone is imported; of all commands if it is none."""
    parser = Parser(
        prog="roughgas",
        usage="roughgas [-h] [--version] COMMAND ...",
        description="Event-driven simulation of gases of rough, inelastic disks and spheres.",
        formatter_class=Formatter,
    )
    parser.add_argument("--version", action="version", version=f"roughgas {__version__}")
    commands = Commands(parser)
    known = FOR_PEOPLE | OF_THE_WORKFLOW
    for module in [known[command]] if command in known else dict.fromkeys(known.values()):
        import_module(f"roughgas.cli.{module}").add_commands(commands)
    more = "`roughgas COMMAND --help` explains a command, with examples."
    groups = {"commands": FOR_PEOPLE, "commands that the workflow gives": OF_THE_WORKFLOW}
    parser.epilog = f"{commands.overview(groups)}\n\n{more}"
    return parser
