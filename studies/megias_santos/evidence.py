"""Published stationary states against ours, and theory, as rows of evidence."""

from collections.abc import Iterator

import xarray as xr

from roughgas import theory
from roughgas.judging import Estimate, Row, point_text

from .long import HOMOGENEOUS_R, SIZE_EFFECT, committed
from .published import CUMULANTS, published, published_R

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
    """Yield R and each cumulant of every state, against both published methods and theory."""
    size = float((gas.R_ratio_of_means - gas.R_corrected).max())
    counted = f"D (N - 1) translational degrees of freedom: R lower by up to {size:.4f}"
    states = gas.R.transpose("r", "beta", "spin_share").to_series().dropna().index
    points = [dict(zip(states.names, state, strict=True)) for state in states]
    for name in ("R", *CUMULANTS):
        corrections = counted if name == "R" else ""
        for method, reason in REASONS.items():
            values, errors = published(method, gas.R, name)
            for point in points:
                theirs = Estimate(float(values.sel(point)), float(errors.sel(point)))
                quantity = f"{name} of disks driven by white noise, {method}"
                source = point_text(point), "simulation", SIMULATED, RAW.format(FOLDERS[name])
                yield Row(quantity, *source, theirs, _ours(gas, name, point), corrections, reason)
        for point in points:
            parameters = point["r"], point["beta"], gas.attrs["dimension"], gas.attrs["inertia"]
            state = theory.sonine_state(*parameters, point["spin_share"])
            theirs = Estimate(float(getattr(state, name)), 0.0)
            quantity = f"{name} of disks driven by white noise, Sonine approximation"
            source = point_text(point), "theory", PREDICTED, DERIVED
            yield Row(quantity, *source, theirs, _ours(gas, name, point), corrections)
    yield from _homogeneous_rows()


def _homogeneous_rows() -> Iterator[Row]:
    """Yield R of homogeneous gases, from long.csv, against published DSMC and theory."""
    size_effects = committed(SIZE_EFFECT)
    for state, ours in committed(HOMOGENEOUS_R).items():
        at = point_text(state._asdict())
        corrections = f"extrapolated in N: R of N disks is larger by {size_effects[state]}/N"
        read, theirs = RAW.format(FOLDERS["R"]), published_R(*state)
        name = f"{HOMOGENEOUS_R}, DSMC"
        yield Row(name, at, "simulation", SIMULATED, read, theirs, ours, corrections)
        sonine = theory.sonine_state(state.r, state.beta, spin_share=state.spin_share)
        name = f"{HOMOGENEOUS_R}, Sonine approximation"
        theirs = Estimate(float(sonine.R), 0.0)
        yield Row(name, at, "theory", PREDICTED, DERIVED, theirs, ours, corrections)


def _ours(gas: xr.Dataset, name: str, point: dict[str, float]) -> Estimate:
    """Return our value; the error of R_corrected is the error of R, which pools its seeds."""
    state = gas.sel(point)
    value = state.R_corrected if name == "R" else state[name]
    return Estimate(float(value), float(state[f"{name}_stderr"]), float(state[f"{name}_dof"]))
