"""Judges of the statements on gases that cool by the same drive."""

import math

import numpy as np
import xarray as xr

from roughgas.judging import SIGNIFICANT, Estimate, Finding, NotTestedError, grade

from .curves import Pair, expected, pair, simulated

NOISY = 0.3
"""Relative error of a crossing from which on nothing is judged."""
SURE = 5.0
"""Standard errors of the energies by which a crossing, or a hump, counts; T_st's is left out."""
CLOSE = 0.1
"""Relative difference up to which one that differs significantly qualifies."""
LAST = 2
"""The stage in which a gas remembers."""


def hotter_cools_first(hot: xr.Dataset, cold: xr.Dataset) -> Finding:
    """The temperatures cross, and when they are published to."""
    return _crosses(pair(hot, cold))


def overshoots(hot: xr.Dataset, cold: xr.Dataset) -> Finding:
    """The distances from the stationary temperature cross, and when they are published to."""
    both = pair(hot, cold)
    curve = both.simulated["cold"]
    later = curve.time > 0.0
    depth = float(np.max((1.0 - curve.T[later]) / curve.stderr[later]))
    found = _crosses(both)
    if depth < SURE:
        return found._replace(verdict=grade(False, False))
    return found


def _crosses(both: Pair) -> Finding:
    ours, theirs, theory = map(both.crossing, (both.simulated, both.published, both.expected))
    if ours.stderr > NOISY * theirs.time:  # where they do not cross there is no error
        raise NotTestedError("The curves are too noisy to tell where they cross.")
    z = (ours.time - theirs.time) / math.hypot(ours.stderr, theirs.stderr)
    there = ours.deepest >= SURE
    close = abs(ours.time - theirs.time) < CLOSE * theirs.time
    reason = (
        f"The curves cross at {Estimate(ours.time, ours.stderr)}, published ones at "
        f"{Estimate(theirs.time, theirs.stderr)} (z = {z:.1f}), those of the rate equations at "
        f"{theory.time:.3f}; then the difference gets {ours.deepest:.0f} standard errors below 0."
    )
    values = (
        ("crossing", Estimate(ours.time, ours.stderr)),
        ("published crossing", Estimate(theirs.time, theirs.stderr)),
    )
    return Finding(grade(there and abs(z) < SIGNIFICANT, there and close), reason, values)


def spins_are_remembered(gas: xr.Dataset) -> Finding:
    """The hump has the depth of the rate equations."""
    curve = simulated(gas, LAST)
    theory = expected(gas, curve, LAST)
    lowest = int(np.nanargmin(theory.T))
    depth = Estimate(float(1.0 - curve.T[lowest]), float(curve.stderr[lowest]))
    wanted = float(1.0 - theory.T[lowest])
    away = abs(depth.value - wanted)
    there = depth.value > SURE * depth.stderr
    reason = (
        f"At {curve.time[lowest]:.2f} the gas is colder than in the end by the share {depth}, by "
        f"the rate equations {wanted:.4f}; z = {away / depth.stderr:.1f}."
    )
    fits, close = away < SIGNIFICANT * depth.stderr, away < CLOSE * wanted
    return Finding(grade(there and fits, there and close), reason, (("depth", depth),))
