"""Which equation a dataset obeys, and what it says of R."""

import math
from collections.abc import Container, Mapping
from typing import Any, NamedTuple

import numpy as np

from roughgas.theory.mixture_composition import SPECIES


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
    if SPECIES in attributes:
        from roughgas.theory.prediction_of_mixtures import name_of_mixture

        return Equation(kind, name_of_mixture(attributes, kind))
    if "mu" in attributes or swept == "mu":
        return Equation(kind, "rate equations with Coulomb friction")
    if kind == "K":
        return Equation(kind, "theory of free cooling")
    if "spin_share" not in attributes and swept == "spin_share":
        return Equation(kind, "rate equations")
    share = attributes.get("spin_share", 0.0)
    return Equation(kind, f"rate equations, spin share {share:g}" if share else "Lun's formula")


def predicted_ratio(attributes: Mapping[str, Any], r: Any, beta: Any) -> np.ndarray:
    """Return R of theory, over the broadcast shape of its arguments; NaN where nothing spins, and
    for a cooling gas at beta = -1: contacts leave spins alone there, and R has no stationary value.

    That is the theory of free cooling for a gas without a drive, Lun's formula for one whose drive
    adds translation only, and the result of the rate equations for other drives, and for friction.
    `attributes` are those of a reduced dataset, with what is its third axis: `inertia`,
    `spin_share` (of the drive), or `mu`; these broadcast with `r` and `beta`. Mixtures have
    `species_json`, and a theory of their own.
    """
    if SPECIES in attributes:
        from roughgas.theory.prediction_of_mixtures import ratio_of_mixture

        return ratio_of_mixture(attributes, r, beta)
    from roughgas import theory

    names = {"inertia": math.nan, "spin_share": 0.0, "mu": math.inf}
    given = (attributes.get(name, value) for name, value in names.items())
    r, beta, q, share, mu = np.broadcast_arrays(*(np.asarray(x, float) for x in (r, beta, *given)))
    if np.isnan(q).any():
        return np.full(r.shape, math.nan)
    dimension, driven = int(attributes["dimension"]), attributes["theory"] != "K"
    of_drive = share if driven else None
    if np.isfinite(mu).any():
        found = theory.friction_ratio(r, beta, mu, dimension, q, of_drive)
    else:
        found = theory.stationary_ratio(r, beta, dimension, q, of_drive)
    return np.where((beta == -1.0) & (not driven), math.nan, found)


def ratio_of_point(point: Any) -> float:
    """Return R of theory for a point (a Dataset); NaN where there is none.

    Where a quantity of a species is swept, it is the value that counts.
    """
    about = point.attrs | {"theory": equation_of(point.attrs, point).kind}
    if not isinstance(value := about.get("swept_value", ""), str):
        about[about["swept"].rpartition(".")[2]] = value
    return float(predicted_ratio(about, about["r"], about["beta"]))
