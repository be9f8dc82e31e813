"""Figures of experiments, drawn by name from reduced data beside theory."""

from collections.abc import Iterable
from pathlib import Path

from roughgas.base.errors import InputError, not_one_of
from roughgas.data.reduced import read_reduced
from roughgas.show import style
from roughgas.show.catalogue import FIGURES
from roughgas.show.figures import fig1a, fig1b, fig2a, fig2b, fig3, fig4, fig5, fig6, fig7, fig8

MODULES = (fig1a, fig1b, fig2a, fig2b, fig3, fig4, fig5, fig6, fig7, fig8)
DRAWN = {module.__name__.rpartition(".")[2]: module.draw for module in MODULES}
"""The function that draws each figure from the datasets of what the catalogue says it shows."""


def draw(name: str, inputs: Iterable[str | Path], outputs: Iterable[str | Path]) -> None:
    """Draw the figure `name` from the reduced datasets at `inputs`, in any order, into `outputs`.

    Each output is a .pdf or a .png. Raises InputError for an unknown figure, another kind of file,
    and experiments other than those that the figure shows.
    """
    if name not in DRAWN:
        raise not_one_of("figure", name, DRAWN)
    needed = FIGURES[name].shows
    datasets = {data.attrs["experiment"]: data for data in map(read_reduced, inputs)}
    if set(datasets) != set(needed):
        raise InputError(f"data of {name}", ", ".join(datasets), f"be {', '.join(needed)}")
    style.draw(lambda: DRAWN[name](*(datasets[one] for one in needed)), outputs)
