"""Parsers of all commands, and the command lines in the examples of their help texts."""

import argparse
import re
import shlex

from roughgas import cli

LINE = re.compile(r"\broughgas ([^#|)\n]*)")


def commands():
    parser = cli.parser_of()
    (subparsers,) = (
        action for action in parser._actions if isinstance(action, argparse._SubParsersAction)
    )
    return subparsers.choices


def examples(parser):
    """Return the arguments of `roughgas` in each example of a help text."""
    return [shlex.split(line) for line in LINE.findall(parser.epilog or "")]
