"""Figures of experiments, drawn by name from reduced data beside theory."""

from collections.abc import Iterable
from pathlib import Path

from roughgas.base.errors import InputError, not_one_of
from roughgas.data.reduced import read_reduced
from roughgas.show import style
from roughgas.show.catalogue import FIGURES
from roughgas.show.figures import (
    fig1a,
    fig1b,
    fig2a,
    fig2b,
    fig3,
    fig4,
    fig5,
    fig6,
    fig7,
    fig8,
)

DRAWN = {
    "fig1a": fig1a.draw,
    "fig1b": fig1b.draw,
    "fig2a": fig2a.draw,
    "fig2b": fig2b.draw,
    "fig3": fig3.draw,
    "fig4": fig4.draw,
    "fig5": fig5.draw,
    "fig6": fig6.draw,
    "fig7": fig7.draw,
    "fig8": fig8.draw,
}
"""What draws a figure: given the datasets of the experiments that the catalogue has for it."""


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
