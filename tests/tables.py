"""Tables of cases in a test: a line each."""

import re
import textwrap

import yaml


def rows(text):
    """The rows of a table, as tuples: cells are YAML, but for the last, which is plain text.

    Cells stand between " | "; an indented line goes on with the one before it.
    """
    lines = re.sub(r"\n +", " ", textwrap.dedent(text).strip()).splitlines()
    return [(*map(yaml.safe_load, cells), last) for *cells, last in (x.split(" | ") for x in lines)]
