"""Tables of statements, read from YAML: quotations, the data that they are on, and their judges."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import xarray as xr
import yaml

from roughgas.claims import (
    averages,
    evidence,
    materials,
    mixtures,
    of_studies,
    open_questions,
    paper,
)
from roughgas.claims.evidence import NotTestedError
from roughgas.claims.verdicts import (
    NOT_TESTED,
    Finding,
    agreement,
    agreement_in_proportion,
    points,
)

ROOM = (evidence, averages, materials, mixtures, of_studies, open_questions, paper)
FUNCTIONS = {name: one for module in ROOM for name, one in vars(module).items()}
"""The samples and judges that the tables name."""
REFERENCE = """\
S. McNamara and S. Luding, *Energy nonequipartition in systems of inelastic, rough spheres*,
Phys. Rev. E 58, 2247 (1998)"""


class Statement(NamedTuple):
    """A testable statement: `judge` takes the datasets of `experiments`, in that order."""

    name: str
    quote: str
    experiments: tuple[str, ...]
    judge: Callable[..., Finding]
    criterion: str  # what is judged, in a sentence
    fixed: str  # whether the criterion was, before its data were seen


class Subject(NamedTuple):
    """What a table of verdicts is about: its texts, and its statements."""

    title: str
    about: str  # a paragraph
    quotes: str  # the heading of the column of quotations
    statements: tuple[Statement, ...]
    after: str = ""  # a line below the table


def read_subject(name: str) -> Subject:
    """Return the table of statements in the file `name`.yaml of this room."""
    table = yaml.safe_load(Path(__file__).with_name(f"{name}.yaml").read_text(encoding="utf-8"))
    table["about"] = table["about"].format(reference=REFERENCE)
    table["statements"] = tuple(
        _statement(name, **row) for name, row in table["statements"].items()
    )
    return Subject(**table)


def _statement(
    name: str,
    quote: str,
    experiments: list[str],
    fixed: str,
    judge: str = "",
    agrees_with: str = "",
    sample: str = "deviation",
    in_proportion: bool = False,
) -> Statement:
    def agrees(*datasets: xr.Dataset) -> Finding:
        if in_proportion:
            (gas,) = datasets
            return agreement_in_proportion(gas, agrees_with)
        return agreement(FUNCTIONS[sample](*datasets), agrees_with)

    criterion = _said_of(FUNCTIONS[judge or sample])
    if not judge:
        value = criterion.removeprefix("Return ").rstrip(".")
        criterion = f"{value} is compatible with zero: agreement with {agrees_with}"
        criterion += ", also relative to theory." if in_proportion else "."
    decide = FUNCTIONS[judge] if judge else agrees
    return Statement(name, quote, tuple(experiments), decide, criterion, fixed)


def _said_of(function: Callable) -> str:
    """Return the first paragraph of a docstring, as one line."""
    return " ".join((inspect.getdoc(function) or "").split("\n\n")[0].split())


def _size(data: xr.Dataset) -> str:
    """Return a sentence on the size of a cooling gas, on which its R depends; "" of others."""
    about = data.attrs
    if about.get("theory") != "K" or "packing" not in about:
        return ""
    size = f"N = {about['particles']}, packing {about['packing']:.2g}"
    return f"R of the cooling gas is that at {size}."


def examine(statement: Statement, datasets: dict[str, xr.Dataset]) -> Finding:
    """Judge `statement` on `datasets` (by experiment or study), or say why it cannot be judged."""
    missing = [name for name in statement.experiments if name not in datasets]
    try:
        if missing:
            raise NotTestedError(f"no data of {', '.join(missing)}")
        used = [datasets[name] for name in statement.experiments]
        finding = statement.judge(*used)
    except NotTestedError as lack:
        reason = str(lack)
        return Finding(NOT_TESTED, f"{reason[0].upper()}{reason[1:]}.")
    for sentence in filter(None, map(_size, used)):
        finding = finding.noting(sentence)
    aside = sum(data.attrs.get("set_aside", 0) for data in used)
    if not aside:
        return finding
    return finding.noting(f"{points(aside)} not known to be in a steady state set aside.")
