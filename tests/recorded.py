"""Gases whose frames the kernel keeps, for tests of frames and of observables."""

import functools

import numpy as np
from brute_force.scenes import UNLIMITED, settings
from raw import build, protocols, start_gas
from schedules import COOLING, STEADY
from slow_cases import slow_but

from roughgas.kernel.loop import REACHED
from roughgas.kernel.record import Sampling, allocate_frames, columns, record
from roughgas.simulation.frames import frames_of

TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "mass": 3.0}]
PER_REFRESH = 4  # samples of a cooling gas
PATHS = {"paths": {}}


def with_paths(experiment):
    return experiment | {"effects": experiment["effects"] | PATHS}


GASES = {
    "sheared": settings("sheared") | {"schedule": STEADY},
    "bed": settings("bed") | {"schedule": STEADY},
    "heated": settings("heated", 80, [50, 50]) | {"schedule": STEADY},
    "cooling": settings("gas") | {"schedule": COOLING},
    "cooling mixture": settings("gas") | {"schedule": COOLING, "species": TWO},
    "spheres": settings("spheres") | {"schedule": COOLING},
    "sheared, in cells": settings("sheared", 800, [100, 100]) | {"schedule": STEADY},
    "heated mixture": settings("heated", 80, [60, 60]) | {"schedule": STEADY, "species": TWO},
    "sheared mixture with paths, in cells": with_paths(settings("sheared", 800, [120, 120]))
    | {"schedule": STEADY, "species": TWO},
}
RARE = {"heated mixture", "sheared mixture with paths, in cells"}
NAMES = slow_but(GASES.keys() - RARE, GASES)


class Recording:
    """A gas at its start, whose frames the kernel keeps when it `advances`."""

    def __init__(self, name):
        self.experiment = GASES[name]
        scene = build(self.experiment, 0.9, 0.3)
        self.system = protocols.observed_system(scene, self.experiment)
        self.gas = start_gas(scene, self.experiment, np.random.default_rng(1))
        self.taken, collisions, refresh, every = 0, UNLIMITED, 0, 1
        interval = 0.5 if self.gas.particles < 500 else 4.0  # many are sorted anew now and then
        if self.system.cooling:
            refresh = every = PER_REFRESH
            interval, collisions = np.inf, len(self.gas.state.label) // 2
        self.sampling = Sampling(interval, collisions, refresh, first=every, every=every)

    def advance(self, instants):
        """Return the kernel's frames of the next `instants`."""
        state, scene = self.gas.state, self.gas.scene
        rows = np.empty((instants * self.sampling.every, len(columns(scene))))
        frames = allocate_frames(state, instants)
        sampling = self.sampling._replace(taken=self.taken)
        assert record(state, scene, sampling, rows, frames) == (REACHED, len(rows))
        assert frames.stored[0] == instants
        self.taken += len(rows)
        return frames


@functools.cache
def recorded(name, instants):
    """Frames of the first instants of a gas, without rates."""
    recording = Recording(name)
    return frames_of(recording.gas, recording.advance(instants), recording.system)


def bits(value):
    """All bits of numbers, but not which NaN there is; None of None."""
    if value is None:
        return None
    array = np.asarray(value)
    if array.dtype.kind == "f":
        array = np.where(np.isnan(array), np.nan, array)
    return array.shape, array.dtype.str, array.tobytes()
