"""A pilot: what the cost and the error of a point follow from."""

from typing import Any

from roughgas.base.layout import columns
from roughgas.planning.pilot import Pilot
from roughgas.planning.pilot import read_pilot as read

__all__ = ["read", "record", "text"]

UNIT = "T (cooling gas: collisions per particle)"
MEANING = {
    "transient": f"until energies are steady, in {UNIT}",
    "autocorrelation_time": f"of R, in {UNIT}",
    "variance": "of the mean of R over a length of one",
    "dof": "degrees of freedom of the variance",
    "pace": "collisions per particle in a length of one",
    "seconds_per_length": "s of CPU time",
    "settled": "whether a steady state was found",
    "length": f"that was simulated, in {UNIT}",
    "seconds": "s of CPU time that the pilot took",
}


def record(pilot: Pilot) -> dict[str, Any]:
    """Return all of it."""
    return {"variables": pilot._asdict()}


def text(pilot: Pilot) -> str:
    """Return a summary for a person."""
    rows = []
    for name, value in pilot._asdict().items():
        shown = ("no", "yes")[value] if isinstance(value, bool) else f"{value:.5g}"
        rows.append([name, shown, MEANING[name]])
    error = (pilot.variance / 1000.0) ** 0.5
    note = f"A run that measures for a length of 1000 finds R to about {error:.2g}."
    return f"{columns(rows)}\n\n{note}"
