"""What theory says of gases: every number with its equation."""

from typing import Any, NamedTuple

from roughgas import theory
from roughgas.theory.prediction import equation_of, predicted_ratio

TOLERANCE = 0.01  # of R, within which it counts as settled


class Gas(NamedTuple):
    """Points (r, beta), arrays of equal shape, and what they share; no friction: `mu` is None."""

    r: Any
    beta: Any
    dimension: int
    inertia: float
    spin_share: float
    mu: float | None


class Quantity(NamedTuple):
    """An array over the points, what it is, and which equation it is from."""

    values: Any
    meaning: str
    source: str


def quantities(gas: Gas) -> dict[str, Quantity]:
    """Return all that theory says of a gas, by name."""
    about = {"dimension": gas.dimension, "inertia": gas.inertia, "spin_share": gas.spin_share}
    if gas.mu is not None:
        about["mu"] = gas.mu
    drive = "through translation" if gas.spin_share == 0.0 else f"spin share {gas.spin_share:g}"
    found = {}
    for name, kind, way in (("driven", "lun", f"driven, {drive}"), ("cooling", "K", "cooling")):
        obeying = about | {"theory": kind}
        R = predicted_ratio(obeying, gas.r, gas.beta)
        found[f"R_{name}"] = Quantity(R, f"R, {way}", equation_of(obeying).name)
    return found | (_relaxation(gas) if gas.mu is None else _friction(gas))


def _relaxation(gas: Gas) -> dict[str, Quantity]:
    """Return how fast R settles and energy decays."""
    point, source = (gas.r, gas.beta), "rate equations"
    spins = {"dimension": gas.dimension, "inertia": gas.inertia}
    until = f"collisions per particle until R is there to {TOLERANCE:.0%}"
    found = {}
    for name, share in (("driven", gas.spin_share), ("cooling", None)):
        rate = theory.relaxation_rate(*point, **spins, spin_share=share)
        needed = theory.collisions_to_relax(*point, TOLERANCE, **spins, spin_share=share)
        found[f"rate_{name}"] = Quantity(rate, f"rate at which R settles, {name}", source)
        found[f"settled_{name}"] = Quantity(needed, f"{until}, {name}", source)
    decay = theory.decay_rate(*point, **spins)
    return found | {"decay": Quantity(decay, "rate at which energy decays, cooling", "Haff's law")}


def _friction(gas: Gas) -> dict[str, Quantity]:
    """Return how fast R settles and how often contacts slide, if they can."""
    spins, source = (gas.mu, gas.dimension, gas.inertia), "rate equations with Coulomb friction"
    rate = theory.friction_relaxation_rate(gas.r, gas.beta, *spins)
    R = theory.friction_ratio(gas.r, gas.beta, *spins, gas.spin_share)
    sliding = theory.sliding_fraction(1.0 - R, R, gas.r, gas.beta, *spins)
    critical = "mu below which a gas of fast spins keeps them, cooling"
    return {
        "rate_cooling": Quantity(rate, "rate at which R settles, cooling", source),
        "sliding": Quantity(sliding, "share of contacts that slide, driven", source),
        "mu_c": Quantity(theory.critical_friction(gas.r), critical, "sqrt((1 - r)/(1 + r))"),
    }
