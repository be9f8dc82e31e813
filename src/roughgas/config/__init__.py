"""config.yaml and the folders of studies: read, checked, and merged into experiments.

`load` reads a configuration. Its experiments are kept as files write them
(roughgas.config.written); their method `experiment` returns the checked settings of points. All
functions raise InputError, with a text of one line, for unknown names and illegal values.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roughgas.base import InputError
from roughgas.base.fields import RawSettings
from roughgas.config import study_code
from roughgas.config.configuration import (
    ACCURACY,
    PAPER,
    Configuration,
    WrittenConfiguration,
)
from roughgas.config.loading import active_config_path, default_scale, load, load_experiment
from roughgas.config.packaged import SHIPPED
from roughgas.config.study import Study, StudyTasks, TaskSettings
from roughgas.config.written import CASE, GRID_AXES, PACKING, SEEDS, WrittenExperiment

if TYPE_CHECKING:
    from roughgas.simulation.experiment import Experiment

__all__ = [
    "ACCURACY",
    "CASE",
    "GRID_AXES",
    "PACKING",
    "PAPER",
    "SEEDS",
    "SHIPPED",
    "UNNAMED",
    "Configuration",
    "Study",
    "StudyTasks",
    "TaskSettings",
    "WrittenConfiguration",
    "WrittenExperiment",
    "active_config_path",
    "default_scale",
    "experiment_of",
    "load",
    "load_experiment",
]

UNNAMED = "scene"
"""Name, in messages and datasets, of an experiment without a name."""


def experiment_of(
    name: str | None, changes: RawSettings, scale: str | None = None, path: str | Path | None = None
) -> "tuple[str, str, Experiment[Any]]":
    """Return the name of an experiment, as paths spell it, its scale, and its points' settings.

    `changes` are merged over the experiment `name` of the configuration at `path`; None among them
    changes nothing. Without a name they are the complete experiment, and the default scale (a set
    of changes of size and length, such as "paper") is the paper's; with a name it is the
    configuration's. The default path is SHIPPED. Raises InputError as the pipeline does.
    """
    from roughgas.simulation import protocols

    changes = {key: _json_types(value) for key, value in changes.items() if value is not None}
    base = WrittenExperiment({})
    if name is None:
        scale = scale or PAPER
        study_code.use(())
    else:
        path = path or SHIPPED
        scale = scale or default_scale(path)
        base = load_experiment(path, name, scale)
    written = base.for_points().changed(changes)
    try:
        experiment = written.experiment(name or UNNAMED)
    except InputError:
        if name is not None and base.lacks_level(written):
            base.check_has_points(name)  # its message is clearer
        raise
    protocols.check_experiment(experiment)
    return written.spelled_name(name or UNNAMED), scale, experiment


def _json_types(value: Any) -> Any:
    """Return a value as JSON types: without numpy's types and without tuples."""
    if isinstance(value, Mapping):
        return {str(key): _json_types(inner) for key, inner in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_json_types(inner) for inner in value]
    return value
