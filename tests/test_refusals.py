"""Bad input ends in one line that names the key, the value and the legal values: refusals.txt,
where each row is a call and the beginning of its line; "..." stands for anything."""

import contextlib
import copy
import io
import json
import math
import re
import shlex
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray
import yaml
from brute_force import begin, settings
from msgspec.structs import asdict
from raw import FreeCooling, build, check, check_initial, protocols
from schedules import COOLING, STEADY, TINY
from synthetic import reduced
from tests.cli.conftest import GAS
from tests.configurations import EXPERIMENTS, checked, raw_configuration
from tests.entry import main
from tests.files import point
from tests.observables.frames import frame_of, system_of
from tests.study_modules import module_of_study

from roughgas import config as configuration
from roughgas import simulate, theory, trajectory
from roughgas.base import InputError, labels  # noqa: F401  rows have it
from roughgas.config.forms import PointForm
from roughgas.data.point import Point, read_point, write_point
from roughgas.observables import OBSERVABLES
from roughgas.show import living as page
from roughgas.show.figures import sweep
from roughgas.simulation.initial_states import InitialState
from roughgas.simulation.saved_states import initial_states_of
from roughgas.tasks import dsmc

TESTS = Path(__file__).parent
PAPER, CONFIGURATION = raw_configuration(), configuration.load(EXPERIMENTS)
SPIN = {"spin": {"inertia": 0.5}}
GRAVITY = {"gravity": {"acceleration": 1}}
FLOOR = {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1}
BED = SPIN | GRAVITY | {"floor": FLOOR}
WALLS = {"walls": {"restitution": 1, "roughness": 1}}
SHEAR = {"shear": {"velocity": 2}}
HEAT = {"thermostat": {"power": 1, "spin_share": 0.5, "interval": 0.5}}
LID = SPIN | {"bottom_wall": {}}
BOX = LID | {"lid": {}, "left_wall": {}, "right_wall": {}}
POWER = {"speed": 1.0, "exponent": 0.75, "least": 0.7}
TABLE = settings("tabulated bed")["effects"]["restitution_table"]
TIMED = {"kind": "steady", "equilibrate": 20.0, "measure": 20.0, "sample_every": 1.0}
STRIPES = {
    "particles": 600,
    "layer": {"gamma": 3.0, "f_star": 0.44, "depth": 5.42, "width": 10},
    "effects": SPIN | GRAVITY | {"floor": {"restitution": 1, "roughness": -1}},
    "schedule": {"kind": "steady"},
}
STRIPES["layer"]["cycles"] = {"equilibrate": 40, "measure": 8, "samples": 32, "repeat": 4}


class RefusalLine(InputError):
    """The one line of a command's refusal."""

    def __init__(self, line):
        self.line = line

    def __str__(self):
        return self.line


def command(line, settings=None):
    """Call a command, with settings as its option; raise its refusal, if any."""
    arguments = [*shlex.split(line), *([f"--settings={json.dumps(settings)}"] if settings else [])]
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            status = main(arguments)
        except SystemExit as stop:  # of words that no command takes
            status = stop.code
    assert output.getvalue() == "" and not [path for path in Path().iterdir() if path.is_file()]
    if status:
        assert status in (1, 2) and errors.getvalue().startswith("roughgas: error: ")
        raise RefusalLine(errors.getvalue().removeprefix("roughgas: error: ").removesuffix("\n"))


def mixture(*species, dimension=2, pairs=()):
    return theory.mixture([*species], 0.9, 0, dimension, pairs=list(pairs))


def scene(effects, box=None, beta=None, particles=20, **settings_beside):
    """Build and check an experiment: a bed is open above."""
    box = box or (50, "open" if {"floor", "gravity"} & {*effects} else 50)
    beta = (0.0 if "spin" in effects else -1.0) if beta is None else beta
    chosen = {"particles": particles, "box": list(box), "effects": effects} | settings_beside
    build(chosen, 0.9, beta)
    check(chosen)


def fall(*direction):
    """Settings of gravity in a direction."""
    return {"gravity": {"acceleration": 1.0, "direction": [*direction]}}


def scheduled(effects, schedule):
    box = {"particles": 10, "box": [12.5, 12.5], "effects": effects}
    protocols.check_experiment(box | {"schedule": schedule})


def bath(**langevin):
    still = dict.fromkeys(("drag", "temperature", "power", "spin_drag", "spin_power"), 0.0)
    scene(SPIN | {"langevin": {"interval": 0.5} | still | langevin})


def table(**changes):
    """A table of restitution with other entries; ... takes one away."""
    changed = {key: entry for key, entry in (TABLE | changes).items() if entry is not ...}
    scene({"restitution_table": changed}, (20, 20))


def species(*every, pairs=(), beta=0.3, **further_settings):
    chosen = settings("gas", 40, [40, 40]) | {"species": [*every]} | further_settings
    chosen["species_pairs"] = [{"between": names, "restitution": 0.5} for names in pairs]
    build(chosen, 0.9, beta)


def schema(*every):
    PointForm.check(settings("gas", 40) | {"species": [*every]}, "gas")


def timed(kernel, **changes):
    """Check a schedule, whose kind is the right one unless it is among the changes."""
    usual = COOLING | {"replicas": 6, "plateau": 30} if kernel == "gas" else TIMED
    box = [12.5, "open" if kernel == "bed" else 12.5]
    chosen = changes if "kind" in changes else usual | changes
    protocols.check_experiment(settings(kernel, 10, box) | {"schedule": chosen})


def staged(*stage_settings, **options):
    stages = {"kind": "stages", "sample_every": 0.5, "stages": [*stage_settings]}
    simulate(r=0.9, beta=0.2, **settings("heated", 40, [30, 30]), schedule=stages, **options)


def begun(kernel, position):
    chosen = settings(kernel, 2, [12, "open" if kernel == "bed" else 12]) | {"schedule": TIMED}
    time = 3.0  # the images of a sheared gas have moved by 6 a
    initial = InitialState(np.array(position, float), np.zeros((2, 2)), time=time)
    check_initial([initial], chosen, build(chosen, 0.9, 0.3))


def outside(*dims, units="a", **coordinates):
    """Read the state of two disks, whose positions have other dimensions, units or coordinates."""
    position, velocity = [[2.0, 6.0], [9.0, 6.0]], np.zeros((2, 2))
    vectors = {"position": (dims, position, {"units": units}), "velocity": (dims, velocity)}
    initial_states_of(xarray.Dataset(vectors, coordinates))


def watched(observe, beta=0.5, **further_settings):
    chosen = settings("sheared", 20, [25, 25]) | {"schedule": STEADY} | further_settings
    simulate(r=0.9, beta=beta, observe=observe, progress=False, **chosen)


def looked(name, **changes):
    """Make an observable of a system of disks, with changes of its settings or of the system."""
    system, kind = system_of((20, 20)), OBSERVABLES[name]
    chosen = asdict(kind.settings())
    chosen.pop("every")
    chosen |= {key: changes.pop(key) for key in [*changes] if key in chosen}
    kind(frame_of(system).system._replace(**changes), **chosen)


def simulated(name, **changes):
    simulate(name, **({"r": 0.9, "beta": 0.5} | changes))


def changed(configured, path, value):
    """The configuration with another value at a path, of an experiment or such as /scale."""
    configured = copy.deepcopy(configured)
    path = path[1:] if path.startswith("/") else f"experiments.{path}"
    *parents, last = (int(key) if key.isdigit() else key for key in path.split("."))
    inner = configured
    for key in parents:
        inner = inner[key]
    if value == "(absent)":
        del inner[last]
    else:
        inner[last] = value
    return configured


def config(path, value):
    """Check the configuration with another value; the message names its location."""
    try:
        checked(changed(PAPER, path, yaml.safe_load(value)))
    except InputError as error:
        assert str(error).startswith("config.yaml: ")
        assert path.removeprefix("/").split(".")[0] in str(error)
        raise


def another(text):
    checked(changed(PAPER, "mine", yaml.safe_load(text)))


def axis(sweep):
    checked(changed(PAPER, "spun", {"extends": "sheared", "sweep": yaml.safe_load(sweep)}))


def at_scale(name, text):
    checked(changed(PAPER, f"/scales.small.{name}", yaml.safe_load(text)))


def layer(text):
    experiment = configuration.WrittenExperiment(STRIPES).fitted("stripes")
    experiment.changed(yaml.safe_load(text)).experiment("stripes")


def opened(name, value):
    """Read a point whose file has another attribute."""
    write_point("point.nc", point())
    with netCDF4.Dataset("point.nc", "a") as file:
        file.setncattr(name, value)
    read_point("point.nc")


def of_points(name, **changes):
    """Call a command with a point with another variable or attribute."""
    original = point()
    attributes = {key: changes.pop(key) for key in [*changes] if key in original.attributes}
    original = Point(original.variables | changes, original.attributes | attributes)
    Path("data").mkdir()
    write_point("data/point.nc", original)
    command(f"{name} data/point.nc{' -o all.nc' if name == 'reduce' else ''}")


def living(effects):
    """Put a bed with other effects into the living page."""
    bed = page.experiment_of(CONFIGURATION, "vibrated")
    page.scene_of("vibrated", bed.changed({"effects": effects}))


def loaded(text):
    Path("c.yaml").write_text(text)
    configuration.load("c.yaml")


springs = module_of_study("accuracy", "soft_spheres").springs
CALLED = begin, springs, trajectory, reduced, FreeCooling
NAMES = globals() | {function.__name__: function for function in CALLED}
NAMES |= {"GAS": GAS, "TINY": TINY, "sweep": sweep, "dsmc": dsmc, "COOLING": COOLING}
NAMES |= {
    "nan": math.nan,
    "inf": math.inf,
    "RNG": np.random.default_rng(0),
    "HALF": {"fraction": 0.5},
    "SPREAD": {"distribution": "uniform"},
    "FAST": {"amplitude": 1, "period": 1e-5},
    "STROKE": {"amplitude": 1.0, "period": 1.7},
    "LAWS": {
        "viscoelastic": {"viscoelastic": {}},
        "power_law": {"power_law": POWER},
        "restitution_table": {"restitution_table": TABLE},
    },
}
ROWS = [
    tuple(map(str.strip, line.split(" -> ")))
    for line in (TESTS / "refusals.txt").read_text(encoding="utf-8").splitlines()
    if line and not line.startswith("#")
]


@pytest.mark.parametrize(("call", "message"), ROWS, ids=[call for call, _ in ROWS])
def test_what_is_refused(call, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError) as caught:
        eval(call, NAMES)
    refusal = str(caught.value)
    assert "\n" not in refusal
    assert re.match(".*".join(map(re.escape, re.split(r" ?\.\.\. ?", message))), refusal), refusal
