"""Judge of the statement on Couette flow."""

import numpy as np
import xarray as xr

from roughgas.judging import Finding, agreement, difference


def couette_is_lees_edwards(couette: xr.Dataset, sheared: xr.Dataset) -> Finding:
    """R between sliding rough walls - R between sliding images is compatible with zero.

    R of either does not depend on the shear rate, which only sets the unit of time. So the two are
    compared at different rates; the finding states the rates over the thermal speed.
    """
    finding = agreement(difference(couette, sheared), "R between sliding images")
    if "shear_rate" not in couette:
        return finding
    rate = couette.shear_rate / np.sqrt(2 * couette.E_trans)
    low, high = float(rate.min()), float(rate.max())
    return finding.with_note(f"Shear rates are from {low:.3f} to {high:.3f} sqrt(T_tr/m)/a.")
