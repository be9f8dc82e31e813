"""The report's front page: the paper's figures with their captions beside them, and its claims.

Snakemake's own report opens on the graph of the workflow, and names pictures in a menu.
"""

import base64
from collections.abc import Iterable
from html import escape
from itertools import takewhile
from pathlib import Path
from string import Template

from roughgas.base.errors import InputError, not_one_of
from roughgas.base.files import write_text
from roughgas.show.catalogue import FIGURES
from roughgas.show.page.document import markdown_as_html
from roughgas.show.page.policy import policy

FIGURE = """<figure id="{name}"><img src="data:image/png;base64,{picture}" alt="{alt}">
<figcaption><h2>{title}</h2>
{caption}</figcaption></figure>"""


def write_front(
    claims: str | Path,
    figures: Iterable[str | Path],
    captions: Iterable[str | Path],
    output: str | Path,
) -> None:
    """Write one HTML page that loads nothing, of pictures (.png), their captions and claims (.md).

    A picture's caption is the .rst file of its name; both know the catalogue's figures. Raises
    InputError for a figure that the catalogue does not have, or that has no caption.
    """
    texts = {Path(one).stem: Path(one).read_text("utf-8") for one in captions}
    shown = "\n".join(_figure(Path(one), texts) for one in figures)
    page, css = (Path(__file__).with_name(f"front.{kind}") for kind in ("html", "css"))
    verdicts = markdown_as_html(_table_first(Path(claims).read_text("utf-8")).encode())
    parts = {"policy": policy(), "css": css.read_text("utf-8"), "figures": shown}
    write_text(output, Template(page.read_text("utf-8")).substitute(parts, claims=verdicts))


def _table_first(text):
    """Return Markdown with its first table right after its first line, the title."""
    title, *lines = text.splitlines()
    first = next((k for k, line in enumerate(lines) if line.startswith("|")), 0)
    rows = list(takewhile(lambda line: line.startswith("|"), lines[first:]))
    rest = lines[:first] + lines[first + len(rows) :]
    return "\n".join([title, "", *rows, "", *rest])


def _figure(path, texts):
    name = path.stem
    if name not in FIGURES:
        raise not_one_of("figure", name, FIGURES)
    if name not in texts:
        raise InputError("captions", ", ".join(texts), f"have one of {name}")
    title, text = FIGURES[name].title, texts[name]
    return FIGURE.format(
        name=name,
        picture=base64.b64encode(path.read_bytes()).decode("ascii"),
        alt=escape(f"{title}. {' '.join(text.partition('**')[0].split())}"),
        title=escape(title),
        caption=markdown_as_html(text.encode()),
    )
