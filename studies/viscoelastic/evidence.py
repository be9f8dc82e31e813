"""Exponents of time of cooling viscoelastic gases, against published ones, as rows of evidence."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from roughgas.judging import Estimate, Row, over_seeds

LAWS = {
    5 / 3: (
        "Schwager & Poschel 1998, Phys. Rev. E 57, 650",
        "T ~ t^(-5/3): the share that contacts lose falls with the speed, to the 1/5",
        "holds at long times, when contacts have become nearly elastic",
    ),
    2.0: (
        "Haff 1983, doi:10.1017/S0022112083003419",
        "T ~ t^(-2): roughness takes a constant share of the energy",
        "holds at long times, when normal losses have become small beside those of roughness",
    ),
}
"""Source, law, and reason of differences, by exponent."""


def rows(gas: xr.Dataset) -> Iterator[Row]:
    """Yield -d ln E_trans/d ln t at each point."""
    is_known = np.isfinite(gas.decay_exponent)
    exponents = over_seeds(gas, gas.decay_exponent.where(is_known), "decay_exponent")
    lossless = np.abs(exponents.coordinates["beta"]) == 1.0
    for exponent, (source, read, reason) in LAWS.items():
        for index in np.flatnonzero(lossless == (exponent < 2.0)):
            yield Row(
                quantity="exponent of time in the cooling of viscoelastic disks",
                at=exponents.point_text(index),
                tier="theory",
                source=source,
                read=read,
                theirs=Estimate(exponent, 0.0),
                ours=exponents.at(index),
                corrections="none",
                reason=reason,
            )
