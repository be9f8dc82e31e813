"""Numbers and tables of the pages of a checkout, from the last results, which are committed.

They are of figures/numbers.json and of figures/evidence.csv. A study that quotes numbers in its
README.md has quoted.py, with `numbers` and `tables`: functions of all rows of evidence that return
texts by name. `numbers.filled` takes the numbers by their marks, such as STUDY.NAME.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from types import ModuleType

import numpy as np

from roughgas.base.files import study_module
from roughgas.claims.numbers import IN_WORDS
from roughgas.results.comparison import Row, read_rows
from roughgas.results.row_counts import row_counts
from roughgas.statistics.errors import sum_error
from roughgas.statistics.estimates import Estimate

MODULE = "quoted"
"""Module of a study that makes the numbers and tables of its README.md."""
Evidence = Sequence[tuple[str, Row]]
"""Rows of evidence, each as (name of its study, row)."""


def numbers_of_pages(root: str | Path) -> dict[str, str]:
    """Return all numbers that pages of the checkout in `root` quote, as texts by mark."""
    figures = Path(root, "figures")
    evidence = read_rows(figures / "evidence.csv")
    texts = json.loads((figures / "numbers.json").read_text(encoding="utf-8"))
    texts |= row_counts(evidence)
    for study, module in _modules(root):
        texts |= {f"{study}.{name}": text for name, text in module.numbers(evidence).items()}
    return texts


def tables_of_studies(root: str | Path) -> dict[tuple[str, str], str]:
    """Return the tables in README.md of the studies in `root`, Markdown by study and name."""
    evidence = read_rows(Path(root, "figures", "evidence.csv"))
    return {
        (study, name): table
        for study, module in _modules(root)
        for name, table in module.tables(evidence).items()
    }


def _modules(root: str | Path) -> Iterator[tuple[str, ModuleType]]:
    """Yield the name of each study with quoted.py, and this module."""
    for path in sorted(Path(root).glob(f"studies/*/{MODULE}.py")):
        yield path.parent.name, study_module(path.parent, MODULE)


# ---------------------------------------------------------------------- for studies


def rows_of(evidence: Evidence, study: str, quantity: str, tier: str = "") -> Mapping[str, Row]:
    """Return the rows of a quantity of a study by their state `at`, of all tiers or of one."""
    return {
        row.at: row
        for name, row in evidence
        if (name, row.quantity) == (study, quantity) and tier in ("", row.tier)
    }


def relative(row: Row) -> Estimate:
    """Return ours over theirs, which count as exact."""
    return row.ours.scaled(1.0 / row.theirs.value)


def mean_of(estimates: Iterable[Estimate]) -> Estimate:
    """Return the mean of independent estimates, with the error that follows from their errors."""
    value, stderr, dof = np.array(list(estimates)).T
    error = sum_error(stderr, dof)
    return Estimate(float(value.mean()), float(error.stderr) / len(value), float(error.dof))


def rounded(value: float, decimals: int = 0) -> str:
    """Return a number as text with so many decimals, and with a minus sign, no hyphen."""
    return _with_minus(f"{value:.{decimals}f}")


def with_error(estimate: Estimate, scale: float = 1.0) -> str:
    """Return an estimate times `scale` as text, such as −0.0012(3)."""
    return _with_minus(f"{estimate.scaled(scale)}")


def in_words(count: int) -> str:
    """Return a count as a word, or in digits if it is large."""
    words = IN_WORDS.split()
    return words[count] if count < len(words) else f"{count}"


def _with_minus(text: str) -> str:
    return text.replace("-", "−")
