"""argparse as `roughgas` uses it: errors in one line, examples as they are written, and commands in
two groups."""

import argparse
import re
from collections.abc import Iterable, Mapping
from typing import Any, NoReturn

BAD_INPUT = 2


class Parser(argparse.ArgumentParser):
    """A parser that refuses in one line, and takes what begins like a negative number for a value:
    --beta -1:1:0.1."""

    def __init__(self, *arguments: Any, **others: Any) -> None:
        super().__init__(*arguments, **others)
        self._negative_number_matcher = re.compile(r"-\.?\d")

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"roughgas: error: {message} (see `{self.prog} --help`)\n")


class Formatter(argparse.HelpFormatter):
    """Wraps paragraphs, but leaves those with indented lines, which are examples, as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        fill = super()._fill_text
        paragraphs = text.split("\n\n")
        return "\n\n".join(one if "\n " in one else fill(one, width, indent) for one in paragraphs)


class Commands:
    """The commands of a parser: added as with argparse's `add_subparsers`, shown in groups."""

    def __init__(self, parser: Parser) -> None:
        self._parsers = parser.add_subparsers(
            prog=parser.prog, metavar="COMMAND", required=True, help=argparse.SUPPRESS
        )
        self._summaries: dict[str, str] = {}

    def add_parser(self, name: str, *, help: str, **about: Any) -> Parser:
        """The parser of a command; `help` is its line in the overview."""
        self._summaries[name] = help
        return self._parsers.add_parser(name, formatter_class=Formatter, **about)

    def overview(self, groups: Mapping[str, Iterable[str]]) -> str:
        """For each group, by its title, a line for each of its commands that was added."""
        width = max(map(len, self._summaries))
        return "\n\n".join(
            f"{title}:\n"
            + "\n".join(
                f"  {name:{width}}  {self._summaries[name]}"
                for name in names
                if name in self._summaries
            )
            for title, names in groups.items()
        )


def examples(*commands: str) -> str:
    """The end of a command's help: command lines that work."""
    return "\n".join(
        ["examples:" if len(commands) > 1 else "example:"] + [f"  {c}" for c in commands]
    )
