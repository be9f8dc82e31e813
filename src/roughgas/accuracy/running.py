"""The tasks of accuracy, run one at a time and combined; tables and figures of what they find."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas import config
from roughgas.accuracy import FIGURES, STUDIES, study
from roughgas.base import InputError, not_one_of
from roughgas.base.files import write_text
from roughgas.config.schema import check_schema
from roughgas.data.netcdf import TASK, Content, content_of, read_groups, read_netcdf, write_netcdf
from roughgas.tasks.running import combined, write_found

if TYPE_CHECKING:
    import xarray as xr


class Experiments(dict):
    """Settings of experiments by name; raises InputError for one that the configuration lacks."""

    def __missing__(self, name: str) -> None:
        raise not_one_of("experiment", name, self)


def run_task(
    name: str, task: str, *, scale: str = config.PAPER, settings: str, output: str | Path
) -> None:
    """Run one of the independent tasks of a study of accuracy, and write what it finds.

    `settings` are those of the `study` and of `experiments`, as JSON. Raises InputError for an
    unknown study or task and for illegal settings, CollapseError as a simulation does, OSError.
    """
    module = study(name)

    def check(own: Any, source: str) -> None:
        for part in (name, f"accuracy_in_full/properties/{name}"):
            check_schema(own, source, part)

    found = config.task_from_text(settings, check)
    found["experiments"] = Experiments(found["experiments"])
    about = {"study": name, "task": task, "scale": scale, "settings_json": settings}
    write_found(module.run, module.tasks(found["study"]), found, about, output)


def combine(inputs: Iterable[str | Path], *, output: str | Path) -> None:
    """Combine the files of tasks into one file, with a group for each study among them.

    Raises InputError where tasks of a study are missing or come from different settings.
    """
    found: dict[str, dict[str, xr.Dataset]] = {}
    for path in inputs:
        data = read_netcdf(path, TASK)
        found.setdefault(data.attrs["study"], {})[data.attrs["task"]] = data
    groups = {}
    for name, parts in found.items():
        one = study(name)
        groups[name] = content_of(combined(name, parts, one.tasks, one.combine))
    write_netcdf(output, Content({}, {"title": "Studies"}), groups)


def read_studies(path: str | Path) -> "dict[str, xr.Dataset]":
    """Return the groups of all studies in the combined file at `path`, by name."""
    groups = read_groups(path)
    return {name: groups[name] for name in STUDIES if name in groups}


def write_tables(input: str | Path, *, output: str | Path) -> None:
    """Write the tables of all studies in a combined file as Markdown."""
    found = read_studies(input).items()
    write_text(output, "\n".join(study(name).table(data) for name, data in found))


def draw(name: str, input: str | Path, *, output: Iterable[str | Path]) -> None:
    """Draw a figure of FIGURES from the combined dataset at `input`.

    Raises InputError for another figure, other files than .pdf and .png, and where the dataset
    lacks a study that the figure shows.
    """
    from roughgas.accuracy import figures
    from roughgas.show import catalogue, style

    if name not in FIGURES:
        raise not_one_of("figure", name, FIGURES)
    studies, shows = read_studies(input), catalogue.FIGURES[name].shows
    for one in shows:
        if one not in studies:
            legal = "have all that the figure shows"
            raise InputError(f"studies in {input}", f"without {one}", legal)
    function = getattr(figures, name)
    style.draw(lambda: function(*(studies[one] for one in shows)), output)
