"""The kernel as plain Python, beside what is compiled; and functions as they are written."""

import subprocess
import sys
from typing import NamedTuple

import numpy as np
import pytest
from brute_force import begin, settings
from brute_force.scenes import RARE
from compiled import from_python
from project import ROOT

from kernel.test_cells import sheared_or_slow
from roughgas.compiling.jit import jit
from roughgas.effects import Effects
from roughgas.effects.drives import Gravity
from roughgas.effects.settings import register
from roughgas.kernel import hooks, memory
from roughgas.kernel.hooks import present
from roughgas.kernel.record import Sampling, columns, record

TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5}]
BOXES = {2: [14, 14], 3: [12, 12, 12]}
SWEPT = ("smooth", "gas", "sheared", "bed", "walled", "spheres", "friction", "shaken", "heated")
SWEPT += ("viscoelastic", "container", *RARE)
CELLS = ("sheared", "walled", "spheres")
WAVES = {name: settings("bed", floor={"wave": name}) for name in ("triangle", "sine")}
# where registers differ between machines, and with plain Python, these have another order
SCRATCH = ("slot_time", "slot_partner", "slot_change", "found", "when")


def arrays(part, name=""):
    """Name -> array of all that a state holds but for scratch."""
    if isinstance(part, np.ndarray):
        return {} if name in SCRATCH else {name: part}
    inner = [arrays(getattr(part, key), key) for key in getattr(part, "_fields", ())]
    return {f"{name}.{key}": array for found in inner for key, array in found.items()}


def assert_plain_python_has_the_same_bits(experiment, collisions=25):
    ends = []
    for advance in (record, record.py_func):
        beta = 0.3 if "spin" in experiment["effects"] else -1.0
        scene, state = begin(experiment, 0.9, beta, 3)
        rows = np.empty((3, len(columns(scene))))
        refresh = 0 if present(scene.effects, "drives") else 2
        with np.errstate(all="ignore"):  # infinite times
            ended = advance(state, scene, Sampling(np.inf, collisions, refresh), rows)
        ends.append(arrays(state) | {"rows": rows, "ended": np.array(ended)})
    compiled, plain = ends
    for name, array in compiled.items():
        assert array.tobytes() == plain[name].tobytes(), name
    assert rows[-1, 1] == 3 * collisions


def of_ten(kernel, **more):
    """The settings of a scene of ten particles."""
    box = settings(kernel)["box"]
    lengths = BOXES[len(box)]
    top = "open" if box[-1] == "open" else lengths[-1]
    return settings(kernel, 10, [*lengths[:-1], top]) | more


@pytest.mark.parametrize(
    "kernel", [pytest.param(n, marks=[pytest.mark.slow] * (n in RARE)) for n in SWEPT]
)
def test_scenes_run_as_plain_python(kernel):
    assert_plain_python_has_the_same_bits(of_ten(kernel))


@pytest.mark.parametrize("kernel", ["gas", pytest.param("heated", marks=pytest.mark.slow)])
def test_mixtures_run_as_plain_python(kernel):
    assert_plain_python_has_the_same_bits(of_ten(kernel, species=TWO, box=[20, 20]))


@pytest.mark.slow  # compiles kernels
@pytest.mark.parametrize("wave", WAVES)
def test_floors_run_as_plain_python(wave):
    own = {"particles": 10, "box": [14, "open"]}
    assert_plain_python_has_the_same_bits(WAVES[wave] | own, collisions=8)


@pytest.mark.parametrize("kernel", sheared_or_slow(CELLS))
def test_cells_run_as_plain_python(kernel, monkeypatch):
    run_in_cells(kernel, monkeypatch)


def test_lists_run_as_plain_python(monkeypatch):
    run_in_cells("walled", monkeypatch, neighbours="lists")


def run_in_cells(kernel, monkeypatch, **more):
    monkeypatch.setattr(memory, "FEW", 0)
    monkeypatch.setattr(memory, "PER_CELL", {2: 0.0, 3: 0.0})
    box = [17, *settings(kernel)["box"][1:]]
    box[1:] = [length if length == "open" else 17 for length in box[1:]]
    assert_plain_python_has_the_same_bits(settings(kernel, 10, box) | more, collisions=10)


# ---------------------------------------------------------------------- as it is written


class Part(NamedTuple):
    weights: tuple
    other: object


class Whole(NamedTuple):
    part: Part
    nothing: None


@jit
def aliases(whole, x):
    part, nothing = whole.part, whole.nothing
    weights = part.weights
    pieces = tuple(2.0 * weights[k] for k in range(len(weights)) if k != 1)
    if nothing is not None or (part.other is None and len(pieces) == 7):
        return undefined(x)  # noqa: F821
    y = x if not (nothing is None and len(pieces) > 1) else pieces[1]
    if part.weights is not None:
        return x + y + len(weights)
    return undefined(x)  # noqa: F821


@jit
def reassigned(x):
    while x is not None:
        x = None
    return x


@jit
def misspelt(whole):
    return 1.0 if whole.prat is None else 2.0


@jit
def accelerated(effects, v):
    g = 0.0
    for part in present(effects, "acceleration"):
        g += part.own(effects[part.place], part.rank)
    return v - g if present(effects, "acceleration") else v


@jit
def twice_the_same(effects):
    total = 0.0
    for part in present(effects, "phase"):
        total = 10.0 * total + part.own(effects[part.place], part.rank, 0.0)
    return total


def digit(number):
    """An effect whose hook has the name and the file of those of others."""

    class Digit(NamedTuple):
        value: float

    @jit
    def phase(effect, index, base):
        return number * effect.value

    register(Digit, {}, phase=phase)
    return Digit(1.0)


WHOLE = Whole(Part((1.0, 2.0, 3.0), 4), None)


def test_what_types_tell_is_decided():
    assert from_python(aliases)(WHOLE, 0.5) == aliases(WHOLE, 0.5) == 9.5
    (written,) = aliases.written.values()
    assert len(written.body) == 5  # what follows the decided return is cut
    for effects in (Effects(), Effects(gravity=Gravity(2.0))):
        assert from_python(accelerated)(effects, 3.0) == accelerated(effects, 3.0)
    assert from_python(hooks.acceleration)(Effects()) is None


def test_hooks_of_one_name_are_told_apart():
    effects = digit(1.0), digit(2.0), digit(3.0)
    assert from_python(twice_the_same)(effects) == twice_the_same(effects) == 123.0


@pytest.mark.parametrize(
    ("function", "given", "said"),
    [
        (reassigned, 1.0, "reassigned, line [0-9]+: x is not None: types do not decide it"),
        (misspelt, WHOLE, "Whole has no prat"),
    ],
)
def test_what_types_do_not_decide_is_refused(function, given, said):
    with pytest.raises(Exception, match=said):
        from_python(function)(given)


def show(*options):
    command = [sys.executable, "-m", "roughgas.kernel", *options]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


@pytest.mark.slow  # compiles a kernel
def test_a_function_is_shown_as_it_is_compiled_for_a_scene():
    shown = show("--show", "collide", "--scene", "cooling").stdout
    assert shown.startswith("# roughgas.kernel.contact") and "n = direction(" in shown
    assert "None" not in shown and "observe_contact" not in shown and "turn_and_book" in shown


@pytest.mark.parametrize(
    ("function", "scene", "said"),
    [
        ("colide", "cooling", "--show = colide: must be a compiled function"),
        ("collide", "coolin", "experiment = 'coolin': must be one of cooling"),
        pytest.param(
            *("resolve_wall", "cooling", "resolve_wall: must be compiled for this scene"),
            marks=pytest.mark.slow,  # which compiles it
        ),
    ],
)
def test_what_cannot_be_shown_is_refused_in_one_line(function, scene, said):
    done = show("--show", function, "--scene", scene)
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert said in done.stderr
