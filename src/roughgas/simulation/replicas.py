"""The samples of the replicas of a cooling gas, from the onset of dissipation.

Replicas are independent gases in one point. Energies are in units of E_trans at the onset.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Self

import numpy as np

from roughgas.simulation.checkpoint import under_prefix, with_prefix
from roughgas.simulation.energies import Columns, Energies, species_energies
from roughgas.simulation.energy_balance import EnergyBalance
from roughgas.simulation.gas import Batch, Gas, concatenated
from roughgas.simulation.leg import Changes, Leg
from roughgas.simulation.tracker import Tracker

COOLING_LEG = "cooling"
"""Name of the leg in which a replica cools."""


class CooledRun(NamedTuple):
    """One replica, or several along the first axis; energies in units of E_trans at the onset."""

    energies: Energies  # of each sample, over 4^exponent, else below the smallest number
    exponent: np.ndarray
    collisions: np.ndarray  # per particle since the onset of dissipation
    time: np.ndarray  # of each sample, in T since the onset of dissipation
    before: EnergyBalance
    after: EnergyBalance
    species: list[Energies]  # as `energies`, of each species

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the run as arrays by name, for a checkpoint."""
        arrays = {name: getattr(self, name) for name in ("exponent", "collisions", "time")}
        for name in ("before", "after"):
            arrays |= with_prefix(name, getattr(self, name)._asdict())
        for number, energies in enumerate([self.energies, *self.species]):
            arrays[f"energies.{number}"] = np.array(energies.present_components())
        return arrays

    @classmethod
    def of(cls, arrays: Mapping[str, np.ndarray]) -> Self:
        """Return a run from its arrays by name, made by `arrays`."""
        energies = under_prefix("energies", arrays)
        all_energies = [Energies(*energies[str(number)]) for number in range(len(energies))]
        series = {name: arrays[name] for name in ("exponent", "collisions", "time")}
        before, after = (
            EnergyBalance(**under_prefix(name, arrays)) for name in ("before", "after")
        )
        return cls(
            energies=all_energies[0], before=before, after=after, species=all_energies[1:], **series
        )


class CooledReplicas(Tracker):
    """Stores the replicas of a point, each from the onset of dissipation."""

    def __init__(self) -> None:
        self.runs: list[CooledRun] = []
        self._start_sample: Columns = {}  # at the onset of dissipation
        self._start_balance: Changes = {}
        self._rows: list[Columns] = []

    def begin(self, gas: Gas, leg: Leg, changes: Changes) -> None:
        """Store the sample and the energy balance at the onset of dissipation."""
        self._start_sample, self._start_balance, self._rows = gas.sample, changes, []

    def take(self, gas: Gas, leg: Leg, batch: Batch) -> None:
        """Store the samples of a batch."""
        self._rows.append(batch.rows)

    def end(self, gas: Gas, leg: Leg) -> None:
        """Reduce the samples of a replica to energies, at the end of its cooling."""
        if leg.name == COOLING_LEG:
            before = EnergyBalance(self._start_balance["energy"], self._start_balance["ledger"])
            self.runs.append(reduced_run(gas, self._start_sample, before, concatenated(self._rows)))
        self._rows = []

    def arrays(self) -> dict[str, np.ndarray]:
        """Return the finished replicas, and the samples of the present one, as arrays by name."""
        arrays = with_prefix("start", self._start_sample) | with_prefix(
            "before", self._start_balance
        )
        arrays |= with_prefix("rows", concatenated(self._rows)) if self._rows else {}
        for number, run in enumerate(self.runs):
            arrays |= with_prefix(f"runs.{number}", run.arrays())
        return arrays

    def restore(self, arrays: Mapping[str, np.ndarray]) -> None:
        """Restore the replicas from the arrays of a checkpoint."""
        self._start_sample, self._start_balance = (
            under_prefix("start", arrays),
            under_prefix("before", arrays),
        )
        rows, runs = under_prefix("rows", arrays), under_prefix("runs", arrays)
        self._rows = [rows] if rows else []
        count = len({name.partition(".")[0] for name in runs})
        self.runs = [CooledRun.of(under_prefix(str(number), runs)) for number in range(count)]


def reduced_run(gas: Gas, start: Columns, before: EnergyBalance, rows: Columns) -> CooledRun:
    """Return a replica, reduced to energies from its samples `rows` (columns by name).

    `start` and `before` are its sample and energy balance at the onset of dissipation.
    """
    unit, exponent = gas.energies(start).translational[0], int(start["exponent"][0])
    energy = math.ldexp(unit, 2 * exponent)
    before, after = (
        EnergyBalance(*(values / energy for values in balance))
        for balance in (before, gas.balance())
    )
    species = [
        energies.map(lambda values: values / unit)
        for energies in species_energies(rows, gas.scene, gas.state)
    ]
    return CooledRun(
        energies=gas.energies(rows).map(lambda values: values / unit),
        exponent=rows["exponent"].astype(int) - exponent,
        collisions=2 * (rows["collisions"] - start["collisions"]) / gas.particles,
        time=rows["time"] - start["time"][0],
        before=before,
        after=after,
        species=species,
    )


def stacked_runs(runs: Sequence[CooledRun]) -> CooledRun:
    """Return all replicas as one run, with replicas along the first axis of the arrays.

    Energy balances are averaged over replicas.
    """
    return CooledRun(
        energies=_stacked([run.energies for run in runs]),
        exponent=np.array([run.exponent for run in runs]),
        collisions=np.array([run.collisions for run in runs]),
        time=np.array([run.time for run in runs]),
        before=_mean([run.before for run in runs]),
        after=_mean([run.after for run in runs]),
        species=[
            _stacked(species_energies)
            for species_energies in zip(*(run.species for run in runs), strict=True)
        ],
    )


def _mean(balances: Sequence[EnergyBalance]) -> EnergyBalance:
    """Return the mean of energy balances over replicas."""
    return EnergyBalance(*(np.mean(values, axis=0) for values in zip(*balances, strict=True)))


def _stacked(replicas: Sequence[Energies]) -> Energies:
    """Return the energies of all replicas, (replicas, samples)."""
    return Energies(
        *map(np.array, zip(*(run.present_components() for run in replicas), strict=True))
    )
