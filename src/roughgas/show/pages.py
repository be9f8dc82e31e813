"""Pages of HTML that load nothing: their making, documents, and the captions of figures.

Templates (Jinja2), style sheets and programs are in page/ and living/. Text from files is escaped,
and the content security policy of a page admits only the page's own programs.
"""

import base64
import hashlib
import json
import re
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import Any
from urllib.parse import unquote

from roughgas.base import InputError, in_rst_with_bold
from roughgas.base.files import readme, write_text

SHOW_FOLDER = Path(__file__).parent
THEME = "page/theme.css"
"""Style sheet of the colours that all pages have."""
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


def write_page(
    output: str | Path,
    template: str,
    css: Iterable[str],
    scripts: Iterable[str] = (),
    **variables: Any,
) -> None:
    """Write the page `output`: a template filled with THEME and further style sheets, programs, and
    variables (`variables`).

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
    variables |= {
        "policy": markup(policy(*scripts)),
        "css": markup("".join(map(text_of, [THEME, *css]))),
    }
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
    css, variables = ["page/document.css"], {"title": source.name, "body": markup(body)}
    write_page(output, "page/document.html", css, **variables)


def markdown_as_html(content: bytes, folder: Path | None = None) -> str:
    """Return Markdown, bytes in UTF-8, as HTML; HTML in the Markdown is escaped.

    Pictures in `folder` or below it are embedded, so that the page loads nothing; the name of a
    picture is its anchor. Raises UnicodeDecodeError for other bytes.
    """
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(content.decode("utf-8"))
    for inline in (child for token in tokens for child in token.children or ()):
        if inline.type == "image" and folder is not None:
            path = Path(folder, unquote(str(inline.attrGet("src")))).resolve()
            picture_type = PICTURE_TYPES.get(path.suffix)
            if picture_type and path.is_relative_to(folder.resolve()) and path.is_file():
                inline.attrSet("id", path.stem)
                inline.attrSet(
                    "src", f"data:image/{picture_type};base64,{base64_of(path.read_bytes())}"
                )
    return markdown.renderer.render(tokens, markdown.options, {})


def base64_of(content: bytes) -> str:
    """Return bytes as text in base64."""
    return base64.b64encode(content).decode("ascii")


PICTURE_TYPES = {".png": "png", ".gif": "gif", ".jpg": "jpeg", ".jpeg": "jpeg", ".svg": "svg+xml"}
MP4_TAG = '<video controls loop muted autoplay src="data:video/mp4;base64,{}"></video>'
GIF_TAG = '<img alt="" src="data:image/gif;base64,{}">'
CONVERTERS = {
    ".md": markdown_as_html,
    ".yaml": lambda content, _: f"<pre>{escape(content.decode('utf-8'))}</pre>",
    ".mp4": lambda content, _: MP4_TAG.format(base64_of(content)),
    ".gif": lambda content, _: GIF_TAG.format(base64_of(content)),
}
"""Functions of the content (bytes) and folder of a file that return HTML, by suffix."""


# ---------------------------------------------------------------- captions


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
    names = figures_in_readme(segments[1::2], figures)
    pairs = zip(names, segments[2::2], strict=True)
    return {name: re.split(r"^#", caption, flags=re.M)[0].strip() for name, caption in pairs}


def figures_in_readme(named: Sequence[str], figures: Sequence[str]) -> list[str]:
    """Return the figure to show for each picture `named` in a README, from the names of all
    `figures` of the study.

    A copy of a study may have the README of the original: unknown names stand for the figures
    without a name, in their order.
    """
    unnamed = [figure for figure in figures if figure not in named]
    return [
        figure if figure in figures else unnamed.pop(0) if unnamed else figure for figure in named
    ]
