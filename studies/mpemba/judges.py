"""Judges of the statements on gases that cool by the same drive."""

import math
from statistics import NormalDist

import numpy as np
import xarray as xr

from roughgas.judging import (
    SIGNIFICANT,
    Estimate,
    Finding,
    NotTestedError,
    combined_finding,
    grade,
    point_text,
)

from .curves import Crossing, Pair, hump, pair, pairs

LARGEST_ERROR = 0.3
"""Relative error of a crossing beyond which nothing is judged."""
SIGNIFICANT_DEPTH = 5.0
"""Standard errors by which a crossing, or a hump, counts."""
CLOSE = 0.1
"""Relative difference up to which one that differs significantly qualifies."""
CLOSE_CURVE = 0.03
"""Difference of a quarter of a curve from the published one, in T_st, up to which one that differs
significantly qualifies."""
MEMORY_STAGE = 2
"""Index of the stage in which a gas remembers its drive."""


def hotter_cools_first(hot: xr.Dataset, cold: xr.Dataset) -> Finding:
    """The temperatures cross, and at the published time."""
    return _crosses(pair(hot, cold))


def overshoots(hot: xr.Dataset, cold: xr.Dataset) -> Finding:
    """The distances from the stationary temperature cross, and at the published time."""
    two = pair(hot, cold)
    curve = two.simulated["cold"]
    later = curve.time > 0.0
    depth = float(np.max((1.0 - curve.T[later]) / curve.stderr[later]))
    finding = _crosses(two)
    if depth < SIGNIFICANT_DEPTH:
        return finding._replace(verdict=grade(False, False))
    return finding


def _crosses(two: Pair) -> Finding:
    ours = two.simulated_crossing()
    theirs, theory = map(two.crossing, (two.published, two.expected()))
    crosses = ours.deepest >= SIGNIFICANT_DEPTH
    if not crosses and theirs.depth < SIGNIFICANT_DEPTH * ours.depth_stderr:
        raise NotTestedError(
            f"The published difference, {theirs.depth:.4f} T_st at most, is below "
            f"{SIGNIFICANT_DEPTH:g} of our standard errors, {ours.depth_stderr:.4f}"
        )
    if crosses and ours.stderr > LARGEST_ERROR * theirs.time:
        raise NotTestedError("the curves are too noisy to tell where they cross")
    gap = time_of(ours).minus(time_of(theirs))
    close = abs(gap.value) < CLOSE * theirs.time
    reason = (
        f"The curves cross at {time_of(ours)}, published ones at {time_of(theirs)} "
        f"(z = {gap.sigma:.1f}), those of the rate equations at {theory.time:.3f}; then the "
        f"difference gets {ours.deepest:.1f} standard errors below 0."
    )
    values = (("crossing", time_of(ours)), ("published crossing", time_of(theirs)))
    return Finding(
        grade(crosses and abs(gap.sigma) < SIGNIFICANT, crosses and close), reason, values
    )


def time_of(crossing: Crossing) -> Estimate:
    """Return the time of a crossing with its error."""
    return Estimate(crossing.time, crossing.stderr, crossing.dof)


def depth_of(crossing: Crossing) -> Estimate:
    """Return the largest difference beyond a crossing, in T_st, with its error."""
    return Estimate(crossing.depth, crossing.depth_stderr, crossing.dof)


def are_curves_published(*gases: xr.Dataset) -> Finding:
    """The means over the quarters of each curve are the published ones."""
    curves = [(two, sample) for two in pairs(gases) for sample in two.published]
    limit = curve_limit(len(curves))
    return combined_finding(
        (_curve_name(two, sample), _curve_finding(two, sample, limit)) for two, sample in curves
    )


def curve_limit(count: int) -> float:
    """Return the probability below which one of `count` curves differs from the published one."""
    return 2.0 * NormalDist().cdf(-SIGNIFICANT) / count


def _curve_name(two, sample):
    """Return the name of a curve for sentences."""
    return f"{two.protocol}, {sample} gas, {point_text(two.material)}"


def _curve_finding(two, sample, limit):
    """Return the finding on a curve, which differs if it is less probable than `limit`."""
    published, quarters = two.quarters(sample)
    gaps = quarters._replace(value=quarters.value - published)
    probability = gaps.probability()
    if math.isnan(probability):
        raise NotTestedError("the covariance of the quarters of a curve needs more seeds")
    largest = int(np.argmax(np.abs(gaps.value)))
    is_close = abs(gaps.value[largest]) < CLOSE_CURVE
    reason = (
        f"the largest difference of a quarter is {gaps.estimate(largest)} T_st; the probability "
        f"of all four is {probability:.2g}."
    )
    verdict = grade(probability >= limit, is_close)
    return Finding(verdict, reason, (("largest difference of a quarter", gaps.estimate(largest)),))


def spins_are_remembered(gas: xr.Dataset) -> Finding:
    """The hump has the depth of the rate equations."""
    time, T = hump(gas, MEMORY_STAGE)
    lowest, expected, gap = (T.estimate(index) for index in range(3))
    depth = Estimate(1.0 - lowest.value, lowest.stderr, lowest.dof)
    expected_depth = 1.0 - expected.value
    has_hump = depth.value > SIGNIFICANT_DEPTH * depth.stderr
    if not has_hump and expected_depth < SIGNIFICANT_DEPTH * depth.stderr:
        raise NotTestedError(
            f"The depth by the rate equations, {expected_depth:.4f} T_st, is below "
            f"{SIGNIFICANT_DEPTH:g} of our standard errors, {depth.stderr:.4f}"
        )
    reason = (
        f"At {time:.2f} the gas is colder than in the end by the share {depth}, by "
        f"the rate equations {expected_depth:.4f}; z = {abs(gap.sigma):.1f}."
    )
    fits, close = abs(gap.sigma) < SIGNIFICANT, abs(gap.value) < CLOSE * expected_depth
    return Finding(grade(has_hump and fits, has_hump and close), reason, (("depth", depth),))
