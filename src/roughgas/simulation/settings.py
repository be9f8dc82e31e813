"""Settings of a point from keyword arguments, merged over an experiment's and checked."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from roughgas import config
from roughgas.config.arguments import Observe
from roughgas.config.schema import check_schema
from roughgas.simulation import schedule


def settings_of(
    name: str | None,
    changes: Mapping[str, Any],
    scale: str,
    path: str | Path | None,
    unnamed: str,
) -> dict[str, Any]:
    """Return the settings of a point, checked as those of the pipeline are.

    `changes` that are None change nothing. Without a name they are all that there is, and messages
    call it `unnamed`. Raises InputError.
    """
    given = {key: _plain(value) for key, value in changes.items() if value is not None}
    known = {} if name is None else config.load_experiment(path or config.SHIPPED, name, scale)
    where = name or unnamed
    settings = config.changed_by(config.point_settings(known), given)
    check_schema(settings, where, "experiment")
    settings = config.fitted(settings, where)
    check_schema(settings, where, "point")
    schedule.check(settings)
    return settings


def observables_of(
    observe: Observe | None,
) -> tuple[dict[str, Any] | None, dict[str, Callable[[Any], Any]]]:
    """Return the observables that settings name, and those that are functions."""
    if observe is None:
        return None, {}
    named = [observe] if isinstance(observe, str) else observe
    given = named if isinstance(named, Mapping) else dict.fromkeys(named)
    functions = {name: one for name, one in given.items() if callable(one)}
    return {name: one or {} for name, one in given.items() if not callable(one)}, functions


def _plain(value: Any) -> Any:
    """Return a value as JSON would have it: no numpy, no tuples."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(inner) for inner in value]
    return value
