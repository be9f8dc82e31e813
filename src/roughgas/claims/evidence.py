"""The data that statements are judged on: reduced datasets beside theory, as samples of numbers."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.claims.statistics import Sample, pooled_errors
from roughgas.reduce import EQUILIBRATED, predicted_ratio, read_reduced


class NotTestedError(Exception):
    """The data at hand cannot decide a statement; the message says why."""


def load(path: str | Path) -> xr.Dataset:
    """The reduced dataset at `path` with `error`, `theory` and `deviation` over (r, beta).

    `deviation` is R - theory. Points that are not in a steady state cannot test a theory of one:
    their R is NaN, and the attribute `set_aside` counts them. The attribute `freedom` is the
    number of degrees of freedom of the errors. Values of r at which the contact-time model was
    there are left out: the paper has none.
    """
    data = _without_contact_time(read_reduced(path))
    errors, freedom = _errors(data, "R_stderr_over_seeds")
    data["error"] = (("r", "beta"), errors)
    theory = predicted_ratio(data.attrs, data.r.values[:, None], data.beta.values)
    data["theory"] = (("r", "beta"), theory)
    found, steady = np.isfinite(data.R), data.equilibrated > EQUILIBRATED
    data["R"] = data.R.where(steady)
    data["deviation"] = data.R - data.theory
    counts = {"points": int(found.sum()), "set_aside": int((found & ~steady).sum())}
    return data.assign_attrs(freedom=freedom, **counts)


def _without_contact_time(data: xr.Dataset) -> xr.Dataset:
    """The part of a reduced dataset that was simulated without the contact-time model."""
    if "contact_time" not in data:
        return data
    modelled = np.isfinite(data.contact_time).any("beta")
    return data.sel(r=data.r[~modelled])


def load_all(paths: Iterable[str | Path]) -> dict[str, xr.Dataset]:
    """The reduced datasets at `paths`, by experiment."""
    datasets = [load(path) for path in paths]
    return {data.attrs["experiment"]: data for data in datasets}


def deviation(data: xr.Dataset) -> Sample:
    """R - theory at every point."""
    return sample(data.deviation, data.error, data.attrs["freedom"])


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
    r, beta = (np.broadcast_to(axis, values.shape) for axis in _grid(values))
    there = np.isfinite(values.values)
    if not there.any():
        raise NotTestedError("no point is in a steady state and measured in all that is compared")
    columns = (column[there] for column in (r, beta, values.values, np.asarray(errors)))
    return Sample(*columns, freedom)


def _grid(values: xr.DataArray) -> tuple[np.ndarray, np.ndarray]:
    r = values.r.values[:, None] if values.r.ndim else values.r.values
    return r, values.beta.values


def _errors(data: xr.Dataset, name: str) -> tuple[np.ndarray, float]:
    return pooled_errors(data[name].values, data.R_stderr_within.values, data.n_seeds.values)
