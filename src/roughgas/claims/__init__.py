"""Claims, statements with their judges: of McNamara & Luding (1998) on its experiments, of studies.

Tables in YAML hold quotations, the names of the data, and judges. A judge is a function of datasets
that returns a finding: a verdict (holds, holds with a qualification, fails) with its reason and
numbers. Verdicts are written as JSON, for programs, and as Markdown, for people; the same data give
the same bytes.
"""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import xarray as xr
import yaml

from roughgas import base
from roughgas.base import InputError, NamedValues, Record
from roughgas.base.files import study_module, write_text
from roughgas.claims import driven, verdicts
from roughgas.claims.variables import THEORY, deviation_of
from roughgas.claims.verdicts import (
    FAILS,
    NOT_TESTED,
    Finding,
    NotTestedError,
    check_power,
    load_all,
    points,
    text,
)
from roughgas.statistics.estimates import POWER, SIGNIFICANCE, SIGNIFICANT

GENERAL_MODULES = (verdicts, driven)
"""Modules whose samples and judges are available to every table."""
REFERENCE = """\
S. McNamara and S. Luding, *Energy nonequipartition in systems of inelastic, rough spheres*,
Phys. Rev. E 58, 2247 (1998)"""
STATEMENTS = "statements"
OPTIONAL_KEYS = ("ours", "conclusion", "refuted_beyond")
"""Keys of a row of claims.yaml that are fields of `Statement` with a default."""
HEAD_KEYS = ("title", "about", "quotes", "after")
"""Texts that the head of a table may replace."""
DEFAULT_TEXTS = {
    "about": "The statements of studies/{name}, computed from its datasets.",
    "quotes": "Statement",
}


WHEN = {
    "before data": "before its data",
    "partly after data": "in part after its data",
    "after data": "after its data",
}
"""Times at which a criterion was fixed, in claims.yaml, and in sentences."""


class Fixed(NamedTuple):
    """When a criterion was fixed: a key of WHEN."""

    when: str
    tries: int = 1  # criteria that the data have been judged by, this one included
    note: str = ""  # what was known, or changed

    @property
    def text(self) -> str:
        """The time in words, with the number of tries if there were several, and the note."""
        tries = f", {self.tries} tries" if self.tries > 1 else ""
        return f"{WHEN[self.when]}{tries}{'; ' * bool(self.note)}{self.note}"

    @property
    def mark(self) -> str:
        """A remark beside a verdict by a criterion that was chosen after its data, or tried."""
        if self == Fixed("before data", note=self.note):
            return ""
        return f"criterion {WHEN[self.when]}, {self.tries} {'try' if self.tries == 1 else 'tries'}"


class Statement(NamedTuple):
    """A testable statement; `judge` takes the datasets of `experiments`, in their order."""

    name: str
    quote: str
    experiments: tuple[str, ...]
    judge: Callable[..., Finding]
    criterion: str  # in a sentence
    fixed: Fixed
    ours: bool = False  # whether it is our statement, not a quotation
    conclusion: str = ""  # a few words for the title of a figure of data in which it holds
    refuted_beyond: float = math.inf  # deviation of the deciding number that refutes it

    @property
    def text(self) -> str:
        """The statement as text in quotation marks, or, if it is ours, marked as such."""
        return f"Ours: {self.quote}" if self.ours else f"“{self.quote}”"


class Subject(NamedTuple):
    """A table of statements with its texts, for verdicts."""

    title: str
    about: str  # a paragraph
    quotes: str  # heading of the column of quotations
    statements: tuple[Statement, ...]
    after: str = ""  # a line below the table
    reservation: str = ""  # why its criteria were not fixed before these data


def read_study(
    folder: str | Path, title: str, experiments: Iterable[str], reservation: str = ""
) -> Subject:
    """Return the table of statements in claims.yaml of the study in `folder`, already checked.

    `title` is the study's. The table may have a head, whose texts replace the default texts; its
    rows are then under `statements`. Judges come from judges.py of the study and from the general
    modules, the theory of variables from theory.py. `experiments` are the full names, NAME.KEY, of
    the study's experiments, `reservation` says why its criteria were not fixed before these data.
    Raises InputError for an unknown judge.
    """
    folder = Path(folder)
    theory = study_module(folder, THEORY) if (folder / f"{THEORY}.py").exists() else None
    full_names = {name.partition(".")[2]: name for name in experiments} | {"tasks": folder.name}
    judges = (study_module(folder, "judges"),) if (folder / "judges.py").exists() else ()
    table, statements = _read(folder / "claims.yaml"), []
    for name, row in table.get(STATEMENTS, table).items():
        row |= {
            "experiments": [
                full_names.get(experiment, experiment) for experiment in row["experiments"]
            ]
        }
        try:
            statements.append(_statement(name, row, (*GENERAL_MODULES, *judges), theory))
        except KeyError as error:
            key, file = ("variable", "theory.py") if "variable" in row else ("judge", "judges.py")
            legal = f"be a function of {file}" + " or roughgas.judging" * (key == "judge")
            raise InputError(
                f"studies/{folder.name}/claims.yaml: {name}: {key}", error, legal
            ) from error
    head = {key: table[key] for key in HEAD_KEYS if key in table} if STATEMENTS in table else {}
    texts = {"title": f"{title}: the verdicts"} | DEFAULT_TEXTS | head
    texts |= {"about": texts["about"].format(name=folder.name, reference=REFERENCE)}
    return Subject(statements=tuple(statements), reservation=reservation, **texts)


def _read(path: Path) -> Any:
    """Return the content of a YAML file, which `read_study` has already checked."""
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def _statement(
    name: str, row: Record, modules: tuple[ModuleType, ...], theory: ModuleType | None
) -> Statement:
    """Return the statement `name` from its row in claims.yaml, with its judge from the modules.

    `theory` is theory.py of the study, or None. Raises KeyError for an unknown judge.
    """
    functions = {key: function for module in modules for key, function in vars(module).items()}
    if "judge" in row:
        judge = functions[row["judge"]]
    elif "variable" in row:
        judge = _agrees_with_theory(row, (vars(theory) if theory else {})[row["variable"]])
    else:
        judge = _agrees(row, functions)
    optional = {key: row[key] for key in OPTIONAL_KEYS if key in row}
    experiments, fixed = tuple(row["experiments"]), Fixed(**row["fixed"])
    return Statement(name, row["quote"], experiments, judge, row["criterion"], fixed, **optional)


def _agrees(row: Record, functions: Mapping[str, Callable[..., Any]]) -> Callable[..., Finding]:
    """Return the judge of a row of claims.yaml with `agrees_with`, the name of a reference.

    It judges whether the row's sample, by default R - theory, is compatible with zero. `functions`
    has the samples by name.
    """
    sample, reference = functions[row.get("sample", "deviation")], row["agrees_with"]
    if row.get("in_proportion"):
        return lambda gas: verdicts.agreement_in_proportion(gas, reference)
    return lambda *datasets: verdicts.agreement(sample(*datasets), reference, **_tolerances(row))


def _agrees_with_theory(row: Record, theory: Callable[..., xr.DataArray]) -> Callable[..., Finding]:
    """Return the judge of a row of claims.yaml with `variable`, the name of a measured quantity.

    It judges whether the variable minus `theory`, a function of the dataset, is compatible with
    zero.
    """
    variable, relative = row["variable"], row.get("relative", False)

    def judge(gas: xr.Dataset) -> Finding:
        """Return the finding on a reduced dataset."""
        sample = deviation_of(gas, variable, theory(gas), relative)
        return verdicts.agreement(sample, row["agrees_with"], **_tolerances(row))

    return judge


def _tolerances(row: Record) -> dict[str, float]:
    """Return the tolerances of `verdicts.agreement` that a row of claims.yaml sets."""
    names = {"within": "agree", "refuted_beyond": "disagree"}
    return {names[key]: row[key] for key in names if key in row}


def _size(data: xr.Dataset) -> str:
    """Return a sentence on the size of a cooling gas, on which its R depends; "" for other gases.

    R = E_rot/(E_rot + E_trans); `data` is a reduced dataset with theory.
    """
    attributes = data.attrs
    if attributes.get("theory") != "K" or "packing" not in attributes:
        return ""
    size = f"N = {attributes['particles']}, packing {attributes['packing']:.2g}"
    return f"R of the cooling gas is that at {size}."


def examine(statement: Statement, datasets: dict[str, xr.Dataset]) -> Finding:
    """Return the finding on a statement from datasets by experiment or study.

    It is "not tested", with a reason, if data are missing or cannot decide, and if its test could
    not have failed: if deviations that refute it would have been hidden by errors.
    """
    missing = [name for name in statement.experiments if name not in datasets]
    if missing:
        return Finding(NOT_TESTED, f"No data of {', '.join(missing)}.")
    used = [datasets[name] for name in statement.experiments]
    try:
        finding = statement.judge(*used)
        if finding.verdict != FAILS and math.isfinite(statement.refuted_beyond):
            check_power(finding.smallest_deviation, statement.refuted_beyond)
    except NotTestedError as reason_not_tested:
        reason = str(reason_not_tested)
        return Finding(NOT_TESTED, f"{reason[0].upper()}{reason[1:]}.")
    for sentence in filter(None, map(_size, used)):
        finding = finding.with_note(sentence)
    set_aside = sum(data.attrs.get("set_aside", 0) for data in used)
    if not set_aside:
        return finding
    return finding.with_note(
        f"R of {points(set_aside)} not known to be in a steady state set aside."
    )


SCHEMA_VERSION = 1
TOLERANCES = {
    "agree": verdicts.AGREE,
    "limit": verdicts.DISAGREE,
    "tendency": verdicts.TENDENCY,
    "few": verdicts.EXCEPTIONS,
    "near": verdicts.AGREE_RELATIVE,
    "far": verdicts.DISAGREE_RELATIVE,
    "significant_sigma": SIGNIFICANT,
    "significance": SIGNIFICANCE,
    "power": POWER,
}
HOW_TO_READ = """\
How to read it. A number is "value, 95 % low to high (sigma)": its 95 % interval by Student's t, and
its distance from 0 in sigma, which is the Gaussian z with the probability of Student's t. With few
degrees of freedom the interval is wider than 4 standard errors. Significance and size count
separately: with small errors a theory that is 2 % off is 20 sigma off and still useful. R agrees
where it is within {agree:g}, and disagrees beyond {limit:g} where the difference is significant:
its two-sided probability by Student's t is below {significance:.2g}, {significant_sigma:g} sigma.
In between, agreement is qualified, and so it is where errors are too large to tell at more than a
few points ({few:.0%} of them). Where R spans decades it is
also judged relative to theory: agreement is qualified where more than a few points differ by
{near:.0%} of theory, and fails at {far:.0%}. A direction (above, below) needs {tendency:g} in R.
R of points that are not in a steady state is set aside, and these are counted. Each statement has
the smallest deviation of its deciding number that the test could have seen, with probability
{power:g}, at half of its points; a test that deviations large enough to refute the statement would
have passed is "not tested". docs/evidence.md
gives the reason for each of these numbers, and says what was fixed before the data were seen.

Errors are those of the reduced datasets (`R_stderr`, with `R_dof` degrees of freedom), which pool
the scatter over seeds with the errors within the runs; `coverage.md` shows how often their
intervals hold the truth."""


def judge(
    reduced: Iterable[str | Path], json_path: str | Path, md_path: str | Path, subject: Subject
) -> list[Finding]:
    """Judge every statement of a subject on the datasets at paths; write JSON and Markdown.

    `reduced` are the paths of reduced datasets and of datasets of studies. Statements whose
    experiments or studies are missing among the datasets are "not tested". Returns the findings in
    the order of the statements. Raises InputError for datasets of several scales.
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
    """Return all findings as JSON, with the tolerances, the scale and a summary of the datasets.

    `datasets` are by experiment or study.
    """
    content = {
        "schema_version": SCHEMA_VERSION,
        "title": subject.title,
        "scale": scale,
        "reservation": subject.reservation,
        "about": subject.about,
        "how_to_read": HOW_TO_READ.format(**TOLERANCES),
        "summary": _counts(subject.statements, findings),
        "after": subject.after,
        "tolerances": TOLERANCES,
        "data": {name: _data(data) for name, data in sorted(datasets.items())},
        "claims": [
            _claim(statement, finding, subject.reservation)
            for statement, finding in zip(subject.statements, findings, strict=True)
        ],
    }
    return base.as_json(content, indent=1) + "\n"


def _data(data: xr.Dataset) -> NamedValues:
    """Return a summary of the dataset of an experiment or study, for JSON, by name.

    It has numbers of particles, points and seeds, and the kind of theory; of a study the title.
    """
    if "experiment" not in data.attrs:
        return {"study": data.attrs["title"]}
    counts = {name: int(data.attrs[name]) for name in ("particles", "points", "set_aside")}
    swept = {name: data.attrs[name] for name in ("swept",) if name in data.attrs}
    return counts | {"seeds": int(data.n_seeds.max()), "theory": data.attrs["theory"]} | swept


def _claim(statement: Statement, finding: Finding, reservation: str) -> NamedValues:
    """Return a statement and its finding by name, as they stand in JSON.

    `text` is the statement as pages show it, `mark` a remark beside its verdict, "" without one.

    The deciding number, the first, has `deviation` (its value), `error` (standard error), `ci95`
    (half width of its 95 % interval) and `sigma` (distance from 0); `detectable` is the smallest
    deviation that the test could have seen, null if it is unknown.
    """
    numbers = [
        {"label": label} | value.record() | {"text": text(value)}
        for label, value in finding.numbers
    ]
    deciding = numbers[0] if numbers else {}
    detectable = finding.smallest_deviation
    return {
        "id": statement.name,
        "quote": statement.quote,
        "ours": statement.ours,
        "text": statement.text,
        "criterion": statement.criterion,
        "fixed": statement.fixed.text,
        "fixed_when": statement.fixed.when,
        "tries": statement.fixed.tries,
        "mark": _mark(statement, reservation),
        "experiments": list(statement.experiments),
        "verdict": finding.verdict,
        "reason": finding.reason,
        "deviation": deciding.get("value"),
        "error": deciding.get("error"),
        "ci95": deciding.get("ci95"),
        "sigma": deciding.get("sigma"),
        "detectable": float(f"{detectable:.6g}") if math.isfinite(detectable) else None,
        "numbers": numbers,
    }


def as_markdown(subject: Subject, findings: list[Finding], scale: str) -> str:
    """Return a table of all verdicts, and the reasons and numbers of each, as Markdown.

    `scale` is the name of the scale of the data, such as "paper".
    """
    rows = [(i, *row) for i, row in enumerate(zip(subject.statements, findings, strict=True), 1)]
    head = ("#", subject.quotes, "Deciding number", "Could have seen", "Verdict")
    paragraphs = [
        f"# {subject.title}",
        *(
            [f"**Not fixed before these data.** {subject.reservation}"]
            if subject.reservation
            else []
        ),
        f"{subject.about}\n",
        HOW_TO_READ.format(**TOLERANCES),
        f"Sizes and run lengths: those of the scale `{scale}` in config.yaml.",
        _counts(subject.statements, findings),
        base.markdown(head, [_cells(*row, subject.reservation) for row in rows]).rstrip(),
        *([subject.after] if subject.after else []),
        "## Reasons and numbers",
        *(_details(*row, subject.reservation) for row in rows),
    ]
    return "\n\n".join(paragraphs) + "\n"


def _counts(statements: Iterable[Statement], findings: Iterable[Finding]) -> str:
    """Return sentences with the numbers of statements of each verdict, ours separately."""
    pairs, sentences = list(zip(statements, findings, strict=True)), []
    for ours, kind in ((False, "statements"), (True, "statements of ours")):
        count = Counter(finding.verdict for statement, finding in pairs if statement.ours == ours)
        if count:
            counts = (f"{verdict} {count[verdict]}" for verdict in (*verdicts.VERDICTS, NOT_TESTED))
            sentences.append(f"Of {count.total()} {kind}: {', '.join(counts)}.")
    return " ".join(sentences)


def _cells(
    number: int, statement: Statement, finding: Finding, reservation: str
) -> tuple[object, ...]:
    """Return the cells of a statement in the table of verdicts; `number` counts from 1."""
    deciding = "".join(f"{label}: {text(value)}" for label, value in finding.numbers[:1])
    mark = _mark(statement, reservation)
    verdict = f"**{finding.verdict}**{f' ({mark})' if mark else ''}"
    return number, statement.text, deciding, _detectable(finding), verdict


def _mark(statement: Statement, reservation: str) -> str:
    """Return a remark beside the verdict on a statement: when its criterion was fixed, or ""."""
    return "criterion not fixed before these data" if reservation else statement.fixed.mark


def _detectable(finding: Finding) -> str:
    """Return the smallest deviation that the test of a finding could have seen, as text.

    "–" if its errors are unknown, or infinite.
    """
    deviation = finding.smallest_deviation
    return f"{deviation:.2g}" if math.isfinite(deviation) else "–"


def _details(number: int, statement: Statement, finding: Finding, reservation: str) -> str:
    """Return the paragraphs below the table on a statement: its verdict, reason and numbers."""
    fixed = reservation or f"Fixed {statement.fixed.text}."
    numbers = "".join(f"\n- {label}: {text(value)}" for label, value in finding.numbers)
    return (
        f"### {number}. {statement.text}\n\n**{finding.verdict}**: "
        f"{finding.reason}\n\n- criterion: {statement.criterion} {fixed}\n"
        f"- name: `{statement.name}`; data: {', '.join(statement.experiments)}\n"
        f"- smallest deviation that the test could have seen: {_detectable(finding)}{numbers}"
    )
