"""The figures of the studies, each drawn from one combined dataset."""

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

FIGURES = ("accuracy", "coverage", "profiles", "finite_size", "runaway")


def draw(name: str, data: str | Path, outputs: Iterable[str | Path]) -> None:
    """Draw the figure `name` of FIGURES from the combined dataset at `data` into `outputs`.

    Raises InputError for other files than .pdf and .png.
    """
    from roughgas.show import style

    module = import_module(f"roughgas.studies.figures.{name}")
    style.draw(lambda: module.draw(data), outputs)
