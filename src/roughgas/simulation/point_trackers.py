"""The trackers of points: samples, energy balances, final states and contact logs."""

from collections.abc import Mapping

import numpy as np

from roughgas.base import NamedValues
from roughgas.simulation.checkpoint import under_prefix, with_prefix
from roughgas.simulation.contact_log import contact_log_variables
from roughgas.simulation.energies import Columns
from roughgas.simulation.energy_balance import balances
from roughgas.simulation.gas import Batch, Gas, concatenated
from roughgas.simulation.initial_states import BODY_VARIABLES, InitialState, initial_state_of
from roughgas.simulation.leg import Changes, Leg
from roughgas.simulation.tracker import Tracker


class Samples(Tracker):
    """Stores the samples of a run's gases by leg, and the changes at the start of each leg."""

    def __init__(self) -> None:
        self._changes: dict[str, Changes] = {}
        self._rows: dict[str, list[Columns]] = {}

    def begin(self, gas: Gas, leg: Leg, changes: Changes) -> None:
        """Store the changes at the beginning of a leg, arrays by name."""
        key = _key(leg.name, gas.number)
        self._changes[key], self._rows[key] = changes, []

    def take(self, gas: Gas, leg: Leg, batch: Batch) -> None:
        """Store the samples of a batch."""
        self._rows[_key(leg.name, gas.number)].append(self.columns(gas, batch))

    def columns(self, gas: Gas, batch: Batch) -> Columns:
        """Return the columns of a batch to be stored, by name."""
        return batch.rows

    def rows(self, leg: str, samples: int | None = None, gas: int = 0) -> Columns:
        """Return the first `samples` samples of the leg named `leg`, by default all.

        The result has an array (samples,) for each column, by name. `gas` is the gas's index from
        0.
        """
        rows = self._joined(_key(leg, gas))
        return rows if samples is None else {key: column[:samples] for key, column in rows.items()}

    def changes(self, leg: str, gas: int = 0) -> Changes:
        """Return the arrays with the changes at the start of the leg named `leg`, by name.

        `gas` is the number of the gas.
        """
        return self._changes[_key(leg, gas)]

    def _joined(self, key: str) -> Columns:
        """Return the samples of a leg as columns, by the leg's `_key`; empty without samples."""
        if self._rows[key]:
            self._rows[key] = [concatenated(self._rows[key])]
        return self._rows[key][0] if self._rows[key] else {}

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the samples and changes of all legs as arrays by name, for a checkpoint."""
        arrays: dict[str, np.ndarray] = {}
        for key, changes in self._changes.items():
            rows = self._joined(key)
            arrays |= with_prefix(f"{key}.changes", changes)
            arrays[f"{key}{COLUMNS_SUFFIX}"] = np.array(list(rows), str)
            arrays[f"{key}.rows"] = np.array(list(rows.values()))
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the samples and changes of all legs from their arrays in a checkpoint."""
        for name in arrays:
            if name.endswith(COLUMNS_SUFFIX):
                key = name.removesuffix(COLUMNS_SUFFIX)
                columns = zip(arrays[name].tolist(), arrays[f"{key}.rows"], strict=True)
                rows = dict(columns)
                self._rows[key] = [rows] if rows else []
                self._changes[key] = under_prefix(f"{key}.changes", arrays)


COLUMNS_SUFFIX = ".columns"
"""Suffix of the name of the array with the column names of a leg."""


def _key(leg: str, gas: int) -> str:
    """Return the key of the leg named `leg` of a gas with this number."""
    return f"{gas}.{leg}"


class SamplesWithBalance(Samples):
    """Stores the samples of a single gas, each with its energy balance."""

    def frames(self, leg: Leg) -> tuple[int, int]:
        """Request a frame after each sample."""
        return 1, 1

    def columns(self, gas: Gas, batch: Batch) -> Columns:
        """Return the samples of a batch as columns, with the energy balance at each."""
        return {**batch.rows, **balances(batch.frames, gas.state, gas.scene)}


class LastStates(Tracker):
    """Stores the final state of each gas of a run."""

    def __init__(self) -> None:
        self.memory_owner = ""  # see roughgas.simulation.initial_states.memory_owner
        self._states: dict[int, dict[str, np.ndarray]] = {}

    def finish(self, gas: Gas) -> None:
        """Store the present state of a gas, in place of an earlier one."""
        state = initial_state_of(gas.state, gas.scene, gas.collisions_before_cooling, gas.extents)
        self.memory_owner = state.memory_owner
        self._states[gas.number] = _state_variables(state)

    def variables(self) -> NamedValues:
        """Return the variables `last_...` of a point: positions, velocities, spins and the like at
        the end of the run, with the gases along the first axis."""
        states = [self._states[number] for number in sorted(self._states)]
        return {f"last_{name}": np.array([state[name] for state in states]) for name in states[0]}

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the states as arrays by name, for a checkpoint.

        The names begin with the number of the gas.
        """
        arrays = {"owner": np.array(self.memory_owner)}
        for number, state in self._states.items():
            arrays |= with_prefix(str(number), state)
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the states from their arrays in a checkpoint."""
        self.memory_owner = str(arrays["owner"])
        numbers = {key.partition(".")[0] for key in arrays} - {"owner"}
        self._states = {int(number): under_prefix(number, arrays) for number in numbers}


def _state_variables(state: InitialState) -> dict[str, np.ndarray]:
    """Return the arrays of a state by the names of a point's variables, without `last_`."""
    variables: dict[str, np.ndarray] = {
        "time": np.array(state.time),
        "position": state.position,
        "velocity": state.velocity,
        "memory": np.frombuffer(state.memory, np.uint8),
    }
    if state.spin is not None:
        variables["spin"] = state.spin
    for name, variable in BODY_VARIABLES.items() if state.species is not None else ():
        variables[variable] = getattr(state, name)
    return variables


class ContactLog(Tracker):
    """Stores the contact log of the first gas of a run, as variables of a point."""

    def __init__(self) -> None:
        self.variables: NamedValues = {}
        """Variables of a point (see roughgas.data.point); empty before the end of the gas."""

    def finish(self, gas: Gas) -> None:
        """Read the log of the first gas at its end."""
        if gas.number == 0 and gas.state.log is not None:
            self.variables = contact_log_variables(gas, gas.state.log)

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the variables as arrays by name, for a checkpoint."""
        return {name: np.array(value) for name, value in self.variables.items()}

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the variables from their arrays in a checkpoint."""
        self.variables = dict(arrays)
