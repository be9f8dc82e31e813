"""The contact log of a run as variables of a point."""

import numpy as np

from roughgas.base import NamedValues
from roughgas.kernel.state import NOBODY, Log
from roughgas.simulation.free_flight import in_starting_order
from roughgas.simulation.gas import Gas

WALL_VALUES = {"species": -1, "radius": np.nan, "mass": np.nan, "inertia": np.nan}
"""Logged quantities of partners in a mixture, and the value that stands for a wall."""


def contact_log_variables(gas: Gas, log: Log) -> NamedValues:
    """Return the variables `logged_...` of a point, the last contacts of a gas from its `log`.

    Contacts are along the first axis, oldest first: times, partners (particle numbers in the order
    of the start, NOBODY for a wall), normals, positions, and the velocities and spins before and
    after. The log is a ring buffer: `contacts_lost` counts the contacts that were overwritten.
    """
    state, D = gas.state, len(gas.scene.box)
    buffer, contacts = log.rows, int(log.made[0])
    lost = max(0, contacts - len(buffer))
    rows = np.roll(buffer, -contacts, axis=0) if lost else buffer[:contacts]
    partners = rows[:, 1:3].astype(int)
    variables = {
        "contacts_lost": lost,
        "instant": ["before", "after"],
        "logged_time": rows[:, 0],
        "logged_partner": partners,
        "logged_normal": rows[:, 3 : 3 + D],
        "logged_position": rows[:, 3 + D : 3 + 2 * D],
        "logged_velocity": rows[:, 3 + 2 * D : 3 + 6 * D].reshape(len(rows), 2, 2, D),
    }
    if state.spin is not None:
        variables["logged_spin"] = rows[:, 3 + 6 * D :].reshape(
            len(rows), 2, 2, state.spin.shape[1]
        )
    if state.bodies is not None:
        for name, wall_value in WALL_VALUES.items():
            values = in_starting_order(state, getattr(state.bodies, name))[partners]
            variables[f"logged_{name}"] = np.where(partners == NOBODY, wall_value, values)
    return variables
