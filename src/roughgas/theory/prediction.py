"""Which equation a dataset obeys, and what it says of R."""

import math
from typing import Any

import numpy as np


def predicted_ratio(attributes: dict[str, Any], r: Any, beta: Any) -> np.ndarray:
    """R of theory: Eq. (K) for a freely cooling gas, Eq. (lun) for one whose drive adds translation
    only, and what the rate equations say of other drives, and of friction.

    `attributes` are those of a reduced dataset, with what is its third axis: `inertia`,
    `spin_share` (of the drive), `mu`; these broadcast with `r` and `beta`. NaN where nothing spins.
    """
    from roughgas import theory

    names = {"inertia": math.nan, "spin_share": 0.0, "mu": math.inf}
    given = (attributes.get(name, value) for name, value in names.items())
    r, beta, q, share, mu = np.broadcast_arrays(*(np.asarray(x, float) for x in (r, beta, *given)))
    if np.isnan(q).any():
        return np.full(r.shape, math.nan)
    dimension, share = int(attributes["dimension"]), None if attributes["theory"] == "K" else share
    if np.isfinite(mu).any():
        return np.asarray(theory.friction_ratio(r, beta, mu, dimension, q, share))
    return np.asarray(theory.stationary_ratio(r, beta, dimension, q, share))
