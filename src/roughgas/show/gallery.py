"""Figures of experiments: by name, and of any reduced dataset, beside theory."""

from collections.abc import Iterable, Sequence
from importlib import import_module
from pathlib import Path

from roughgas.base.errors import InputError, not_one_of
from roughgas.data.reduced import read_reduced
from roughgas.show import style
from roughgas.show.catalogue import FIGURES, figures_of


def draw(
    name: str,
    inputs: Iterable[str | Path],
    outputs: Iterable[str | Path],
    slide: bool = False,
) -> None:
    """Draw the figure `name` from the reduced datasets at `inputs`, in any order, into `outputs`.

    Each output is a .pdf, .png or .svg, of 16 to 9 for a `slide`. Raises InputError for an unknown
    figure, another kind of file, experiments other than those that the figure shows, and those
    that were swept otherwise.
    """
    if name not in (known := figures_of("paper", "beyond")):
        raise not_one_of("figure", name, known)
    needed = FIGURES[name].shows
    datasets = {data.attrs["experiment"]: data for data in map(read_reduced, inputs)}
    if set(datasets) != set(needed):
        raise InputError(f"data of {name}", ", ".join(datasets), f"be {', '.join(needed)}")
    figure = import_module(f"roughgas.show.figures.{name}")
    try:
        style.draw(lambda: figure.draw(*(datasets[one] for one in needed)), outputs, slide)
    except KeyError as error:
        swept = "; ".join(f"{one} over {', '.join(datasets[one].R.dims)}" for one in needed)
        raise InputError(f"data of {name}", swept, f"have all that it shows: {error}") from error


def plot(
    path: str | Path,
    outputs: Iterable[str | Path],
    over: str | None = None,
    **chosen: Sequence[float],
) -> list[str]:
    """Draw the reduced dataset at `path` into `outputs`, each a .pdf, .png or .svg.

    Returns a line for each coordinate of which not all values are shown. Raises InputError as
    `sweep.draw` does, and for another kind of file.
    """
    from roughgas.show.figures import sweep

    data = read_reduced(path)
    layout = sweep.arranged(data, over, chosen)
    style.draw(lambda: sweep.draw(data, over, **chosen), outputs)
    return sweep.left_out(data, layout)
