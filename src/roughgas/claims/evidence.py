"""The data that statements are judged on, as samples of numbers beside theory, and verdicts."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas.data.reduced import EQUILIBRATED, GRID, read_by_name
from roughgas.statistics.errors import SIGNIFICANT, Estimate, sum_error
from roughgas.theory.arguments import NET_SHARE
from roughgas.theory.prediction import predicted_ratio


class NotTestedError(Exception):
    """The data at hand cannot decide a statement; the message says why."""


class Sample(NamedTuple):
    """Independent numbers at points of a sweep, all columns 1-D and of one length.

    `places` has the coordinates of the points by name: r, beta, and any third parameter.
    """

    places: dict[str, np.ndarray]
    value: np.ndarray
    stderr: np.ndarray
    dof: np.ndarray

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.value)

    def at(self, index: int) -> Estimate:
        """Return the estimate at one point."""
        return Estimate(*(float(column[index]) for column in self[1:]))

    def where(self, mask: np.ndarray) -> "Sample":
        """Return the part of the sample where `mask` holds."""
        places = {name: column[mask] for name, column in self.places.items()}
        return Sample(places, *(column[mask] for column in self[1:]))

    def joined(self, other: "Sample") -> "Sample":
        """Return both samples as one."""
        pairs = ((name, (column, other.places[name])) for name, column in self.places.items())
        places = {name: np.concatenate(pair) for name, pair in pairs}
        return Sample(places, *map(np.concatenate, zip(self[1:], other[1:], strict=True)))

    def real(self) -> np.ndarray:
        """Return where the values differ from 0 significantly."""
        return np.array([self.at(index).real for index in range(self.size)])

    def off(self, tolerance: float) -> np.ndarray:
        """Return where the values differ from 0 significantly and by more than `tolerance`."""
        return self.real() & (np.abs(self.value) > tolerance)

    def vague(self, tolerance: float) -> np.ndarray:
        """Return where values larger than `tolerance` have errors too large to tell from 0."""
        return ~self.real() & (np.abs(self.value) > tolerance)

    def mean(self) -> Estimate:
        """Return the mean value, its error from the errors of the values."""
        stderr, dof = sum_error(self.stderr, self.dof)
        return Estimate(float(self.value.mean()), float(stderr) / self.size, float(dof))

    def rms(self) -> float:
        """Return the root mean square of the values."""
        return float(np.sqrt(np.mean(self.value**2)))

    def largest(self) -> tuple[Estimate, str]:
        """Return the value that is largest in size, and its place."""
        index = int(np.argmax(np.abs(self.value)))
        return self.at(index), self.place(index)

    def place(self, index: int) -> str:
        """Return such as "r = 0.9, beta = 0, mu = 0.1"."""
        return place_of({name: column[index] for name, column in self.places.items()})


def place_of(coordinates: Mapping[str, Any]) -> str:
    """Return such as "r = 0.9, beta = 0, mu = 0.1"."""
    return ", ".join(f"{name} = {written(value)}" for name, value in coordinates.items())


def written(value: float | str) -> str:
    """Return a coordinate, a number or a word, as text."""
    return value if isinstance(value, str) else f"{value:g}"


def load_all(path: str | Path) -> dict[str, xr.Dataset]:
    """Return the reduced dataset at `path`, beside theory, or all studies in it, by their names."""
    found = read_by_name(path).items()
    return {name: beside_theory(one) if "experiment" in one.attrs else one for name, one in found}


def beside_theory(data: xr.Dataset) -> xr.Dataset:
    """Return a reduced dataset with `theory`, which is like its R.

    Points that are not in a steady state cannot test a theory of one: their R is NaN, and the
    attribute `set_aside` counts them. Values of r that were simulated with the contact-time model
    are left out, since the paper has none. A gas without spin has no R, and no theory of it.
    """
    data = data.copy()
    if "R" not in data:
        return data.assign_attrs(points=int((data.n_seeds > 0).sum()), set_aside=0)
    if "contact_time" in data:
        modelled = np.isfinite(data.contact_time)
        data = data.sel(r=data.r[~modelled.any([name for name in modelled.dims if name != "r"])])
    found, steady = np.isfinite(data.R), data.equilibrated > EQUILIBRATED
    data["theory"] = data.R.copy(data=theory_of(data))
    data["R"] = data.R.where(steady)
    return data.assign_attrs(points=int(found.sum()), set_aside=int((found & ~steady).sum()))


def theory_of(data: xr.Dataset, **others: np.ndarray) -> np.ndarray:
    """Return R of theory at every point; `others` are parameters that the dataset does not have,
    such as spin_share, with the shape of R."""
    axes = [data[name].values for name in data.R.dims]
    places = dict(zip(data.R.dims, np.meshgrid(*axes, indexing="ij"), strict=True))
    return predicted_ratio(data.attrs | places | others, places["r"], places["beta"])


def sample(values: xr.DataArray, stderr: Any, dof: Any) -> Sample:
    """Return the finite `values` as a sample; raise NotTestedError where there is none."""
    there = np.isfinite(values.values)
    if not there.any():
        raise NotTestedError("no point is in a steady state and measured in all that is compared")
    axes = [*GRID, *(name for name in values.coords if name not in GRID)]
    places = {str(name): values[name].broadcast_like(values).values[there] for name in axes}
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
    return of_ratio(data, data.R - data.theory)


def deviation_in_proportion(data: xr.Dataset) -> Sample:
    """Return R/theory - 1 at every point."""
    gap, theory = deviation(data), of_ratio(data, data.theory.where(np.isfinite(data.R))).value
    return gap._replace(value=gap.value / theory, stderr=gap.stderr / theory)


def deviation_at_shares(data: xr.Dataset) -> Sample:
    """Return R - the rate equations for a drive with the measured share of rotation.

    The share, from the energy books, lies outside of [0, 1] where sources take energy out of one
    motion. Raises NotTestedError where theory knows none such.
    """
    share = spin_shares(data)
    measured = np.nan_to_num(share.values)
    step = np.nan_to_num(data.input_spin_share_stderr.values)
    ends = np.array([measured - step, measured, measured + step])
    if (wrong := measured[~NET_SHARE.holds(measured)]).size:
        said = f"a measured share of rotation is {wrong[0]:.3g}"
        raise NotTestedError(f"{said}, and theory takes those in {NET_SHARE}")
    taken = np.clip(ends, NET_SHARE.low, NET_SHARE.high)
    low, expected, high = (theory_of(data, spin_share=end) for end in taken)
    known = np.isfinite(data.input_spin_share_stderr) & (ends == taken).all(0)
    spread = np.where(known, np.fmax(high - expected, expected - low), np.nan)
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
    return difference(low, high.assign_coords(r=low.r))


HOLDS = "holds"
QUALIFIED = "holds with a qualification"
FAILS = "fails"
NOT_TESTED = "not tested"
VERDICTS = (HOLDS, QUALIFIED, FAILS)
"""The most favourable first."""

AGREE = 0.02
"""Difference in R up to which two values agree. Lun's formula and the theory of free cooling differ
by 0.12 at r = 0.9, beta = 0; this is a sixth of that. Where R < 0.02 the criterion is empty, so
such ranges are also judged relative to theory. Fixed before any data; justified later."""
LIMIT = 0.06
"""Difference in R beyond which they disagree; between the two, agreement is qualified. Half of that
0.12: beyond it the other theory may be nearer. Fixed before any data; justified later."""
TENDENCY = 0.005
"""Difference in R from which a statement about a direction (above, below) has content. A
convention: a quarter of AGREE. Fixed before any data."""
FEW = 0.1
"""Share of the points of a sweep that may be exceptions. A convention: two of the 21 values of beta
at one r. Fixed before any data."""
NEAR = 0.1
"""Fraction of R up to which a value agrees relative to theory. AGREE over the R of a driven
gas in mid-range, Lun's formula at beta = 0. Fixed before the data of friction and inertia; for beds
and sheared gases (Figs. 1a and 2a, the study `spheres`) after their data."""
FAR = 0.5
"""Fraction beyond which it disagrees; between the two, agreement is qualified. A convention: theory
is then wrong by a factor of 1.5 to 2. Fixed as NEAR was."""


class Finding(NamedTuple):
    """A verdict, the sentence that follows from the numbers, and these, the deciding one first."""

    verdict: str
    reason: str
    numbers: tuple[tuple[str, Estimate], ...] = ()

    def with_note(self, sentence: str) -> "Finding":
        """Return the finding with one more sentence to its reason."""
        return self._replace(reason=f"{self.reason} {sentence}")


def agreement(sample: Sample, other: str) -> Finding:
    """Judge whether the values of `sample`, differences from `other`, are compatible with zero.

    A point disagrees where it differs significantly and by more than the tolerance. Fails: more
    than a few points differ by more than LIMIT. Holds: no point differs by more than AGREE.
    """
    off, far, vague = sample.off(AGREE), sample.off(LIMIT), sample.vague(AGREE)
    if vague.mean() > 0.5:
        raise NotTestedError(f"the errors are too large at {vague.sum()} of {sample.size} points")
    verdict = grade(not off.any() and vague.mean() <= FEW, far.mean() <= FEW)
    (largest, place), mean = sample.largest(), sample.mean()
    reason = (
        f"{int((np.abs(sample.value) <= AGREE).sum())} of {sample.size} points within {AGREE:g} of "
        f"{other}; the largest difference is {text(largest)} at {place}, the mean {text(mean)}."
    )
    if vague.mean() > FEW:
        reason += f" At {points(vague.sum())} the errors are too large to tell."
    numbers = (("largest difference", largest), ("mean difference", mean), *_along(sample))
    return Finding(verdict, reason, numbers)


def _along(sample: Sample) -> list[tuple[str, Estimate]]:
    """Return the largest value at each step of the third parameter, if there is one."""
    return [
        (f"largest at {name} = {written(value)}", sample.where(column == value).largest()[0])
        for name, column in sample.places.items()
        if name not in GRID
        for value in np.unique(column)
    ]


def agreement_in_proportion(gas: xr.Dataset, theory: str) -> Finding:
    """Judge whether R - theory is compatible with zero, and so is its ratio to theory at all but a
    few points: where R spans decades, a small R must follow theory, too."""
    found, relative = agreement(deviation(gas), theory), deviation_in_proportion(gas)
    off, far, vague = relative.off(NEAR), relative.off(FAR), relative.vague(NEAR)
    verdict = grade(off.mean() <= FEW and vague.mean() <= FEW, far.mean() <= FEW)
    near = int((np.abs(relative.value) <= NEAR).sum())
    reason = f"Relative to theory, {near} of {relative.size} points are within {NEAR:.0%}"
    numbers: tuple[tuple[str, Estimate], ...] = ()
    if off.any():
        largest, place = relative.where(off).largest()
        reason += f"; the largest significant difference is {text(largest)} of {theory} at {place}"
        numbers = ((f"largest significant difference over {theory}", largest),)
    if vague.any():
        reason += f"; at {points(vague.sum())} the errors are too large to tell"
    reason, numbers = f"{found.reason} {reason}.", found.numbers + numbers
    return Finding(worse(found.verdict, verdict), reason, numbers)


def together(findings: Iterable[tuple[str, Finding]]) -> Finding:
    """Return findings on several gases, by name, as one: the worst verdict, and the numbers and
    reasons of all, the one with the largest deciding number first."""
    found = sorted(findings, key=lambda pair: -abs(pair[1].numbers[0][1].value))
    numbers = [(f"{name}: {label}", x) for name, one in found for label, x in one.numbers]
    reason = " ".join(f"{name}: {one.reason}" for name, one in found)
    return Finding(worse(*(one.verdict for _, one in found)), reason, tuple(numbers))


def tendency(value: Estimate) -> str:
    """Return the verdict on the statement that `value` is positive, significantly and not
    trivially.

    Raises NotTestedError where its error leaves the direction open.
    """
    if not value.real and not SIGNIFICANT * value.stderr < TENDENCY:
        raise NotTestedError(f"the errors are too large to tell a direction: {text(value)}")
    if value.real and value.value >= TENDENCY:
        return HOLDS
    return QUALIFIED if value.real and value.value > 0 else FAILS


def grade(full: bool, partly: bool) -> str:
    """Return the verdict on a statement that holds in full, with a qualification, or not."""
    return HOLDS if full else QUALIFIED if partly else FAILS


def worse(*verdicts: str) -> str:
    """Return the least favourable of some verdicts."""
    return max(verdicts, key=VERDICTS.index)


def text(number: Estimate) -> str:
    """Return such as "+0.0213, 95 % +0.0185 to +0.0241 (12.3 sigma)".

    Interval and sigma count the degrees of freedom alike, so that sigma exceeds 1.96 exactly if the
    interval leaves out 0. A standard error would not fit sigma with few of them.
    """
    if not np.isfinite(number.ci95):
        return f"{number:+.4f}"
    how, sigma = f"+.{4 if number.stderr >= 0.001 else 5}f", abs(number.sigma)
    low, high = number.value - number.ci95, number.value + number.ci95
    size = "> 20" if sigma > 20 else f"{sigma:.1f}"
    return f"{number.value:{how}}, 95 % {low:{how}} to {high:{how}} ({size} sigma)"


def points(count: int) -> str:
    """Return such as "2 points"."""
    return f"{count} {'point' if count == 1 else 'points'}"
