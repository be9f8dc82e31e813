"""Tables, configurations and movies as HTML pages: Snakemake's report shows HTML and pictures in
place, and other files only as downloads."""

import base64
from html import escape
from pathlib import Path
from string import Template

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
        body = KINDS[source.suffix](source.read_bytes())
    except UnicodeDecodeError as error:
        raise InputError("document", source, "be text in UTF-8") from error
    write_text(output, page.substitute(title=title, policy=policy(), css=css, body=body))


def markdown_as_html(content: bytes) -> str:
    """Return Markdown as HTML; what is HTML in it stays text."""
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark", {"html": False}).enable("table").render(content.decode("utf-8"))


MOVIE = '<video controls loop muted autoplay src="data:video/mp4;base64,{}"></video>'
PICTURE = '<img alt="" src="data:image/gif;base64,{}">'
KINDS = {
    ".md": markdown_as_html,
    ".yaml": lambda content: f"<pre>{escape(content.decode('utf-8'))}</pre>",
    ".mp4": lambda content: MOVIE.format(base64.b64encode(content).decode("ascii")),
    ".gif": lambda content: PICTURE.format(base64.b64encode(content).decode("ascii")),
}
"""How the content (bytes) of a file becomes HTML, by its suffix."""
