"""What the tasks of studies simulate, a file for each study: these alone need the kernel."""

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from roughgas.base import InputError, shown


def timed(function: Callable[..., Any], *arguments: Any) -> tuple[Any, float]:
    """Return what a call returns, and the CPU seconds that it takes."""
    begin = time.process_time()
    return function(*arguments), time.process_time() - begin


def check_alike(experiment: Mapping[str, Any]) -> None:
    """Raise InputError for an experiment with species, in a study of particles that are alike."""
    if experiment.get("species"):
        legal = "not be there in an experiment of this study, whose particles are alike"
        raise InputError("species", shown(experiment["species"]), legal)


def stream(settings: Mapping[str, Any], *key: int) -> np.random.SeedSequence:
    """Return the seed of random numbers of their own, for each key and each seed of a study."""
    return np.random.SeedSequence(settings["seed"], spawn_key=key)
