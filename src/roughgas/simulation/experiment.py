"""Settings of an experiment: scene, schedule, observables, and what its runs store."""

from collections.abc import Mapping
from typing import Annotated, Any, Generic, Self, TypeVar

from msgspec import to_builtins
from msgspec.structs import replace

from roughgas.base import merged, sorted_json
from roughgas.base.fields import Settings, described, number, read
from roughgas.base.labels import SWEPT, level_in
from roughgas.scene.settings import SceneSettings

KEYS_OF_NO_POINT = ("description", "sweep", "betas_per_job")
"""Keys of an experiment that do not affect its points."""
Length = Annotated[float, number("[0, 1e+09]")]
"""A length of time, possibly zero, in T or in collisions per particle."""
Duration = Annotated[float, number("(0, 1e+09]")]
"""A length of time, in T or in collisions per particle."""
RelaxationTimes = Annotated[
    float,
    number(
        "[0, 1e+09]",
        "Relaxation times of theory to wait until R is on its plateau; of a steady state at least "
        "`equilibrate`, at most 100 times that.",
    ),
]
Target = Annotated[
    float,
    number(
        "(0, 0.1]",
        "Standard error of R that each run is prolonged to, if the lengths above do not reach it: "
        "up to 100 times `measure` (steady) or `replicas` (cooling).",
    ),
]


class ScheduleSettings(Settings, frozen=True, kw_only=True, tag_field="kind"):
    """Settings that schedules of all kinds share."""

    sample_every: Annotated[
        Duration,
        described(
            "Between samples, in T (steady, stages) or in collisions per particle (cooling); a "
            "stage may have other samples."
        ),
    ]

    @property
    def kind(self) -> str:
        """Name of the kind of schedule in settings."""
        return str(self.__struct_config__.tag)


Schedule = TypeVar("Schedule", bound=ScheduleSettings)


class Experiment(SceneSettings, Generic[Schedule], frozen=True, kw_only=True):
    """Validated settings of the points of an experiment."""

    schedule: Schedule
    observables: Mapping[str, Any] = {}
    """Settings structs of the observables, by name."""
    keep_state: bool = False
    raw: Mapping[str, Any]
    """The merged settings as they were written, from which alone texts of settings are made."""

    @property
    def text(self) -> str:
        """The settings of the points as JSON; equal settings have equal texts."""
        return sorted_json({key: self.raw[key] for key in self.raw if key not in KEYS_OF_NO_POINT})

    @property
    def swept(self) -> str | None:
        """The parameter that a variant of an experiment varies, such as spin.inertia, or None."""
        return self.raw.get(SWEPT)

    @property
    def level(self) -> Any:
        """The value of the swept parameter in this variant, or None."""
        return level_in(self.raw, self.swept or "")

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """Return the experiment with `changes`, new values by key.

        Effects and the schedule change key by key, other settings as a whole. Raises InputError for
        illegal values.
        """
        schedule = to_builtins(self.schedule) | dict(changes.get("schedule", {}))
        changes_of_scene = {key: change for key, change in changes.items() if key != "schedule"}
        return replace(
            super().changed(changes_of_scene),
            schedule=read(type(self.schedule), schedule, "schedule"),
            raw=merged(self.raw, changes),
        )
