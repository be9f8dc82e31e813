"""Rate equations in a Langevin bath: drag and noise on velocities and on spins."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from roughgas.theory.arguments import check, quotient
from roughgas.theory.closed_forms import collision_frequency
from roughgas.theory.mixtures import SPECIES
from roughgas.theory.rate_equations import collision_rates

LANGEVIN = "langevin_json"
"""The attribute of datasets that holds the settings of a bath."""
BESIDE = (SPECIES, "mu", "spin_share")
"""Attributes of a gas that is more than a bath of rough particles."""
FAR, HALVINGS = 30.0, 110
"""Decades of T_tr, either way, in which a stationary state is looked for, and steps of that."""


def bath_temperatures(
    r,
    beta,
    packing,
    drag=0.0,
    temperature=0.0,
    spin_drag=0.0,
    spin_temperature=0.0,
    power=0.0,
    spin_power=0.0,
    dimension=2,
    inertia=None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the stationary T_tr and T_rot of a gas in a Langevin bath.

    They solve dT_tr/dt = (collisions) + 2 gamma (T - T_tr) + 2 power/D, and the same for spins with
    2 spin_power/(2D-3), the collisions being those of a Maxwellian gas (`temperature_changes`) at
    the `collision_frequency` of T_tr and the packing. For smooth particles: M. G. Chamorro, F.
    Vega Reyes & V. Garzó, J. Stat. Mech. P07013 (2013). Drags are in 1/T, powers in
    m a^2/T^3 per particle; temperatures 0 where the bath gives nothing.
    """
    rates = collision_rates(r, beta, dimension, inertia)
    a, b, c, d = (np.asarray(rate) for rate in rates)
    loss, spin_loss = 2 * check("drag", drag), 2 * check("drag of spins", spin_drag)
    gain = loss * check("temperature T", temperature) + 2 * check("power", power) / dimension
    spin_gain = spin_loss * check("temperature of spins", spin_temperature)
    spin_gain = spin_gain + 2 * check("power of spins", spin_power) / (2 * dimension - 3)
    unit = collision_frequency(1.0, packing, dimension)

    def state(logarithm):
        """Return both temperatures that balance at the frequency which one of them sets."""
        nu = unit * 10.0 ** (logarithm / 2)
        out, spin_out = nu * a + loss, nu * d + spin_loss
        both = out * spin_out - nu**2 * b * c
        T_tr = quotient(gain * spin_out + spin_gain * nu * b, both)
        return T_tr, quotient(spin_gain * out + gain * nu * c, both)

    parts = a, loss, gain, spin_gain, spin_loss, unit
    low = np.full(np.broadcast_shapes(*(np.shape(part) for part in parts)), -FAR)
    high = -low
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        rises = state(middle)[0] > 10.0**middle
        low, high = np.where(rises, middle, low), np.where(rises, high, middle)
    given = (gain > 0) | (spin_gain > 0)
    T_tr, T_rot = state(low)
    return np.where(given, T_tr, 0.0)[()], np.where(given, T_rot, 0.0)[()]


def ratio_in_bath(attributes: Mapping[str, Any], r: Any, beta: Any) -> np.ndarray:
    """Return R of theory in the bath of a dataset, over the broadcast shape of its arguments; NaN
    where the packing is not known, nothing spins, or the bath gives nothing, and for what these
    rate equations leave out: several species, friction, a thermostat beside the bath.

    A swept parameter of the bath stands among the attributes, as the inertia does.
    """
    r, beta = np.broadcast_arrays(r, beta)
    if any(name in attributes for name in BESIDE):
        return np.full(r.shape, np.nan)
    settings = json.loads(attributes[LANGEVIN])
    part, _, swept = attributes.get("swept", "").rpartition(".")
    names = {"inertia", "packing", *(settings.keys() - {"interval"})}
    given = {name: settings.get(name, attributes.get(name, np.nan)) for name in names}
    if part == "langevin" and swept in given:
        given[swept] = attributes.get(swept, np.nan)
    if not all(np.isfinite(value).all() for value in given.values()):
        return np.full(r.shape, np.nan)
    T_tr, T_rot = bath_temperatures(r, beta, dimension=int(attributes["dimension"]), **given)
    with np.errstate(invalid="ignore"):
        return np.asarray(T_rot / (T_tr + T_rot))
