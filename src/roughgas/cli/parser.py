"""Commands declared as data, and argparse built from them: errors in one line, examples as they
are written, commands in groups."""

import argparse
import re
from collections.abc import Callable, Mapping
from importlib import import_module
from textwrap import fill
from typing import Any, NoReturn

from roughgas.base import on_one_line

BAD_INPUT = 2
WIDTH = 78
Option = Callable[[Any], None]
"""Adds an argument, or several, to a parser or to a group of one."""


class Command:
    """A subcommand; without `about`, its summary describes it.

    `calls` names a function, "room.module:function". One of `cli` is given all options (an
    argparse.Namespace); one of another room is given their values, in the order of `options`.
    `writes` is the kind of its outputs, of `cli.options.BEGINNINGS`; "" if their endings tell it.
    """

    def __init__(
        self,
        calls: str,
        summary: str,
        *options: Option,
        examples: tuple[str, ...],
        about: str = "",
        writes: str = "",
    ) -> None:
        self.calls, self.summary, self.options, self.examples = calls, summary, options, examples
        self.writes = writes
        self.description = about or f"{summary[0].upper()}{summary[1:]}."

    def __call__(self, options: argparse.Namespace) -> None:
        """Import and call the function."""
        module, _, name = self.calls.partition(":")
        function = getattr(import_module(f"roughgas.{module}"), name)
        if module.startswith("cli."):
            function(options)
        else:
            function(*(value for key, value in vars(options).items() if key != "command"))


def value(name: str, help: str, *, completer: Any = None, **settings: Any) -> Option:
    """Declare an option with a value, or a positional argument, as argparse's `add_argument`.

    `name` is such as "-o --output FILE"; a default is added to the help; `completer` lists what a
    shell may complete the value to.
    """
    names = name.split()
    if names[-1].isupper():
        settings["metavar"] = names.pop()
    if isinstance(settings.get("default"), str):
        help += " (default: %(default)s)"

    if names[0].startswith("-"):
        settings.setdefault("action", Given)

    def add(parser: Any) -> None:
        action = parser.add_argument(*names, help=help, **settings)
        if completer:
            action.completer = completer

    return add


class Given(argparse.Action):
    """Stores a value, which is given once; values of a list that is given in parts are joined."""

    seen = False

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        """Store what the option is given. Raises ArgumentError for a second value."""
        if self.seen and self.nargs is None:
            raise argparse.ArgumentError(self, f"given twice, the second time as {values}")
        given = [*getattr(namespace, self.dest), *values] if self.seen else values
        setattr(namespace, self.dest, given)
        self.seen = True


def flag(name: str, help: str) -> Option:
    """Declare an option without a value."""
    return value(name, help, action="store_true")


def output(help: str, metavar: str = "FILE", required: bool = True, **settings: Any) -> Option:
    """Declare -o, --output."""
    return value(f"-o --output {metavar}", help, required=required, **settings)


def one_of(*options: Option, required: bool = False) -> Option:
    """Declare options that exclude each other."""

    def add(parser: argparse.ArgumentParser) -> None:
        group = parser.add_mutually_exclusive_group(required=required)
        for option in options:
            option(group)

    return add


class Parser(argparse.ArgumentParser):
    """A parser that reports errors in one line, and takes whatever begins like a negative number
    as a value: --beta -1:1:0.1."""

    def __init__(self, **keywords: Any) -> None:
        form = argparse.RawDescriptionHelpFormatter  # which leaves examples as they are
        super().__init__(**{"formatter_class": form, **keywords})
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        """Exit with the message."""
        said = on_one_line(f"roughgas: error: {message} (see `{self.prog} --help`)")
        self.exit(BAD_INPUT, f"{said}\n")


def add_commands(parser: Parser, commands: Mapping[str, Command]) -> None:
    """Add subcommands to a parser."""
    parsers = parser.add_subparsers(
        prog=parser.prog, metavar="COMMAND", required=True, help=argparse.SUPPRESS
    )
    for name, command in commands.items():
        title = "example:" if len(command.examples) == 1 else "examples:"
        epilog = "\n  ".join([title, *command.examples])
        about = fill(command.description, WIDTH)
        one = parsers.add_parser(name, help=command.summary, description=about, epilog=epilog)
        for option in command.options:
            option(one)
        one.set_defaults(command=command)


def overview(title: str, commands: Mapping[str, Command]) -> str:
    """Return a line for each command, below a title."""
    lines = [f"  {name:10}  {command.summary}" for name, command in commands.items()]
    return "\n".join([f"{title}:", *lines])
