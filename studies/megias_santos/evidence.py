"""The published stationary states beside ours, row by row."""

from collections.abc import Iterator

import xarray as xr

from roughgas.judging import Estimate, Row, place_of

from .published import published

SOURCE = "Megias & Santos 2022, doi:10.3389/fphy.2022.971671"
READ = "raw data: repository amegiasf/MpembaSplitting, commit f2d033c, folder Steady states"
REASONS = {
    "DSMC": "what N = 160 does beyond degrees of freedom is worth about 0.0004",
    "EDMD": "their event-driven data differ from their own DSMC by up to 20 of their errors",
}


def rows(gas: xr.Dataset) -> Iterator[Row]:
    """Yield R of each state beside that of either method."""
    size = float((gas.R_ratio_of_means - gas.R_corrected).max())
    corrections = f"D (N - 1) translational degrees of freedom: R lower by up to {size:.4f}"
    states = gas.R.transpose("r", "beta", "spin_share").to_series().dropna().index
    for method, reason in REASONS.items():
        values, errors = published(method, gas.R)
        for state in states:
            place = dict(zip(states.names, state, strict=True))
            one = gas.sel(place)
            yield Row(
                quantity=f"R of a gas driven by white noise, {method}",
                at=place_of(place),
                tier="simulation",
                source=SOURCE,
                read=READ,
                theirs=Estimate(float(values.sel(place)), float(errors.sel(place))),
                ours=Estimate(float(one.R_corrected), float(one.R_stderr), float(one.R_dof)),
                corrections=corrections,
                reason=reason,
            )
