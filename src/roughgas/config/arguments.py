"""The types of keyword arguments that stand for keys of an experiment in config.yaml."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, TypedDict

Values = float | Sequence[float]
"""One value of r, of beta or of the seed, or several."""
Side = float | Literal["open"]
"""Length of a box along one axis in a; the last axis may be open above."""
Effects = Mapping[str, Mapping[str, float | str] | None]
"""Parameters of effects by the effects' names; None takes away one that the experiment has."""

Species = Sequence[Mapping[str, Any]]
"""Species, or pairs of them, each a mapping of keys to values."""
Observe = Sequence[str] | Mapping[str, Mapping[str, float] | Callable[[Any], Any] | None]
"""Observables by name, each with settings, with None for the usual ones, or a function of frames
(`roughgas.observables.Frame`)."""


class Schedule(TypedDict, total=False):
    """How long to simulate and what to measure, as `schedule` in config.yaml.

    A driven gas has the kind `steady`, and its lengths in T; one that nothing drives has the kind
    `cooling`, and its lengths in collisions per particle.
    """

    kind: Literal["steady", "cooling"]  #: driven, or not
    sample_every: float  #: between samples
    equilibrate: float  #: (steady) before the measurement
    measure: float  #: (steady) length of the measurement
    period: float  #: (steady) of the drive; averages are over whole periods
    replicas: int  #: (cooling) independent runs
    thermalise: float  #: (cooling) as smooth elastic particles, at the start
    relaxation_times: float  #: (cooling) e-folds of theory until R is on its plateau
    plateau: float  #: (cooling) length of the plateau
    target_stderr: float  #: standard error of R that the run is prolonged to
