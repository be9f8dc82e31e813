"""What people read of a study: its README.md as a page, and captions of its figures."""

import re
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from roughgas.base.formatting import markdown
from roughgas.config.study_folders import readme
from roughgas.show import pages

PICTURE = re.compile(r"!\[[^]]*\]\([^)]*?([\w.]+)\.png\)")
LINK = re.compile(r"(?<!!)\[([^]]*)\]\((?!https?:)[^)]*\)")
COLUMNS = ("experiment", "parameter", "value", "r", "beta", "n_seeds", "R", "R_stderr", "R_theory")
MOST = 400
"""Rows of a table on a page; the file beside it has all."""
STEADY = {1: "yes", 0: "no", -1: "not known"}


def captions(folder: str | Path, figures: Sequence[str]) -> dict[str, str]:
    """Return what stands after each picture in README.md of the study in `folder`, up to the next
    picture or heading, by the figure; plain text, which may be bold."""
    text = readme(folder)
    parts = PICTURE.split(text)
    names = _in_place(parts[1::2], figures)
    pairs = zip(names, parts[2::2], strict=True)
    return {name: re.split(r"^#", after, flags=re.M)[0].strip() for name, after in pairs}


def write_page(
    folder: str | Path,
    *,
    title: str,
    figures: Sequence[str],
    output: str | Path,
    table: str | Path = "",
    found: str | Path = "",
    claims: str | Path = "",
) -> None:
    """Write a page of HTML that loads nothing: README.md with the pictures `figures` in it, those
    that it does not show after it, verdicts, the table that its tasks have `found`, and that of R.
    """
    text = readme(folder) or f"# {title}\n"
    pictures = {Path(one).stem: f"![{Path(one).stem}](<{one}>)" for one in figures}
    text = LINK.sub(r"\1", text)  # of the project, which is not beside the page
    parts = PICTURE.split(text)
    parts[1::2] = [pictures.pop(one, "") for one in _in_place(parts[1::2], [*pictures])]
    whole = ["".join(parts), *pictures.values()]
    for path in (claims, found):
        if path:
            whole.append(re.sub(r"^#", "##", Path(path).read_text("utf-8"), flags=re.M))
    if table:
        whole.append(_table(Path(table)))
    body = pages.markup(pages.markdown_as_html("\n\n".join(whole).encode(), Path()))
    shown = {"title": title, "body": body}
    pages.write_page(output, "page/document.html", ["page/document.css"], **shown)


def _in_place(named: Sequence[str], figures: Sequence[str]) -> list[str]:
    """Return which figures stand where a README names some: where it names those of another study,
    of which this one is a copy, they stand in their order."""
    left = [one for one in figures if one not in named]
    return [one if one in figures else left.pop(0) if left else one for one in named]


def _table(path: Path) -> str:
    """Return R at each point as Markdown."""
    every = pd.read_csv(path)
    columns = [name for name in COLUMNS if name in every and every[name].notna().any()]
    steady = every.equilibrated.map(STEADY)
    rows = every[columns].assign(steady=steady).head(MOST).to_numpy().tolist()
    shown = [[f"{one:.5g}" if isinstance(one, float) else one for one in row] for row in rows]
    more = f"\n{len(every) - MOST} more rows are in {path.name}.\n" if len(every) > MOST else ""
    return f"## R at every point\n\n{markdown([*columns, 'steady'], shown)}{more}"
