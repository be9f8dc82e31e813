"""What accuracy costs in time, and whether error bars are true: studies of the methods themselves.

A study is a name in tasks.py, which lists its independent tasks. A file in runs/ does one of them,
a file here combines what all have found and fits what is to be fitted, variables.yaml describes
the outcome, and tables.py shows it in Markdown. Settings are in config.yaml, under `accuracy`.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from roughgas.studies.accuracy.tasks import PANELS, STUDIES, check_task, tasks

if TYPE_CHECKING:
    import xarray

__all__ = ["PANELS", "STUDIES", "run", "tasks"]


def run(
    study: str,
    task: str,
    settings: Mapping[str, Any],
    experiments: Mapping[str, Mapping[str, Any]],
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> "xarray.Dataset":
    """Do one task of a study and return what it finds: values of R, and CPU seconds.

    The seconds are without those of compiling. `progress(done, total)` is called now and then.
    Raises InputError for unknown names and illegal settings, CollapseError as a simulation does.
    """
    check_task(study, task, settings)
    from roughgas.studies.accuracy.runs import coverage, discretisation, models, statistical

    registered = {
        "statistical": statistical.run,
        "models": models.run,
        "discretisation": discretisation.run,
        "coverage": coverage.run,
    }
    return registered[study](task, settings, experiments, progress)
