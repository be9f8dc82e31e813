"""The figures of the paper and of what it leaves open, drawn from reduced data beside theory."""

from collections.abc import Iterable
from importlib import import_module
from pathlib import Path

from roughgas.base.errors import InputError, not_one_of
from roughgas.data.reduced import read_reduced

PAPER = ("fig1a", "fig1b", "fig2a", "fig2b")
EXTENSIONS = ("fig3", "fig4", "fig5", "fig6", "fig7", "fig8")
FIGURES = PAPER + EXTENSIONS


def draw(name: str, inputs: Iterable[str | Path], outputs: Iterable[str | Path]) -> None:
    """Draw the figure `name` from the reduced datasets at `inputs`, in any order, into `outputs`.

    Each output is a .pdf or a .png. Raises InputError for an unknown figure, another kind of file,
    and experiments that are not those of the figure.
    """
    if name not in FIGURES:
        raise not_one_of("figure", name, FIGURES)
    from roughgas.show import style

    figure = import_module(f"roughgas.show.figures.{name}")
    style.draw(lambda: figure.draw(*_datasets(name, figure.EXPERIMENTS, inputs)), outputs)


def _datasets(name, experiments, inputs):
    """The reduced datasets of the experiments that a figure shows, in its order."""
    datasets = {data.attrs["experiment"]: data for data in map(read_reduced, inputs)}
    if set(datasets) != set(experiments):
        needed = ", ".join(experiments)
        raise InputError(f"data of {name}", ", ".join(datasets), f"be {needed}")
    return [datasets[experiment] for experiment in experiments]
