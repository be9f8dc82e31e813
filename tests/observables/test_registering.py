"""Observables of users: they are checked, measured, and saved in datasets."""

from collections.abc import Mapping
from typing import Annotated, NamedTuple

import numpy as np
import pytest
from schedules import STEADY

import roughgas
from roughgas import observables
from roughgas.base import InputError
from roughgas.base.fields import number
from roughgas.data.variables import Variable
from roughgas.observables import Observable
from roughgas.observables.plugin import ObservableSettings

GAS = {
    "particles": 20,
    "box": (25, 25),
    "effects": {"spin": {"inertia": 0.5}, "thermostat": {"power": 1, "spin_share": 0.5}},
    "schedule": STEADY,
}
GAS["effects"]["thermostat"]["interval"] = 0.5


class FastSettings(ObservableSettings, frozen=True, kw_only=True):
    """Settings of `fast`."""

    above: Annotated[float, number("[0, 100]", "Speed of the slowest that count, in a/T.")] = 1.0


class Fast(Observable):
    """The share of fast particles, and of their energy in the energy of all."""

    settings = FastSettings
    variables: Mapping[str, Variable] = {
        "fast_share": Variable("share of fast particles"),
        "fast_energy": Variable("share of fast particles in the energy of translation"),
    }

    def __init__(self, system, above):
        super().__init__(system)
        self._above = above

    def observe(self, frame):
        square = (frame.velocity**2).sum(axis=1)
        fast = square > self._above**2
        return {"fast": fast.mean(), "energy": square[fast].sum(), "whole": square.sum()}

    def combine(self, means):
        return {"fast_share": means["fast"], "fast_energy": means["energy"] / means["whole"]}


def gas(observe, **changes):
    return roughgas.simulate(r=0.9, beta=0.5, observe=observe, progress=False, **(GAS | changes))


@pytest.fixture(autouse=True)
def unregister():
    """Unregister the observables of each test after it."""
    before = set(observables.OBSERVABLES)
    yield
    for name in set(observables.OBSERVABLES) - before:
        observables.forget_observable(name)


def share(frame):
    """Return the share of fast particles in a frame, as a function for a threshold of 1.5 a/T."""
    return ((frame.velocity**2).sum(axis=1) > 2.25).mean()


@pytest.mark.slow
def test_a_registered_observable_is_measured_in_a_run():
    """Its variables are in the point, with errors, units and meanings; its settings count."""
    with pytest.raises(InputError, match="key = 'fast': must be one of autocorrelation, "):
        gas(["fast"])
    roughgas.register_observable("fast", Fast)
    dataset = gas({"fast": {"above": 1.5}, "as_function": share})
    assert 0.0 < float(dataset.fast_share) < float(dataset.fast_energy) < 1.0
    assert float(dataset.fast_share) == pytest.approx(float(dataset.as_function), rel=1e-12)
    assert float(dataset.fast_share_stderr) == pytest.approx(float(dataset.as_function_stderr))
    assert dataset.fast_share.attrs["long_name"] == "share of fast particles"
    assert {"fast_energy_stderr", "fast_energy_dof", "fast_energy_trusted"} <= set(
        dataset.variables
    )
    assert float(gas(["fast"]).fast_share) > float(dataset.fast_share)  # faster than 1
    assert float(gas({"fast": {"above": 0, "every": 4}}).fast_share) == 1.0


@pytest.mark.slow
def test_a_registered_observable_is_averaged_over_seeds_and_split_by_species():
    roughgas.register_observable("fast", Fast)
    both_seeds = gas(["fast"], seed=[1, 2])
    shares = [float(gas(["fast"], seed=seed).fast_share) for seed in (1, 2)]
    assert float(both_seeds.fast_share.squeeze()) == pytest.approx(np.mean(shares))
    mixed = gas(["fast"], species=[{"fraction": 0.5}, {"fraction": 0.5, "mass": 4}])
    light, heavy = mixed.fast_share_species.values
    assert heavy < float(mixed.fast_share) < light


def test_settings_of_a_registered_observable_are_checked():
    roughgas.register_observable("fast", Fast)
    for chosen, message in (
        ({"fast": {"above": -1}}, r"fast\.above = -1: must be a number in \[0, 100\]"),
        ({"fast": {"abov": 1}}, r"key = 'abov': must be one of above, every"),
        ({"fasts": {}}, "did you mean fast"),
    ):
        with pytest.raises(InputError, match=message):
            gas(chosen)
    observables.forget_observable("fast")
    with pytest.raises(InputError, match="key = 'fast'"):
        gas(["fast"])


class WithoutDefault(Fast):
    """An observable with a setting that has no default."""

    class settings(ObservableSettings, frozen=True, kw_only=True):
        """A setting without a default."""

        above: Annotated[float, number("[0, 100]", "A speed.")]


class FrictionObservable(Fast):
    """An observable of an effect that needs settings."""

    effects = ("friction",)


class TakenVariable(Fast):
    """An observable with the name of a variable of points."""

    variables: Mapping[str, Variable] = {"E_trans": Variable("energy")}


class OtherSettings(Fast):
    """An observable with a settings class of another kind."""

    settings = int


class NoObservable(NamedTuple):
    """A class of another kind."""


@pytest.mark.parametrize(
    ("name", "kind", "message"),
    [
        ("Fast", Fast, "observable = 'Fast': must have a name of lower-case letters, digits"),
        ("stress", Fast, "observable = stress: must have a name that is free: there is stress"),
        ("fast", NoObservable, "observable fast = <class"),
        ("fast", share, "observable fast = <function share at"),
        ("fast", WithoutDefault, "observable fast: above = (nothing): must have a default"),
        ("fast", FrictionObservable, "observable fast: effect = friction: must be one of "),
        (
            "fast",
            TakenVariable,
            "observable fast: variable = E_trans: must have a name that points",
        ),
        ("fast", OtherSettings, "observable fast: settings = int: must be derived from Obs"),
    ],
)
def test_an_illegal_observable_is_refused(name, kind, message):
    registered = [*observables.OBSERVABLES]
    with pytest.raises(InputError) as caught:
        roughgas.register_observable(name, kind)
    assert str(caught.value).startswith(message) and "\n" not in str(caught.value)
    assert [*observables.OBSERVABLES] == registered


def test_a_name_is_free_for_the_same_class_and_no_other():
    roughgas.register_observable("fast", Fast)
    roughgas.register_observable("fast", Fast)
    with pytest.raises(InputError, match="there is fast already"):
        roughgas.register_observable("fast", OtherSettings)
    with pytest.raises(InputError, match="observable = 'stress': must be one of fast"):
        observables.forget_observable("stress")
