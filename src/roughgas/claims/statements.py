"""Tables of statements, read from YAML: quotations, the data that they are on, and their judges."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import xarray as xr
import yaml

from roughgas.base import InputError
from roughgas.base.files import module_of
from roughgas.claims import evidence, paper
from roughgas.claims.evidence import NotTestedError
from roughgas.claims.verdicts import (
    NOT_TESTED,
    Finding,
    agreement,
    agreement_in_proportion,
    points,
)

OWN = (evidence, paper)
"""The modules whose samples and judges every table may name."""
REFERENCE = """\
S. McNamara and S. Luding, *Energy nonequipartition in systems of inelastic, rough spheres*,
Phys. Rev. E 58, 2247 (1998)"""
ON_STUDY = {
    "about": "The statements of studies/{name}, computed from its datasets.",
    "quotes": "Statement",
}


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
    table = _read(Path(__file__).with_name(f"{name}.yaml"))
    table["about"] = table["about"].format(reference=REFERENCE)
    rows = table["statements"].items()
    table["statements"] = tuple(_statement(one, row, OWN) for one, row in rows)
    return Subject(**table)


def read_study(folder: str | Path, title: str, experiments: Iterable[str]) -> Subject:
    """Return the table of statements in claims.yaml of the study in `folder`, already checked.

    Its judges are those of judges.py beside it, and the general ones. `experiments` are those of
    the study, called NAME.KEY. Raises InputError for a judge that is not there.
    """
    folder = Path(folder)
    own = {name.partition(".")[2]: name for name in experiments} | {"tasks": folder.name}
    judges = (module_of(folder, "judges"),) if (folder / "judges.py").exists() else ()
    statements = []
    for name, row in _read(folder / "claims.yaml").items():
        row |= {"experiments": [own.get(one, one) for one in row["experiments"]]}
        try:
            statements.append(_statement(name, row, (*OWN, *judges)))
        except KeyError as error:
            key = f"studies/{folder.name}/claims.yaml: {name}: judge"
            legal = "be a function of roughgas.judging or judges.py"
            raise InputError(key, error, legal) from error
    about = {key: text.format(name=folder.name) for key, text in ON_STUDY.items()}
    return Subject(f"{title}: the verdicts", statements=tuple(statements), **about)


def _read(path: Path) -> Any:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def _statement(name: str, row: Mapping[str, Any], modules: tuple[ModuleType, ...]) -> Statement:
    functions = {key: one for module in modules for key, one in vars(module).items()}
    judge = functions[row["judge"]] if "judge" in row else _agrees(row, functions)
    texts = row["quote"], tuple(row["experiments"]), judge, row["criterion"], row["fixed"]
    return Statement(name, *texts)


def _agrees(row: Mapping[str, Any], functions: Mapping[str, Any]) -> Callable[..., Finding]:
    """Return the judge of agreement with what `agrees_with` names."""
    of, other = functions[row.get("sample", "deviation")], row["agrees_with"]
    if row.get("in_proportion"):
        return lambda gas: agreement_in_proportion(gas, other)
    return lambda *datasets: agreement(of(*datasets), other)


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
        finding = finding.with_note(sentence)
    aside = sum(data.attrs.get("set_aside", 0) for data in used)
    if not aside:
        return finding
    return finding.with_note(f"{points(aside)} not known to be in a steady state set aside.")
