"""The interactive page: one HTML file that holds its data and its program, and loads nothing."""

import json
from collections.abc import Iterable
from pathlib import Path
from string import Template

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.show.page.gather import GRID, experiment, rounded
from roughgas.show.style import LOOKS

# Plotly's names of the figures' markers and lines
SYMBOLS = {"o": "circle", "s": "square", "^": "triangle-up", "D": "diamond", "v": "triangle-down"}
DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}


def write_page(reduced: Iterable[str | Path], points: str | Path, output: str | Path) -> None:
    """Write the page of the experiments whose reduced datasets are at `reduced`, in this order.

    The folder `points` has seed 1 of each of their points, as the pipeline leaves it.
    Raises InputError where one is missing, where nothing spins, and for several scales at once.
    """
    from plotly.offline import get_plotlyjs

    experiments = [experiment(path, Path(points)) for path in reduced]
    scales = sorted({one["scale"] for one in experiments})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    looks = [
        {
            "colour": look.colour,
            "symbol": SYMBOLS[look.marker],
            "dash": DASHES.get(look.line, "longdashdot"),
        }
        for look in LOOKS
    ]
    data = {"scale": scales[0], "grid": rounded(GRID), "looks": looks, "experiments": experiments}
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", r"<\/")
    parts = {name: _text(f"page.{name}") for name in ("css", "js")}
    parts |= {"scale": scales[0], "plotly": get_plotlyjs(), "data": text}
    write_text(output, Template(_text("page.html")).substitute(parts))


def _text(name):
    return Path(__file__).with_name(name).read_text("utf-8")
