"""The published stationary states beside ours, row by row, and theory of both."""

from collections.abc import Iterator

import xarray as xr

from roughgas import theory
from roughgas.judging import Estimate, Row, place_of

from .published import CUMULANTS, published

SIMULATED = "Megias & Santos 2022, Front. Phys. 10, 971671, doi:10.3389/fphy.2022.971671"
PREDICTED = "Megias & Santos 2023, Phys. Rev. E 108, 014902"
RAW = "raw data: repository amegiasf/MpembaSplitting, commit f2d033c, folders {}"
FOLDERS = {"R": "Steady states", **dict.fromkeys(CUMULANTS, "Transient, last 100 rows")}
DERIVED = "first order in cumulants, collision integrals derived anew"
REASONS = {
    "DSMC": "kicks of finite size: up to 0.0009, 0.0017 and 0.0007 in a20, a11 and a02",
    "EDMD": "their event-driven data differ from their own DSMC by up to 20 of their errors",
}


def rows(gas: xr.Dataset) -> Iterator[Row]:
    """Yield R and each cumulant of every state beside those of either method, and of theory."""
    size = float((gas.R_ratio_of_means - gas.R_corrected).max())
    counted = f"D (N - 1) translational degrees of freedom: R lower by up to {size:.4f}"
    states = gas.R.transpose("r", "beta", "spin_share").to_series().dropna().index
    places = [dict(zip(states.names, state, strict=True)) for state in states]
    for name in ("R", *CUMULANTS):
        corrections = counted if name == "R" else ""
        for method, reason in REASONS.items():
            values, errors = published(method, gas.R, name)
            for place in places:
                theirs = Estimate(float(values.sel(place)), float(errors.sel(place)))
                quantity = f"{name} of disks driven by white noise, {method}"
                about = place_of(place), "simulation", SIMULATED, RAW.format(FOLDERS[name])
                yield Row(quantity, *about, theirs, _ours(gas, name, place), corrections, reason)
        for place in places:
            about = place["r"], place["beta"], gas.attrs["dimension"], gas.attrs["inertia"]
            state = theory.sonine_state(*about, place["spin_share"])
            theirs = Estimate(float(getattr(state, name)), 0.0)
            quantity = f"{name} of disks driven by white noise, Sonine approximation"
            at = place_of(place), "theory", PREDICTED, DERIVED
            yield Row(quantity, *at, theirs, _ours(gas, name, place), corrections)


def _ours(gas: xr.Dataset, name: str, place: dict[str, float]) -> Estimate:
    """Return what was measured; the error of R_corrected is that of R, which pools its seeds."""
    one = gas.sel(place)
    value = one.R_corrected if name == "R" else one[name]
    return Estimate(float(value), float(one[f"{name}_stderr"]), float(one[f"{name}_dof"]))
