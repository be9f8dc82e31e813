"""Pages of HTML that load nothing: documents, the report's front page, and the page of a study.

Templates (Jinja2), style sheets and programs are in page/ and living/. Whatever text gets into a
page from a file stays text, and its content security policy lets it run no program but its own.
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

from roughgas.base import InputError, markdown, not_one_of
from roughgas.base.files import readme, write_text
from roughgas.show.catalogue import FIGURES

HERE = Path(__file__).parent
POLICY = {
    "default-src": "'none'",
    "style-src": "'unsafe-inline'",
    "img-src": "data: blob:",
    "media-src": "data:",
    "base-uri": "'none'",
    "form-action": "'none'",
}
SHOWN = re.compile(r"!\[[^]]*\]\([^)]*?([\w.]+)\.png\)")
LINK = re.compile(r"(?<!!)\[([^]]*)\]\((?!https?:)[^)]*\)")
COLUMNS = ("experiment", "parameter", "value", "r", "beta", "n_seeds", "R", "R_stderr", "R_theory")
MOST = 400
"""Rows of a table on a page; the file beside it has all."""
STEADY = {1: "yes", 0: "no", -1: "not known"}


def write_page(
    output: str | Path, template: str, css: Iterable[str], scripts: Iterable[str] = (), **parts: Any
) -> None:
    """Write a page: a template with the text of style sheets, programs, and other parts.

    `template` and `css` are names of files. Parts that are no Markup are escaped.
    """
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    scripts = list(scripts)
    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        keep_trailing_newline=True,
    )
    parts |= {"policy": markup(policy(*scripts)), "css": markup("".join(map(text_of, css)))}
    shown = environment.get_template(template).render(scripts=list(map(markup, scripts)), **parts)
    write_text(output, shown)


def text_of(name: str) -> str:
    """Return the text of a file beside this one, such as "page/front.css"."""
    return (HERE / name).read_text("utf-8")


def markup(text: str) -> Any:
    """Return text that is HTML already."""
    from markupsafe import Markup

    return Markup(text)


def policy(*scripts: str) -> str:
    """Return the policy of a page with these inline scripts, each the text between its tags."""
    digests = (hashlib.sha256(script.encode()).digest() for script in scripts)
    known = " ".join(f"'sha256-{base64.b64encode(one).decode()}'" for one in digests)
    rules = POLICY | ({"script-src": known} if known else {})
    return "; ".join(f"{what} {whence}" for what, whence in rules.items())


def data_of(content: Any) -> str:
    """Return JSON for a script: `<` could end it, or begin a comment."""
    text = json.dumps(content, separators=(",", ":"), allow_nan=False)
    return text.replace("<", r"\u003c")


# ---------------------------------------------------------------- documents


def write_document(input: str | Path, *, output: str | Path) -> None:
    """Write a table, a configuration or a movie as one page, which Snakemake's report shows.

    Raises InputError for a kind of file that KINDS does not have, and where a text is none.
    """
    source = Path(input)
    if source.suffix not in KINDS:
        raise InputError("document", source, f"end in one of {', '.join(KINDS)}")
    try:
        body = KINDS[source.suffix](source.read_bytes(), source.parent)
    except UnicodeDecodeError as error:
        raise InputError("document", source, "be text in UTF-8") from error
    parts = {"title": source.name, "body": markup(body)}
    write_page(output, "page/document.html", ["page/document.css"], **parts)


def markdown_as_html(content: bytes, folder: Path | None = None) -> str:
    """Return Markdown as HTML; what is HTML in it stays text.

    Pictures that are files in `folder`, or below it, become part of the page: it loads nothing.
    """
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(content.decode("utf-8"))
    for one in (child for token in tokens for child in token.children or ()):
        if one.type == "image" and folder is not None:
            path = Path(folder, unquote(str(one.attrGet("src")))).resolve()
            kind = PICTURES.get(path.suffix)
            if kind and path.is_relative_to(folder.resolve()) and path.is_file():
                one.attrSet("src", f"data:image/{kind};base64,{_base64(path.read_bytes())}")
    return markdown.renderer.render(tokens, markdown.options, {})


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")


PICTURES = {".png": "png", ".gif": "gif", ".jpg": "jpeg", ".jpeg": "jpeg", ".svg": "svg+xml"}
MOVIE = '<video controls loop muted autoplay src="data:video/mp4;base64,{}"></video>'
PICTURE = '<img alt="" src="data:image/gif;base64,{}">'
KINDS = {
    ".md": markdown_as_html,
    ".yaml": lambda content, _: f"<pre>{escape(content.decode('utf-8'))}</pre>",
    ".mp4": lambda content, _: MOVIE.format(_base64(content)),
    ".gif": lambda content, _: PICTURE.format(_base64(content)),
}
"""How the content (bytes) of a file in a folder becomes HTML, by its suffix."""


# ---------------------------------------------------------------- the report's front page


def write_front(
    input: str | Path,
    *,
    figures: Iterable[str | Path],
    captions: Iterable[str | Path],
    output: str | Path,
) -> None:
    """Write one page of pictures (.png) with their captions, and of the claims in `input` (.md).

    A picture's caption is the .rst file of its name; both know the catalogue's figures. Raises
    InputError for a figure that the catalogue does not have, or that has no caption.
    """
    texts = {Path(one).stem: Path(one).read_text("utf-8") for one in captions}
    shown = [_figure(Path(one), texts) for one in figures]
    verdicts = markdown_as_html(_table_first(Path(input).read_text("utf-8")).encode())
    parts = {"figures": shown, "claims": markup(verdicts)}
    write_page(output, "page/front.html", ["page/front.css"], **parts)


def _table_first(text):
    """Return Markdown with its first table right after its first line, the title."""
    title, *lines = text.splitlines()
    first = next((k for k, line in enumerate(lines) if line.startswith("|")), 0)
    rows = list(takewhile(lambda line: line.startswith("|"), lines[first:]))
    rest = lines[:first] + lines[first + len(rows) :]
    return "\n".join([title, "", *rows, "", *rest])


def _figure(path: Path, texts: dict[str, str]) -> dict[str, Any]:
    name = path.stem
    if name not in FIGURES:
        raise not_one_of("figure", name, FIGURES)
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
    """Return what stands after each picture in README.md of the study in `folder`, up to the next
    picture or heading, by the figure; plain text, which may be bold."""
    text = readme(folder)
    parts = SHOWN.split(text)
    names = _in_place(parts[1::2], figures)
    pairs = zip(names, parts[2::2], strict=True)
    return {name: re.split(r"^#", after, flags=re.M)[0].strip() for name, after in pairs}


def write_study(
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
    parts = SHOWN.split(text)
    parts[1::2] = [pictures.pop(one, "") for one in _in_place(parts[1::2], [*pictures])]
    whole = ["".join(parts), *pictures.values()]
    for path in (claims, found):
        if path:
            whole.append(re.sub(r"^#", "##", Path(path).read_text("utf-8"), flags=re.M))
    if table:
        whole.append(_table_of(Path(table)))
    body = markup(markdown_as_html("\n\n".join(whole).encode(), Path()))
    shown = {"title": title, "body": body}
    write_page(output, "page/document.html", ["page/document.css"], **shown)


def _in_place(named: Sequence[str], figures: Sequence[str]) -> list[str]:
    """Return which figures stand where a README names some: where it names those of another study,
    of which this one is a copy, they stand in their order."""
    left = [one for one in figures if one not in named]
    return [one if one in figures else left.pop(0) if left else one for one in named]


def _table_of(path: Path) -> str:
    """Return R at each point as Markdown."""
    import pandas as pd

    every = pd.read_csv(path)
    columns = [name for name in COLUMNS if name in every and every[name].notna().any()]
    steady = every.equilibrated.map(STEADY)
    rows = every[columns].assign(steady=steady).head(MOST).to_numpy().tolist()
    shown = [[f"{one:.5g}" if isinstance(one, float) else one for one in row] for row in rows]
    more = f"\n{len(every) - MOST} more rows are in {path.name}.\n" if len(every) > MOST else ""
    return f"## R at every point\n\n{markdown([*columns, 'steady'], shown)}{more}"
