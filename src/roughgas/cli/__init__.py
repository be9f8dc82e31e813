"""The command `roughgas`: one subcommand for each step of the pipeline.

Bad input ends a command with one line on stderr and exit status 2, a full disk and other failures
with status 1, Ctrl-C and SIGTERM with 130; none of them leaves half a file behind, but for the
frames of a trajectory so far.
"""

import argparse
import gc
import logging
import os
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from roughgas import base
from roughgas.base import EndedEarlyError, InputError, __version__, on_one_line, shown
from roughgas.cli.commands import COMMANDS
from roughgas.cli.parser import BAD_INPUT, Given, Parser, add_commands, check_outputs, overview

FAILED, INTERRUPTED, NOBODY_READS = 1, 130, 141
GO_ON = "nothing is half-written; the same command begins anew"


def process(run: Callable[[], int] | None = None) -> NoReturn:
    """Run `run`, by default `main`, as a process of its own, without what slows down a short one.

    Of a job that takes half a second, a sixth went into freeing its memory at the end, and as much
    into threads for linear algebra that has nothing for them to do (and whose sums would depend on
    the number of cores).
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(100_000)  # imports make few cycles and many objects
    for number in (signal.SIGINT, signal.SIGTERM):  # from a person, from a cluster
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _stop)
    _mend_streams()
    os.environ["MPLBACKEND"] = "agg"  # whatever it was: nothing is shown on a screen
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # hide warnings of read-only folders
    try:
        status = (run or main)()
    except SystemExit as end:  # argparse has said why
        status = int(end.code or 0)
    os._exit(_flush(status))


def _mend_streams() -> None:
    """Let everything be printed: what a stream cannot encode becomes a question mark, and what goes
    to a closed stream is lost."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w"))
        getattr(sys, name).reconfigure(errors="replace")


def _stop(*_: object) -> NoReturn:
    """End the command as Ctrl-C does, and ignore an impatient second one."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def _flush(status: int) -> int:
    """Flush what has been printed, and return the exit status after that."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except BrokenPipeError:
        return NOBODY_READS
    except OSError as error:
        return _fail(FAILED, f"standard output: {error.strerror}")
    return status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line `arguments` (by default the process's own) and return its exit status.

    Raises SystemExit after --help, --version and what argparse refuses.
    """
    return status_of(_options, arguments)


def status_of(
    parse: Callable[[Sequence[str]], argparse.Namespace], arguments: Sequence[str] | None = None
) -> int:
    """Return the exit status of what `parse` makes of arguments, and runs as its `command`.

    Errors are printed in one line. Raises what `parse` raises of SystemExit.
    """
    options = argparse.Namespace()
    given = sys.argv[1:] if arguments is None else arguments
    try:
        for one in given:
            if not one.isascii() and one != one.encode(errors="ignore").decode():
                raise InputError("argument", shown(one), "be text in UTF-8")
        options = parse(given or ["--help"])
        options.command(options)
    except (InputError, EndedEarlyError) as error:
        return _fail(BAD_INPUT if isinstance(error, InputError) else FAILED, str(error))
    except BrokenPipeError:  # of `| head`, which has seen enough
        return NOBODY_READS
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        return _fail(FAILED, f"{where}{error.strerror or error}")
    except MemoryError as error:
        return _fail(FAILED, f"out of memory. {error}".strip())
    except (LookupError, AttributeError, TypeError, ValueError, ArithmeticError) as error:
        if (path := _foreign(options)) is None:
            raise
        wrong = f"hold what roughgas writes, as it wrote it: {type(error).__name__}: {error}"
        return _fail(BAD_INPUT, str(InputError("file", path, wrong)))
    except ImportError as error:
        lacks = base.remedy(error)
        return _fail(FAILED, lacks or f"{error}: `roughgas doctor` says what is wrong")
    except KeyboardInterrupt as stop:
        print(f"roughgas: stopped: {stop if stop.args else GO_ON}", file=sys.stderr)
        return INTERRUPTED
    return 0


def _options(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the command line. Raises InputError and OSError as `check_outputs`."""
    parser = parser_of(*arguments[:1])
    if "_ARGCOMPLETE" in os.environ:  # a shell asks how its line may go on
        from argcomplete import autocomplete, safe_actions

        safe_actions.add(Given)  # whose values completions look at
        autocomplete(parser)
    options = parser.parse_args(arguments)
    if getattr(options, "config", "") is None:
        from roughgas.config import in_use

        options.config = in_use()
    if getattr(options, "scale", "") is None:
        from roughgas.config import PAPER, usual_scale

        told = getattr(options, "settings", None) is not None
        options.scale = PAPER if told else usual_scale(options.config)
    check_outputs(options)
    return options


def _foreign(options: argparse.Namespace) -> Path | None:
    """Return the first dataset among the inputs that another program has written or changed.

    Whatever fails while it is read is due to what it holds; with one of ours, it would be a fault.
    """
    from roughgas.data.netcdf import is_foreign

    names = ("inputs", "input", "files", "points", "start_from")
    given = (getattr(options, name, None) for name in names)
    lists = ([one] if isinstance(one, str) else one for one in given)
    for path in (Path(name) for one in lists if isinstance(one, list) for name in one):
        for file in sorted(path.rglob("*.nc")) if path.is_dir() else [path]:
            if file.is_file() and is_foreign(file):
                return file
    return None


def _fail(status: int, message: str) -> int:
    print(f"roughgas: error: {on_one_line(message)}", file=sys.stderr)
    return status


def parser_of(command: str = "") -> Parser:
    """Return the parser of `command` alone, which is faster; of all commands if it is none."""
    more = "`roughgas COMMAND --help` explains a command, with examples."
    parser = Parser(
        prog="roughgas",
        usage="roughgas [-h] [--version] COMMAND ...",
        description="Event-driven simulation of gases of rough, inelastic disks and spheres.",
        epilog=f"{overview('commands', COMMANDS)}\n\n{more}",
    )
    parser.add_argument("--version", action="version", version=f"roughgas {__version__}")
    add_commands(parser, {command: COMMANDS[command]} if command in COMMANDS else COMMANDS)
    return parser
