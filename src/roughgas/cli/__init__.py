"""The command `roughgas`: one subcommand for each step of the pipeline.

Bad input ends a command with one line on stderr and exit status 2, a full disk and other failures
with status 1, Ctrl-C and SIGTERM with 130. No file is left half-written, except a trajectory, which
keeps its frames.
"""

import gc
import logging
import os
import signal
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NoReturn

from roughgas import base
from roughgas.base import (
    EndedEarlyError,
    InputError,
    NamedValues,
    Record,
    __version__,
    on_one_line,
    short_repr,
)
from roughgas.cli.commands import COMMANDS, CONFIG_DEFAULT
from roughgas.cli.parser import BAD_INPUT, Function, Parser, StoreOnce, add_commands, overview
from roughgas.cli.values import INPUTS, check_outputs, paths_of

FAILED, INTERRUPTED, OUTPUT_CLOSED = 1, 130, 141
RERUN_ADVICE = "nothing is half-written; the same command begins anew"


def process(run: Callable[[], int] | None = None) -> NoReturn:
    """Run `run` (by default `main`), which returns an exit status, and end the process with it.

    SIGINT and SIGTERM raise KeyboardInterrupt in `run`. Made for short processes: a job of half a
    second spent a sixth of its time on freeing memory at exit, and another sixth on idle threads
    for linear algebra, whose sums would also depend on the number of cores.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.set_threshold(100_000)  # imports make many objects and few cycles
    for number in (signal.SIGINT, signal.SIGTERM):  # from a person, from a cluster
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)
    _tolerate_unprintable_text()
    os.environ["MPLBACKEND"] = "agg"  # figures go to files, never to a screen
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # hide warnings of read-only folders
    try:
        status = (run or main)()
    except SystemExit as end:  # argparse has printed the reason
        status = int(end.code or 0)
    os._exit(_flush(status))


def _tolerate_unprintable_text() -> None:
    """Make printing never fail: characters that a stream cannot encode become question marks, and a
    closed stream discards its text."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w"))
        getattr(sys, name).reconfigure(errors="replace")


def _interrupt(*_: object) -> NoReturn:
    """Handle SIGINT and SIGTERM: ignore further signals, and raise KeyboardInterrupt."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def _flush(status: int) -> int:
    """Flush stdout and stderr; return the exit status `status`, or FAILED or OUTPUT_CLOSED after an
    error in flushing."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except BrokenPipeError:
        return OUTPUT_CLOSED
    except OSError as error:
        return _fail(FAILED, f"standard output: {error.strerror}")
    return status


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line `arguments`, the words after `roughgas` (by default the process's own),
    and return its exit status.

    Raises SystemExit after --help, --version and errors found by argparse.
    """
    return status_of(_parse, arguments)


def status_of(
    parse: Callable[[Sequence[str]], tuple[Function, Record]],
    arguments: Sequence[str] | None = None,
) -> int:
    """Run the function that `parse` finds in a command line, and return the exit status.

    `parse` takes the words of the command line, and returns the function and its arguments by
    parameter. The words are `arguments`, by default the process's own; an empty command line asks
    for help. Errors are printed in one line. Raises SystemExit where `parse` does.
    """
    options: Record = {}
    command_line = sys.argv[1:] if arguments is None else arguments
    try:
        for word in command_line:
            if not word.isascii() and word != word.encode(errors="ignore").decode():
                raise InputError("argument", short_repr(word), "be text in UTF-8")
        function, options = parse(command_line or ["--help"])
        function(**options)
    except (InputError, EndedEarlyError) as error:
        return _fail(BAD_INPUT if isinstance(error, InputError) else FAILED, str(error))
    except BrokenPipeError:  # from `| head`, say, which stops reading early
        return OUTPUT_CLOSED
    except OSError as error:
        prefix = f"{error.filename}: " if error.filename else ""
        return _fail(FAILED, f"{prefix}{error.strerror or error}")
    except MemoryError as error:
        return _fail(FAILED, f"out of memory. {error}".strip())
    except ImportError as error:
        advice = base.install_advice(error)
        return _fail(FAILED, advice or f"{error}: `roughgas doctor` says what is wrong")
    except KeyboardInterrupt as stop:
        print(f"roughgas: stopped: {stop if stop.args else RERUN_ADVICE}", file=sys.stderr)
        return INTERRUPTED
    except Exception as error:
        if (dataset_error := _dataset_error(options, error)) is None:
            raise
        return _fail(BAD_INPUT, str(dataset_error))
    return 0


def _parse(arguments: Sequence[str]) -> tuple[Function, NamedValues]:
    """Return the function of the command line `arguments`, and its arguments by parameter, defaults
    filled in.

    Raises InputError and OSError as `check_outputs`.
    """
    parser = parser_of(*arguments[:1])
    if "_ARGCOMPLETE" in os.environ:  # a shell requests completions
        from argcomplete import autocomplete, safe_actions

        safe_actions.add(StoreOnce)  # completers read its values
        autocomplete(parser)
    function, options = parser.call_of(arguments)
    if options.get("config", "") is CONFIG_DEFAULT:
        from roughgas.config import active_config_path

        options["config"] = active_config_path()
    if options.get("scale", "") is CONFIG_DEFAULT:
        from roughgas.config import PAPER, default_scale

        has_settings = options.get("settings") is not None
        options["scale"] = PAPER if has_settings else default_scale(options["config"])
    outputs, inputs = paths_of(options, ["output"]), paths_of(options, INPUTS)
    check_outputs(outputs, inputs, COMMANDS[function.__name__].writes)
    return function, options


def _dataset_error(options: Record, error: Exception) -> InputError | None:
    """Return an unexpected error as an InputError that names an input dataset; None if no input is
    a dataset.

    `options` are the command's arguments by parameter. The error names the first dataset that
    another program has written or changed. If there is none, it names the first dataset and the
    line of code that failed: the checksum may be forged, or the fault may be in roughgas.
    """
    from roughgas.data.netcdf import is_dataset, is_foreign

    datasets = [file for file in _input_files(options) if is_dataset(file)]
    if not datasets:
        return None
    path = next(filter(is_foreign, datasets), None)
    legal = f"hold what roughgas writes, as it wrote it: {type(error).__name__}: {error}"
    if path is None:
        innermost = traceback.extract_tb(error.__traceback__)[-1]
        legal += (
            f" ({Path(innermost.filename).name}:{innermost.lineno}; if it does, report this line)"
        )
    return InputError("file", path or datasets[0], legal)


def _input_files(options: Record) -> Iterator[Path]:
    """Yield the input files of a command, and the datasets in its input folders; `options` are its
    arguments by parameter."""
    for path in paths_of(options, ["inputs", "input", "files", "points", "start_from"]):
        for file in sorted(path.rglob("*.nc")) if path.is_dir() else [path]:
            if file.is_file():
                yield file


def _fail(status: int, message: str) -> int:
    """Print an error message in one line on stderr, and return the exit status `status`."""
    print(f"roughgas: error: {on_one_line(message)}", file=sys.stderr)
    return status


def parser_of(command: str = "") -> Parser:
    """Return the parser of the command named `command` alone, which is faster, or of all commands
    if there is none of this name."""
    hint = "`roughgas COMMAND --help` explains a command, with examples."
    parser = Parser(
        prog="roughgas",
        usage="roughgas [-h] [--version] COMMAND ...",
        description="Event-driven simulation of gases of rough, inelastic disks and spheres.",
        epilog=f"{overview('commands', COMMANDS)}\n\n{hint}",
    )
    parser.add_argument("--version", action="version", version=f"roughgas {__version__}")
    add_commands(parser, {command: COMMANDS[command]} if command in COMMANDS else COMMANDS)
    return parser
