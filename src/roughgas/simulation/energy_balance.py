"""The energy balance: the energy that each source has supplied and each sink removed.

A motion is translation (index 0) or rotation (index 1).

Each effect that does work, and the contacts, have an account in the kernel's ledger. The sum of all
accounts equals the change of the energy, to rounding. The potential energy of gravity counts as
translational; where gravity acts along a periodic axis, its work has an account.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from roughgas.base import NamedValues
from roughgas.effects.gravity import Gravity
from roughgas.kernel import hooks
from roughgas.kernel.record import RawFrames
from roughgas.kernel.state import EXPONENT, State
from roughgas.scene import Scene
from roughgas.simulation.energies import Columns
from roughgas.simulation.free_flight import in_starting_order

MOTIONS = ("translation", "rotation")
CONTACTS = "contacts"
STAGES = "stages"
"""Source that stands for the energy jumps at the beginnings of stages."""
MIN_EXCHANGE = 1e-3
"""Share of the energy below which an exchange is too small to be compared with its roundings."""


class EnergyBalance(NamedTuple):
    """The energy of all particles, and the energy supplied since the start, in m a^2/T^2."""

    energy: np.ndarray  # (2,) of translation and rotation
    ledger: np.ndarray  # (accounts, 2) supplied by each effect and, last, by the contacts


def balance(state: State, scene: Scene) -> EnergyBalance:
    """Return the energy balance of the kernel's `state` at its present instant."""
    bodies = state.bodies
    mass, inertia = (None, None) if bodies is None else (bodies.mass, bodies.inertia)
    return _balance_of_motions(
        ParticleMotions(state.trajectory, state.spin, mass, inertia),
        state.ledger,
        state.counts,
        scene,
    )


def balances(frames: RawFrames, state: State, scene: Scene) -> Columns:
    """Return the energy balances of k frames as columns (k,), in m a^2/T^2.

    Their names are `energy M` and `booked ACCOUNT M`: M is the index of a motion, and ACCOUNT the
    number of an account of the ledger. `state` is the state of the gas after the last frame; its
    particles may be stored in another order.
    """
    columns: dict[str, list[float]] = {}
    bodies, mass, inertia = state.bodies, None, None
    body_quantities = bodies and tuple(
        in_starting_order(state, quantity) for quantity in (bodies.mass, bodies.inertia)
    )
    for k in range(len(frames.rows)):
        if body_quantities:
            mass, inertia = (values[frames.label[k]] for values in body_quantities)
        spin = None if frames.spin is None else frames.spin[k]
        motions = ParticleMotions(frames.trajectory[k], spin, mass, inertia)
        energy, ledger = _balance_of_motions(motions, frames.ledger[k], frames.counts[k], scene)
        for motion, value in enumerate(energy):
            columns.setdefault(f"energy {motion}", []).append(value)
        for (account, motion), value in np.ndenumerate(ledger):
            columns.setdefault(f"booked {account} {motion}", []).append(value)
    return {name: np.array(values) for name, values in columns.items()}


class ParticleMotions(NamedTuple):
    """Trajectories, spins, masses and inertias of particles, in the kernel's units and order."""

    trajectory: np.ndarray  # (N, 2 D + 1)
    spin: np.ndarray | None  # (N, 2 D - 3)
    mass: np.ndarray | None  # (N,) in m; None if all are identical
    inertia: np.ndarray | None  # (N,) q


def _balance_of_motions(
    motions: ParticleMotions, ledger: np.ndarray, counts: np.ndarray, scene: Scene
):
    """Return the energy balance of particles in m a^2/T^2, from values in the kernel's units.

    `ledger` (2, accounts, 2) and `counts` are arrays of State.
    """
    unit = np.ldexp(1.0, 2 * int(counts[EXPONENT]))
    return EnergyBalance(_energy(motions, scene) * unit, ledger[0] * unit + ledger[1])


def _energy(motions: ParticleMotions, scene: Scene) -> np.ndarray:
    """Return the energy of all particles, (2,) of translation (kinetic and potential) and rotation.

    The result is in the kernel's units. Velocities refer to the image that a particle was in at its
    last event, as in the ledger.
    """
    dimension, gravity, spin = len(scene.box), scene.effects.gravity, scene.effects.spin
    mass = np.ones(1) if motions.mass is None else motions.mass
    trajectory = motions.trajectory
    translational = 0.5 * np.sum(mass[:, None] * trajectory[:, dimension:-1] ** 2)
    if gravity is not None:
        # kinetic plus potential energy is constant in free flight: evaluate it at its start
        translational += potential_energy(gravity, mass, trajectory[:, :dimension])
    if spin is None:
        return np.array([translational, 0.0])
    assert motions.spin is not None
    share = mass if motions.inertia is None else mass * motions.inertia / spin.inertia
    rotational = 0.5 * spin.inertia * np.sum(share[:, None] * motions.spin**2)
    return np.array([translational, rotational])


def potential_energy(gravity: Gravity, mass: np.ndarray, position: np.ndarray) -> float:
    """Return the potential energy of particles of `mass` (N,) or (1,) at `position` (N, D)."""
    return -sum(g * np.sum(mass * position[:, axis]) for axis, g in gravity.along.items())


def energy_exchange(
    before: EnergyBalance,
    after: EnergyBalance,
    scene: Scene,
    particles: int,
    changes: np.ndarray | None = None,
) -> NamedValues:
    """Return the energy per particle that each source supplied from `before` to `after`, by name.

    The variables are defined in roughgas.data.point. With drives and spin, `input_spin_share` is
    the rotational share of the energy from drives. `particles` is N, and `changes` (2,) is the
    energy supplied at the beginnings of stages, in m a^2/T^2.
    """
    booked = (after.ledger - before.ledger) / particles
    gain = (after.energy - before.energy) / particles
    accounts = _working_accounts(scene)
    if changes is not None:
        accounts = accounts | {STAGES: len(booked)}
        booked = np.vstack([booked, changes / particles])
    variables = {
        "source": list(accounts),
        "motion": list(MOTIONS),
        "energy_input": booked[list(accounts.values())],
        "energy_gain": gain,
        "energy_imbalance": imbalance(booked, gain, before.energy.sum() / particles),
    }
    if scene.effects.spin is None or not hooks.active(scene.effects, "drives"):
        return variables
    sources = [number for name, number in accounts.items() if name not in (CONTACTS, STAGES)]
    drive_input = booked[sources].sum(axis=0)
    total = drive_input.sum()
    return variables | {"input_spin_share": drive_input[1] / total if total else math.nan}


def exchange_series(
    columns: Columns,
    before: EnergyBalance,
    scene: Scene,
    particles: int,
    changes: np.ndarray,
    counts: Sequence[int],
) -> dict[str, np.ndarray]:
    """Return the energy per particle, supplied by each source and gained, up to each sample.

    It counts from the balance `before`. `columns` (samples,) come from `balances`; the series are
    (samples, sources, 2) and (samples, 2), in units of m a^2/T^2. `changes` (stages, 2) is the
    energy supplied at the beginning of each stage, in the same unit, and `counts` are the numbers
    of samples of the stages. `particles` is N.
    """

    def columns_of_motions(name):
        """Return the columns of both motions whose names begin with `name`, (samples, 2)."""
        return np.stack([columns[f"{name} {k}"] for k in range(len(MOTIONS))], axis=1)

    accounts = _working_accounts(scene).values()
    booked = [
        columns_of_motions(f"booked {account}") - before.ledger[account] for account in accounts
    ]
    booked.append(np.repeat(changes.cumsum(axis=0), counts, axis=0))
    return {
        "energy_input_series": np.stack(booked, axis=1) / particles,
        "energy_gain_series": (columns_of_motions("energy") - before.energy) / particles,
    }


def imbalance(booked: np.ndarray, gain: np.ndarray, energy: float = 0.0) -> float:
    """Return the relative error of an energy balance: the largest unexplained gain of a motion.

    `booked` (sources, 2) is the energy that sources supplied, and `gain` (2,) the change of the
    energy. The error is divided by the exchanged energy or, if little was exchanged (as by
    particles that are nearly elastic and smooth), by a thousandth of the initial `energy`, whose
    roundings then dominate.
    """
    exchanged = max(np.abs(booked).sum(), MIN_EXCHANGE * energy)
    missing = np.abs(gain - booked.sum(axis=0)).max()
    return float(missing / exchanged) if exchanged > 0.0 else float(missing)


def _working_accounts(scene):
    """Return the account numbers of the ledger by source.

    Sources are the effects that do work, and last the contacts.
    """
    effects = scene.effects
    working = [
        hook
        for hook_name in ("resolve", "transfer", "speed_gain")
        for hook in hooks.active(effects, hook_name)
    ]
    ranks = {effects._fields[hook.effect_index]: hook.account for hook in working}
    return dict(sorted(ranks.items(), key=lambda item: item[1])) | {
        CONTACTS: hooks.accounts(effects)
    }
