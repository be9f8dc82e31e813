"""Sampling of a stage: at equal intervals, at listed instants, or evenly per decade of time.

A stage is a section of a staged run; settings may change at its beginning. Instants are in T since
the beginning of the stage. They always include its end.
"""

import math
from collections.abc import Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np

from roughgas.base import InputError
from roughgas.base.fields import Settings, described, numbers, whole
from roughgas.simulation.experiment import Duration, Length
from roughgas.simulation.steady import is_whole

LENGTH_ROUNDING = 1e-9  # relative difference of two equal lengths of time due to rounding
LISTED_LIMIT = 10_000  # listed samples, each a call of the kernel
SAMPLING_KEYS = ("sample_every", "sample_at", "samples_per_decade")
"""Keys of a stage that define its sampling, mutually exclusive."""


class StageInstants(NamedTuple):
    """The instants of a stage's samples, in T since its beginning."""

    duration: float
    every: float | None  # T between two samples; None where all instants are listed
    listed: tuple[float, ...] = ()  # after the beginning, rising, the end included
    start: bool = False  # whether the beginning is sampled

    @property
    def after_start(self) -> int:
        """Number of samples after the beginning of the stage."""
        return len(self.listed) if self.every is None else round(self.duration / self.every)

    def intervals(self) -> np.ndarray:
        """Return the interval before each sample, (samples,) in T.

        It is 0 for a sample at the beginning of the stage.
        """
        if self.every is None:
            intervals = np.diff(self.listed, prepend=0.0)
        else:
            intervals = np.full(self.after_start, self.every)
        return np.concatenate([np.zeros(1), intervals]) if self.start else intervals

    @property
    def spacing(self) -> float | None:
        """Interval between samples, in T; None if intervals differ."""
        if self.start or self.every is not None:
            return None if self.start else self.every
        intervals = self.intervals()
        return (
            float(intervals[0])
            if np.allclose(intervals, intervals[0], LENGTH_ROUNDING, 0.0)
            else None
        )


def common_spacing(stages: Sequence[StageInstants]) -> float | None:
    """Return the interval between samples in all stages, in T; None if intervals differ."""
    spacing = stages[0].spacing
    for instants in stages[1:]:
        if spacing is None or instants.spacing is None:
            return None
        if not math.isclose(instants.spacing, spacing, rel_tol=LENGTH_ROUNDING):
            return None
    return spacing


class StageSamplingSettings(Settings, frozen=True, kw_only=True):
    """Duration and sampling of a stage."""

    duration: Annotated[
        Duration,
        described("How long it lasts, in T; of even samples a whole multiple of their interval."),
    ]
    sample_every: (
        Annotated[
            Duration,
            described("Between its samples, in T, in place of `sample_every` of the schedule."),
        ]
        | None
    ) = None
    sample_at: (
        Annotated[
            tuple[Length, ...],
            numbers(
                1,
                LISTED_LIMIT,
                "Instants of its samples in place of even ones, rising, in T since it begins, up "
                "to its duration; its end is always sampled.",
            ),
        ]
        | None
    ) = None
    samples_per_decade: (
        Annotated[
            int,
            whole(
                1,
                1000,
                "Number n of its samples in a decade of time, in place of even ones: at "
                "`first_sample` times 10^(k/n), k = 0, 1, 2, ..., and at its end.",
            ),
        ]
        | None
    ) = None
    first_sample: (
        Annotated[
            Duration,
            described("First instant of `samples_per_decade`, in T since it begins."),
        ]
        | None
    ) = None
    sample_start: Annotated[
        bool,
        described(
            "Whether the instant at which it begins is sampled, too, after what it changes; false "
            "by default."
        ),
    ] = False

    def samples(self, default_interval: float) -> float:
        """Return an estimate of the number of samples in the stage.

        `default_interval` is the schedule's `sample_every`, in T.
        """
        if self.sample_at is not None:
            return len(self.sample_at) + 1
        if self.samples_per_decade is not None and self.first_sample is not None:
            decades = math.log10(self.duration / self.first_sample)
            return max(0.0, self.samples_per_decade * decades) + 2
        return self.duration / (self.sample_every or default_interval)

    def sampling_key(self) -> tuple[str, Any]:
        """Return the key and the value of the setting that overrides the schedule's sampling."""
        name = next(name for name in ("sample_start", *SAMPLING_KEYS) if getattr(self, name))
        value = getattr(self, name)
        return name, list(value) if isinstance(value, tuple) else value

    def instants(self, default_interval: float) -> StageInstants:
        """Return the instants of the stage's samples; `default_interval` as in `samples`.

        The settings must have passed `check_instants`.
        """
        if self.sample_at is None and self.samples_per_decade is None:
            every = self.sample_every or default_interval
            return StageInstants(self.duration, every, start=self.sample_start)
        instants = self._decade_instants() if self.sample_at is None else self.sample_at
        end = self.duration * (1.0 - LENGTH_ROUNDING)
        listed = *(instant for instant in instants if 0.0 < instant < end), self.duration
        start = self.sample_start or instants[0] == 0.0
        return StageInstants(self.duration, None, listed, start)

    def _decade_instants(self) -> Sequence[float]:
        """Return the instants evenly spaced per decade of time, from the first sample on, in T."""
        number, first = self.samples_per_decade, self.first_sample
        assert number is not None and first is not None
        last = math.floor(number * math.log10(self.duration / first) + LENGTH_ROUNDING)
        return [first * 10.0 ** (k / number) for k in range(last + 1)]

    def check_instants(self, default_interval: float, key: str) -> None:
        """Raise InputError, whose key begins with `key`, for contradictory settings.

        The sampling must also fit the duration; `default_interval` as in `samples`.
        """
        self._check_sampling_keys(key)
        legal = f"be at most the duration of the stage, {self.duration:g} T"
        if self.first_sample is not None and self.first_sample > self.duration:
            raise InputError(f"{key}.first_sample", self.first_sample, legal)
        if self.sample_at is not None:
            if not all(np.diff(self.sample_at) > 0.0):
                raise InputError(f"{key}.sample_at", list(self.sample_at), "rise")
            if self.sample_at[-1] > self.duration:
                last = len(self.sample_at) - 1
                raise InputError(f"{key}.sample_at[{last}]", self.sample_at[-1], legal)
            return
        if self.samples_per_decade is not None:
            if self.samples(default_interval) > LISTED_LIMIT:
                legal = f"make at most {LISTED_LIMIT} samples from first_sample on"
                raise InputError(f"{key}.samples_per_decade", self.samples_per_decade, legal)
            return
        every = self.sample_every or default_interval
        if not is_whole(self.duration / every):
            name = "its sample_every" if self.sample_every else "schedule.sample_every"
            legal = f"be a whole multiple of {name}, {every:g} T"
            raise InputError(f"{key}.duration", self.duration, legal)

    def _check_sampling_keys(self, key: str) -> None:
        """Raise InputError for settings of the sampling that contradict each other.

        The key of the error begins with `key`.
        """
        first, *extra_keys = [
            name for name in SAMPLING_KEYS if getattr(self, name) is not None
        ] or [""]
        if extra_keys:
            value = getattr(self, extra_keys[0])
            value = list(value) if isinstance(value, tuple) else value
            raise InputError(f"{key}.{extra_keys[0]}", value, f"not be given beside {first}")
        if self.samples_per_decade is None and self.first_sample is not None:
            legal = "come with samples_per_decade"
            raise InputError(f"{key}.first_sample", self.first_sample, legal)
        if self.samples_per_decade is not None and self.first_sample is None:
            legal = "be given beside samples_per_decade"
            raise InputError(f"{key}.first_sample", "(nothing)", legal)
