"""The data that statements are judged on: reduced datasets beside theory, as samples of numbers."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.claims.statistics import Sample, pooled_errors
from roughgas.data.reduced import EQUILIBRATED, GRID, read_reduced
from roughgas.theory.arguments import NET_SHARES
from roughgas.theory.prediction import predicted_ratio


class NotTestedError(Exception):
    """The data at hand cannot decide a statement; the message says why."""


def load(path: str | Path) -> xr.Dataset:
    """The reduced dataset at `path` with `error`, `theory` and `deviation`, all like its R.

    `deviation` is R - theory. Points that are not in a steady state cannot test a theory of one:
    their R is NaN, and the attribute `set_aside` counts them. The attribute `freedom` is the
    number of degrees of freedom of the errors. Values of r at which the contact-time model was
    there are left out: the paper has none.
    """
    data = _without_contact_time(read_reduced(path))
    errors, freedom = _errors(data, "R_stderr_over_seeds")
    data["error"] = data.R.copy(data=errors)
    data["theory"] = data.R.copy(data=theory_of(data))
    found, steady = np.isfinite(data.R), data.equilibrated > EQUILIBRATED
    data["R"] = data.R.where(steady)
    data["deviation"] = data.R - data.theory
    counts = {"points": int(found.sum()), "set_aside": int((found & ~steady).sum())}
    return data.assign_attrs(freedom=freedom, **counts)


def theory_of(data: xr.Dataset, **others: np.ndarray) -> np.ndarray:
    """R of theory at every point; `others` are parameters beside the dataset's own, such as
    spin_share, of the same shape."""
    axes = [data[name].values for name in data.R.dims]
    places = dict(zip(data.R.dims, np.meshgrid(*axes, indexing="ij"), strict=True))
    return predicted_ratio(data.attrs | places | others, places["r"], places["beta"])


def _without_contact_time(data: xr.Dataset) -> xr.Dataset:
    """The part of a reduced dataset that was simulated without the contact-time model."""
    if "contact_time" not in data:
        return data
    modelled = np.isfinite(data.contact_time)
    modelled = modelled.any([name for name in modelled.dims if name != "r"])
    return data.sel(r=data.r[~modelled])


def load_all(paths: Iterable[str | Path]) -> dict[str, xr.Dataset]:
    """The reduced datasets at `paths`, by experiment."""
    datasets = [load(path) for path in paths]
    return {data.attrs["experiment"]: data for data in datasets}


def deviation(data: xr.Dataset) -> Sample:
    """R - theory at every point."""
    return sample(data.deviation, data.error, data.attrs["freedom"])


def deviation_at_shares(data: xr.Dataset) -> Sample:
    """R - the rate equations for a drive with the share of rotation that the energy books say.

    It lies outside of [0, 1] where sources take out some of one motion.
    """
    share, uncertainty = spin_shares(data)
    measured, step = np.nan_to_num(share.values), np.nan_to_num(uncertainty.values)
    ends = (np.clip(end, *NET_SHARES) for end in (measured - step, measured, measured + step))
    low, expected, high = (theory_of(data, spin_share=end) for end in ends)
    spread = np.where(np.isfinite(uncertainty), np.fmax(high - expected, expected - low), np.nan)
    values = (data.R - expected).where(np.isfinite(share))
    return sample(values, np.hypot(data.error, spread), data.attrs["freedom"])


def spin_shares(data: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
    """Share of rotation in what the sources put in, where R is measured, and its standard error.

    None at beta = -1: contacts leave spin alone there, so that in a steady state the sources put in
    none on balance, whatever R is.
    """
    if "input_spin_share" not in data:
        raise NotTestedError("the dataset holds no share of rotation in what its sources put in")
    known = np.isfinite(data.R) & (data.beta > -1.0)
    return data.input_spin_share.where(known), data.input_spin_share_stderr


def unsubtracted_deviation(data: xr.Dataset) -> Sample:
    """R - theory where the mean flow and the mean spin are left in."""
    if "R_unsubtracted" not in data:
        raise NotTestedError("the dataset holds no un-subtracted R")
    errors, freedom = _errors(data, "R_unsubtracted_stderr")
    values = (data.R_unsubtracted - data.theory).where(np.isfinite(data.R))
    return sample(values, data.error.copy(data=errors), freedom)


def difference(first: xr.Dataset, second: xr.Dataset) -> Sample:
    """R of `first` minus R of `second` at the points that both hold."""
    names = ["R", "error"]
    one, two = xr.align(first[names], second[names], join="inner")
    freedom = min(first.attrs["freedom"], second.attrs["freedom"])
    return sample(one.R - two.R, np.hypot(one.error, two.error), freedom)


def effect_of_restitution(data: xr.Dataset) -> Sample:
    """R at the lowest r minus R at the highest, at each beta that both hold."""
    ends = data.r.values[[0, -1]] if data.r.size else ()
    if len(set(ends)) < 2:
        raise NotTestedError(f"{data.attrs['experiment']} holds fewer than two values of r")
    low, high = (data[["R", "error"]].sel(r=r) for r in ends)
    error = np.hypot(low.error, high.error)
    return sample((low.R - high.R).assign_coords(r=ends[0]), error, data.attrs["freedom"])


def sample(values: xr.DataArray, errors: xr.DataArray, freedom: float) -> Sample:
    """The finite `values` as a sample; raises NotTestedError where there is none."""
    there = np.isfinite(values.values)
    if not there.any():
        raise NotTestedError("no point is in a steady state and measured in all that is compared")
    axes = [*GRID, *(name for name in values.coords if name not in GRID)]
    places = {name: values[name].broadcast_like(values).values[there] for name in axes}
    return Sample(places, values.values[there], np.asarray(errors)[there], freedom)


def _errors(data: xr.Dataset, name: str) -> tuple[np.ndarray, float]:
    return pooled_errors(data[name].values, data.R_stderr_within.values, data.n_seeds.values)
