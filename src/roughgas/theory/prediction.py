"""What theory predicts for a dataset: which equation it obeys, and what that says of R.

Of a mixture, `species_json` among its attributes holds `species` and `species_pairs`, as in
config.yaml, and the `volume` of a periodic box. Where a quantity of a species is swept, its values
stand among the attributes under its name.
"""

import json
import math
from collections.abc import Container, Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import SPECIES as OF_SPECIES
from roughgas.base import holder
from roughgas.theory import mixture_states
from roughgas.theory.closed_forms import VOLUME
from roughgas.theory.friction import friction_ratio
from roughgas.theory.mixtures import SPECIES, Mixture, Temperatures, mixture
from roughgas.theory.rate_equations import LANGEVIN, bath_temperatures, stationary_ratio

BESIDE = (SPECIES, "mu", "spin_share")
"""Attributes of a gas that is more than a bath of rough particles."""


class Equation(NamedTuple):
    """What R of a gas is compared with."""

    kind: str  # "K" for a freely cooling gas, "lun" for a driven one: the attribute `theory`
    name: str  # "theory of free cooling", "rate equations with Coulomb friction"...


def equation_of(attributes: Mapping[str, Any], variables: Container[Any] = ()) -> Equation:
    """Return the equation that a point or a reduced dataset obeys.

    A point has no attribute `theory`: there, `variables` tell whether R has a plateau that ends,
    as in a cooling gas. A parameter that is swept, and so is no attribute, has no single value.
    """
    kind = attributes.get("theory", "K" if "plateau_end" in variables else "lun")
    swept = attributes.get("swept", "").rpartition(".")[2]
    if LANGEVIN in attributes:
        return Equation(kind, "rate equations in a Langevin bath")
    if SPECIES in attributes and kind == "K":
        return Equation(kind, "theory of free cooling of mixtures")
    if SPECIES in attributes:
        kicked, other = "rate equations of mixtures", "Lun's formula for mixtures, equal T_trans"
        return Equation(kind, kicked if "spin_share" in attributes else other)
    if "mu" in attributes or swept == "mu":
        return Equation(kind, "rate equations with Coulomb friction")
    if kind == "K":
        return Equation(kind, "theory of free cooling")
    if "spin_share" not in attributes and swept == "spin_share":
        return Equation(kind, "rate equations")
    share = attributes.get("spin_share", 0.0)
    return Equation(kind, f"rate equations, spin share {share:g}" if share else "Lun's formula")


def like_theory(variables: Container[Any]) -> bool:
    """Return whether the average over collisions is that of theory, in what has these `variables`.

    Theory of a driven gas balances what collisions change, so its R is an average over collisions
    (McNamara & Luding 1998, below Eq. (Energybalance)). Contacts of a sheared gas feel its mean
    flow and mean spin, which theory leaves out; there it is R over time that leaves them out, too.
    """
    return "R_unsubtracted" not in variables


def over_collisions(attributes: Mapping[str, Any], variables: Container[Any] = ()) -> str:
    """Return what R averaged over collisions is to the equation of `equation_of`, in words."""
    name = equation_of(attributes, variables).name
    if like_theory(variables):
        return f"as {name}"
    return f"mean flow included, unlike {name}"


def predicted_ratio(attributes: Mapping[str, Any], r: Any, beta: Any) -> np.ndarray:
    """Return R of theory, over the broadcast shape of its arguments; NaN where nothing spins, for a
    gas through `stages`, and for a cooling gas at beta = -1: contacts leave spins alone there, and
    R has no stationary value.

    That is the theory of free cooling for a gas without a drive, Lun's formula for one whose drive
    adds translation only, and the result of the rate equations for other drives, and for friction.
    `attributes` are those of a reduced dataset, with what is its third axis: `inertia`,
    `spin_share` (of the drive), or `mu`; these broadcast with `r` and `beta`. Mixtures have
    `species_json`, a Langevin bath `langevin_json`, and theories of their own.
    """
    if "stages" in attributes:
        return np.full(np.broadcast_shapes(np.shape(r), np.shape(beta)), math.nan)
    if LANGEVIN in attributes:
        return ratio_in_bath(attributes, r, beta)
    if SPECIES in attributes:
        return ratio_of_mixture(attributes, r, beta)
    names = {"inertia": math.nan, "spin_share": 0.0, "mu": math.inf}
    given = (attributes.get(name, value) for name, value in names.items())
    r, beta, q, share, mu = np.broadcast_arrays(*(np.asarray(x, float) for x in (r, beta, *given)))
    if np.isnan(q).any():
        return np.full(r.shape, math.nan)
    dimension, driven = int(attributes["dimension"]), attributes["theory"] != "K"
    of_drive = share if driven else None
    if np.isfinite(mu).any():
        found = friction_ratio(r, beta, mu, dimension, q, of_drive)
    else:
        found = stationary_ratio(r, beta, dimension, q, of_drive)
    return np.where((beta == -1.0) & (not driven), math.nan, found)


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


def ratio_of_point(point: Any) -> float:
    """Return R of theory for a point (a Dataset); NaN where there is none.

    Where a quantity of a species is swept, it is the value that counts.
    """
    about = point.attrs | {"theory": equation_of(point.attrs, point).kind}
    if not isinstance(value := about.get("swept_value", ""), str):
        about[about["swept"].rpartition(".")[2]] = value
    return float(predicted_ratio(about, about["r"], about["beta"]))


SMOOTH = -1 + 1e-7
"""Roughness that stands for the limit beta -> -1 of a cooling gas: see `cooling_ratio`."""
FINE = 121
"""Values along a line from which on theory is computed at some, and interpolated between them."""


def ratio_of_mixture(attributes: Mapping[str, Any], r: Any, beta: Any) -> np.ndarray:
    """Return R of all particles over the broadcast shape of the arguments, as `predicted_ratio`.

    Without a drive it is that of `mixture_cooling`, with the thermostat that of `mixture_driven`.
    Another drive leaves open how species share the energy of translation: then it is that of
    `mixture_rotation` with equal temperatures.
    """
    swept = attributes.get("swept", "").rpartition(".")[2]
    names = {"inertia": math.nan, "spin_share": 0.0, "mu": math.inf} | {swept: math.nan}
    given = [np.asarray(attributes.get(name, value), float) for name, value in names.items()]
    places = np.broadcast_arrays(r, beta, *given)
    columns = [np.asarray(place, float).ravel() for place in places]
    moving = [column for column in columns if len(set(column.tolist())) > 1]

    def at(index: int) -> float:
        place = dict(zip(("r", "beta", *names), (column[index] for column in columns), strict=True))
        return _ratio(attributes, place, swept)

    size = columns[0].size
    if size <= FINE or len(moving) > 1:
        return np.reshape([at(k) for k in range(size)], places[0].shape)
    some = np.unique(np.linspace(0, size - 1, FINE).round().astype(int))
    found = np.interp(np.arange(size), some, [at(k) for k in some])
    return np.reshape(found, places[0].shape)


def species_at(
    attributes: Mapping[str, Any], place: Mapping[str, float], T_tr=None
) -> Temperatures:
    """Return what theory says of the species of a dataset at one place (see `mixture_at`).

    Of a cooling gas, their temperatures. Of a driven one, T_rot by `mixture_rotation` from their
    measured `T_tr`, (species,).
    """
    gas, packing = mixture_at(attributes, place)
    if attributes["theory"] == "K":
        return mixture_states.mixture_cooling(gas, packing).as_given(gas)
    measured = np.asarray(T_tr)[gas.part_of]
    return Temperatures(measured, mixture_states.mixture_rotation(gas, measured, packing)).as_given(
        gas
    )


def mixture_at(attributes: Mapping[str, Any], place: Mapping[str, float]) -> tuple[Mixture, float]:
    """Return the mixture of a dataset, and its packing (0 where the box is open), at one place: r,
    beta, and what is swept, by name."""
    known = json.loads(attributes[SPECIES])
    part, _, key = attributes.get("swept", "").rpartition(".")
    if part.startswith(OF_SPECIES) and (changed := holder(known, part, key)) is not None:
        changed[key] = float(place[key])
    q, mu = (place.get(name, attributes.get(name)) for name in ("inertia", "mu"))
    q = None if q is None or math.isnan(q) else q
    about = int(attributes["dimension"]), q, math.inf if mu is None else mu
    gas = mixture(known["species"], place["r"], place["beta"], *about, known["species_pairs"])
    if not known["volume"]:
        return gas, 0.0
    filled = VOLUME[gas.dimension] * float(gas.fraction @ gas.radius**gas.dimension)
    return gas, int(attributes["particles"]) * filled / known["volume"]


def _ratio(attributes: Mapping[str, Any], place: Mapping[str, float], swept: str) -> float:
    cools = attributes["theory"] == "K"
    rough = {"beta": max(place["beta"], SMOOTH)} if cools else {}
    gas, packing = mixture_at(attributes, {**place, **rough})
    if cools:
        return mixture_states.mixture_cooling(gas, packing).overall_ratio(gas)
    if "spin_share" in attributes or swept == "spin_share":
        share = place["spin_share"]
        power = (1 - share) * mixture_states.kick_power(gas)
        return mixture_states.mixture_driven(gas, power, packing, share).overall_ratio(gas)
    even = np.ones(len(gas.mass))
    return Temperatures(even, mixture_states.mixture_rotation(gas, even, packing)).overall_ratio(
        gas
    )
