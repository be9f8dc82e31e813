"""Observables of a run, by their names in settings.

To add one is to add a file with a class (see roughgas.observables.plugin), and its line in KINDS.
An observable that nobody asks for is not made, and costs nothing.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

from roughgas import effects
from roughgas.base import InputError, NeedsError, not_one_of
from roughgas.effects.settings import schema_of_kinds
from roughgas.observables.autocorrelation import Autocorrelation, FluxAutocorrelation
from roughgas.observables.contacts import Contacts
from roughgas.observables.distributions import (
    Cumulants,
    Histograms,
    MeanSquareDisplacement,
    PairCorrelation,
    SpinCorrelation,
)
from roughgas.observables.fields import HeatFlux, Profiles, Stress
from roughgas.observables.flow import LocalFlow
from roughgas.observables.layers import Layer, Pattern
from roughgas.observables.plugin import (
    Frame,
    Function,
    Observable,
    OfSpecies,
    Setting,
    System,
    Whole,
)

__all__ = ["KINDS", "Frame", "Observable", "System"]

KINDS: dict[str, type[Observable]] = {
    "profiles": Profiles,
    "cumulants": Cumulants,
    "histograms": Histograms,
    "spin_correlation": SpinCorrelation,
    "pair_correlation": PairCorrelation,
    "stress": Stress,
    "heat_flux": HeatFlux,
    "local_flow": LocalFlow,
    "contacts": Contacts,
    "mean_square_displacement": MeanSquareDisplacement,
    "autocorrelation": Autocorrelation,
    "flux_autocorrelation": FluxAutocorrelation,
    "layer": Layer,
    "pattern": Pattern,
}
"""The observables by the names that they have in settings."""
EVERY = Whole("Samples from one observation to the next.", 1, 1_000_000, 1)
"""A setting of all of them."""


class Wanted(NamedTuple):
    """An observable that is asked for; a new one is made for every gas."""

    name: str
    every: int  # samples from one look to the next
    make: Callable[[System], Observable]


def wanted(
    settings: Mapping[str, Mapping[str, Any]],
    functions: Mapping[str, Callable[[Frame], Any]] | None = None,
) -> list[Wanted]:
    """Return the observables of settings, by name, and those that are functions of a user's.

    Raises InputError for unknown names, and for settings that are unknown or illegal.
    """
    found = [_wanted(name, given) for name, given in settings.items()]
    for name, function in (functions or {}).items():
        if name in KINDS or not name.isidentifier():
            raise InputError("observe", name, "be a name, and not that of another observable")
        found.append(Wanted(name, 1, partial(Function, name=name, function=function)))
    return found


def _wanted(name, given):
    if name not in KINDS:
        raise not_one_of("observables: key", name, KINDS)
    kind, known = KINDS[name], _settings(KINDS[name])
    for key in given:
        if key not in known:
            raise not_one_of(f"observables.{name}: key", key, known)
    values = {key: _read(f"observables.{name}.{key}", given.get(key), known[key]) for key in known}
    every = values.pop("every")

    def make(system):
        if kind.spins and system.inertia is None:
            raise NeedsError(f"observables.{name}", "spin")
        if system.species and not _sums_contacts(kind):
            return OfSpecies(kind, system, values)
        return kind(system, **values)

    return Wanted(name, every, make)


def _sums_contacts(kind: type[Observable]) -> bool:
    """Return whether an observable rests on sums over contacts, which have no parts by species."""
    return any(effects.KINDS[name].hooks.sums for name in kind.effects)


def _settings(kind: type[Observable]) -> dict[str, Setting]:
    return {**kind.settings, "every": EVERY}


def _read(key, value, setting):
    return setting.default if value is None else setting.read(key, value)


def effects_of(names: Iterable[str]) -> dict[str, dict[str, Any]]:
    """Return the settings of the effects that observables of these names need."""
    kinds = (KINDS[name] for name in names if name in KINDS)
    return {effect: {} for kind in kinds for effect in kind.effects}


def schema() -> dict[str, Any]:
    """Return what `observables` may hold in settings, as a JSON schema; null takes one away."""
    description = "Observables of a run; one that is not listed costs nothing."
    return schema_of_kinds(description, KINDS, _settings)
