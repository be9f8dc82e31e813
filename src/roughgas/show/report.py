"""Pages of results: the report of the paper's figures, the page of a study, and all verdicts.

A table of verdicts links to the pictures, which have their captions beside them.
"""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from roughgas.base import InputError, NamedValues, from_json, markdown, unknown_name_error
from roughgas.base.files import readme
from roughgas.show.catalogue import FIGURES
from roughgas.show.pages import (
    PICTURE_LINK,
    base64_of,
    figures_in_readme,
    markdown_as_html,
    markup,
    text_of,
    texts_of_figures,
    write_page,
)
from roughgas.show.verdicts import label_of, read_verdicts, read_verdicts_of_studies

RELATIVE_LINK = re.compile(r"(?<!!)\[([^][]*)\]\((?!https?:)[^()]*\)")
FINDINGS_BEGIN = re.compile(r"^(?=##|!\[)", re.MULTILINE)
"""The first heading or picture of README.md of a study, before which it states a question."""
NOT_JUDGED = "**Not judged yet.** "
COLUMNS = ("experiment", "parameter", "value", "r", "beta", "n_seeds", "R", "R_stderr", "R_theory")
MAX_TABLE_ROWS = 400
"""Largest number of rows of a table in a page; the CSV file has all rows."""
STEADY_WORDS = {1: "yes", 0: "no", -1: "not known"}


def write_front(
    input: str | Path,
    *,
    figures: Iterable[str | Path],
    shows: str,
    readme: str | Path,
    output: str | Path,
    reservation: str = "",
) -> None:
    """Write the report: pictures (.png) with captions, and the verdicts in `input` (claims.json).

    `shows` has the experiments in each figure, JSON by figure. The caption of a picture follows it
    in the `readme` of its study; it is NOT_JUDGED with the `reservation`, if there is one: a
    sentence why that text is of other data. Raises InputError for a figure without an entry in the
    catalogue or without a caption.
    """
    pictures = [Path(figure) for figure in figures]
    texts = texts_of_figures(Path(readme).parent, [picture.stem for picture in pictures])
    if reservation:
        texts = dict.fromkeys((picture.stem for picture in pictures), NOT_JUDGED + reservation)
    verdicts = read_verdicts(input, from_json(shows, "--shows"))
    records = [_figure_record(picture, texts, verdicts["claims"]) for picture in pictures]
    _write_page(output, "page/front.html", "page/front.css", figures=records, verdicts=verdicts)


def _figure_record(path: Path, texts: dict[str, str], claims: Sequence[NamedValues]) -> NamedValues:
    """Return the fields of a picture (.png) in the report: name, title, label, picture in base64,
    alternative text, caption in HTML, and the statements whose first figure it is.

    `texts` has captions, Markdown by figure, `claims` all statements of `read_verdicts`. Raises
    InputError as `write_front`.
    """
    name = path.stem
    if name not in FIGURES:
        raise unknown_name_error("figure", name, FIGURES)
    if name not in texts:
        raise InputError("captions", ", ".join(texts), f"have one of {name}")
    title, text = FIGURES[name].title, texts[name]
    return {
        "name": name,
        "title": title,
        "label": label_of(name),
        "picture": base64_of(path.read_bytes()),
        "alt": f"{title}. {' '.join(text.partition('**')[0].split())}",
        "caption": markup(markdown_as_html(text.encode())),
        "claims": [
            claim
            for claim in claims
            if [link.address for link in claim["figures"][:1]] == [f"#{name}"]
        ],
    }


def write_study(
    folder: str | Path,
    *,
    title: str,
    figures: Sequence[str],
    output: str | Path,
    shows: str = "{}",
    table: str | Path = "",
    found: str | Path = "",
    claims: str | Path = "",
    reservation: str = "",
) -> None:
    """Write the page of a study: README.md with the pictures `figures`, further pictures, verdicts
    (`claims`, .json), results of tasks (`found`, .md), and a table of R (`table`, .csv).

    `shows` has the experiments in each figure, JSON by figure. With a `reservation`, a sentence why
    the findings of README.md are of other data, the page has that sentence in place of all text
    after the introduction.
    """
    text = readme(folder) or f"# {title}\n"
    if reservation and readme(folder):
        introduction = FINDINGS_BEGIN.split(text)[0].rstrip()
        text = f"{introduction}\n\n## Findings\n\n{NOT_JUDGED}{reservation}\n\n"
    pictures = {Path(figure).stem: f"![{_title_of(figure)}](<{figure}>)" for figure in figures}
    text = RELATIVE_LINK.sub(r"\1", text)  # their targets are not beside the page
    segments = PICTURE_LINK.split(text)
    segments[1::2] = [
        pictures.pop(figure, "") for figure in figures_in_readme(segments[1::2], [*pictures])
    ]
    findings = "\n\n".join(["".join(segments), *pictures.values()])
    tasks = re.sub(r"^#", "##", Path(found).read_text("utf-8"), flags=re.M) if found else ""
    content = {
        "title": title,
        "body": markup(markdown_as_html(findings.encode(), Path())),
        "verdicts": read_verdicts(claims, from_json(shows, "--shows")) if claims else None,
        "tasks": markup(markdown_as_html(tasks.encode(), Path())),
        "ratios": markup(markdown_as_html(_ratio_table(Path(table)).encode())) if table else "",
    }
    _write_page(output, "page/study.html", "page/document.css", **content)


def write_verdicts(inputs: Iterable[str | Path], *, studies: str, output: str | Path) -> None:
    """Write a page with the verdicts of several studies, in the files claims.json at `inputs`.

    `studies` has their titles, pages and figures, JSON in the form of `read_verdicts_of_studies`.
    """
    verdicts = read_verdicts_of_studies(inputs, from_json(studies, "--studies"))
    _write_page(output, "page/all_verdicts.html", "page/document.css", verdicts=verdicts)


def _write_page(
    output: str | Path, template: str, css: str, verdicts: NamedValues | None, **variables: Any
) -> None:
    """Write a page with a style sheet and `verdicts`, whose table has a program; None: no table."""
    scripts = [] if verdicts is None else [text_of("page/verdicts.js")]
    variables |= {"verdicts": verdicts}
    write_page(output, template, ["page/verdicts.css", css], scripts, **variables)


def _title_of(path: str) -> str:
    """Return the title of the figure at `path`, in the catalogue, or else its name."""
    name = Path(path).stem
    return FIGURES[name].title if name in FIGURES else name


def _ratio_table(path: Path) -> str:
    """Return Markdown of a table of R at all points, at most MAX_TABLE_ROWS of them, from the CSV
    file at `path`."""
    import pandas as pd

    table = pd.read_csv(path)
    columns = [name for name in COLUMNS if name in table and table[name].notna().any()]
    steady = table.equilibrated.map(STEADY_WORDS)
    rows = table[columns].assign(steady=steady).head(MAX_TABLE_ROWS).to_numpy().tolist()
    cells = [
        [f"{value:.5g}" if isinstance(value, float) else value for value in row] for row in rows
    ]
    note = (
        f"\n{len(table) - MAX_TABLE_ROWS} more rows are in {path.name}.\n"
        if len(table) > MAX_TABLE_ROWS
        else ""
    )
    return f"{markdown([*columns, 'steady'], cells)}{note}"
