"""Verdicts on statements as pages show them: a table with a filter, and links to figures."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from roughgas.base import NamedValues, Record, from_json
from roughgas.show.catalogue import FIGURES
from roughgas.show.pages import markdown_as_html, markup
from roughgas.statistics.estimates import Estimate

KINDS = {
    "holds": "holds",
    "holds with a qualification": "qualified",
    "fails": "fails",
    "not tested": "untested",
}
"""Class of a verdict in the style sheet, by verdict, in the order of the buttons."""
SUBSCRIPT = re.compile(r"\b(E|beta)_([a-z0-9]+)\b")
ROUGHNESS = re.compile(r"\bbeta(?![a-z])")
NEGATIVE = re.compile(r"(?<![\w.])-(?=[\d.])")


class FigureLink(NamedTuple):
    """A link to a figure: its address, such as #fig1a, and its text."""

    address: str
    label: str


def read_verdicts(path: str | Path, shows: Mapping[str, Sequence[str]]) -> NamedValues:
    """Return the verdicts in claims.json at `path`, in the form of page/verdicts.html.

    `shows` has the experiments in each figure of the page, by figure. Raises InputError if the
    file is not JSON.
    """
    content = _content_of(path)
    claims = [
        _claim_record(
            claim,
            content["reservation"],
            [
                FigureLink(f"#{name}", label_of(name))
                for name in figures_on(claim["experiments"], shows)
            ],
        )
        for claim in content["claims"]
    ]
    return _table(content, claims)


def read_verdicts_of_studies(
    paths: Iterable[str | Path], studies: Mapping[str, Record]
) -> NamedValues:
    """Return the verdicts in claims.json of several studies, at `paths`, as a single table.

    `studies` has for each study, in this order, its `title`, the address of its `page`, and `shows`
    as in `read_verdicts`. A statement links to that page. Raises InputError if a file is not JSON.
    """
    claims, content = [], {}
    for path, (name, study) in zip(paths, studies.items(), strict=True):
        content = _content_of(path)
        for claim in content["claims"]:
            anchors = [f"#{figure}" for figure in figures_on(claim["experiments"], study["shows"])]
            link = FigureLink("".join([study["page"], *anchors[:1]]), study["title"])
            record = _claim_record(claim, content["reservation"], [link])
            claims.append(record | {"id": f"{name}.{claim['id']}"})
    title, summary = "All verdicts", f"{len(claims)} statements of {len(studies)} studies."
    return _table(content | {"title": title, "summary": summary, "reservation": ""}, claims)


def _content_of(path: str | Path) -> NamedValues:
    """Return the content of claims.json at `path`."""
    return from_json(Path(path).read_text("utf-8"), str(path))


def _table(content: Record, claims: Sequence[NamedValues]) -> NamedValues:
    """Return the table of statements `claims`, with the texts of claims.json (`content`)."""
    numbers = Counter(claim["verdict"] for claim in claims)
    return {
        **{name: content[name] for name in ("title", "scale", "reservation", "summary")},
        "how_to_read": markup(markdown_as_html(content["how_to_read"].encode())),
        "counts": [
            {"kind": kind, "verdict": verdict, "number": numbers[verdict]}
            for verdict, kind in KINDS.items()
        ],
        "claims": claims,
    }


def _claim_record(claim: Record, reservation: str, figures: Sequence[FigureLink]) -> NamedValues:
    """Return the fields of a statement of claims.json for the table, with links to `figures`.

    `reservation` says why its criterion was not fixed before these data; "" if it was.
    """
    deciding = [f"{number['label']}: {_in_short(number)}" for number in claim["numbers"][:1]]
    detectable = claim["detectable"]
    return {
        **{name: claim[name] for name in ("id", "verdict", "mark")},
        **{name: in_symbols(claim[name]) for name in ("reason", "criterion")},
        "kind": KINDS[claim["verdict"]],
        "statement": in_symbols(claim["text"]),
        "fixed": reservation or f"Fixed {claim['fixed']}.",
        "data": ", ".join(claim["experiments"]),
        "detectable": "not known" if detectable is None else f"{detectable:.2g}",
        "deciding": in_symbols("".join(deciding)),
        "numbers": [
            in_symbols(f"{number['label']}: {number['text']}") for number in claim["numbers"]
        ],
        "figures": figures,
    }


def _in_short(number: Record) -> str:
    """Return a number of claims.json with half of its 95 % interval, such as +0.0512 ± 0.0009."""
    if not number["ci95"]:
        return str(number["text"])
    return f"{Estimate(number['value'], number['ci95']):+±}".replace(" ± ", "\u00a0±\u00a0")


def figures_on(experiments: Iterable[str], shows: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the names of the figures that show `experiments`, at most one for each of them.

    `shows` has the experiments in each figure, by figure. A figure that shows all `experiments`
    stands for the others.
    """
    names = list(experiments)
    complete = [figure for figure, shown in shows.items() if {*names} <= {*shown}]
    first = [
        next((figure for figure, shown in shows.items() if name in shown), None) for name in names
    ]
    return complete[:1] or list(dict.fromkeys(figure for figure in first if figure))


def label_of(figure: str) -> str:
    """Return a short name of a figure, such as Fig. 1a, from its title in the catalogue."""
    if figure not in FIGURES:
        return figure.replace("_", " ")
    return FIGURES[figure].title.partition(":")[0]


def in_symbols(text: str) -> Any:
    """Return text as HTML, a Markup, with subscripts, the roughness β, and signs of minus."""
    with_subscripts = SUBSCRIPT.sub(r"\1<sub>\2</sub>", escape(text))
    return markup(NEGATIVE.sub("−", ROUGHNESS.sub("β", with_subscripts)))
