"""Observables of a run, by their names in settings.

A new observable takes a file with a class (see roughgas.observables.plugin), and a line in
OBSERVABLES; `register_observable` adds observables from files of users. An observable that is not
requested is not instantiated, and costs nothing.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

from msgspec.structs import asdict

from roughgas import effects
from roughgas.base import InputError, NeedsError, short_repr, unknown_name_error
from roughgas.base.fields import Schema, required_by, schema_of_kinds
from roughgas.base.files import package_of_study
from roughgas.data.variables import POINT
from roughgas.effects.user_code import check_name, check_settings, is_same_definition
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
from roughgas.observables.frames import Frame, FrameSeries, System
from roughgas.observables.plugin import (
    FunctionObservable,
    Observable,
    ObservableSettings,
    SpeciesObservable,
)
from roughgas.observables.shaken_layer import Layer, Pattern
from roughgas.observables.walls import WallForces

__all__ = ["OBSERVABLES", "Frame", "FrameSeries", "Observable", "System"]

OBSERVABLES: dict[str, type[Observable]] = {
    "profiles": Profiles,
    "cumulants": Cumulants,
    "histograms": Histograms,
    "spin_correlation": SpinCorrelation,
    "pair_correlation": PairCorrelation,
    "stress": Stress,
    "heat_flux": HeatFlux,
    "wall_forces": WallForces,
    "local_flow": LocalFlow,
    "contacts": Contacts,
    "mean_square_displacement": MeanSquareDisplacement,
    "autocorrelation": Autocorrelation,
    "flux_autocorrelation": FluxAutocorrelation,
    "layer": Layer,
    "pattern": Pattern,
}
"""The classes of observables by their names in settings."""
_REGISTERED: set[str] = set()


OF_STUDIES: dict[str, dict[str, Any]] = {}
"""Classes of observables that studies register, by the study's package and by name."""


def register_observable(name: str, observable_class: Any) -> None:
    """Register a class of observables of a user under a name: see `roughgas.register_observable`.

    An observable of a study is only noted, in OF_STUDIES: experiments of the study add it, and
    check it then. Raises InputError as `add_observable`.
    """
    if package := package_of_study(observable_class):
        OF_STUDIES.setdefault(package, {})[name] = observable_class
    else:
        add_observable(name, observable_class)


def add_observable(name: str, observable_class: Any) -> None:
    """Add a class of a user to the observables, under a name, until `forget_observable`.

    Raises InputError for an illegal name or class: a setting without a default, an unknown effect,
    or a variable that points have already.
    """
    redefined = name in _REGISTERED and is_same_definition(OBSERVABLES[name], observable_class)
    check_name("observable", name, taken=name in OBSERVABLES and not redefined)
    key = f"observable {name}"
    if not (isinstance(observable_class, type) and issubclass(observable_class, Observable)):
        raise InputError(
            key,
            short_repr(observable_class),
            "be a class derived from roughgas.observables.Observable",
        )
    check_settings(key, observable_class.settings, ObservableSettings)
    if missing := required_by(observable_class.settings):
        raise InputError(f"{key}: {missing[0]}", "(nothing)", "have a default")
    for effect in observable_class.effects:
        without_settings = [
            effect_name
            for effect_name, effect_class in effects.EFFECTS.items()
            if not required_by(effect_class.settings)
        ]
        if effect not in without_settings:
            raise unknown_name_error(f"{key}: effect", effect, without_settings)
    for variable in sorted(observable_class.variables.keys() & POINT.keys()):
        raise InputError(f"{key}: variable", variable, "have a name that points do not have")
    OBSERVABLES[name] = observable_class
    _REGISTERED.add(name)


def forget_observable(name: str) -> None:
    """Remove a registered observable; raise InputError for any other name."""
    if name not in _REGISTERED:
        registered = ", ".join(sorted(_REGISTERED)) or "(none)"
        raise InputError("observable", short_repr(name), f"be one of {registered}")
    _REGISTERED.remove(name)
    del OBSERVABLES[name]


class RequestedObservable(NamedTuple):
    """An observable that a run requests; it is instantiated for every gas."""

    name: str
    every: int  # samples between observations
    make: Callable[[System], Observable]


def requested_observables(
    settings: Mapping[str, ObservableSettings],
    functions: Mapping[str, Callable[[Frame], Any]] | None = None,
) -> list[RequestedObservable]:
    """Return the observables in `settings`, by name, and observables made of users' `functions`.

    `functions` are functions of a frame, by the name of their observable. Raises InputError for
    illegal names of functions.
    """
    requests = [_requested_observable(name, chosen) for name, chosen in settings.items()]
    for name, function in (functions or {}).items():
        if name in OBSERVABLES or not name.isidentifier():
            raise InputError("observe", name, "be a name, and not that of another observable")
        requests.append(
            RequestedObservable(name, 1, partial(FunctionObservable, name=name, function=function))
        )
    return requests


def _requested_observable(name, settings):
    """Return the request of the observable `name` with these settings."""
    observable_class, arguments = OBSERVABLES[name], asdict(settings)
    every = arguments.pop("every")

    def make(system):
        """Return the observable of a gas; raise NeedsError if it needs spins and nothing spins."""
        if observable_class.needs_spin and system.inertia is None:
            raise NeedsError(f"observables.{name}", "spin")
        if system.species and not (
            issubclass(observable_class, FunctionObservable) or _sums_contacts(observable_class)
        ):
            return SpeciesObservable(observable_class, system, arguments)
        return observable_class(system, **arguments)

    return RequestedObservable(name, every, make)


def _sums_contacts(observable_class: type[Observable]) -> bool:
    """Return whether an observable needs sums over contacts, which cover all species at once."""
    return any(effects.EFFECTS[name].hooks.sums for name in observable_class.effects)


def effects_of(names: Iterable[str]) -> list[str]:
    """Return the names of the effects that the observables `names` need; these need no settings."""
    return [effect for name in names for effect in OBSERVABLES[name].effects]


def schema() -> Schema:
    """Return the JSON schema of `observables` in settings; null removes an observable."""
    description = "Observables of a run; one that is not listed costs nothing."
    return schema_of_kinds(description, OBSERVABLES)
