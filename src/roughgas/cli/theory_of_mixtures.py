"""What `roughgas theory --species` prints: R and temperatures of a mixture, species by species."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roughgas import theory
from roughgas.cli.quantities import GasParameters, Quantity
from roughgas.config.reading import parse_yaml, read_yaml

SOURCE = "rate equations of mixtures"


def species_from(text: str) -> Sequence[Mapping[str, Any]]:
    """Return species from a YAML file, or from YAML itself; a file may have them as `species`.

    Raises InputError for what is neither, and as `theory.mixture`; OSError for a missing file.
    """
    found = parse_yaml(text, "--species") if text.lstrip().startswith("[") else read_yaml(text)
    if isinstance(found, Mapping):
        found = found.get("species", found)
    theory.mixture(found, 1.0, 1.0)
    return found


def quantities_of_mixture(gas: GasParameters) -> dict[str, Quantity]:
    """Return all that theory says of a mixture, by name."""
    points = [_at_a_point(gas, *place) for place in zip(gas.r, gas.beta, strict=True)]
    return {
        name: Quantity(np.array([point[name].values for point in points]), *about)
        for name, (_, *about) in points[0].items()
    }


def _at_a_point(gas: GasParameters, r: float, beta: float) -> dict[str, Quantity]:
    mu = np.inf if gas.mu is None else gas.mu
    mixed = theory.mixture(gas.species, r, beta, gas.dimension, gas.inertia, mu)
    kicks, share = theory.kick_power(mixed), gas.spin_share
    states = {
        "driven": theory.mixture_driven(mixed, (1 - share) * kicks, gas.packing, share),
        "cooling": theory.mixture_cooling(mixed, gas.packing),
    }
    found = {}
    for way, state in states.items():
        found[f"R_{way}"] = Quantity(state.overall_ratio(mixed), f"R of all, {way}", SOURCE)
        for k, one in enumerate(gas.species or ()):
            name = str(one.get("name", k + 1))
            found[f"R_{way}_{name}"] = Quantity(state.R[k], f"R of {name}, {way}", SOURCE)
            about = f"T_tr of {name} over its mean, {way}"
            found[f"T_{way}_{name}"] = Quantity(state.T_tr[k], about, SOURCE)
    rates = theory.mixture_relaxation_rate, theory.mixture_decay_rate
    settles, decays = (rate(mixed, gas.packing) for rate in rates)
    found["rate_cooling"] = Quantity(settles, "rate at which ratios settle, cooling", SOURCE)
    return found | {"decay": Quantity(decays, "rate at which energy decays, cooling", SOURCE)}
