"""R of sheared spheres against a formula for planetary rings, as rows of evidence."""

from collections.abc import Iterator

import xarray as xr

from roughgas.judging import Estimate, Row, ratio_sample

SOURCE = "Morishima & Salo 2004, Bull. Am. Astron. Soc. 36, 1109 (DPS 36, 19.01)"
READ = (
    "E_rot/E_kin = 2 (1 - e_t)/[14 - 5 (1 - e_t)], e_t = -beta, which their simulations of thin "
    "rings bear out; the same as Lun's formula (1991)"
)
REASON = "velocities are neither Maxwellian nor isotropic; R is a mean over time, not contacts"


def rows(sheared: xr.Dataset) -> Iterator[Row]:
    """Yield R at each point with a steady state."""
    excess = sheared.R * (1.0 - sheared.R) / sheared.attrs["particles"]
    counted = f"D (N - 1) translational degrees of freedom: R lower by up to {excess.max():.4f}"
    sample = ratio_sample(sheared, sheared.R - excess)
    for index, beta in enumerate(sample.coordinates["beta"]):
        ratio = 2.0 * (1.0 + beta) / (14.0 - 5.0 * (1.0 + beta))
        yield Row(
            quantity="R of spheres under uniform shear",
            at=sample.point_text(index),
            tier="theory",
            source=SOURCE,
            read=READ,
            theirs=Estimate(ratio / (1.0 + ratio), 0.0),
            ours=sample.at(index),
            corrections=counted,
            reason=REASON,
        )
