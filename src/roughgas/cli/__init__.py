"""The command `roughgas`: one subcommand for each step of the pipeline.

Bad input ends a command with one line on stderr and exit status 2, a failing disk and the like with
status 1; neither leaves a file behind.
"""

import gc
import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

from roughgas import __version__
from roughgas.cli.parser import BAD_INPUT, Commands, Formatter, Parser
from roughgas.errors import CollapseError, InputError

FAILED, INTERRUPTED = 1, 130
FOR_PEOPLE = {
    "run": "run",
    "show": "show",
    "theory": "theory",
    "plan": "planning",
    "bench": "bench",
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
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line `arguments` (by default the process's own); its exit status."""
    if arguments is None:
        arguments = sys.argv[1:]
    parser = _parser(*arguments[:1])
    if "_ARGCOMPLETE" in os.environ:  # a shell asks how its line may go on
        from argcomplete import autocomplete

        autocomplete(parser)
    options = parser.parse_args(arguments)
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
