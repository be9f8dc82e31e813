"""Predictions of theory for a dataset: the equation that it obeys, and R by this equation.

R = T_rot/(T_rot + T_tr) is the share of rotational energy, r the normal restitution, beta the
roughness, `inertia` q = I/(m a^2).

The attribute `species_json` of a mixture holds `species` and `species_pairs`, as in config.yaml,
and the `volume` of a periodic box. The values of a swept quantity of a species are an attribute
with the name of the quantity.
"""

import json
import math
from collections.abc import Container, Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.base import Attributes, InputError
from roughgas.base.labels import SPECIES_PREFIX as SPECIES_KEY
from roughgas.base.labels import species_settings
from roughgas.theory import mixture_states
from roughgas.theory.closed_forms import VOLUME
from roughgas.theory.friction import friction_ratio
from roughgas.theory.mixtures import SPECIES_ATTRIBUTE, Mixture, Temperatures, mixture
from roughgas.theory.rate_equations import (
    FLOWS,
    LANGEVIN_ATTRIBUTE,
    bath_temperatures,
    stationary_ratio,
)

OUTSIDE_BATH_THEORY = (SPECIES_ATTRIBUTE, "mu", "spin_share")
"""Attributes of gases with species, friction or a thermostat, which the theory of a bath lacks."""

NOT_IN_BATH_THEORY = {"interval", "spin_velocity", "spin_axis"}
"""Settings of a bath that its rate equations do not have."""


class Equation(NamedTuple):
    """The equation of theory that R, the share of rotational energy, is compared with."""

    kind: str  # "K" for a freely cooling gas, "lun" for a driven one: the attribute `theory`
    name: str  # "theory of free cooling", "rate equations with Coulomb friction"...


def equation_of(attributes: Attributes, variables: Container[Any] = ()) -> Equation:
    """Return the equation that a dataset of a point, or a reduced dataset, obeys.

    `attributes` and `variables` are the attributes and the names of the variables of the dataset. A
    point has no attribute `theory`: a cooling gas is recognised by the variable `plateau_end`. A
    swept parameter has no single value, and is not an attribute.
    """
    kind = attributes.get("theory", "K" if "plateau_end" in variables else "lun")
    swept = attributes.get("swept", "").rpartition(".")[2]
    if LANGEVIN_ATTRIBUTE in attributes:
        return Equation(kind, "rate equations in a Langevin bath")
    if SPECIES_ATTRIBUTE in attributes and kind == "K":
        return Equation(kind, "theory of free cooling of mixtures")
    if SPECIES_ATTRIBUTE in attributes:
        thermostat_name, general_name = (
            "rate equations of mixtures",
            "Lun's formula for mixtures, equal T_trans",
        )
        return Equation(kind, thermostat_name if "spin_share" in attributes else general_name)
    if "mu" in attributes or swept == "mu":
        return Equation(kind, "rate equations with Coulomb friction")
    if kind == "K":
        return Equation(kind, "theory of free cooling")
    if "spin_share" not in attributes and swept == "spin_share":
        return Equation(kind, "rate equations")
    share = attributes.get("spin_share", 0.0)
    return Equation(kind, f"rate equations, spin share {share:g}" if share else "Lun's formula")


def theory_averages_over_collisions(variables: Container[Any]) -> bool:
    """Return whether R of theory corresponds to R averaged over collisions.

    `variables` are the names of the variables of a dataset. Theory of a driven gas balances the
    changes by collisions, so its R is an average over collisions (McNamara & Luding 1998, below Eq.
    (Energybalance)). Contacts of a sheared gas depend on its mean flow and mean spin, which theory
    omits; the average of R over time omits them, too.
    """
    return "R_unsubtracted" not in variables


def describe_collisional_average(attributes: Attributes, variables: Container[Any] = ()) -> str:
    """Return in words how R averaged over collisions relates to the equation of `equation_of`.

    Arguments as in `equation_of`.
    """
    name = equation_of(attributes, variables).name
    if theory_averages_over_collisions(variables):
        return f"as {name}"
    return f"mean flow included, unlike {name}"


def predicted_ratio(attributes: Attributes, r: Any, beta: Any) -> np.ndarray:
    """Return R of theory, the share of rotational energy, in the shape of its arguments.

    R is computed by the theory of free cooling for a gas without a drive, Lun's formula for a drive
    that adds translational energy only, and the rate equations for other drives, and for friction.
    `attributes` are the attributes of a reduced dataset, with its third axis: `inertia`,
    `spin_share` (of the drive), or `mu` (coefficient of friction); these broadcast with `r` and
    `beta`. Mixtures, which have `species_json`, are treated by `ratio_of_mixture`, Langevin baths,
    which have `langevin_json`, by `ratio_in_bath`.

    NaN where nothing spins, for a gas through `stages`, and for a cooling gas at beta = -1, where
    contacts do not change spins, and R has no stationary value.
    """
    if "stages" in attributes:
        return np.full(np.broadcast_shapes(np.shape(r), np.shape(beta)), math.nan)
    if LANGEVIN_ATTRIBUTE in attributes:
        return ratio_in_bath(attributes, r, beta)
    if SPECIES_ATTRIBUTE in attributes:
        return ratio_of_mixture(attributes, r, beta)
    defaults = {"inertia": math.nan, "spin_share": 0.0, "mu": math.inf}
    parameters = (attributes.get(name, value) for name, value in defaults.items())
    r, beta, q, share, mu = np.broadcast_arrays(
        *(np.asarray(x, float) for x in (r, beta, *parameters))
    )
    if np.isnan(q).any():
        return np.full(r.shape, math.nan)
    dimension, driven = int(attributes["dimension"]), attributes["theory"] != "K"
    spin_share = share if driven else None
    if np.isfinite(mu).any():
        predicted = friction_ratio(r, beta, mu, dimension, q, spin_share)
    else:
        predicted = stationary_ratio(r, beta, dimension, q, spin_share)
    return np.where((beta == -1.0) & (not driven), math.nan, predicted)


def ratio_in_bath(attributes: Attributes, r: Any, beta: Any) -> np.ndarray:
    """Return R of theory, the share of rotational energy, in the Langevin bath of a dataset.

    It has the broadcast shape of `r` and `beta`. `attributes` are the attributes of the dataset;
    its settings of the bath are in `langevin_json`. NaN where the packing is unknown, nothing
    spins, or the bath supplies no energy, and for gases outside of these rate equations: with
    several species, friction, a thermostat, or a medium that rotates or flows (FLOWS). A
    swept parameter of the bath is among the attributes, as is the inertia.
    """
    r, beta = np.broadcast_arrays(r, beta)
    settings = json.loads(attributes[LANGEVIN_ATTRIBUTE])
    section, _, swept = attributes.get("swept", "").rpartition(".")
    moves = settings.get("spin_velocity") or settings.get(FLOWS) or swept == "spin_velocity"
    if moves or any(name in attributes for name in OUTSIDE_BATH_THEORY):
        return np.full(r.shape, np.nan)
    names = {"inertia", "packing", *(settings.keys() - NOT_IN_BATH_THEORY)}
    parameters = {name: settings.get(name, attributes.get(name, np.nan)) for name in names}
    if section == "langevin" and swept in parameters:
        parameters[swept] = attributes.get(swept, np.nan)
    if not all(np.isfinite(value).all() for value in parameters.values()):
        return np.full(r.shape, np.nan)
    T_tr, T_rot = bath_temperatures(r, beta, dimension=int(attributes["dimension"]), **parameters)
    with np.errstate(invalid="ignore"):
        return np.asarray(T_rot / (T_tr + T_rot))


def ratio_of_point(point: Any) -> float:
    """Return R of theory, the share of rotational energy, for a point; NaN without a theory.

    `point` is its dataset. A swept quantity of a species has its value at this point, not the value
    of the experiment.
    """
    attributes = point.attrs | {"theory": equation_of(point.attrs, point).kind}
    if not isinstance(swept_value := attributes.get("swept_value", ""), str):
        attributes[attributes["swept"].rpartition(".")[2]] = swept_value
    return float(predicted_ratio(attributes, attributes["r"], attributes["beta"]))


NEARLY_SMOOTH = -1 + 1e-7
"""Roughness that represents the limit beta -> -1 of a cooling gas: see `cooling_ratio`."""
INTERPOLATION_NODES = 121
"""Theory is computed at no more values than these along a line, and interpolated between them."""


def ratio_of_mixture(attributes: Attributes, r: Any, beta: Any) -> np.ndarray:
    """Return R of theory, the share of rotational energy, of all particles of a mixture.

    It has the broadcast shape of the arguments. `attributes` are the attributes of a dataset: its
    species in `species_json`, and `inertia`, `spin_share` (of the drive), `mu` or the swept
    quantity, which broadcast with `r` and `beta`. R is computed by `mixture_cooling` without a
    drive, by `mixture_driven` with the thermostat. Other drives do not determine how species share
    the translational energy: then by `mixture_rotation` with equal temperatures T_tr. A long line
    of values is interpolated between INTERPOLATION_NODES of them.
    """
    swept = attributes.get("swept", "").rpartition(".")[2]
    defaults = {"inertia": math.nan, "spin_share": 0.0, "mu": math.inf} | {swept: math.nan}
    parameters = [
        np.asarray(attributes.get(name, value), float) for name, value in defaults.items()
    ]
    broadcast = np.broadcast_arrays(r, beta, *parameters)
    columns = [np.asarray(values, float).ravel() for values in broadcast]
    varying = [column for column in columns if len(set(column.tolist())) > 1]

    def ratio_at(index: int) -> float:
        """Return R at the parameters with this `index` in the flattened arguments."""
        parameter_values = dict(
            zip(("r", "beta", *defaults), (column[index] for column in columns), strict=True)
        )
        return _mixture_ratio(attributes, parameter_values, swept)

    size = columns[0].size
    if size <= INTERPOLATION_NODES or len(varying) > 1:
        return np.reshape([ratio_at(k) for k in range(size)], broadcast[0].shape)
    sampled = np.unique(np.linspace(0, size - 1, INTERPOLATION_NODES).round().astype(int))
    interpolated = np.interp(np.arange(size), sampled, [ratio_at(k) for k in sampled])
    return np.reshape(interpolated, broadcast[0].shape)


def species_at(attributes: Attributes, parameters: Mapping[str, float], T_tr=None) -> Temperatures:
    """Return the temperatures of the species of a dataset by theory, arrays (species,).

    `attributes` are the attributes of the dataset, `parameters` as in `mixture_at`. For a driven
    gas, T_tr is the measured `T_tr`, (species,), and T_rot follows from it by `mixture_rotation`; a
    cooling gas has both from `mixture_cooling`.
    """
    gas, packing = mixture_at(attributes, parameters)
    if attributes["theory"] == "K":
        return mixture_states.mixture_cooling(gas, packing).averaged_over_radii(gas)
    measured = np.asarray(T_tr)[gas.species_of]
    return Temperatures(
        measured, mixture_states.mixture_rotation(gas, measured, packing)
    ).averaged_over_radii(gas)


def mixture_at(attributes: Attributes, parameters: Mapping[str, float]) -> tuple[Mixture, float]:
    """Return the mixture of a dataset, and its packing fraction; 0 if the box is open.

    `attributes` are the attributes of the dataset; `parameters` has r, beta and the swept quantity
    by name.
    """
    description = json.loads(attributes[SPECIES_ATTRIBUTE])
    holder_path, _, key = attributes.get("swept", "").rpartition(".")
    swept_holder = (
        species_settings(description["species"], holder_path, key)
        if holder_path.startswith(SPECIES_KEY)
        else None
    )
    if swept_holder is not None:
        swept_holder[key] = float(parameters[key])
    q, mu = (parameters.get(name, attributes.get(name)) for name in ("inertia", "mu"))
    q = None if q is None or math.isnan(q) else q
    gas_settings = int(attributes["dimension"]), q, math.inf if mu is None else mu
    gas = mixture(
        description["species"],
        parameters["r"],
        parameters["beta"],
        *gas_settings,
        description["species_pairs"],
    )
    if not description["volume"]:
        return gas, 0.0
    mean_volume = VOLUME[gas.dimension] * float(gas.fraction @ gas.radius**gas.dimension)
    return gas, int(attributes["particles"]) * mean_volume / description["volume"]


def _mixture_ratio(attributes: Attributes, parameters: Mapping[str, float], swept: str) -> float:
    """Return R of theory of all particles of a mixture at the given `parameters` (`mixture_at`).

    NaN where kicks have no steady state, as those to the spins of smooth particles. `attributes`
    are the attributes of the dataset, `swept` is the name of the swept quantity, without its
    section.
    """
    cools = attributes["theory"] == "K"
    above_smooth = {"beta": max(parameters["beta"], NEARLY_SMOOTH)} if cools else {}
    gas, packing = mixture_at(attributes, {**parameters, **above_smooth})
    if cools:
        return mixture_states.mixture_cooling(gas, packing).overall_ratio(gas)
    if "spin_share" in attributes or swept == "spin_share":
        share = parameters["spin_share"]
        power = (1 - share) * mixture_states.kick_power(gas)
        try:
            return mixture_states.mixture_driven(gas, power, packing, share).overall_ratio(gas)
        except InputError:  # contacts cannot dissipate the power
            return math.nan
    equal = np.ones(len(gas.mass))
    return Temperatures(equal, mixture_states.mixture_rotation(gas, equal, packing)).overall_ratio(
        gas
    )
