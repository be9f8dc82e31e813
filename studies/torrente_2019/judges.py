"""Judges of two gases with the same noise, of which the hotter one gets colder."""

import xarray as xr

from roughgas.judging import (
    SIGNIFICANT,
    Estimate,
    Finding,
    check_power,
    grade,
    mean_by_scatter,
    text,
)

from .gases import temperatures

CLOSE = 0.05
"""Relative deviation from the rate equations that agrees."""
FAR = 0.15
"""Relative deviation from the rate equations that refutes them."""


def hotter_gets_colder(hot: xr.Dataset, cold: xr.Dataset) -> Finding:
    """T of the hotter gas, averaged over the measured stage, is below T of the colder gas."""
    gap, expected = (
        first - second
        for first, second in zip(
            temperatures(hot).in_last_stage(), temperatures(cold).in_last_stage(), strict=True
        )
    )
    difference = mean_by_scatter(gap)
    if not difference.is_significant:
        check_power(difference.detectable, abs(expected))
    fits = abs(difference.minus(Estimate(expected, 0.0)).sigma) < SIGNIFICANT
    is_below = difference.is_significant and difference.value < 0.0
    reason = (
        f"T of the hotter gas minus T of the colder one is {text(difference)} m a^2/T^2, "
        f"{expected:.4f} by the rate equations."
    )
    return Finding(grade(is_below and fits, is_below), reason, (("difference of T", difference),))


def rate_equations_have_both(hot: xr.Dataset, cold: xr.Dataset) -> Finding:
    """T of both gases over the measured stage is T by the rate equations."""
    ratios = {}
    for name, gas in (("hot", hot), ("cold", cold)):
        measured, expected = temperatures(gas).in_last_stage()
        ratios[name] = mean_by_scatter(measured / expected - 1.0)
    largest = max(ratios.values(), key=lambda ratio: abs(ratio.value))
    verdict = grade(
        *(
            all(abs(ratio.value) < limit or not ratio.is_significant for ratio in ratios.values())
            for limit in (CLOSE, FAR)
        )
    )
    detectable = max(ratio.detectable for ratio in ratios.values())
    check_power(detectable, FAR)
    reason = ", ".join(f"{name}: {text(ratio)}" for name, ratio in ratios.items())
    return Finding(
        verdict, f"T over the rate equations - 1 is {reason}.", (("largest", largest),), detectable
    )
