"""The page docs/claims.md: its tables of tolerances and criteria, which are made from the code.

    .venv/bin/python -m tests.claims.page

writes them anew.
"""

import ast
import inspect
from itertools import pairwise
from pathlib import Path

from roughgas.base.formatting import markdown
from roughgas.claims import OPEN_QUESTIONS, PAPER, averages, paper, verdicts
from roughgas.statistics import errors

PAGE = Path(__file__).parents[2] / "docs" / "claims.md"
BEGIN, END = "<!-- {}: made by tests/claims/page.py -->\n", "<!-- until here -->\n"
SAID = {"AGREE": verdicts, "LIMIT": verdicts, "TENDENCY": verdicts, "FEW": verdicts}
SAID |= {"NEAR": verdicts, "FAR": verdicts, "SIGNIFICANT": errors, "INTERMEDIATE": paper}
SAID |= {"CONSIDERABLY": paper, "MOST": averages}
"""What decides verdicts, and where it stands."""


def tables():
    """The tables that follow from the code, by name."""
    subjects = {"paper": PAPER, "open questions": OPEN_QUESTIONS}
    found = {name: criteria(of) for name, of in subjects.items()}
    return {"tolerances": tolerances(), **found}


def tolerances():
    """Each tolerance with its value, and what its docstring says."""
    found = ((name, getattr(of, name), said(of)[name]) for name, of in SAID.items())
    rows = [(f"`{name}`", f"{value:.3g}", about) for name, value, about in found]
    return markdown(("tolerance", "value", "what it is, and why so large"), rows)


def criteria(subject):
    """Each statement of a subject with its criterion, and when that was fixed."""
    rows = [(f"`{one.name}`", one.criterion, one.fixed) for one in subject.statements]
    return markdown(("statement", "criterion", "fixed"), rows)


def said(module):
    """The docstring of each constant of a module, as one line."""
    body = ast.parse(inspect.getsource(module)).body
    return {
        ast.unparse(one.targets[0]): " ".join(text.value.value.split())
        for one, text in pairwise(body)
        if isinstance(one, ast.Assign)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
    }


def written(name):
    """A table that is on the page."""
    return PAGE.read_text(encoding="utf-8").split(BEGIN.format(name))[1].split(END)[0]


def _write(name, table):
    text, begin = PAGE.read_text(encoding="utf-8"), BEGIN.format(name)
    PAGE.write_text(text.replace(begin + written(name) + END, begin + table + END), "utf-8")


if __name__ == "__main__":
    for name, table in tables().items():
        _write(name, table)
