"""The data that statements are judged on: reduced datasets beside theory, as samples of numbers."""

from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.claims.sample import Sample
from roughgas.data.reduced import EQUILIBRATED, GRID, read_reduced
from roughgas.statistics.intervals import sum_error
from roughgas.theory.arguments import NET_SHARE
from roughgas.theory.prediction import predicted_ratio


class NotTestedError(Exception):
    """The data at hand cannot decide a statement; the message says why."""


def load(path: str | Path) -> xr.Dataset:
    """Return the reduced dataset at `path`, beside theory."""
    return beside_theory(read_reduced(path))


def beside_theory(data: xr.Dataset) -> xr.Dataset:
    """Return a reduced dataset with `theory` and `deviation` (R - theory), which are like its R.

    Points that are not in a steady state cannot test a theory of one: their R is NaN, and the
    attribute `set_aside` counts them. Values of r that were simulated with the contact-time model
    are left out, since the paper has none.
    """
    data = _without_contact_time(data).copy()
    found, steady = np.isfinite(data.R), data.equilibrated > EQUILIBRATED
    data["theory"] = data.R.copy(data=theory_of(data))
    data["R"] = data.R.where(steady)
    data["deviation"] = data.R - data.theory
    return data.assign_attrs(points=int(found.sum()), set_aside=int((found & ~steady).sum()))


def theory_of(data: xr.Dataset, **others: np.ndarray) -> np.ndarray:
    """Return R of theory at every point; `others` are parameters that the dataset does not have,
    such as spin_share, with the shape of R."""
    axes = [data[name].values for name in data.R.dims]
    places = dict(zip(data.R.dims, np.meshgrid(*axes, indexing="ij"), strict=True))
    return predicted_ratio(data.attrs | places | others, places["r"], places["beta"])


def _without_contact_time(data: xr.Dataset) -> xr.Dataset:
    if "contact_time" not in data:
        return data
    modelled = np.isfinite(data.contact_time)
    modelled = modelled.any([name for name in modelled.dims if name != "r"])
    return data.sel(r=data.r[~modelled])


def sample(values: xr.DataArray, stderr: xr.DataArray, dof: xr.DataArray) -> Sample:
    """Return the finite `values` as a sample; raise NotTestedError where there is none."""
    there = np.isfinite(values.values)
    if not there.any():
        raise NotTestedError("no point is in a steady state and measured in all that is compared")
    axes = [*GRID, *(name for name in values.coords if name not in GRID)]
    places = {name: values[name].broadcast_like(values).values[there] for name in axes}
    known = np.where(np.asarray(dof) >= 1, stderr, np.nan)
    return Sample(places, values.values[there], known[there], np.asarray(dof)[there])


def of_ratio(data: xr.Dataset, values: xr.DataArray) -> Sample:
    """Return `values`, which are R plus what is known exactly, with the errors of R."""
    return sample(values, data.R_stderr, data.R_dof)


def over_seeds(data: xr.Dataset, values: xr.DataArray, name: str) -> Sample:
    """Return `values` with the errors of the variable `name`, which come from its scatter over
    seeds."""
    return sample(values, data[f"{name}_stderr"], data.n_seeds - 1.0)


def deviation(data: xr.Dataset) -> Sample:
    """Return R - theory at every point."""
    return of_ratio(data, data.deviation)


def deviation_in_proportion(data: xr.Dataset) -> Sample:
    """Return R/theory - 1 at every point."""
    gap = deviation(data)
    return gap.over(of_ratio(data, data.theory.where(np.isfinite(data.R))).value)


def deviation_at_shares(data: xr.Dataset) -> Sample:
    """Return R - the rate equations for a drive with the measured share of rotation.

    The share, from the energy books, lies outside of [0, 1] where sources take energy out of one
    motion.
    """
    share = spin_shares(data)
    measured = np.nan_to_num(share.values)
    step = np.nan_to_num(data.input_spin_share_stderr.values)
    ends = (
        np.clip(end, NET_SHARE.low, NET_SHARE.high)
        for end in (measured - step, measured, measured + step)
    )
    low, expected, high = (theory_of(data, spin_share=end) for end in ends)
    spread = np.fmax(high - expected, expected - low)
    spread = np.where(np.isfinite(data.input_spin_share_stderr), spread, np.nan)
    errors = sum_error([data.R_stderr, spread], [data.R_dof, data.n_seeds - 1.0])
    return sample((data.R - expected).where(np.isfinite(share)), *errors)


def spin_shares(data: xr.Dataset) -> xr.DataArray:
    """Return the share of rotation in the energy that the sources put in, where R is measured.

    It is NaN at beta = -1, where contacts leave spin alone: in a steady state the sources then put
    in none on balance, whatever R is.
    """
    if "input_spin_share" not in data:
        raise NotTestedError("the dataset holds no share of rotation in what its sources put in")
    return data.input_spin_share.where(np.isfinite(data.R) & (data.beta > -1.0))


def difference(first: xr.Dataset, second: xr.Dataset) -> Sample:
    """Return R of `first` minus R of `second` at the points that both hold."""
    names = ["R", "R_stderr", "R_dof"]
    one, two = xr.broadcast(*xr.align(first[names], second[names], join="inner"))
    errors = sum_error([one.R_stderr, two.R_stderr], [one.R_dof, two.R_dof])
    return sample(one.R - two.R, *errors)


def effect_of_restitution(data: xr.Dataset) -> Sample:
    """Return R at the lowest r minus R at the highest, at each beta that both hold."""
    ends = data.r.values[[0, -1]] if data.r.size else ()
    if len(set(ends)) < 2:
        raise NotTestedError(f"{data.attrs['experiment']} holds fewer than two values of r")
    low, high = (data.sel(r=r) for r in ends)
    return difference(low, high.assign_coords(r=ends[0]))
