"""The kernel has the same bits compiled and as plain Python; and the source that is compiled."""

import subprocess
import sys
from typing import NamedTuple

import numpy as np
import pytest
import schemes
from brute_force import begin, settings
from brute_force.scenes import RARE, kernels
from compiled import from_python
from project import ROOT

from kernel.test_cells import sheared_or_slow
from roughgas.compiling.jit import jit
from roughgas.effects import Effects
from roughgas.effects.gravity import Gravity
from roughgas.effects.settings import register
from roughgas.kernel import hooks
from roughgas.kernel.hooks import active
from roughgas.kernel.record import Sampling, allocate_frames, columns, record

TWO_SPECIES = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5}]
BOXES = {2: [14, 14], 3: [12, 12, 12]}
SWEPT = ("smooth", "gas", "sheared", "bed", "walled", "spheres", "heated", "container", *RARE)
CELLS = ("sheared", "walled", "spheres")
WAVES = {name: settings("bed", floor={"wave": name}) for name in ("triangle", "sine")}
# the order in these depends on the width of registers, which plain Python does not have
SCRATCH = ("slot_time", "slot_partner", "slot_change", "found", "when")


def arrays(state, name=""):
    """Name -> array of a state, without scratch arrays."""
    if isinstance(state, np.ndarray):
        return {} if name in SCRATCH else {name: state}
    nested = [arrays(getattr(state, key), key) for key in getattr(state, "_fields", ())]
    return {
        f"{name}.{key}": array for named_arrays in nested for key, array in named_arrays.items()
    }


def assert_plain_python_has_the_same_bits(experiment, collisions=25):
    """Run an experiment compiled and as plain Python, and compare all arrays."""
    ends = []
    for advance in (record, record.py_func):
        beta = 0.3 if "spin" in experiment["effects"] else -1.0
        scene, state = begin(experiment, 0.9, beta, 3)
        rows = np.empty((3, len(columns(scene))))
        refresh = 0 if active(scene.effects, "drives") else 2
        with np.errstate(all="ignore"):  # infinite times
            sampling = Sampling(np.inf, collisions, refresh, every=2)
            frames = allocate_frames(state, 1)
            ended = advance(state, scene, sampling, rows, frames)
        copies = arrays(frames, "frames")
        ends.append(arrays(state) | copies | {"rows": rows, "ended": np.array(ended)})
    compiled, plain = ends
    for name, array in compiled.items():
        assert array.tobytes() == plain[name].tobytes(), name
    assert rows[-1, 1] == 3 * collisions


def of_ten(kernel, **changes):
    """The settings of a scene of ten particles."""
    box = settings(kernel)["box"]
    lengths = BOXES[len(box)]
    top = "open" if box[-1] == "open" else lengths[-1]
    return settings(kernel, 10, [*lengths[:-1], top]) | changes


@pytest.mark.parametrize("kernel", kernels(*SWEPT))
def test_scenes_run_as_plain_python(kernel):
    assert_plain_python_has_the_same_bits(of_ten(kernel))


@pytest.mark.parametrize("kernel", ["gas", pytest.param("heated", marks=pytest.mark.slow)])
def test_mixtures_run_as_plain_python(kernel):
    assert_plain_python_has_the_same_bits(of_ten(kernel, species=TWO_SPECIES, box=[20, 20]))


@pytest.mark.slow  # compiles kernels
@pytest.mark.parametrize("wave", WAVES)
def test_floors_run_as_plain_python(wave):
    size = {"particles": 10, "box": [14, "open"]}
    assert_plain_python_has_the_same_bits(WAVES[wave] | size, collisions=8)


@pytest.mark.parametrize("kernel", sheared_or_slow(CELLS))
def test_cells_run_as_plain_python(kernel, monkeypatch):
    run_in_cells(kernel, monkeypatch)


def test_lists_run_as_plain_python(monkeypatch):
    run_in_cells("walled", monkeypatch, neighbours="lists")


def run_in_cells(kernel, monkeypatch, **changes):
    """Compare both on ten particles that are sorted into cells."""
    schemes.use_smallest_cells(monkeypatch)
    box = [17, *settings(kernel)["box"][1:]]
    box[1:] = [length if length == "open" else 17 for length in box[1:]]
    assert_plain_python_has_the_same_bits(settings(kernel, 10, box) | changes, collisions=10)


# ---------------------------------------------------------------------- the source that is compiled


class Inner(NamedTuple):
    weights: tuple
    count: object


class Outer(NamedTuple):
    inner: Inner
    nothing: None


# branches on aliases of fields, all decided by types
@jit
def aliases(outer, x):
    inner, nothing = outer.inner, outer.nothing
    weights = inner.weights
    doubled = tuple(2.0 * weights[k] for k in range(len(weights)) if k != 1)
    if nothing is not None or (inner.count is None and len(doubled) == 7):
        return undefined(x)  # noqa: F821
    y = x if not (nothing is None and len(doubled) > 1) else doubled[1]
    if inner.weights is not None:
        return x + y + len(weights)
    return undefined(x)  # noqa: F821


@jit
def reassigned(x):
    """A loop on a variable whose type changes."""
    while x is not None:
        x = None
    return x


@jit
def misspelt(outer):
    """A branch on a field that does not exist."""
    return 1.0 if outer.innre is None else 2.0


@jit
def velocity_after_gravity(effects, v):
    """Velocity after unit time under all effects with an acceleration."""
    g = 0.0
    for hook in active(effects, "acceleration"):
        g += hook.function(effects[hook.effect_index], hook.account)[1]
    return v + g if active(effects, "acceleration") else v


@jit
def digits_of_phases(effects):
    """The phases of all effects as digits of a number."""
    total = 0.0
    for hook in active(effects, "phase"):
        total = 10.0 * total + hook.function(effects[hook.effect_index], hook.account, 0.0)
    return total


def digit(number):
    """An effect whose hook has the name and the file of other effects' hooks."""

    class Digit(NamedTuple):
        value: float

    @jit
    def phase(effect, index, base):
        return number * effect.value

    register(Digit, {}, phase=phase)
    return Digit(1.0)


OUTER = Outer(Inner((1.0, 2.0, 3.0), 4), None)


def test_conditions_on_types_are_decided_when_compiled():
    assert from_python(aliases)(OUTER, 0.5) == aliases(OUTER, 0.5) == 9.5
    (written,) = aliases.specialised.values()
    assert len(written.body) == 5  # statements after the decided return are cut
    for effects in (Effects(), Effects(gravity=Gravity((None, -2.0)))):
        assert from_python(velocity_after_gravity)(effects, 3.0) == velocity_after_gravity(
            effects, 3.0
        )
    assert from_python(hooks.acceleration)(Effects()) is None


def test_hooks_of_the_same_name_are_distinguished():
    effects = digit(1.0), digit(2.0), digit(3.0)
    assert from_python(digits_of_phases)(effects) == digits_of_phases(effects) == 123.0


@pytest.mark.parametrize(
    ("function", "argument", "message"),
    [
        (reassigned, 1.0, "reassigned, line [0-9]+: x is not None: types do not decide it"),
        (misspelt, OUTER, "Outer has no innre"),
    ],
)
def test_undecided_conditions_are_refused(function, argument, message):
    with pytest.raises(Exception, match=message):
        from_python(function)(argument)


def show(*options):
    """Run `python -m roughgas.kernel` with these options."""
    command = [sys.executable, "-m", "roughgas.kernel", *options]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


@pytest.mark.slow  # compiles a kernel
def test_a_function_is_shown_as_it_is_compiled_for_a_scene():
    shown = show("--show", "collide", "--scene", "cooling").stdout
    assert shown.startswith("# roughgas.kernel.contact") and "n = direction(" in shown
    assert (
        "None" not in shown and "observe_contact" not in shown and "change_spin_and_book" in shown
    )


@pytest.mark.parametrize(
    ("function", "scene", "message"),
    [
        ("colide", "cooling", "--show = colide: must be a compiled function"),
        ("collide", "coolin", "experiment = 'coolin': must be one of cooling"),
        pytest.param(
            *("resolve_wall", "cooling", "resolve_wall: must be compiled for this scene"),
            marks=pytest.mark.slow,  # which compiles it
        ),
    ],
)
def test_functions_that_cannot_be_shown_are_refused_in_one_line(function, scene, message):
    process = show("--show", function, "--scene", scene)
    assert (process.returncode, process.stdout, process.stderr.count("\n")) == (2, "", 1)
    assert message in process.stderr
