"""Temperatures of a gas over time: of each seed, and by the rate equations."""

import json
from typing import NamedTuple

import numpy as np
import xarray as xr

from roughgas import theory


class Temperatures(NamedTuple):
    """T = (T_tr + T_rot)/2 of a gas of spheres over time, in m a^2/T^2."""

    time: np.ndarray  # in T, (samples,)
    of_seeds: np.ndarray  # (seeds, samples)
    expected: np.ndarray  # by the rate equations, (samples,)
    measured_from: float  # begin of the last stage, in T

    def mean(self) -> np.ndarray:
        """Return the mean over seeds, (samples,)."""
        return self.of_seeds.mean(axis=0)

    def stderr(self) -> np.ndarray:
        """Return the standard error of the mean from the scatter of seeds, (samples,)."""
        return self.of_seeds.std(axis=0, ddof=1) / np.sqrt(len(self.of_seeds))

    def in_last_stage(self) -> tuple[np.ndarray, float]:
        """Return means over the last stage: of each seed, (seeds,), and by the rate equations."""
        last = self.time > self.measured_from
        return self.of_seeds[:, last].mean(axis=1), float(self.expected[last].mean())


def temperatures(gas: xr.Dataset) -> Temperatures:
    """Return the temperatures of a reduced dataset of one point, through stages."""
    point = gas.isel(r=0, beta=0)
    energies = point.E_trans_series_seed + point.E_rot_series_seed
    settings = json.loads(gas.attrs["experiment_json"])
    first = settings["schedule"]["stages"][0]
    drive = settings["effects"]["thermostat"]
    time = point.time_series.values
    T_tr, T_rot = theory.driven_temperatures(
        time,
        first["temperature"],
        first["spin_temperature"],
        float(point.r),
        float(point.beta),
        gas.attrs["packing"],
        drive["power"],
        drive["spin_share"],
        gas.attrs["dimension"],
        gas.attrs["inertia"],
    )
    of_seeds = energies.transpose("seed", "sample").values
    return Temperatures(time, of_seeds, 0.5 * (T_tr + T_rot), float(point.stage_begin[-1]))
