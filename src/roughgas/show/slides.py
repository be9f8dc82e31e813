"""A page of slides for a lecture, with a slider to turn them: an HTML file that loads nothing."""

import base64
from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib import rc_context

from roughgas.base import NamedValues
from roughgas.base.files import study_module
from roughgas.data.reduced import read_reduced
from roughgas.show import pages
from roughgas.show.style import PARAMETERS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI, QUALITY = 130, 80  # of pictures in WebP, of some 30 kB each


def write_slides(
    folder: str | Path, inputs: Iterable[str | Path], *, title: str, output: str | Path
) -> None:
    """Write the page of slides of the study in `folder` from its reduced datasets at `inputs`.

    `draw` in its slides.py takes the datasets, and yields name, text (Markdown) and figure of each
    slide.
    """
    with rc_context(PARAMETERS):
        slide_contents = study_module(folder, "slides").draw(*map(read_reduced, inputs))
        slides = [_slide(*slide) for slide in slide_contents]
    css, scripts = ["page/document.css", "page/slides.css"], [pages.text_of("page/slides.js")]
    pages.write_page(output, "page/slides.html", css, scripts, title=title, slides=slides)


def _slide(name: str, text: str, figure: "Figure") -> NamedValues:
    """Return the fields of a slide for the page: its name, its text (Markdown) as HTML, and its
    figure as a picture in base64."""
    file = BytesIO()
    figure.savefig(file, format="webp", dpi=DPI, pil_kwargs={"quality": QUALITY})
    picture = base64.b64encode(file.getvalue()).decode("ascii")
    body = pages.markup(pages.markdown_as_html(text.encode()))
    return {"name": name, "text": body, "picture": picture}
