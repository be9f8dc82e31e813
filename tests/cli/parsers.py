"""All commands with their parsers, and the command lines that their help texts give."""

import argparse
import re
import shlex

from roughgas import cli

LINE = re.compile(r"\broughgas ([^#|)\n]*)")


def commands():
    parser = cli.parser_of()
    (found,) = (one for one in parser._actions if isinstance(one, argparse._SubParsersAction))
    return found.choices


def examples(parser):
    """The arguments of `roughgas` in each example of a help text."""
    return [shlex.split(line) for line in LINE.findall(parser.epilog or "")]
