"""Flags of trust for the errors of observables, and descriptions of missing evidence.

A flag is 1 (yes), 0 (no) or -1 (not known). Theory determines the necessary length of a window, so
that chance does not. The data of a run can only veto: if a series is short compared with its
autocorrelation time, or if a few rare visits dominate its variance.
"""

import math
from typing import NamedTuple

import numpy as np

from roughgas.base import Record
from roughgas.scene import Scene
from roughgas.simulation import protocols
from roughgas.simulation.experiment import Experiment
from roughgas.statistics.sample_sizes import (
    MINIMUM_SAMPLE_SIZE,
    NO,
    UNKNOWN,
    YES,
    SampleSize,
    verdict,
)


class ObservedWindow(NamedTuple):
    """Length and steadiness of the measured window, as an observable shows it."""

    steady: int  # a flag
    memories: float  # length in e-folds of the slowest temperature, or flow
    phases: float  # observed phases of each periodic drive


class Trust(NamedTuple):
    """Flags in the shape of a variable, and the missing evidence if some are not YES."""

    flags: np.ndarray
    lack: str


def window_of(
    scene: Scene,
    experiment: Experiment,
    point: Record,
    observations: tuple[int, int],
    depends_on_flow: bool = False,
) -> ObservedWindow:
    """Return the measured window of an observable, from the variables of its `point`.

    `observations` are their number and their interval in samples. For an observable that
    `depends_on_flow` the length is in e-folds of flows, too.
    """
    number, every = observations
    protocol, length = (
        protocols.protocol_of(experiment),
        number * every * experiment.schedule.sample_every,
    )
    if not protocol.DRIVEN:
        return ObservedWindow(int(point.get("R_ci95_trusted", UNKNOWN)), math.inf, math.inf)
    relaxation = float(point.get("slowest_relaxation", math.nan))
    if depends_on_flow:
        relaxation = max(relaxation, float(point.get("flow_relaxation", math.nan)))
    memories = length / relaxation if relaxation > 0.0 else math.nan
    phases = protocol.phases(scene, experiment.schedule, every)
    return ObservedWindow(int(point["equilibrated"]), memories, phases)


def trust_in(
    value: np.ndarray,
    stderr: np.ndarray,
    evidence: SampleSize,
    window: ObservedWindow,
    relaxations: float,
) -> Trust:
    """Return the trust in the errors `stderr` of a variable's `value`, arrays of the same shape.

    `evidence` are the amounts of data behind each element. The variable needs a `window` of
    `relaxations` e-folds of the slowest relaxation.
    """
    required = MINIMUM_SAMPLE_SIZE._replace(memories=relaxations)
    if math.isinf(window.memories):  # of replicas: independent of the length
        required = MINIMUM_SAMPLE_SIZE
    evidence = evidence._replace(memories=window.memories, phases=window.phases)
    finite = np.isfinite(value) & np.isfinite(stderr)
    flags = np.broadcast_to(verdict(window.steady, evidence, required), finite.shape)
    flags = np.where(finite | (flags == NO), flags, UNKNOWN).astype(np.int8)
    lack = _lack_of_window(window, required) or _lack_of_elements(flags, evidence, required)
    return Trust(flags, lack if (flags != YES).any() else "")


def _lack_of_window(window: ObservedWindow, required: SampleSize) -> str:
    """Return the evidence that a window lacks, in words; empty if it reaches `required`."""
    if window.steady != YES:
        return "no steady state" if window.steady == NO else "steady state not known"
    lacks = []
    if math.isinf(required.memories):
        lacks.append("needed length of the window not known")
    elif not window.memories > 0.0:  # zero or NaN
        lacks.append("relaxation time not known")
    elif window.memories < required.memories:
        lacks.append(
            _shortage("window of {} relaxation time{}", window.memories, required.memories)
        )
    if window.phases < required.phases:
        lacks.append(_shortage("{} phase{} of the drive", window.phases, required.phases))
    return "; ".join(lacks)


def _shortage(text: str, number: float, limit: float) -> str:
    """Return in words that `number` is less than `limit`.

    `text` has two places, for the number and for a plural s.
    """
    count = math.floor(number)
    return f"{text.format(count, '' if count == 1 else 's')}, {limit:g} needed"


ELEMENT_LACKS = {
    "runs": "fewer than {:g} replicas",
    "samples": "fewer than {:g} looks",
    "times": "shorter than {:g} autocorrelation times",
    "effective_samples": "variance from fewer than {:g} looks",
}
"""Kinds of evidence that differ among the elements of a variable, and the texts for a lack."""


def _lack_of_elements(flags: np.ndarray, evidence: SampleSize, required: SampleSize) -> str:
    """Return, in words, the first missing evidence of each element whose flag is not YES, joined.

    The amounts of data in `evidence` have the shape of `flags`, and are compared with `required`.
    """
    doubted, lacks = flags != YES, []
    for name, text in ELEMENT_LACKS.items():
        limit = getattr(required, name)
        short = doubted & ~np.greater_equal(getattr(evidence, name), limit)
        if short.any():
            lacks.append(text.format(limit))
        doubted = doubted & ~short
    return "; ".join(lacks) or "no finite error"
