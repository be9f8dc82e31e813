"""Whether the errors of observables are to be trusted, and the evidence that they lack.

Theory says how long a window must be, so that a run's luck does not; its data may only veto: by a
series that is short against its own autocorrelation time, or whose variance a few rare visits make.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.scene import Scene
from roughgas.simulation import schedule
from roughgas.statistics.errors import LEAST, NO, UNKNOWN, YES, Evidence, verdict


class Window(NamedTuple):
    """A measured window, as an observable has looked at it."""

    steady: int  # a flag
    memories: float  # e-folds of the slowest temperature, or flow, that it is long
    phases: float  # of each periodic drive that looks show


class Trust(NamedTuple):
    """Flags in the shape of a variable, and the evidence that is missing where they are not YES."""

    flags: np.ndarray
    lack: str


def window_of(
    scene: Scene,
    experiment: Mapping[str, Any],
    point: Mapping[str, Any],
    looks: tuple[int, int],
    of_flow: bool = False,
) -> Window:
    """Return the window of `looks`, their number and the samples from one to the next, at a gas
    with the variables of a `point`; in e-folds of flows, too, if the observable is one `of_flow`.
    """
    number, every = looks
    kind, length = schedule.of(experiment), number * every * experiment["schedule"]["sample_every"]
    if not kind.DRIVEN:
        return Window(int(point.get("R_ci95_trusted", UNKNOWN)), math.inf, math.inf)
    relaxation = float(point.get("slowest_relaxation", math.nan))
    if of_flow:
        relaxation = max(relaxation, float(point.get("flow_relaxation", math.nan)))
    memories = length / relaxation if relaxation > 0.0 else math.nan
    phases = kind.phases(scene, experiment["schedule"], every)
    return Window(int(point["equilibrated"]), memories, phases)


def trust_in(
    value: np.ndarray, stderr: np.ndarray, evidence: Evidence, window: Window, relaxations: float
) -> Trust:
    """Return whether to trust the errors of a variable that needs `relaxations` e-folds."""
    least = LEAST._replace(memories=relaxations)
    if math.isinf(window.memories):  # of replicas, whose errors need no length
        least = LEAST
    evidence = evidence._replace(memories=window.memories, phases=window.phases)
    finite = np.isfinite(value) & np.isfinite(stderr)
    flags = np.broadcast_to(verdict(window.steady, evidence, least), finite.shape)
    flags = np.where(finite | (flags == NO), flags, UNKNOWN).astype(np.int8)
    lack = _lack_of_window(window, least) or _lack_of_elements(flags, evidence, least)
    return Trust(flags, lack if (flags != YES).any() else "")


def _lack_of_window(window: Window, least: Evidence) -> str:
    """Return the evidence that a window lacks, in words; nothing where it is enough."""
    if window.steady != YES:
        return "no steady state" if window.steady == NO else "steady state not known"
    lacks = []
    if math.isinf(least.memories):
        lacks.append("needed length of the window not known")
    elif not window.memories > 0.0:  # in no time, or not known
        lacks.append("relaxation time not known")
    elif window.memories < least.memories:
        lacks.append(_short("window of {} relaxation time{}", window.memories, least.memories))
    if window.phases < least.phases:
        lacks.append(_short("{} phase{} of the drive", window.phases, least.phases))
    return "; ".join(lacks)


def _short(text: str, number: float, limit: float) -> str:
    count = math.floor(number)
    return f"{text.format(count, '' if count == 1 else 's')}, {limit:g} needed"


OF_ELEMENTS = {
    "runs": "fewer than {:g} replicas",
    "samples": "fewer than {:g} looks",
    "times": "shorter than {:g} autocorrelation times",
    "carriers": "variance from fewer than {:g} looks",
}
"""Evidence of which each element of a variable has another amount, and what is said of a lack."""


def _lack_of_elements(flags: np.ndarray, evidence: Evidence, least: Evidence) -> str:
    """Return the first lack of each element that is not trusted, joined."""
    doubted, lacks = flags != YES, []
    for name, text in OF_ELEMENTS.items():
        limit = getattr(least, name)
        short = doubted & ~np.greater_equal(getattr(evidence, name), limit)
        if short.any():
            lacks.append(text.format(limit))
        doubted = doubted & ~short
    return "; ".join(lacks) or "no finite error"
