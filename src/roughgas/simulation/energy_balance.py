"""The energy balance of a simulation: how much each source has put in, and each sink taken out.

Effects that do work, and the contacts, each have an account in the kernel's ledger. All that they
have booked is the change of the energy, to rounding. Gravity has no account: its potential counts
as translational energy.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from roughgas.kernel import hooks
from roughgas.kernel.state import EXPONENT, State
from roughgas.scene import Scene

MOTIONS = ("translation", "rotation")
CONTACTS = "contacts"
LEAST = (
    1e-3  # of the energy: of what exchanges less, roundings of the energy are all that is missing
)


class EnergyBalance(NamedTuple):
    """The energies of all particles, in m a^2/T^2."""

    energy: np.ndarray  # (2,) of translation and rotation
    ledger: np.ndarray  # (accounts, 2) what each effect, and last the contacts, have put into them


def balance(state: State, scene: Scene) -> EnergyBalance:
    """Return the energy balance now."""
    unit = np.ldexp(1.0, 2 * int(state.counts[EXPONENT]))
    return EnergyBalance(_energy(state, scene) * unit, state.ledger[0] * unit + state.ledger[1])


def _energy(state, scene):
    """Return translational (kinetic and potential) and rotational energy, in the kernel's units.

    Velocities are those of the images that the particles last were in, as in the ledger.
    """
    dimension, gravity, spin = len(scene.box), scene.effects.gravity, scene.effects.spin
    mass, bodies = np.ones(1), state.bodies
    if bodies is not None:
        mass = bodies.mass
    translational = 0.5 * np.sum(mass[:, None] * state.trajectory[:, dimension:-1] ** 2)
    if gravity is not None:
        # free flight keeps the sum of both: take it where the flight began
        translational += gravity.acceleration * np.sum(mass * state.trajectory[:, dimension - 1])
    if spin is None:
        return np.array([translational, 0.0])
    share = mass if bodies is None else mass * bodies.inertia / spin.inertia
    rotational = 0.5 * spin.inertia * np.sum(share[:, None] * state.spin**2)
    return np.array([translational, rotational])


def energy_exchange(
    before: EnergyBalance, after: EnergyBalance, scene: Scene, particles: int
) -> dict[str, Any]:
    """Return variables of a point (see roughgas.data.point): what was put in between two instants.

    With drives and spin, these say how the drives' input is shared between the two motions.
    """
    booked = (after.ledger - before.ledger) / particles
    gain = (after.energy - before.energy) / particles
    accounts = _accounts(scene)
    found = {
        "source": list(accounts),
        "motion": list(MOTIONS),
        "energy_input": booked[list(accounts.values())],
        "energy_gain": gain,
        "energy_imbalance": imbalance(booked, gain, before.energy.sum() / particles),
    }
    if scene.effects.spin is None or not hooks.present(scene.effects, "drives"):
        return found
    sources = [number for name, number in accounts.items() if name != CONTACTS]
    put_in = booked[sources].sum(axis=0)
    total = put_in.sum()
    return found | {"input_spin_share": put_in[1] / total if total else math.nan}


def imbalance(booked: np.ndarray, gain: np.ndarray, energy: float = 0.0) -> float:
    """Return the largest energy of a motion that the balance does not explain, over all exchanged.

    Where hardly anything is exchanged, as by particles that are nearly elastic and smooth, it is
    over a thousandth of the `energy` that was there, whose roundings are missing.
    """
    exchanged = max(np.abs(booked).sum(), LEAST * energy)
    missing = np.abs(gain - booked.sum(axis=0)).max()
    return float(missing / exchanged) if exchanged > 0.0 else float(missing)


def _accounts(scene):
    """Return name -> number of the accounts that can change: those of effects that do work."""
    effects = scene.effects
    working = [part for hook in ("resolve", "transfer") for part in hooks.present(effects, hook)]
    ranks = {effects._fields[part.place]: part.rank for part in working}
    return dict(sorted(ranks.items(), key=lambda item: item[1])) | {
        CONTACTS: hooks.accounts(effects)
    }
