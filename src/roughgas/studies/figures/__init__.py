"""The figures of the studies, each drawn from one combined dataset."""

from collections.abc import Iterable
from pathlib import Path

FIGURES = ("accuracy", "coverage")


def draw(name: str, data: str | Path, outputs: Iterable[str | Path]) -> None:
    """Draw the figure `name` of FIGURES from the combined dataset at `data` into `outputs`.

    Raises InputError for other files than .pdf and .png.
    """
    from roughgas.show import style
    from roughgas.studies.figures import accuracy, coverage

    drawn = {"accuracy": accuracy.draw, "coverage": coverage.draw}[name]
    style.draw(lambda: drawn(data), outputs)
