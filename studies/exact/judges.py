"""Judges of the statements on exact results."""

import numpy as np
import xarray as xr

from roughgas.judging import SIGNIFICANT, Estimate, Finding, NotTestedError, Row, grade

from .evidence import Gas, rows

CLOSE = 0.001
"""Relative difference up to which values that differ qualify. Fixed before its data."""


def meets_exact_results(data: xr.Dataset) -> Finding:
    """No number with a known exact value differs from it by abs(z) = 3 or more."""
    exact = [row for row in rows(data) if row.tier == "exact"]
    off = [row for row in exact if row.gap.is_significant]
    far = [row for row in off if abs(row.gap.value) > CLOSE * abs(row.theirs.value)]
    worst = max(exact, key=lambda row: abs(row.z))
    z = np.array([row.z for row in exact])
    reason = (
        f"{len(off)} of {len(exact)} numbers differ by |z| = {SIGNIFICANT:g} or more; z has the "
        f"root mean square {np.sqrt(np.mean(z**2)):.2f}, and is largest, {worst.z:+.1f}, in "
        f"{worst.quantity} ({worst.at})."
    )
    return Finding(grade(not off, not far), reason, _largest_gap(worst))


def _largest_gap(row: Row) -> tuple[tuple[str, Estimate], ...]:
    return ((f"{row.quantity} minus its exact value where z is largest", row.gap),)


def slides_beyond_threshold(data: xr.Dataset) -> Finding:
    """No contact sticks beyond the threshold of Walton's model or slides below it."""
    tasks = [str(name) for name in data.task_name.values if str(name).startswith("contacts")]
    if not tasks:
        raise NotTestedError("no contacts were looked at")
    names = "misplaced_pair", "misplaced_wall"
    shares = [Gas(data, task).number(name) for task in tasks for name in names]
    misplaced = sum(share.value > 0.0 for share in shares)
    counts = sum(round(float(share.dof) + 1.0) for share in shares)
    reason = f"Of {counts} contacts {'some are' if misplaced else 'none is'} on the wrong side."
    return Finding(grade(misplaced == 0, misplaced == 0), reason)
