"""A page of slides for a lecture, which a slider turns: one HTML file that loads nothing."""

import base64
from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib import rc_context

from roughgas.base.files import module_of
from roughgas.data.reduced import read_reduced
from roughgas.show import pages
from roughgas.show.style import PARAMETERS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI, QUALITY = 130, 80  # of pictures in WebP: some 30 kB each


def write_slides(
    folder: str | Path, inputs: Iterable[str | Path], *, title: str, output: str | Path
) -> None:
    """Write the page of slides of the study in `folder` from its reduced datasets at `inputs`.

    Its slides.py has `draw`, which takes the datasets and yields the name of each slide, its text
    (Markdown) and its figure.
    """
    with rc_context(PARAMETERS):
        drawn = module_of(folder, "slides").draw(*map(read_reduced, inputs))
        slides = [_slide(*one) for one in drawn]
    css, scripts = ["page/document.css", "page/slides.css"], [pages.text_of("page/slides.js")]
    pages.write_page(output, "page/slides.html", css, scripts, title=title, slides=slides)


def _slide(name: str, text: str, figure: "Figure") -> dict[str, Any]:
    file = BytesIO()
    figure.savefig(file, format="webp", dpi=DPI, pil_kwargs={"quality": QUALITY})
    picture = base64.b64encode(file.getvalue()).decode("ascii")
    body = pages.markup(pages.markdown_as_html(text.encode()))
    return {"name": name, "text": body, "picture": picture}
