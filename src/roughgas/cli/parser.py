"""Command lines made from the signatures of functions: an argument for each parameter, errors in
one line, examples printed verbatim."""

import argparse
import inspect
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import takewhile
from textwrap import fill
from types import NoneType
from typing import Annotated, Any, Literal, NamedTuple, NoReturn, get_args, get_origin

from roughgas.base import InputError, NamedValues, on_one_line, short_repr

BAD_INPUT = 2
WIDTH = 78
Function = Callable[..., None]


class Option(NamedTuple):
    """Help and form of the argument made from a parameter annotated Annotated[TYPE, Option(...)].

    A default that is text is added to `help`. `metavar` stands for the value in the help. `name`,
    such as --set, is needed where the option is not called as the parameter. `completer` is a
    function that lists the completions of a value, as in cli.completers.
    """

    help: str = ""
    metavar: str | None = None
    name: str = ""
    completer: Any = None


class Command(NamedTuple):
    """A subcommand: a function whose docstring has a line of summary, and a description.

    `examples` are command lines for its help. The parameters named in `exclusive` exclude each
    other. `writes` is the type of the output files: a key of values.MAGIC_BYTES, a name in
    values.DATASETS, "" if their suffixes tell it.
    """

    function: Function
    examples: Sequence[str]
    exclusive: Sequence[str] = ()
    writes: str = ""

    @property
    def summary(self) -> str:
        """The first line of the docstring, with a small initial and no full stop, for lists of
        commands."""
        line = self._paragraphs()[0]
        return line[:1].lower() + re.sub(r"(?<!\.)\.$", "", line[1:])

    @property
    def description(self) -> str:
        """The docstring below its first line, or this line alone, wrapped to WIDTH columns."""
        return fill(self._paragraphs()[-1], WIDTH)

    def _paragraphs(self) -> list[str]:
        """Return the first paragraph of the docstring, and the text below it if there is any."""
        return (inspect.getdoc(self.function) or "").split("\n\n", maxsplit=1)


def add_arguments(
    parser: argparse.ArgumentParser, function: Function, exclusive: Sequence[str] = ()
) -> None:
    """Add to `parser` an argument for each parameter of `function`, an option for each parameter
    after `*`.

    A list or a sequence takes several values, a bool none; the values of a Literal are choices; a
    parameter with a default may be omitted. The parameters named in `exclusive` exclude each other.
    The parsed options contain the function, under `function`.
    """
    group = parser.add_mutually_exclusive_group() if exclusive else parser
    for name, parameter in inspect.signature(function).parameters.items():
        _add_argument(group if name in exclusive else parser, parameter)
    parser.set_defaults(function=function)


def _add_argument(parser: argparse._ActionsContainer, parameter: inspect.Parameter) -> None:
    """Add the argument of a parameter to a parser, or to a group of a parser."""
    names, value_type, option = [parameter.name], parameter.annotation, Option()
    if get_origin(value_type) is Annotated:
        value_type, option = get_args(value_type)
    if NoneType in get_args(value_type):
        value_type = get_args(value_type)[0]
    required = parameter.default is parameter.empty
    default = None if required else parameter.default
    suffix = " (default: %(default)s)" if option.help and isinstance(default, str) else ""
    settings: dict[str, Any] = {"help": option.help + suffix or None, "default": default}
    if get_origin(value_type) in (list, Iterable, Sequence):
        settings["nargs"] = "+"
    if get_origin(value_type) is Literal:
        settings["choices"] = get_args(value_type)
    if parameter.kind is parameter.KEYWORD_ONLY:
        names = ["-o"] if parameter.name == "output" else []
        names.append(option.name or f"--{parameter.name.replace('_', '-')}")
        settings |= {"dest": parameter.name, "required": required, "action": StoreOnce}
    elif not required:
        settings["nargs"] = "?"
    settings |= {"action": "store_true"} if value_type is bool else {"metavar": option.metavar}
    action = parser.add_argument(*names, **settings)
    if option.completer:
        action.completer = option.completer  # type: ignore[attr-defined]


class StoreOnce(argparse.Action):
    """An action that stores the value of an option, refuses a second value, and joins lists given
    several times."""

    is_set = False

    def __call__(self, parser: Any, namespace: Any, values: Any, option_string: Any = None) -> None:
        """Store the value(s) `values` of the option in `namespace`. Raises ArgumentError for a
        second value; a second list is joined to the first."""
        if self.is_set and self.nargs is None:
            raise argparse.ArgumentError(self, f"given twice, the second time as {values}")
        stored = [*getattr(namespace, self.dest), *values] if self.is_set else values
        setattr(namespace, self.dest, stored)
        self.is_set = True


class Parser(argparse.ArgumentParser):
    """A parser that reports errors in one line, and reads words that begin like a negative number
    as values: --beta -1:1:0.1."""

    def __init__(self, **keywords: Any) -> None:
        """Take the keywords of ArgumentParser; the text of a description or an epilog is printed
        verbatim."""
        formatter = argparse.RawDescriptionHelpFormatter  # prints examples verbatim
        super().__init__(**{"formatter_class": formatter, **keywords})
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse the words `args` as argparse does, but refuse unknown options first: argparse might
        take them for values, or report another option as missing."""
        if self._subparsers is None:
            for text in takewhile(lambda text: text != "--", args or ()):
                self._check_option(text)
        return super().parse_known_args(args, namespace)

    def _check_option(self, text: str) -> None:
        """End the process with an error if `text`, a word of a command line, is an unknown option;
        the message has the most similar options."""
        options, name = self._option_string_actions, text.partition("=")[0]
        is_value = " " in text or self._negative_number_matcher.match(text) or text in ("", "-")
        if is_value or text[0] != "-" or name in options or text[:2] in options:
            return
        if name.startswith("--") and any(option.startswith(name) for option in options):
            return  # an abbreviation
        from difflib import get_close_matches

        word = name.lstrip("-")
        words = sorted(option[2:] for option in options if option.startswith("--"))
        suggestions = [option for option in (word, word[:1]) if option in words][:1]
        suggestions = suggestions or [option for option in words if option.startswith(word)]
        suggestions = suggestions or get_close_matches(word, words, 1) or words
        prefix = "one of " if len(suggestions) > 1 else ""
        legal = f"be {prefix}{', '.join(f'--{option}' for option in suggestions)}"
        self.error(str(InputError("option", short_repr(name), legal)))

    def error(self, message: str) -> NoReturn:
        """Print the message in one line on stderr, and end the process with status BAD_INPUT."""
        line = on_one_line(f"roughgas: error: {message} (see `{self.prog} --help`)")
        self.exit(BAD_INPUT, f"{line}\n")

    def call_of(self, arguments: Sequence[str]) -> tuple[Function, NamedValues]:
        """Return the function of the command in the command line `arguments`, and its arguments by
        parameter."""
        options = vars(self.parse_args(arguments))
        return options.pop("function"), options


def add_commands(parser: Parser, commands: Mapping[str, Command]) -> None:
    """Add to a parser the subcommands `commands`, by name, with their arguments and examples."""
    parsers = parser.add_subparsers(
        prog=parser.prog, metavar="COMMAND", required=True, help=argparse.SUPPRESS
    )
    for name, command in commands.items():
        title = "example:" if len(command.examples) == 1 else "examples:"
        epilog = "\n  ".join([title, *command.examples])
        subparser = parsers.add_parser(
            name, help=command.summary, description=command.description, epilog=epilog
        )
        add_arguments(subparser, command.function, command.exclusive)


def overview(title: str, commands: Mapping[str, Command]) -> str:
    """Return the text of a list of commands, by name, with their summaries, a line for each, below
    the line `title`."""
    width = max(map(len, commands))
    lines = [f"  {name:{width}}  {command.summary}" for name, command in commands.items()]
    return "\n".join([f"{title}:", *lines])
