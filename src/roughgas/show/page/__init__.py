"""The interactive page: one HTML file that holds its data and its program, and asks for nothing."""

import json
from collections.abc import Iterable
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

from roughgas.base.errors import InputError
from roughgas.base.files import write_text
from roughgas.show.page.gather import GRID, experiment
from roughgas.show.page.numbers import rounded

SYMBOLS = {"o": "circle", "s": "square", "^": "triangle-up", "D": "diamond", "v": "triangle-down"}
DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}
"""Plotly's names of the figures' markers and lines."""


def write_page(reduced: Iterable[str | Path], points: str | Path, output: str | Path) -> None:
    """Write the page of the experiments whose reduced datasets are at `reduced`, in this order.

    Below the folder `points`, as the pipeline leaves it, lies seed 1 of each of their points.
    Raises InputError where one is missing, where nothing spins, and for several scales at once.
    """
    experiments = [experiment(path, Path(points)) for path in reduced]
    scales = sorted({one["scale"] for one in experiments})
    if len(scales) != 1:
        raise InputError("scale of the datasets", " and ".join(scales) or "none", "be one")
    write_text(output, assembled(scales[0], experiments))


def assembled(scale: str, experiments: list[dict[str, Any]]) -> str:
    """The page as text: structure, looks, program, Plotly's program, and data as JSON."""
    from plotly.offline import get_plotlyjs

    data = {"scale": scale, "grid": rounded(GRID), "looks": _looks(), "experiments": experiments}
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    here = files("roughgas.show.page")
    parts = {name: here.joinpath(f"page.{name}").read_text("utf-8") for name in ("css", "js")}
    parts |= {"scale": scale, "plotly": get_plotlyjs(), "data": text.replace("</", r"<\/")}
    return Template(here.joinpath("page.html").read_text("utf-8")).substitute(parts)


def _looks() -> list[dict[str, str]]:
    """The looks of the figures' series, in Plotly's words."""
    from roughgas.show.style import LOOKS

    return [
        {
            "colour": look.colour,
            "symbol": SYMBOLS[look.marker],
            "dash": DASHES.get(look.line, "longdashdot"),
        }
        for look in LOOKS
    ]
