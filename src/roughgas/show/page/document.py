"""What the pipeline writes for people, as HTML pages: Snakemake's report shows these, and pictures,
where it would only offer other files for download."""

import base64
from collections.abc import Callable
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template

from roughgas.base.errors import InputError
from roughgas.base.files import write_text


def write_document(source: str | Path, output: str | Path) -> None:
    """Write the file at `source` as one HTML page that asks for nothing.

    Raises InputError for a kind of file that KINDS does not have.
    """
    source = Path(source)
    if source.suffix not in KINDS:
        raise InputError("document", source, f"end in one of {', '.join(KINDS)}")
    here = files("roughgas.show.page")
    body = KINDS[source.suffix](source.read_bytes())
    css = here.joinpath("document.css").read_text("utf-8")
    page = Template(here.joinpath("document.html").read_text("utf-8"))
    write_text(output, page.substitute(title=escape(source.name), css=css, body=body))


def _markdown(content: bytes) -> str:
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark", {"html": False}).enable("table").render(content.decode("utf-8"))


def _text(content: bytes) -> str:
    return f"<pre>{escape(content.decode('utf-8'))}</pre>"


def _movie(content: bytes) -> str:
    data = base64.b64encode(content).decode("ascii")
    return f'<video controls loop muted autoplay src="data:video/mp4;base64,{data}"></video>'


def _picture(content: bytes) -> str:
    data = base64.b64encode(content).decode("ascii")
    return f'<img alt="" src="data:image/gif;base64,{data}">'


KINDS: dict[str, Callable[[bytes], str]] = {
    ".md": _markdown,
    ".yaml": _text,
    ".mp4": _movie,
    ".gif": _picture,
}
"""How the content of a file becomes HTML, by its suffix."""
