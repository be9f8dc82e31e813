"""Numbers and tables of the pages of a checkout, from the last results, which are committed.

They are of figures/numbers.json and of figures/evidence.csv. A study that quotes numbers in its
README.md has quoted.py, with `numbers` and `tables`: functions of all rows of evidence that return
texts by name. `numbers.filled` takes the numbers by their marks, such as STUDY.NAME.
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType

from roughgas.base.files import study_module
from roughgas.results import papers
from roughgas.results.comparison import Row, read_rows
from roughgas.results.row_counts import row_counts

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
    """Return the tables in README.md of the studies in `root`, Markdown by study and name.

    The table `verdicts` is in every study of another group's paper.
    """
    evidence = read_rows(Path(root, "figures", "evidence.csv"))
    rows = papers.read(Path(root, "figures", "papers.csv"))
    verdicts = {
        (study, "verdicts"): papers.table_of_statements([row for row in rows if row.study == study])
        for study in dict.fromkeys(row.study for row in rows)
    }
    return verdicts | {
        (study, name): table
        for study, module in _modules(root)
        for name, table in module.tables(evidence).items()
    }


def _modules(root: str | Path) -> Iterator[tuple[str, ModuleType]]:
    """Yield the name of each study with quoted.py, and this module."""
    for path in sorted(Path(root).glob(f"studies/*/{MODULE}.py")):
        yield path.parent.name, study_module(path.parent, MODULE)
