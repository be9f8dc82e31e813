"""Figures of experiments, drawn by name from reduced data beside theory."""

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

from roughgas.base.errors import InputError, not_one_of
from roughgas.data.reduced import read_reduced
from roughgas.show import style
from roughgas.show.catalogue import FIGURES, figures_of


def draw(name: str, inputs: Iterable[str | Path], outputs: Iterable[str | Path]) -> None:
    """Draw the figure `name` from the reduced datasets at `inputs`, in any order, into `outputs`.

    Each output is a .pdf or a .png. Raises InputError for an unknown figure, another kind of file,
    and experiments other than those that the figure shows.
    """
    if name not in (known := figures_of("paper", "beyond")):
        raise not_one_of("figure", name, known)
    needed = FIGURES[name].shows
    datasets = {data.attrs["experiment"]: data for data in map(read_reduced, inputs)}
    if set(datasets) != set(needed):
        raise InputError(f"data of {name}", ", ".join(datasets), f"be {', '.join(needed)}")
    figure = import_module(f"roughgas.show.figures.{name}")
    style.draw(lambda: figure.draw(*(datasets[one] for one in needed)), outputs)
