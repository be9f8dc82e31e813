"""Effects from files of users act, are checked, and have their own kernels."""

import importlib
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest
from raw import build

import roughgas
from roughgas import effects
from roughgas.base import InputError
from roughgas.base.fields import Settings
from roughgas.compiling.jit import jit
from roughgas.effects.settings import register
from roughgas.kernel import hooks
from roughgas.scene import conserves_momentum

DRAG = '''
"""A drag: all particles lose a share of their velocities at the same instants."""

import math
from typing import Annotated, NamedTuple

import numpy as np

from roughgas.base.fields import Settings, number
from roughgas.compiling.jit import jit
from roughgas.effects.settings import register
from roughgas.kernel.mathematics import scale
from roughgas.kernel.particles import enter_box, set_path_and_book
from roughgas.kernel.state import EXPONENT, NOBODY


class DragSettings(Settings, frozen=True, kw_only=True):
    """Settings of `linear_drag`."""

    drag: Annotated[float, number("(0, 1000]", "Drag gamma on velocities, in 1/T.")]
    interval: Annotated[float, number("[0.001, 1000]", "Between steps, in T.")] = 0.25


class Drag(NamedTuple):
    """All particles lose a share of their velocities at the same instants."""

    interval: float
    kept: float

    @classmethod
    def from_settings(cls, settings, context):
        return cls(settings.interval, math.exp(-settings.drag * settings.interval))


def first_steps(effect, number, rng):
    return np.full(number, 0.5 * effect.interval)


@jit
def predict(effect, index, state, scene, i):
    return state.particle_times.linear_drag[i], 0


@jit
def resolve(effect, index, what, state, scene, i, time):
    position, before = enter_box(state, scene, i, time)
    after = scale(before, effect.kept)
    set_path_and_book(state, scene, i, position, before, after, time, state.ledger[0, index])
    state.changes[i] += 1
    state.particle_times.linear_drag[i] += math.ldexp(effect.interval, int(state.counts[EXPONENT]))
    return NOBODY


register(Drag, DragSettings, particle_times=first_steps, predict=predict, resolve=resolve)
'''
PACKAGE = Path(roughgas.__file__).parent
GAS = {"particles": 20, "box": (20, 20)}
STAGES = {"kind": "stages", "sample_every": 1, "stages": [{"duration": 8}]}


def gas(**effect_settings):
    """Simulate a small smooth elastic gas with these effects."""
    return roughgas.simulate(
        r=1, beta=-1, effects=effect_settings, schedule=STAGES, progress=False, **GAS
    )


@pytest.fixture(autouse=True)
def forget_registered_effects():
    """Forget the effects that a test has registered."""
    before = set(effects.EFFECTS)
    yield
    for name in set(effects.EFFECTS) - before:
        effects.forget_effect(name)


@pytest.fixture
def write_module(tmp_path, monkeypatch):
    """A function that writes a module with a text, and imports it anew."""
    monkeypatch.syspath_prepend(tmp_path)

    def write_and_import(text, name="dragging"):
        (tmp_path / f"{name}.py").write_text(text)
        importlib.invalidate_caches()
        sys.modules.pop(name, None)
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
        return importlib.import_module(name)

    yield write_and_import
    for name in [key for key, module in sys.modules.items() if _is_in(module, tmp_path)]:
        del sys.modules[name]


def _is_in(module, folder):
    """Whether a module comes from a folder."""
    return str(getattr(module, "__file__", None) or "").startswith(str(folder))


class Halved(NamedTuple):
    """Contacts have half of their restitution."""


@jit
def half(halved, index, r, state, i, j, time, speed):
    return 0.5 * r


class HalvedSettings(Settings, frozen=True, kw_only=True):
    """Settings of `halved`."""


register(Halved, HalvedSettings, restitution=half)


@pytest.mark.slow
def test_a_drag_slows_a_gas_as_its_closed_form_says(write_module):
    """E = E_0 exp(-2 gamma t) after whole intervals, and the loss is in the energy balance."""
    with pytest.raises(InputError, match=r"key = 'linear_drag': must be one of back_wall, "):
        gas(linear_drag={"drag": 0.1})
    roughgas.register_effect("linear_drag", write_module(DRAG).Drag)
    slowed = gas(linear_drag={"drag": 0.1})
    begun = slowed.E_trans_series * np.exp(0.2 * np.arange(1, 9))
    np.testing.assert_allclose(begun, begun[0], rtol=1e-12)
    assert slowed.source.values.tolist() == ["linear_drag", "contacts", "stages"]
    gained = 2.0 * float(slowed.E_trans_series[-1] - begun[0])  # two components
    assert slowed.energy_input[0, 0] == pytest.approx(gained, rel=1e-9)
    assert "-" in slowed.kernel_source_hash


def test_settings_of_a_registered_effect_are_checked(write_module):
    roughgas.register_effect("linear_drag", write_module(DRAG).Drag)
    for chosen, message in (
        ({"drag": -1}, r"linear_drag\.drag = -1: must be a number in \(0, 1000\]"),
        ({}, r"linear_drag\.drag = \(nothing\): must be "),
        ({"drag": 1, "dragg": 1}, r"key = 'dragg': must be one of drag, interval"),
    ):
        with pytest.raises(InputError, match=message):
            gas(linear_drag=chosen)
    with pytest.raises(InputError, match="did you mean linear_drag"):
        gas(linear_dragg={"drag": 1})
    effects.forget_effect("linear_drag")
    with pytest.raises(InputError, match="key = 'linear_drag'"):
        gas(linear_drag={"drag": 0.1})


def restitution_of(effect_settings):
    """(restitution of a slow contact of r = 0.9, names of the effects in order) of a scene."""
    scene = build({**GAS, "effects": effect_settings}, 0.9, -1.0)
    r = 0.9
    for k, rank, function in hooks.active(scene.effects, "restitution"):
        counts = {9: 0}  # the only entry of a state that these hooks read
        r = function(scene.effects[k], rank, r, _State(counts), 0, 1, 0.0, -0.1)
    return r, [name for name in scene.effects._fields if getattr(scene.effects, name) is not None]


class _State(NamedTuple):
    counts: dict


def test_an_effect_acts_where_it_was_registered():
    """Last by default, or before a named effect."""
    chosen = {"halved": {}, "threshold": {"speed": 1, "restitution": 0.8}}
    roughgas.register_effect("halved", Halved)
    assert restitution_of(chosen) == (0.45, ["threshold", "halved"])
    roughgas.register_effect("halved", Halved, before="threshold")
    assert restitution_of(chosen) == (0.8, ["halved", "threshold"])
    assert [*effects.EFFECTS].index("halved") == [*effects.EFFECTS].index("threshold") - 1
    roughgas.register_effect("halved", Halved, before="contact_averages")
    assert restitution_of(chosen) == (0.45, ["threshold", "halved"])


@pytest.mark.parametrize("hook", ["observe_contact", "observe_wall", "observe_thermal_wall"])
def test_an_effect_that_only_observes_comes_last(write_module, hook):
    """It has no account in the energy balance, and may not act as well."""
    looking = DRAG[: DRAG.index("register(Drag")] + (
        "@jit\ndef observe(effect, index, state, contact):\n    pass\n\n\n"
        f"register(Drag, DragSettings, {hook}=observe)\n"
    )
    acting = looking.replace("=observe", "=observe, resolve=resolve")
    with pytest.raises(InputError, match=f"be without resolve: an effect with {hook} only looks"):
        roughgas.register_effect("looking", write_module(acting, "acting").Drag)
    roughgas.register_effect("looking", write_module(looking).Drag)
    assert [*effects.EFFECTS][-1] == "looking"
    scene = build({**GAS, "effects": {"spin": {"inertia": 0.5}, "looking": {"drag": 1}}}, 1.0, 0.0)
    assert hooks.accounts(scene.effects) == 1
    with pytest.raises(InputError, match=r"looking: before = 'friction': must be one of contact_a"):
        roughgas.register_effect("looking", sys.modules["dragging"].Drag, before="friction")
    with pytest.raises(InputError, match=r"halved: before = 'contact_log': must be one of spin, "):
        roughgas.register_effect("halved", Halved, before="contact_log")


def test_scenes_without_a_registered_effect_keep_their_kernels(write_module):
    """Its types, the keys of cached machine code, are the same as before the registration."""
    scene = {**GAS, "effects": {"threshold": {"speed": 1}}}
    before = build(scene, 0.9, -1.0)
    roughgas.register_effect("halved", Halved, before="threshold")
    after = build(scene, 0.9, -1.0)
    assert type(after.effects) is effects.Effects
    assert repr(numba.typeof(after)) == repr(numba.typeof(before))
    assert effects.sources_of(after.effects) == ""
    halved_scene = build({**GAS, "effects": {"threshold": {"speed": 1}, "halved": {}}}, 0.9, -1.0)
    assert repr(numba.typeof(halved_scene)) != repr(numba.typeof(before))


HELP = (
    "from roughgas.compiling.jit import jit\n\nSHARE = 0.5\n\n\n@jit\ndef help(r):\n    return r\n"
)


def test_names_of_types_depend_on_the_sources_of_an_effect(write_module, tmp_path):
    """They depend on its file, on files it imports and on their constants, not on other files."""

    def key():
        (tmp_path / "other.py").write_text("# another time\n" * (len(keys) + 1))
        for name in ("helping", "constants"):
            sys.modules.pop(name, None)
        module = write_module("from helping import help\nfrom constants import SIZE\n" + kind)
        roughgas.register_effect("linear_drag", module.Drag)
        scene = build({**GAS, "effects": {"linear_drag": {"drag": 1}}}, 1.0, -1.0)
        assert type(scene.effects) is not effects.Effects
        return str(numba.typeof(scene)), effects.sources_of(scene.effects)

    kind, keys = DRAG, []
    (tmp_path / "helping.py").write_text(HELP)
    (tmp_path / "constants.py").write_text("SIZE = 2.0\n")
    keys += [key()]
    assert key() == keys[0]
    (tmp_path / "helping.py").write_text(HELP.replace("return r", "return 2.0 * r"))
    keys.append(key())
    (tmp_path / "constants.py").write_text("SIZE = 3.0\n")
    keys.append(key())
    kind = DRAG.replace("0.5 * effect.interval", "0.25 * effect.interval")
    keys.append(key())
    assert len(set(keys)) == 4
    roughgas.register_effect("halved", Halved)
    assert key() == keys[-1]


def test_effects_with_events_may_change_the_momentum(write_module):
    """Laws of contacts conserve the momentum; effects with events may not."""
    roughgas.register_effect("halved", Halved)
    roughgas.register_effect("linear_drag", write_module(DRAG).Drag)
    for chosen, conserved in ({"halved": {}}, True), ({"linear_drag": {"drag": 1}}, False):
        assert conserves_momentum(build({**GAS, "effects": chosen}, 1.0, -1.0)) == conserved


class Plain:
    """No NamedTuple."""


class Bare(NamedTuple):
    """An effect that is not registered."""


class Idle(NamedTuple):
    """An effect without hooks."""


class Falling(NamedTuple):
    """An effect that would change free flight."""


class Both(NamedTuple):
    """An effect that observes contacts and changes them."""


class Texts(NamedTuple):
    """An effect whose settings are of other types."""


class TextsSettings(Settings, frozen=True, kw_only=True):
    """Settings that no schema knows."""

    path: dict[str, bool]


register(Idle, HalvedSettings)
register(Falling, HalvedSettings, acceleration=half)
register(Both, HalvedSettings, observe_contact=half, restitution=half)
register(Texts, TextsSettings, restitution=half)
NAME = "have a name of lower-case letters, digits and _, a letter first"


@pytest.mark.parametrize(
    ("name", "kind", "message"),
    [
        ("Halved", Halved, f"effect = 'Halved': must {NAME}"),
        ("half way", Halved, f"effect = 'half way': must {NAME}"),
        ("lambda", Halved, f"effect = 'lambda': must {NAME}"),
        (7, Halved, f"effect = 7: must {NAME}"),
        ("spin", Halved, "effect = spin: must have a name that is free: there is spin already"),
        ("species", Halved, "effect = species: must have a name that is free: "),
        ("contacts", Halved, "effect = contacts: must have a name that is free: "),
        ("plain", Plain, "effect plain = <class"),
        ("plain", Halved(), "effect plain = Halved(): must be a class, a NamedTuple"),
        ("bare", Bare, "effect bare = Bare: must have a struct of settings and hooks, by rough"),
        ("idle", Idle, "effect idle = Idle: must have a hook (roughgas.kernel.hooks)"),
        ("falling", Falling, "effect falling = with acceleration: must leave acceleration to"),
        ("both", Both, "effect both = with restitution: must be without restitution: an effect"),
        ("texts", Texts, "effect texts: settings = TextsSettings: must have fields of numbers"),
    ],
)
def test_invalid_effects_are_refused(name, kind, message):
    order = [*effects.EFFECTS]
    with pytest.raises(InputError) as caught:
        roughgas.register_effect(name, kind)
    assert str(caught.value).startswith(message) and "\n" not in str(caught.value)
    assert [*effects.EFFECTS] == order


def test_a_name_can_be_registered_again_from_the_same_file_only(write_module):
    roughgas.register_effect("linear_drag", write_module(DRAG).Drag)
    roughgas.register_effect("linear_drag", write_module(DRAG).Drag)
    with pytest.raises(InputError, match="there is linear_drag already"):
        roughgas.register_effect("linear_drag", Halved)
    with pytest.raises(InputError, match="effect = 'spin': must be one of linear_drag"):
        effects.forget_effect("spin")


def test_a_file_that_has_changed_since_it_was_imported_is_refused(write_module, tmp_path):
    """Otherwise the cache would take the kernel of the old text for the new one."""
    module, file = write_module(DRAG), tmp_path / "dragging.py"
    roughgas.register_effect("linear_drag", module.Drag)
    for text in (DRAG.replace("scale(before, effect.kept)", "scale(before, 0.5)"), DRAG + "\n("):
        file.write_text(text)
        with pytest.raises(InputError) as caught:
            roughgas.register_effect("linear_drag", module.Drag)
        message = (
            "effect linear_drag: file = dragging.py: must be imported anew (importlib.reload): "
        )
        assert str(caught.value).startswith(message)
    file.write_text(DRAG + "# a remark\n")
    roughgas.register_effect("linear_drag", module.Drag)


def test_an_effect_without_a_file_is_refused():
    names = {"__name__": "nowhere"}
    exec(compile(DRAG, "<typed>", "exec"), names)
    with pytest.raises(InputError, match="be defined in a file that is imported"):
        roughgas.register_effect("linear_drag", names["Drag"])


PROGRAM = """
import json
import sys
import roughgas
from dragging import Drag
from roughgas.kernel.record import record

def gas(**effects):
    schedule = {"kind": "stages", "sample_every": 1, "stages": [{"duration": 8}]}
    scene = {"particles": 20, "box": (20, 20), "effects": effects, "schedule": schedule}
    made = roughgas.simulate(r=1, beta=-1, progress=False, **scene)
    hits, misses = record.dispatcher.stats[1:]
    return [sum(hits.values()), sum(misses.values()), *made.E_trans_series.values.tolist()]

plain = gas()
roughgas.register_effect("linear_drag", Drag)
print(json.dumps([plain, gas(), gas(linear_drag={"drag": 0.1})]))
"""


@pytest.mark.slow
def test_a_kernel_is_compiled_anew_for_another_file_only(tmp_path):
    """The cache has kernels of an unchanged file, and kernels without the effect in any case."""

    def run(text, program=PROGRAM):
        (tmp_path / "dragging.py").write_text(text)
        paths = os.pathsep.join([str(tmp_path), str(PACKAGE.parent)])
        variables = {"PYTHONPATH": paths, "ROUGHGAS_CACHE_DIR": str(tmp_path / "cache")}
        command = [sys.executable, "-B", "-c", program]
        process = subprocess.run(
            command, env=os.environ | variables, stdout=subprocess.PIPE, check=True
        )
        gases = json.loads(process.stdout)
        assert gases[0][2:] == gases[1][2:]  # the same bits, registered or not
        return [gas[:2] for gas in gases], gases[2][2:]

    first, energies = run(DRAG)
    assert first == [[0, 1], [0, 1], [0, 2]]
    assert run(DRAG) == ([[1, 0], [1, 0], [2, 0]], energies)
    edited, edited_energies = run(DRAG.replace("scale(before, effect.kept)", "scale(before, 0.5)"))
    assert edited == [[1, 0], [1, 0], [1, 1]]
    decay = np.log(np.array(edited_energies)[1:] / edited_energies[:-1])
    np.testing.assert_allclose(decay, 8.0 * np.log(0.5), rtol=1e-9)
