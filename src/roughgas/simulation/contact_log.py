"""The log of contacts of a run, as variables of a point."""

from typing import Any

import numpy as np

from roughgas.kernel.state import NOBODY, Log
from roughgas.simulation.gas import Gas
from roughgas.simulation.paths import in_order

OF_PARTNERS = {"species": -1, "radius": np.nan, "mass": np.nan, "inertia": np.nan}
"""What is logged of partners that differ, and what a wall has in its place."""


def logged(gas: Gas, log: Log) -> dict[str, Any]:
    """Return the variables `logged_...` of the last contacts, the earliest first, and how many
    before them are lost."""
    state, D = gas.state, len(gas.scene.box)
    kept, made = log.rows, int(log.made[0])
    lost = max(0, made - len(kept))
    rows = np.roll(kept, -made, axis=0) if lost else kept[:made]
    partners = rows[:, 1:3].astype(int)
    found = {
        "contacts_lost": lost,
        "instant": ["before", "after"],
        "logged_time": rows[:, 0],
        "logged_partner": partners,
        "logged_normal": rows[:, 3 : 3 + D],
        "logged_position": rows[:, 3 + D : 3 + 2 * D],
        "logged_velocity": rows[:, 3 + 2 * D : 3 + 6 * D].reshape(len(rows), 2, 2, D),
    }
    if state.spin is not None:
        found["logged_spin"] = rows[:, 3 + 6 * D :].reshape(len(rows), 2, 2, state.spin.shape[1])
    if state.bodies is not None:
        for name, of_wall in OF_PARTNERS.items():
            values = in_order(state, getattr(state.bodies, name))[partners]
            found[f"logged_{name}"] = np.where(partners == NOBODY, of_wall, values)
    return found
