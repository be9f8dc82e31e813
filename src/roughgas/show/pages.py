"""Pages of HTML that load nothing: documents, the report's front page, and the page of a study.

Templates (Jinja2), style sheets and programs are in page/ and living/. Text from files is escaped,
and the content security policy of a page admits only the page's own programs.
"""

import base64
import hashlib
import json
import re
from collections.abc import Iterable, Sequence
from html import escape
from itertools import takewhile
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from roughgas.base import InputError, NamedValues, in_rst_with_bold, markdown, unknown_name_error
from roughgas.base.files import readme, write_text
from roughgas.show.catalogue import FIGURES

SHOW_FOLDER = Path(__file__).parent
POLICY = {
    "default-src": "'none'",
    "style-src": "'unsafe-inline'",
    "img-src": "data: blob:",
    "media-src": "data:",
    "base-uri": "'none'",
    "form-action": "'none'",
}
# brackets do not nest, so that matching takes linear time
PICTURE_LINK = re.compile(r"!\[[^][]*\]\((?:[^()]*[^\w.()])?([\w.]+)\.png\)")
RELATIVE_LINK = re.compile(r"(?<!!)\[([^][]*)\]\((?!https?:)[^()]*\)")
FINDINGS_BEGIN = re.compile(r"^(?=##|!\[)", re.MULTILINE)
"""The first heading or picture of README.md of a study, before which it states a question."""
NOT_JUDGED = "**Not judged yet.** "
COLUMNS = ("experiment", "parameter", "value", "r", "beta", "n_seeds", "R", "R_stderr", "R_theory")
MAX_TABLE_ROWS = 400
"""Largest number of rows of a table in a page; the CSV file has all rows."""
STEADY_WORDS = {1: "yes", 0: "no", -1: "not known"}


def write_page(
    output: str | Path,
    template: str,
    css: Iterable[str],
    scripts: Iterable[str] = (),
    **variables: Any,
) -> None:
    """Write the page `output`: a template filled with style sheets, programs, and variables
    (`variables`).

    `template` and `css` are names of files as in `text_of`, `scripts` the texts of programs.
    Variables are escaped unless they are Markup. Raises jinja2's UndefinedError if the template has
    a variable that is not given.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    scripts = list(scripts)
    environment = Environment(
        loader=FileSystemLoader(SHOW_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        keep_trailing_newline=True,
    )
    variables |= {"policy": markup(policy(*scripts)), "css": markup("".join(map(text_of, css)))}
    html = environment.get_template(template).render(
        scripts=list(map(markup, scripts)), **variables
    )
    write_text(output, html)


def text_of(name: str) -> str:
    """Return the text of the file `name` in the folder of this module, such as page/front.css."""
    return (SHOW_FOLDER / name).read_text("utf-8")


def markup(text: str) -> Any:
    """Return HTML marked as safe (a Markup): templates do not escape it."""
    from markupsafe import Markup

    return Markup(text)


def policy(*scripts: str) -> str:
    """Return the content security policy of a page with the inline programs `scripts`, texts
    without tags."""
    digests = (hashlib.sha256(script.encode()).digest() for script in scripts)
    sources = " ".join(f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)
    rules = POLICY | ({"script-src": sources} if sources else {})
    return "; ".join(f"{directive} {value}" for directive, value in rules.items())


def data_of(content: Any) -> str:
    """Return JSON for an inline script, with `<` escaped: it could end the script or begin a
    comment.

    Raises ValueError for a number that is not finite.
    """
    text = json.dumps(content, separators=(",", ":"), allow_nan=False)
    return text.replace("<", r"\u003c")


# ---------------------------------------------------------------- documents


def write_document(input: str | Path, *, output: str | Path) -> None:
    """Write a table, a configuration or a movie as a page of Snakemake's report.

    Raises InputError for a suffix without an entry in CONVERTERS, and for text that is not UTF-8.
    """
    source = Path(input)
    if source.suffix not in CONVERTERS:
        raise InputError("document", source, f"end in one of {', '.join(CONVERTERS)}")
    try:
        body = CONVERTERS[source.suffix](source.read_bytes(), source.parent)
    except UnicodeDecodeError as error:
        raise InputError("document", source, "be text in UTF-8") from error
    variables = {"title": source.name, "body": markup(body)}
    write_page(output, "page/document.html", ["page/document.css"], **variables)


def markdown_as_html(content: bytes, folder: Path | None = None) -> str:
    """Return Markdown, bytes in UTF-8, as HTML; HTML in the Markdown is escaped.

    Pictures in `folder` or below it are embedded, so that the page loads nothing. Raises
    UnicodeDecodeError for other bytes.
    """
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(content.decode("utf-8"))
    for inline in (child for token in tokens for child in token.children or ()):
        if inline.type == "image" and folder is not None:
            path = Path(folder, unquote(str(inline.attrGet("src")))).resolve()
            picture_type = PICTURE_TYPES.get(path.suffix)
            if picture_type and path.is_relative_to(folder.resolve()) and path.is_file():
                inline.attrSet(
                    "src", f"data:image/{picture_type};base64,{_base64(path.read_bytes())}"
                )
    return markdown.renderer.render(tokens, markdown.options, {})


def _base64(content: bytes) -> str:
    """Return bytes as text in base64."""
    return base64.b64encode(content).decode("ascii")


PICTURE_TYPES = {".png": "png", ".gif": "gif", ".jpg": "jpeg", ".jpeg": "jpeg", ".svg": "svg+xml"}
MP4_TAG = '<video controls loop muted autoplay src="data:video/mp4;base64,{}"></video>'
GIF_TAG = '<img alt="" src="data:image/gif;base64,{}">'
CONVERTERS = {
    ".md": markdown_as_html,
    ".yaml": lambda content, _: f"<pre>{escape(content.decode('utf-8'))}</pre>",
    ".mp4": lambda content, _: MP4_TAG.format(_base64(content)),
    ".gif": lambda content, _: GIF_TAG.format(_base64(content)),
}
"""Functions of the content (bytes) and folder of a file that return HTML, by suffix."""


# ---------------------------------------------------------------- the report's front page


def write_front(
    input: str | Path,
    *,
    figures: Iterable[str | Path],
    readme: str | Path,
    output: str | Path,
    reservation: str = "",
) -> None:
    """Write the front page: pictures (.png) with captions, and the claims in `input` (.md).

    The caption of a picture follows it in the `readme` of its study; it is NOT_JUDGED with the
    `reservation`, if there is one: a sentence why that text is of other data. Raises InputError for
    a figure without an entry in the catalogue or without a caption.
    """
    pictures = [Path(figure) for figure in figures]
    texts = texts_of_figures(Path(readme).parent, [picture.stem for picture in pictures])
    if reservation:
        texts = dict.fromkeys((picture.stem for picture in pictures), NOT_JUDGED + reservation)
    records = [_figure_record(picture, texts) for picture in pictures]
    verdicts = markdown_as_html(_with_table_first(Path(input).read_text("utf-8")).encode())
    variables = {"figures": records, "claims": markup(verdicts)}
    write_page(output, "page/front.html", ["page/front.css"], **variables)


def _with_table_first(text):
    """Return Markdown with its first table moved up to the title, its first line."""
    title, *lines = text.splitlines()
    first = next((k for k, line in enumerate(lines) if line.startswith("|")), 0)
    rows = list(takewhile(lambda line: line.startswith("|"), lines[first:]))
    other_lines = lines[:first] + lines[first + len(rows) :]
    return "\n".join([title, "", *rows, "", *other_lines])


def _figure_record(path: Path, texts: dict[str, str]) -> NamedValues:
    """Return the fields of a picture (.png) in the front page: name, title, picture in base64,
    alternative text, caption in HTML.

    `texts` has captions, Markdown by figure. Raises InputError as `write_front`.
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
        "picture": _base64(path.read_bytes()),
        "alt": f"{title}. {' '.join(text.partition('**')[0].split())}",
        "caption": markup(markdown_as_html(text.encode())),
    }


# ---------------------------------------------------------------- studies


def captions(folder: str | Path, figures: Sequence[str]) -> dict[str, str]:
    """Return the captions of the figures called `figures` of the study in `folder` (see
    `texts_of_figures`) by figure, as reStructuredText with no markup but bold."""
    texts = texts_of_figures(folder, figures)
    return {name: in_rst_with_bold(text) for name, text in texts.items()}


def texts_of_figures(folder: str | Path, figures: Sequence[str]) -> dict[str, str]:
    """Return the captions of the figures called `figures`, Markdown by figure: the text that
    follows each picture in README.md of the study in `folder`, up to the next picture or
    heading."""
    segments = PICTURE_LINK.split(readme(folder))
    names = _figures_in_readme(segments[1::2], figures)
    pairs = zip(names, segments[2::2], strict=True)
    return {name: re.split(r"^#", caption, flags=re.M)[0].strip() for name, caption in pairs}


def write_study(
    folder: str | Path,
    *,
    title: str,
    figures: Sequence[str],
    output: str | Path,
    table: str | Path = "",
    found: str | Path = "",
    claims: str | Path = "",
    reservation: str = "",
) -> None:
    """Write the page of a study: README.md with the pictures `figures`, further pictures, verdicts
    (`claims`, .md), results of tasks (`found`, .md), and a table of R (`table`, .csv).

    With a `reservation`, a sentence why the findings of README.md are of other data, the page has
    that sentence in place of all text after the introduction.
    """
    text = readme(folder) or f"# {title}\n"
    if reservation and readme(folder):
        introduction = FINDINGS_BEGIN.split(text)[0].rstrip()
        text = f"{introduction}\n\n## Findings\n\n{NOT_JUDGED}{reservation}\n\n"
    pictures = {Path(figure).stem: f"![{Path(figure).stem}](<{figure}>)" for figure in figures}
    text = RELATIVE_LINK.sub(r"\1", text)  # their targets are not beside the page
    segments = PICTURE_LINK.split(text)
    segments[1::2] = [
        pictures.pop(figure, "") for figure in _figures_in_readme(segments[1::2], [*pictures])
    ]
    sections = ["".join(segments), *pictures.values()]
    for path in (claims, found):
        if path:
            sections.append(re.sub(r"^#", "##", Path(path).read_text("utf-8"), flags=re.M))
    if table:
        sections.append(_ratio_table(Path(table)))
    body = markup(markdown_as_html("\n\n".join(sections).encode(), Path()))
    content = {"title": title, "body": body}
    write_page(output, "page/document.html", ["page/document.css"], **content)


def _figures_in_readme(named: Sequence[str], figures: Sequence[str]) -> list[str]:
    """Return the figure to show for each picture `named` in a README, from the names of all
    `figures` of the study.

    A copy of a study may have the README of the original: unknown names stand for the figures
    without a name, in their order.
    """
    unnamed = [figure for figure in figures if figure not in named]
    return [
        figure if figure in figures else unnamed.pop(0) if unnamed else figure for figure in named
    ]


def _ratio_table(path: Path) -> str:
    """Return a section of Markdown with a table of R at all points, at most MAX_TABLE_ROWS of them,
    from the CSV file at `path`."""
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
    return f"## R at every point\n\n{markdown([*columns, 'steady'], cells)}{note}"
