"""The figures of the studies, each drawn from one combined dataset."""

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

from roughgas.base import InputError

FIGURES = ("profiles", "finite_size", "runaway")
DATASETS = {name: name for name in FIGURES}
"""The combined dataset that each is drawn from."""


def draw(name: str, data: str | Path, outputs: Iterable[str | Path]) -> None:
    """Draw the figure `name` of FIGURES from the combined dataset at `data` into `outputs`.

    Raises InputError for other files than .pdf and .png, and where the dataset lacks a study that
    the figure shows.
    """
    from roughgas.show import catalogue, style
    from roughgas.studies.files import read_studies

    studies, shown = read_studies(data), catalogue.FIGURES[name].shows
    for study in shown:
        if study not in studies:
            legal = "have all that the figure shows"
            raise InputError(f"studies in {data}", f"without {study}", legal)
    module = import_module(f"roughgas.studies.figures.{name}")
    style.draw(lambda: module.draw_figure(*(studies[study] for study in shown)), outputs)
