"""Statements and their verdicts: of McNamara & Luding (1998), on its experiments, and of studies.

Tables in YAML hold quotations, the data that they are on, and their judges. Verdicts are JSON, for
programs, and Markdown, for people: same data, same bytes.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import xarray as xr
import yaml

from roughgas import base
from roughgas.base import InputError
from roughgas.base.files import module_of, write_text
from roughgas.claims import evidence, paper
from roughgas.claims.evidence import NOT_TESTED, Finding, NotTestedError, load_all, points, text
from roughgas.statistics.errors import SIGNIFICANT

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
    ours: bool = False  # whether we state it, not the text that the table is about

    @property
    def text(self) -> str:
        """The statement in quotation marks, or as ours without them."""
        return f"Ours: {self.quote}" if self.ours else f"“{self.quote}”"


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
    texts = row["criterion"], row["fixed"], row.get("ours", False)
    return Statement(name, row["quote"], tuple(row["experiments"]), judge, *texts)


def _agrees(row: Mapping[str, Any], functions: Mapping[str, Any]) -> Callable[..., Finding]:
    """Return the judge of agreement with what `agrees_with` names."""
    of, other = functions[row.get("sample", "deviation")], row["agrees_with"]
    if row.get("in_proportion"):
        return lambda gas: evidence.agreement_in_proportion(gas, other)
    return lambda *datasets: evidence.agreement(of(*datasets), other)


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
    if missing:
        return Finding(NOT_TESTED, f"No data of {', '.join(missing)}.")
    used = [datasets[name] for name in statement.experiments]
    try:
        finding = statement.judge(*used)
    except NotTestedError as lack:
        reason = str(lack)
        return Finding(NOT_TESTED, f"{reason[0].upper()}{reason[1:]}.")
    for sentence in filter(None, map(_size, used)):
        finding = finding.with_note(sentence)
    aside = sum(data.attrs.get("set_aside", 0) for data in used)
    if not aside:
        return finding
    return finding.with_note(f"R of {points(aside)} not known to be in a steady state set aside.")


SCHEMA_VERSION = 1
LIMITS = ("agree", "limit", "tendency", "few", "near", "far")
TOLERANCES = {name: getattr(evidence, name.upper()) for name in LIMITS}
TOLERANCES |= {"significant_sigma": SIGNIFICANT}
HOW_TO_READ = """\
How to read it. A number is "value, 95 % low to high (sigma)": its 95 % interval by Student's t, and
its distance from 0 in sigma, which is the Gaussian z with the probability of Student's t. With few
degrees of freedom the interval is wider than 4 standard errors. Significance and size count
separately: with small errors a theory that is 2 % off is 20 sigma off and still useful. R agrees
where it is within {agree:g}, and disagrees beyond {limit:g} where the difference is significant,
{significant_sigma:g} sigma or more. In between, agreement is qualified, and so it is where errors
are too large to tell at more than a few points ({few:.0%} of them). Where R spans decades it is
also judged relative to theory: agreement is qualified where more than a few points differ by
{near:.0%} of theory, and fails at {far:.0%}. A direction (above, below) needs {tendency:g} in R.
R of points that are not in a steady state is set aside, and these are counted. docs/claims.md gives
the reason for each of these numbers, and says what was fixed before the data were seen.

Errors are those of the reduced datasets (`R_stderr`, with `R_dof` degrees of freedom), which pool
the scatter over seeds with the errors within the runs; `coverage.md` shows how often their
intervals hold the truth."""


def judge(
    reduced: Iterable[str | Path], json_path: str | Path, md_path: str | Path, subject: Subject
) -> list[Finding]:
    """Judge every statement of a subject on reduced datasets and studies; write JSON and Markdown.

    Statements whose experiments or studies are not among the datasets are "not tested".
    Raises InputError where the datasets are of several scales.
    """
    datasets = {name: data for path in reduced for name, data in load_all(path).items()}
    scales = sorted({data.attrs["scale"] for data in datasets.values()})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    findings = [examine(statement, datasets) for statement in subject.statements]
    write_text(json_path, as_json(subject, findings, datasets, *scales))
    write_text(md_path, as_markdown(subject, findings, *scales))
    return findings


def as_json(
    subject: Subject, findings: list[Finding], datasets: dict[str, xr.Dataset], scale: str
) -> str:
    """Return all findings as JSON, with the tolerances used and the data they rest on."""
    content = {
        "schema_version": SCHEMA_VERSION,
        "title": subject.title,
        "scale": scale,
        "tolerances": TOLERANCES,
        "data": {name: _data(data) for name, data in sorted(datasets.items())},
        "claims": list(map(_claim, subject.statements, findings)),
    }
    return base.as_json(content, indent=1) + "\n"


def _data(data: xr.Dataset) -> dict[str, Any]:
    """Return what a verdict rests on, of one experiment or study."""
    if "experiment" not in data.attrs:
        return {"study": data.attrs["title"]}
    counts = {name: int(data.attrs[name]) for name in ("particles", "points", "set_aside")}
    swept = {name: data.attrs[name] for name in ("swept",) if name in data.attrs}
    return counts | {"seeds": int(data.n_seeds.max()), "theory": data.attrs["theory"]} | swept


def _claim(statement: Statement, finding: Finding) -> dict[str, Any]:
    numbers = [{"label": label} | value.record() for label, value in finding.numbers]
    deciding = numbers[0] if numbers else {}
    return {
        "id": statement.name,
        "quote": statement.quote,
        "ours": statement.ours,
        "criterion": statement.criterion,
        "fixed": statement.fixed,
        "experiments": list(statement.experiments),
        "verdict": finding.verdict,
        "reason": finding.reason,
        "deviation": deciding.get("value"),
        "error": deciding.get("error"),
        "ci95": deciding.get("ci95"),
        "sigma": deciding.get("sigma"),
        "numbers": numbers,
    }


def as_markdown(subject: Subject, findings: list[Finding], scale: str) -> str:
    """Return a table of all verdicts, then the reasons and numbers of each, as Markdown."""
    rows = [(i, *row) for i, row in enumerate(zip(subject.statements, findings, strict=True), 1)]
    head = ("#", subject.quotes, "Deciding number", "Verdict")
    parts = [
        f"# {subject.title}",
        f"{subject.about}\n",
        HOW_TO_READ.format(**TOLERANCES),
        f"Sizes and run lengths: those of the scale `{scale}` in config.yaml.",
        _counts(subject.statements, findings),
        base.markdown(head, [_cells(*row) for row in rows]).rstrip(),
        *([subject.after] if subject.after else []),
        "## Reasons and numbers",
        *(_details(*row) for row in rows),
    ]
    return "\n\n".join(parts) + "\n"


def _counts(statements: Iterable[Statement], findings: Iterable[Finding]) -> str:
    """Return the number of statements of each verdict, those that are ours apart."""
    pairs, sentences = list(zip(statements, findings, strict=True)), []
    for ours, kind in ((False, "statements"), (True, "statements of ours")):
        count = Counter(finding.verdict for one, finding in pairs if one.ours == ours)
        if count:
            verdicts = (f"{one} {count[one]}" for one in (*evidence.VERDICTS, NOT_TESTED))
            sentences.append(f"Of {count.total()} {kind}: {', '.join(verdicts)}.")
    return " ".join(sentences)


def _cells(number: int, statement: Statement, finding: Finding) -> tuple[object, ...]:
    deciding = "".join(f"{label}: {text(value)}" for label, value in finding.numbers[:1])
    return number, statement.text, deciding, f"**{finding.verdict}**"


def _details(number: int, statement: Statement, finding: Finding) -> str:
    numbers = "".join(f"\n- {label}: {text(value)}" for label, value in finding.numbers)
    return (
        f"### {number}. {statement.name}: {finding.verdict}\n\n> {statement.text}\n\n"
        f"{finding.reason}\n\n- criterion: {statement.criterion} Fixed {statement.fixed}.\n"
        f"- data: {', '.join(statement.experiments)}{numbers}"
    )


PAPER = read_subject("paper")
"""The statements of the paper, on its own experiments."""
