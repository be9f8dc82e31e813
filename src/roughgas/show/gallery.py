"""Figures of experiments: by name, and of any reduced dataset, beside theory."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from roughgas.base import InputError, not_one_of
from roughgas.base.files import module_of
from roughgas.data.netcdf import POINT, REDUCED, kind_of, opened, read_groups
from roughgas.data.point import read_point
from roughgas.data.reduced import read_by_name, read_reduced
from roughgas.results.evidence import read_rows
from roughgas.show import style
from roughgas.show.catalogue import FIGURES, figures_of
from roughgas.theory.prediction import ratio_of_point

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def draw(
    name: str, inputs: Iterable[str | Path], *, output: Iterable[str | Path], slide: bool = False
) -> None:
    """Draw the figure `name` of the paper from the reduced datasets at `inputs`, in any order.

    Each output is a .pdf, .png or .svg, of 16 to 9 for a `slide`. Raises InputError for an unknown
    figure, another kind of file, experiments other than those that the figure shows, and those
    that were swept otherwise.
    """
    if name not in (known := figures_of("paper")):
        raise not_one_of("figure", name, known)
    # by name: figures of studies, which are drawn here, too, do not depend on those of the paper
    paper = import_module("roughgas.show.figures.paper")
    datasets = {data.attrs["experiment"]: data for data in map(read_reduced, inputs)}
    _draw(name, getattr(paper, name), FIGURES[name].shows, datasets, output, slide)


def draw_of_study(
    folder: str | Path,
    figure: str,
    inputs: Iterable[str | Path],
    *,
    shows: Sequence[str],
    output: Iterable[str | Path],
) -> None:
    """Draw a figure of the study in `folder`, which `shows` these experiments, and `tasks`, what
    its tasks have found.

    Its figure.py has `draw` for the figure that has the study's name, and draw_X for NAME_X, which
    take the datasets in the order of `shows`. Raises InputError as `draw`, and where figure.py has
    no such function.
    """
    part = figure.removeprefix(Path(folder).name)
    function = getattr(module_of(folder, "figure"), f"draw{part}", None)
    if function is None:
        raise InputError(f"studies/{Path(folder).name}/figure.py", "it", f"have draw{part}()")
    names = [Path(folder).name if one == "tasks" else one for one in shows]
    datasets = {name: data for path in inputs for name, data in read_by_name(path).items()}
    _draw(figure, function, names, datasets, output)


def movie_of_study(folder: str, input: str | Path, *, output: str | Path) -> None:
    """Write the movie of what the tasks of the study in `folder` have found: its movie.py has
    `draw(data, path)`."""
    (data,) = read_groups(input).values()
    module_of(folder, "movie").draw(data, Path(output))


def draw_evidence(input: str | Path, *, output: Iterable[str | Path]) -> None:
    """Draw the histogram of the rows of evidence in a CSV."""
    figure = import_module("roughgas.show.figures.evidence")
    rows = [row for _, row in read_rows(input)]
    style.draw(lambda: figure.draw(rows), output)


def _draw(
    name: str,
    function: Callable[..., "Figure"],
    shows: Sequence[str],
    datasets: "Mapping[str, xr.Dataset]",
    outputs: Iterable[str | Path],
    slide: bool = False,
) -> None:
    if set(datasets) != set(shows):
        raise InputError(f"data of {name}", ", ".join(datasets), f"be {', '.join(shows)}")
    try:
        style.draw(lambda: function(*(datasets[one] for one in shows)), outputs, slide)
    except KeyError as error:
        swept = "; ".join(f"{one} over {', '.join(map(str, datasets[one].sizes))}" for one in shows)
        raise InputError(f"data of {name}", swept, f"have all that it shows: {error}") from error


def plot(
    path: str | Path,
    outputs: Iterable[str | Path],
    over: str | None = None,
    of: str | None = None,
    **chosen: Sequence[float],
) -> list[str]:
    """Draw the reduced dataset at `path`, or the time series of a point, or what it is told `of`,
    into `outputs`, each a .pdf, .png or .svg.

    Returns a line for each coordinate of which not all values are shown. Raises InputError as
    `sweep.draw` does, for another kind of file, and for an axis or values of a point.
    """
    from roughgas.show.figures import sweep

    with opened(path, REDUCED, POINT) as file:
        is_point = kind_of(file) == POINT
    if is_point and any((over, *chosen.values())):
        raise InputError("dataset", path, "be a reduced one for --over, --r and --beta")
    if of is not None and not is_point:
        raise InputError("dataset", path, "be a point for --of")
    if not is_point:
        data = read_reduced(path)
        lines = sweep.left_out(data, over, chosen)
        style.draw(lambda: sweep.draw(data, over, **chosen), outputs)
        return lines
    point = read_point(path)
    if of is None:
        style.draw(lambda: sweep.draw_point(point, ratio_of_point(point)), outputs)
    else:
        style.draw(lambda: sweep.draw_observed(point, of), outputs)
    return []
