"""Drawing of figures into files: figures of studies by name, and of single datasets."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from roughgas.base import InputError
from roughgas.base.files import study_module
from roughgas.data.netcdf import POINT, REDUCED, file_type_of, opened, read_groups
from roughgas.data.point import read_point
from roughgas.data.reduced import read_by_name, read_reduced
from roughgas.results.comparison import read_rows
from roughgas.show import style
from roughgas.theory.prediction import ratio_of_point

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure


def draw(
    folder: str | Path,
    figure: str,
    inputs: Iterable[str | Path],
    *,
    shows: Sequence[str],
    output: Iterable[str | Path],
    slide: bool = False,
) -> None:
    """Draw a figure of the study in `folder` from datasets at `inputs`, in any order.

    `shows` lists what the figure shows: experiments, modules with tasks, or the word "tasks" if the
    study has a single such module. `output` lists paths of .pdf, .png or .svg files, 16 to 9 for a
    `slide`. The study's figure.py has `draw` for the figure named like the study, draw_X for
    STUDY_X, and a function named like any other figure; they take the datasets in this order.
    Raises InputError if figure.py lacks the function, for another type of output, for other data
    than the figure shows, and for data with other axes.
    """
    study = Path(folder).name
    name = f"draw{figure.removeprefix(study)}" if figure.startswith(study) else figure
    function = getattr(study_module(folder, "figure"), name, None)
    if function is None:
        raise InputError(f"studies/{study}/figure.py", "it", f"have {name}()")
    names = [study if shown == "tasks" else shown for shown in shows]
    datasets = {name: data for path in inputs for name, data in read_by_name(path).items()}
    # a dataset of several modules with tasks may contain data that the figure does not show
    surplus = {name for name, data in datasets.items() if "experiment" not in data.attrs}
    datasets = {k: data for k, data in datasets.items() if k in names or k not in surplus}
    _draw(figure, function, names, datasets, output, slide)


def movie_of_study(folder: str, input: str | Path, *, output: str | Path) -> None:
    """Write the movie of results of tasks of the study in `folder`, by `draw(data, path)` in its
    movie.py."""
    (data,) = read_groups(input).values()
    study_module(folder, "movie").draw(data, Path(output))


def draw_evidence(input: str | Path, *, output: Iterable[str | Path]) -> None:
    """Draw the histograms of the rows of evidence in a CSV file."""
    figure = import_module("roughgas.show.figures.evidence")
    rows = read_rows(input)
    style.draw(lambda: figure.draw(rows), output)


def _draw(
    name: str,
    function: Callable[..., "Figure"],
    shows: Sequence[str],
    datasets: "Mapping[str, xr.Dataset]",
    outputs: Iterable[str | Path],
    slide: bool = False,
) -> None:
    """Draw a figure called `name` by `function` of its datasets into each of `outputs`, of 16 to 9
    for a `slide`.

    The function takes the `datasets`, by name, in the order of the names in `shows`. Raises
    InputError for other datasets than these, and for datasets that lack a coordinate, value or
    variable.
    """
    if set(datasets) != set(shows):
        raise InputError(f"data of {name}", ", ".join(datasets), f"be {', '.join(shows)}")
    try:
        style.draw(lambda: function(*(datasets[shown] for shown in shows)), outputs, slide)
    except KeyError as error:
        swept = "; ".join(
            f"{shown} over {', '.join(map(str, datasets[shown].sizes))}" for shown in shows
        )
        raise InputError(f"data of {name}", swept, f"have all that it shows: {error}") from error


def plot(
    path: str | Path,
    outputs: Iterable[str | Path],
    over: str | None = None,
    of: Sequence[str] = (),
    theory: "Callable[[xr.Dataset], Mapping[str, xr.DataArray]] | None" = None,
    **chosen: Sequence[float],
) -> list[str]:
    """Draw a reduced dataset, the time series of a point, or a variable of an observable of a
    point, into `outputs`, each a .pdf, .png or .svg.

    `path` is the path of the dataset, and `of` names variables to draw, of a point one; by default
    R, and in a reduced dataset all that observables have measured. For a reduced one `over` is the
    horizontal axis, `chosen` has the values of r and beta to show, as in `sweep.draw`, and `theory`
    returns lines of theory of a dataset, by variable. Returns messages on what is not shown.
    Raises InputError as `sweep.draw`, for another type of file, and for an axis, values or a theory
    chosen for a point.
    """
    from roughgas.show.figures import sweep, variables

    with opened(path, REDUCED, POINT) as file:
        is_point = file_type_of(file) == POINT
    if is_point and any((over, theory, *chosen.values())):
        legal = "be a reduced one for --over, --r, --beta and --theory"
        raise InputError("dataset", path, legal)
    if is_point:
        point = read_point(path)
        if len(of) > 1:
            raise InputError("--of", ", ".join(of), "be one variable of a point")
        if of:
            style.draw(lambda: sweep.draw_observed(point, of[0]), outputs)
        else:
            style.draw(lambda: sweep.draw_point(point, ratio_of_point(point)), outputs)
        return []
    data = read_reduced(path)
    lines_of_theory = theory(data) if theory else {}
    names = [*of] or variables.drawn_by_default(data, lines_of_theory)
    if names == ["R" if "R" in data else "E_trans"] and not lines_of_theory:
        lines = sweep.coordinates_not_shown(data, over, chosen)
        style.draw(lambda: sweep.draw(data, over, **chosen), outputs)
    else:
        style.draw(lambda: variables.draw(data, names, over, lines_of_theory, **chosen), outputs)
        lines = variables.not_shown(data, names, over, chosen)
    return lines
