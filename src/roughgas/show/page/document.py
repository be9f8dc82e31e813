"""Tables, configurations and movies as HTML pages: Snakemake's report shows HTML and pictures in
place, and other files only as downloads."""

import base64
from html import escape
from pathlib import Path
from string import Template
from urllib.parse import unquote

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.show.page.policy import policy


def write_document(source: str | Path, output: str | Path) -> None:
    """Write the file at `source` as one HTML page that loads nothing.

    Raises InputError for a kind of file that KINDS does not have, and where a text is none.
    """
    source = Path(source)
    if source.suffix not in KINDS:
        raise InputError("document", source, f"end in one of {', '.join(KINDS)}")
    here, title = Path(__file__), escape(source.name)
    page = Template(here.with_name("document.html").read_text("utf-8"))
    css = here.with_name("document.css").read_text("utf-8")
    try:
        content = source.read_bytes()
        if source.suffix == ".md":
            body = markdown_as_html(content, source.parent)
        else:
            body = KINDS[source.suffix](content)
    except UnicodeDecodeError as error:
        raise InputError("document", source, "be text in UTF-8") from error
    write_text(output, page.substitute(title=title, policy=policy(), css=css, body=body))


def markdown_as_html(content: bytes, folder: Path | None = None) -> str:
    """Return Markdown as HTML; what is HTML in it stays text.

    Pictures that are files in `folder`, or below it, become part of the page: it loads nothing.
    """
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(content.decode("utf-8"))
    for one in (child for token in tokens for child in token.children or ()):
        if one.type == "image" and folder is not None:
            one.attrSet("src", _picture(str(one.attrGet("src")), folder))
    return markdown.renderer.render(tokens, markdown.options, {})


def _picture(source: str, folder: Path) -> str:
    """Return a picture as a data URI where it is a file in the folder; else its source as it is."""
    path = Path(folder, unquote(source)).resolve()
    kind = PICTURES.get(path.suffix)
    if kind is None or not path.is_relative_to(folder.resolve()) or not path.is_file():
        return source
    return f"data:image/{kind};base64,{base64.b64encode(path.read_bytes()).decode('ascii')}"


PICTURES = {".png": "png", ".gif": "gif", ".jpg": "jpeg", ".jpeg": "jpeg", ".svg": "svg+xml"}
MOVIE = '<video controls loop muted autoplay src="data:video/mp4;base64,{}"></video>'
PICTURE = '<img alt="" src="data:image/gif;base64,{}">'
KINDS = {
    ".md": markdown_as_html,
    ".yaml": lambda content: f"<pre>{escape(content.decode('utf-8'))}</pre>",
    ".mp4": lambda content: MOVIE.format(base64.b64encode(content).decode("ascii")),
    ".gif": lambda content: PICTURE.format(base64.b64encode(content).decode("ascii")),
}
"""How the content (bytes) of a file becomes HTML, by its suffix."""
