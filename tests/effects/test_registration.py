"""Hooks are registered by name: nothing else in an effect's file is one."""

from typing import NamedTuple

import pytest
from brute_force import begin, settings

from roughgas.effects import KINDS, friction, thermostat
from roughgas.effects.settings import Number, register
from roughgas.kernel.hooks import Hooks, present


def test_a_misspelt_hook_is_refused():
    class Drag(NamedTuple):
        strength: float

    with pytest.raises(TypeError, match="unexpected keyword argument 'resolv'"):
        register(Drag, {"strength": Number("Strength.")}, resolv=thermostat.resolve)
    assert not hasattr(Drag, "hooks")


def test_a_name_that_is_only_in_the_file_is_no_hook(monkeypatch):
    monkeypatch.setattr(friction, "resolve", thermostat.resolve, raising=False)
    monkeypatch.setattr(friction, "drives", True, raising=False)
    scene, _ = begin(settings("friction"), 0.9, -1.0)
    assert not present(scene.effects, "resolve") and not present(scene.effects, "drives")
    ((place, rank, own),) = present(scene.effects, "roughness")
    assert (scene.effects._fields[place], rank, own) == ("friction", 1, friction.roughness)


def test_every_effect_has_hooks_and_parameters():
    for name, kind in KINDS.items():
        assert isinstance(kind.hooks, Hooks) and kind.parameters is not None, name
        assert name == "spin" or any(kind.hooks), name
