"""R and the correlation of translation and rotation, averaged over the collisions of pairs.

McNamara & Luding (1998) derive Lun's formula from averages over collisions: <v_t^2> = 4 (D-1)
E_tr/m and <v_r^2> = 4 (D-1) E_rot/(q m) in a Maxwellian gas. Read backwards, these say what E_tr
and E_rot are where collisions happen.
"""

import math
from typing import Any

import numpy as np

from roughgas.simulation.energies import Columns
from roughgas.statistics.errors import Error, blocking, degrees_of_freedom, period_means

SUMS = ("v_t^2", "v_r^2", "v_t.v_r")
"""Columns that the effect contact_averages adds."""


def contact_averages(
    rows: Columns, first: int, per_period: int, inertia: float, begun: Columns | None = None
) -> dict[str, Any]:
    """Return variables of a point (see roughgas.data.point) from running sums over collisions.

    Collisions before the sample number `first` do not count, nor those of an incomplete last
    period. R_collisional = q B/(A + q B) and contact_correlation = C/sqrt(A B), where A, B and C
    are the means of v_t^2, v_r^2 and v_t.v_r over collisions, and q is `inertia`. Errors are those
    of the linearised ratios, by blocking over periods. All are NaN where nothing collides or spins,
    and none is there where nothing was summed. The sums were zero at the start, or as in the sample
    `begun`.
    """
    if not set(SUMS) <= set(rows):
        return {}
    running = np.array([rows[name] for name in SUMS])
    before = np.array([begun[name] for name in SUMS]) if begun else np.zeros((len(SUMS), 1))
    periods = period_means(np.diff(running, axis=1, prepend=before)[:, first:], per_period)
    A, B, C = np.where(periods.any(axis=1), periods.mean(axis=1), math.nan).tolist()
    R, correlation = inertia * B / (A + inertia * B), C / math.sqrt(A * B)
    slopes = np.array([-1.0 / A, 1.0 / B, 0.0]) * R * (1.0 - R)
    tilts = np.array([-0.5 * correlation / A, -0.5 * correlation / B, 1.0 / math.sqrt(A * B)])
    shared = _variables("R_collisional", R, slopes, periods)
    return shared | _variables("contact_correlation", correlation, tilts, periods)


def _variables(name, value, gradient, periods):
    """Return a function of means with its error, from its gradient and the means (3, periods)."""
    stderr, blocks = blocking(np.dot(gradient, periods))
    error = Error(stderr, degrees_of_freedom(blocks))
    return {
        name: value,
        f"{name}_stderr": error.stderr,
        f"{name}_dof": error.dof,
        f"{name}_ci95": error.half_width(0.95),
    }
