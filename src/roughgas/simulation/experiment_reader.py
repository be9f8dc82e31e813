"""Conversion of a mapping of settings to an Experiment, with all checks."""

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from roughgas.base import InputError, NamedValues, short_repr
from roughgas.base.fields import TAG, RawSettings, Settings, nested_key, read, read_each
from roughgas.scene.settings import SceneSettings, scene_settings
from roughgas.simulation.experiment import Experiment, ScheduleSettings
from roughgas.simulation.protocols import PROTOCOLS


def read_experiment(raw: RawSettings, key: str = "") -> Experiment[Any]:
    """Return the settings of the points of an experiment, converted and checked, from a mapping.

    `raw` is merged and complete; keys that do not affect points are ignored. Raises InputError,
    whose key begins with `key`, for missing or illegal values.
    """
    key_of_observables = nested_key(key, "observables")
    observables, needed_effects = _observables(raw.get("observables"), key_of_observables)
    scene = scene_settings(raw, key)
    missing: dict[str, RawSettings] = {
        name: {} for name in needed_effects if name not in scene.effects
    }
    return Experiment(
        **_fields(scene.with_effects(missing) if missing else scene),
        schedule=_schedule(raw.get("schedule"), nested_key(key, "schedule")),
        observables=observables,
        keep_state=bool(raw.get("keep_state", False)),
        raw=deepcopy(dict(raw)),
    )


def _fields(settings: SceneSettings) -> NamedValues:
    """Return the values of a settings struct by the name of the field."""
    return {name: getattr(settings, name) for name in settings.__struct_fields__}


def _schedule(raw: Any, key: str) -> ScheduleSettings:
    """Return the checked settings of a schedule from a mapping; errors begin with `key`."""
    kind = raw.get(TAG) if isinstance(raw, Mapping) else None
    if kind not in PROTOCOLS:
        value = "(nothing)" if kind is None else short_repr(kind)
        raise InputError(f"{key}.{TAG}", value, f"be one of {', '.join(PROTOCOLS)}")
    return read(PROTOCOLS[kind].SETTINGS, raw, key)


def _observables(raw: Any, key: str) -> tuple[dict[str, Settings], list[str]]:
    """Return the settings of observables by name, and the names of the effects that these require.

    `raw` is the mapping of observables in an experiment; errors begin with `key`.
    """
    if not raw:
        return {}, []
    from roughgas.observables import OBSERVABLES, effects_of  # slow to import

    return read_each(OBSERVABLES, raw, key), effects_of(raw)
