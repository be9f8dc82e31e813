"""Samples of numbers beside theory, on which statements are judged, and rules for verdicts.

R = E_rot/(E_rot + E_trans) is the share of rotation in the energy, r the normal restitution, beta
the roughness. Datasets are reduced, with the variable `theory`, R by theory (`beside_theory`). A
value differs significantly if its two-sided probability by Student's t is below that of a Gaussian
beyond SIGNIFICANT sigma.
"""

import math
from collections.abc import Iterable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from roughgas.base import Attributes
from roughgas.data.reduced import GRID_DIMS, STEADY_SHARE, read_by_name
from roughgas.statistics.errors import sum_error
from roughgas.statistics.estimates import Estimate, mean_with_error
from roughgas.theory.arguments import NET_SHARE
from roughgas.theory.prediction import predicted_ratio


class NotTestedError(Exception):
    """The data cannot decide a statement; the message gives the reason."""


class Sample(NamedTuple):
    """Independent numbers at points of a sweep, all columns 1-D and of the same length.

    `coordinates` of the points are by name: r, beta, and any third parameter. `stderr` are the
    standard errors of the values, `dof` the degrees of freedom of these.
    """

    coordinates: dict[str, np.ndarray]
    value: np.ndarray
    stderr: np.ndarray
    dof: np.ndarray

    @property
    def size(self) -> int:
        """Number of points."""
        return len(self.value)

    def at(self, index: int) -> Estimate:
        """Return the value at point `index`, with its standard error and degrees of freedom."""
        return Estimate(*(float(column[index]) for column in self[1:]))

    def where(self, mask: np.ndarray) -> "Sample":
        """Return the subsample of the points selected by `mask`, booleans (points,)."""
        coordinates = {name: column[mask] for name, column in self.coordinates.items()}
        return Sample(coordinates, *(column[mask] for column in self[1:]))

    def joined(self, second: "Sample") -> "Sample":
        """Return the union of both samples, which have the same coordinates' names."""
        pairs = (
            (name, (column, second.coordinates[name])) for name, column in self.coordinates.items()
        )
        coordinates = {name: np.concatenate(pair) for name, pair in pairs}
        return Sample(coordinates, *map(np.concatenate, zip(self[1:], second[1:], strict=True)))

    def is_significant(self) -> np.ndarray:
        """Return a mask (points,) of the values that differ from 0 significantly."""
        return np.array([self.at(index).is_significant for index in range(self.size)])

    def off(self, tolerance: float) -> np.ndarray:
        """Return a mask of the values that differ from 0 significantly and exceed `tolerance`.

        The magnitude of a value counts. The mask is (points,).
        """
        return self.is_significant() & (np.abs(self.value) > tolerance)

    def vague(self, tolerance: float) -> np.ndarray:
        """Return a mask (points,) of the values that exceed `tolerance`, but not significantly.

        The magnitude of a value counts.
        """
        return ~self.is_significant() & (np.abs(self.value) > tolerance)

    def detectable(self) -> float:
        """Return the deviation that a test could have seen at half of the points, or infinity.

        It is the median of `Estimate.detectable`, in the unit of the values; a point without a
        known error detects nothing.
        """
        detected = [self.at(index).detectable for index in range(self.size)]
        return float(np.median(np.nan_to_num(detected, nan=np.inf, posinf=np.inf)))

    def mean(self) -> Estimate:
        """Return the mean of the values, with the error that follows from their errors."""
        return mean_with_error(self.value, self.stderr, self.dof)

    def rms(self) -> float:
        """Return the root mean square of the values, which measures their distance from 0."""
        return float(np.sqrt(np.mean(self.value**2)))

    def largest(self) -> tuple[Estimate, str]:
        """Return the value of largest magnitude, with its error, and its coordinates as text."""
        index = int(np.argmax(np.abs(self.value)))
        return self.at(index), self.point_text(index)

    def point_text(self, index: int) -> str:
        """Return the coordinates of point `index` as text, such as "r = 0.9, beta = 0"."""
        return point_text({name: column[index] for name, column in self.coordinates.items()})


def point_text(coordinates: Attributes) -> str:
    """Return coordinates by name as text, such as "r = 0.9, beta = 0, mu = 0.1"."""
    return ", ".join(f"{name} = {coordinate_text(value)}" for name, value in coordinates.items())


def coordinate_text(value: float | str) -> str:
    """Return a coordinate, a number or a word, as text with six digits at most."""
    return value if isinstance(value, str) else f"{value:g}"


def load_all(path: str | Path) -> dict[str, xr.Dataset]:
    """Return the datasets in the file at `path`, by experiment or study.

    These are a reduced dataset, with theory, or the results of the tasks of all studies in the
    file.
    """
    datasets = read_by_name(path).items()
    return {
        name: beside_theory(data) if "experiment" in data.attrs else data for name, data in datasets
    }


def beside_theory(data: xr.Dataset) -> xr.Dataset:
    """Return a reduced dataset with the variable `theory`, R by theory, at the points of R.

    R = E_rot/(E_rot + E_trans). Points that are not in a steady state cannot test a theory of it:
    their R is NaN, and the attribute `set_aside` counts them, `points` all points. Values of r that
    were simulated with the contact-time model are left out, since the paper did not use it. A gas
    without spin has neither R nor `theory`.
    """
    data = data.copy()
    if "R" not in data:
        return data.assign_attrs(points=int((data.n_seeds > 0).sum()), set_aside=0)
    if "contact_time" in data:
        modelled = np.isfinite(data.contact_time)
        data = data.sel(r=data.r[~modelled.any([name for name in modelled.dims if name != "r"])])
    measured, steady = np.isfinite(data.R), data.equilibrated > STEADY_SHARE
    data["theory"] = data.R.copy(data=theory_of(data))
    data["R"] = data.R.where(steady)
    return data.assign_attrs(points=int(measured.sum()), set_aside=int((measured & ~steady).sum()))


def theory_of(data: xr.Dataset, **extra_parameters: np.ndarray) -> np.ndarray:
    """Return R = E_rot/(E_rot + E_trans) by theory at every point of a reduced dataset.

    The array has the shape of R. `extra_parameters`, of this shape, are parameters that the dataset
    lacks, such as spin_share, the share of rotation in the energy input.
    """
    axes = [data[name].values for name in data.R.dims]
    coordinates = dict(zip(data.R.dims, np.meshgrid(*axes, indexing="ij"), strict=True))
    return predicted_ratio(
        data.attrs | coordinates | extra_parameters, coordinates["r"], coordinates["beta"]
    )


def sample(values: xr.DataArray, stderr: Any, dof: Any) -> Sample:
    """Return the finite `values` (r, beta, ...) as a sample, with their errors.

    `stderr` are standard errors, `dof` their degrees of freedom, of the same shape; an error with
    less than one is NaN. Raises NotTestedError if no value is finite.
    """
    is_finite = np.isfinite(values.values)
    if not is_finite.any():
        raise NotTestedError("no point is in a steady state and measured in all that is compared")
    axes = [*GRID_DIMS, *(name for name in values.coords if name not in GRID_DIMS)]
    coordinates = {
        str(name): values[name].broadcast_like(values).values[is_finite] for name in axes
    }
    known_errors = np.where(np.asarray(dof) >= 1, stderr, np.nan)
    return Sample(
        coordinates, values.values[is_finite], known_errors[is_finite], np.asarray(dof)[is_finite]
    )


def ratio_sample(data: xr.Dataset, values: xr.DataArray) -> Sample:
    """Return a sample of `values`, which are R plus exact terms, with the errors of R.

    R = E_rot/(E_rot + E_trans). Raises NotTestedError if no value is finite.
    """
    return sample(values, data.R_stderr, data.R_dof)


def over_seeds(data: xr.Dataset, values: xr.DataArray, name: str) -> Sample:
    """Return a sample of `values` with the error of the variable `name` over its seeds.

    The error is from the scatter. Raises NotTestedError if no value is finite.
    """
    return sample(values, data[f"{name}_stderr"], data.n_seeds - 1.0)


def deviation(data: xr.Dataset) -> Sample:
    """Return R - theory at every point of a reduced dataset, with the errors of R.

    R = E_rot/(E_rot + E_trans), `theory` is R by theory.
    """
    return ratio_sample(data, data.R - data.theory)


def deviation_in_proportion(data: xr.Dataset) -> Sample:
    """Return R/theory - 1 at every point of a reduced dataset, with its errors.

    R = E_rot/(E_rot + E_trans), `theory` is R by theory.
    """
    gap, theory = deviation(data), ratio_sample(data, data.theory.where(np.isfinite(data.R))).value
    return gap._replace(value=gap.value / theory, stderr=gap.stderr / theory)


def deviation_at_shares(data: xr.Dataset) -> Sample:
    """Return R minus R by the rate equations for a drive with the measured share of rotation.

    The share of rotation in the energy input, from the energy balance, lies outside of [0, 1] if
    sources take energy out of translation or rotation. The error includes the error of the share.
    Raises NotTestedError for a share that theory does not cover.
    """
    share = spin_shares(data)
    measured = np.nan_to_num(share.values)
    step = np.nan_to_num(data.input_spin_share_stderr.values)
    ends = np.array([measured - step, measured, measured + step])
    if (uncovered := measured[~NET_SHARE.holds(measured)]).size:
        reason = f"a measured share of rotation is {uncovered[0]:.3g}"
        raise NotTestedError(f"{reason}, and theory takes those in {NET_SHARE}")
    clipped = np.clip(ends, NET_SHARE.low, NET_SHARE.high)
    low, expected, high = (theory_of(data, spin_share=end) for end in clipped)
    is_known = np.isfinite(data.input_spin_share_stderr) & (ends == clipped).all(0)
    spread = np.where(is_known, np.fmax(high - expected, expected - low), np.nan)
    errors = sum_error([data.R_stderr, spread], [data.R_dof, data.n_seeds - 1.0])
    return sample((data.R - expected).where(np.isfinite(share)), *errors)


def spin_shares(data: xr.Dataset) -> xr.DataArray:
    """Return the share of rotation in the energy input of all sources, where R is measured.

    It is over the grid of the reduced dataset. It is NaN at beta = -1, where contacts do not change
    spins: in a steady state the net input into rotation is then 0 for any R. Raises NotTestedError
    if the dataset lacks it.
    """
    if "input_spin_share" not in data:
        raise NotTestedError("the dataset holds no share of rotation in what its sources put in")
    return data.input_spin_share.where(np.isfinite(data.R) & (data.beta > -1.0))


def difference(first: xr.Dataset, second: xr.Dataset) -> Sample:
    """Return R of the dataset `first` minus R of `second` at their common points, with its errors.

    R = E_rot/(E_rot + E_trans). Raises NotTestedError without common points.
    """
    names = ["R", "R_stderr", "R_dof"]
    aligned_first, aligned_second = xr.broadcast(
        *xr.align(first[names], second[names], join="inner")
    )
    errors = sum_error(
        [aligned_first.R_stderr, aligned_second.R_stderr],
        [aligned_first.R_dof, aligned_second.R_dof],
    )
    return sample(aligned_first.R - aligned_second.R, *errors)


def effect_of_restitution(data: xr.Dataset) -> Sample:
    """Return R at the lowest r (normal restitution) minus R at the highest, at their common beta.

    R = E_rot/(E_rot + E_trans), beta is the roughness. The r of the sample is the lowest one.
    Raises NotTestedError for fewer than two r.
    """
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
"""From the most to the least favourable."""

AGREE = 0.02
"""Largest difference in R of two values that agree. Lun's formula and the theory of free cooling
differ by 0.12 at r = 0.9, beta = 0; this is a sixth of it. For R < 0.02 the criterion is empty, so
such ranges are also judged relative to theory. Fixed before any data; justified later."""
DISAGREE = 0.06
"""Least difference in R of two values that disagree; in between, agreement is qualified. Half of
0.12: beyond it the other theory may be closer. Fixed before any data; justified later."""
TENDENCY = 0.005
"""Least difference in R that supports a statement about a direction (above, below). A convention: a
quarter of AGREE. Fixed before any data."""
EXCEPTIONS = 0.1
"""Share of the points of a sweep that may be exceptions. A convention: two of the 21 values of beta
at one r. Fixed before any data."""
AGREE_RELATIVE = 0.1
"""Largest relative difference of a value that agrees with theory. AGREE over the R of a driven gas
in mid-range, Lun's formula at beta = 0. Fixed before the data of friction and inertia; for beds and
sheared gases (Figs. 1a and 2a, the study `spheres`) after their data."""
DISAGREE_RELATIVE = 0.5
"""Least relative difference of a value that disagrees with theory; in between, agreement is
qualified. A convention: theory is then wrong by a factor of 1.5 to 2. Fixed together with
AGREE_RELATIVE."""


class Finding(NamedTuple):
    """A verdict, its reason in sentences, and (label, number) pairs, the deciding number first.

    `detectable` is the smallest deviation that its test could have seen, in the unit of the
    deciding number; NaN: as the deciding number alone has it.
    """

    verdict: str
    reason: str
    numbers: tuple[tuple[str, Estimate], ...] = ()
    detectable: float = math.nan

    @property
    def smallest_deviation(self) -> float:
        """The smallest deviation that its test could have seen; NaN if that is unknown."""
        if not math.isnan(self.detectable) or not self.numbers:
            return self.detectable
        return self.numbers[0][1].detectable

    def with_note(self, sentence: str) -> "Finding":
        """Return the finding with a sentence appended to its reason."""
        return self._replace(reason=f"{self.reason} {sentence}")


def check_power(detectable: float, refuting: float) -> None:
    """Raise NotTestedError if a test could not have failed.

    It could not if the smallest deviation that it could have seen, `detectable`, is larger than the
    deviation that refutes its statement, `refuting`, or if it is unknown (NaN).
    """
    if not math.isfinite(detectable):
        raise NotTestedError("the test could not have failed: its errors are unknown")
    if detectable > refuting:
        raise NotTestedError(
            f"the test could not have failed: its errors hide deviations up to {detectable:.2g}, "
            f"and {refuting:.2g} refutes the statement"
        )


def is_large(value: Estimate, tolerance: float) -> bool:
    """Return whether `value` is significant, and its size above `tolerance`.

    Raises NotTestedError if it is not significant, and its error hides deviations of `tolerance`.
    """
    if not (value.is_significant or value.detectable <= tolerance):
        raise NotTestedError(
            f"{text(value)} is not significant, and the error may hide a deviation of {tolerance:g}"
        )
    return value.is_significant and abs(value.value) > tolerance


def agreement(
    sample: Sample, reference: str, agree: float = AGREE, disagree: float = DISAGREE
) -> Finding:
    """Judge whether the differences in `sample` are compatible with zero; return the finding.

    The values are R, or another quantity, minus a reference, whose name, for sentences, is
    `reference`. A point is off if it differs from 0 significantly and by more than a tolerance. The
    verdict is HOLDS if no point is off by more than `agree` and the errors are too large to tell at
    no more than the share EXCEPTIONS of the points; else QUALIFIED if no more than EXCEPTIONS are
    off by more than `disagree`; else FAILS. Raises NotTestedError if the errors are too large at
    more than half of the points, and if they hide deviations of `disagree` at half of the points,
    unless it FAILS.
    """
    off, far, vague = sample.off(agree), sample.off(disagree), sample.vague(agree)
    if vague.mean() > 0.5:
        raise NotTestedError(f"the errors are too large at {vague.sum()} of {sample.size} points")
    verdict = grade(not off.any() and vague.mean() <= EXCEPTIONS, far.mean() <= EXCEPTIONS)
    if verdict != FAILS:
        check_power(sample.detectable(), disagree)
    (largest, point), mean = sample.largest(), sample.mean()
    reason = (
        f"{int((np.abs(sample.value) <= agree).sum())} of {sample.size} points within {agree:g} of "
        f"{reference}; the largest difference is {text(largest)} at {point}, the mean {text(mean)}."
    )
    if vague.mean() > EXCEPTIONS:
        reason += f" At {points(vague.sum())} the errors are too large to tell."
    numbers = (
        ("largest difference", largest),
        ("mean difference", mean),
        *_largest_along_third_axis(sample),
    )
    return Finding(verdict, reason, numbers, sample.detectable())


def _largest_along_third_axis(sample: Sample) -> list[tuple[str, Estimate]]:
    """Return the largest value at each value of a third parameter, with labels; [] without one."""
    return [
        (
            f"largest at {name} = {coordinate_text(value)}",
            sample.where(column == value).largest()[0],
        )
        for name, column in sample.coordinates.items()
        if name not in GRID_DIMS
        for value in np.unique(column)
    ]


def agreement_in_proportion(gas: xr.Dataset, theory: str) -> Finding:
    """Judge whether R - theory is compatible with zero, and so is R/theory - 1 at most points.

    Where R spans decades, a small R must follow theory, too. `gas` is a reduced dataset, `theory`
    the name of the theory for sentences. The verdict is the worst of both; it is at best QUALIFIED
    if errors hide relative deviations of DISAGREE_RELATIVE at half of the points. Raises
    NotTestedError as `agreement` does.
    """
    absolute, relative = agreement(deviation(gas), theory), deviation_in_proportion(gas)
    off, far, vague = (
        relative.off(AGREE_RELATIVE),
        relative.off(DISAGREE_RELATIVE),
        relative.vague(AGREE_RELATIVE),
    )
    hidden = relative.detectable()
    verdict = grade(
        max(off.mean(), vague.mean()) <= EXCEPTIONS and hidden <= DISAGREE_RELATIVE,
        far.mean() <= EXCEPTIONS,
    )
    agreeing = int((np.abs(relative.value) <= AGREE_RELATIVE).sum())
    reason = (
        f"Relative to theory, {agreeing} of {relative.size} points are within {AGREE_RELATIVE:.0%}"
    )
    numbers: tuple[tuple[str, Estimate], ...] = ()
    if off.any():
        largest, point = relative.where(off).largest()
        reason += f"; the largest significant difference is {text(largest)} of {theory} at {point}"
        numbers = ((f"largest significant difference over {theory}", largest),)
    if vague.any():
        reason += f"; at {points(vague.sum())} the errors are too large to tell"
    reason += f"; a deviation of {hidden:.2g} of theory could have been seen at half of the points"
    reason, numbers = f"{absolute.reason} {reason}.", absolute.numbers + numbers
    verdict = worst_verdict(absolute.verdict, verdict)
    return Finding(verdict, reason, numbers, absolute.detectable)


def combined_finding(findings: Iterable[tuple[str, Finding]]) -> Finding:
    """Return the combination of findings on several gases, given as (name, finding) pairs.

    Its verdict is the least favourable; it has all numbers and reasons, in descending order of the
    magnitudes of the deciding numbers, and detects what the weakest test detects.
    """
    ordered = sorted(findings, key=lambda pair: -abs(pair[1].numbers[0][1].value))
    numbers = [
        (f"{name}: {label}", value) for name, finding in ordered for label, value in finding.numbers
    ]
    reason = " ".join(f"{name}: {finding.reason}" for name, finding in ordered)
    verdict = worst_verdict(*(finding.verdict for _, finding in ordered))
    detectable = max(finding.smallest_deviation for _, finding in ordered)
    return Finding(verdict, reason, tuple(numbers), detectable)


def tendency(value: Estimate) -> str:
    """Return the verdict on the statement that `value` is positive.

    It is HOLDS if the value is significant and at least TENDENCY, QUALIFIED if it is positive and
    significant, else FAILS. Raises NotTestedError if its error hides deviations of TENDENCY.
    """
    if not value.is_significant and not value.detectable < TENDENCY:
        raise NotTestedError(f"the errors are too large to tell a direction: {text(value)}")
    if value.is_significant and value.value >= TENDENCY:
        return HOLDS
    return QUALIFIED if value.is_significant and value.value > 0 else FAILS


def grade(full: bool, partly: bool) -> str:
    """Return the verdict on a statement that is true in full, or only `partly`: with exceptions."""
    return HOLDS if full else QUALIFIED if partly else FAILS


def worst_verdict(*verdicts: str) -> str:
    """Return the least favourable of the verdicts in VERDICTS."""
    return max(verdicts, key=VERDICTS.index)


def text(number: Estimate) -> str:
    """Return an estimate as text, such as "+0.0213, 95 % +0.0185 to +0.0241 (12.3 sigma)".

    Both the interval and sigma account for the degrees of freedom, so that sigma exceeds 1.96
    exactly if the interval excludes 0. A standard error is consistent with sigma only if the
    degrees of freedom are many. Without a finite interval the text is the value.
    """
    if not np.isfinite(number.ci95):
        return f"{number:+.4f}"
    spec, sigma = f"+.{4 if number.stderr >= 0.001 else 5}f", abs(number.sigma)
    low, high = number.value - number.ci95, number.value + number.ci95
    sigmas = "> 20" if sigma > 20 else f"{sigma:.1f}"
    return f"{number.value:{spec}}, 95 % {low:{spec}} to {high:{spec}} ({sigmas} sigma)"


def points(number: int) -> str:
    """Return a number of points of a sweep as text, such as "2 points" or "1 point"."""
    return f"{number} {'point' if number == 1 else 'points'}"
