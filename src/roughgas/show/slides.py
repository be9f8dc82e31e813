"""A page of slides for a lecture, with a slider to turn them: an HTML file that loads nothing."""

from collections.abc import Iterable
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import same_color
from matplotlib.lines import Line2D
from matplotlib.text import Text

from roughgas.base import NamedValues
from roughgas.base.files import study_module
from roughgas.data.reduced import read_reduced
from roughgas.show import pages
from roughgas.show.style import PARAMETERS, THEORY

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI, QUALITY = 160, 80  # of pictures in WebP, of some 30 kB each
LIGHT_INK = "#e8e8e8"  # of letters and lines on a dark page


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
    css = ["page/document.css", "page/slides.css"]
    scripts = [pages.text_of("page/slides.js")]
    pages.write_page(output, "page/slides.html", css, scripts, title=title, slides=slides)


def _slide(name: str, text: str, figure: "Figure") -> NamedValues:
    """Return the fields of a slide for the page: its name, its text (Markdown) as HTML, and its
    figure as pictures in base64, for a light and for a dark page."""
    body = pages.markup(pages.markdown_as_html(text.encode()))
    light = _picture(figure)
    _lighten_ink(figure)
    return {"name": name, "text": body, "light": light, "dark": _picture(figure)}


def _picture(figure: "Figure") -> str:
    """Return a figure as a picture without a background, WebP in base64."""
    file = BytesIO()
    for axes in figure.findobj(Axes):
        axes.set_facecolor("none")
    quality = {"quality": QUALITY}
    figure.savefig(file, format="webp", dpi=DPI, facecolor="none", pil_kwargs=quality)
    return pages.base64_of(file.getvalue())


def _lighten_ink(figure: "Figure") -> None:
    """Give letters, frames, ticks and lines that are black in a figure the colour LIGHT_INK."""
    for artist in figure.findobj():
        is_ink = isinstance(artist, Line2D | Text) and any(
            same_color(artist.get_color(), ink) for ink in ("black", THEORY)
        )
        if is_ink:
            artist.set(color=LIGHT_INK)
    for axes in figure.findobj(Axes):
        axes.tick_params(which="both", color=LIGHT_INK)
        for spine in axes.spines.values():
            spine.set_edgecolor(LIGHT_INK)
