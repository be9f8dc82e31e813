"""Observables of a run: they change no bit, land in the dataset, and refuse what makes no sense."""

import shlex

import numpy as np
import pytest
from schedules import BRIEF, COOLING, STEADY

from roughgas import simulate
from roughgas.base import InputError
from roughgas.cli import main
from roughgas.data.point import WALL_CLOCK, read_point
from roughgas.data.reduced import read_reduced
from roughgas.observables import KINDS
from roughgas.results.reduce import reduce_points

SHEARED = {
    "particles": 20,
    "box": (25, 25),
    "effects": {"spin": {"inertia": 0.5}, "shear": {"velocity": 1}, "contact_averages": {}},
    "schedule": STEADY,
}
COOLED = {
    "particles": 20,
    "box": (25, 25),
    "effects": {"spin": {"inertia": 0.5}},
    "schedule": COOLING | {"replicas": 2, "sample_every": 0.5},
}
OF_LAYERS = ("layer", "pattern")
ONLY_LOOK = [name for name in KINDS if not KINDS[name].effects and name not in OF_LAYERS]


def point(scene, observe=None, r=0.9, beta=0.5, **more):
    return simulate(r=r, beta=beta, observe=observe, progress=False, **(scene | more))


def without_cost(dataset):
    return dataset.drop_vars(WALL_CLOCK, errors="ignore")


@pytest.mark.parametrize("scene", [SHEARED, COOLED], ids=["sheared", "cooling"])
def test_watching_changes_no_other_number(scene):
    plain, watched = point(scene), point(scene, ONLY_LOOK)
    for name, values in without_cost(plain).variables.items():
        assert values.identical(watched.variables[name]), name
    more = watched.data_vars.keys() - plain.data_vars.keys()
    for name in KINDS["cumulants"].variables:
        assert {name, f"{name}_stderr", f"{name}_dof"} <= more


def test_a_run_that_goes_on_is_watched_and_keeps_its_bits():
    """A cooling gas is refreshed where it would have been, wherever the first part has ended."""
    longer = COOLED["schedule"] | {"plateau": 41.0}
    first = point(COOLED, keep_state=True)
    plain, watched = (
        point(COOLED, observe, schedule=longer, initial=first, keep_state=True)
        for observe in (None, {"cumulants": {"every": 3}})
    )
    assert watched.initial_exact == 1
    assert watched.last_position.identical(plain.last_position)
    assert watched.R_series.identical(plain.R_series)


def test_in_a_cooling_gas_the_energy_stays_1():
    """Per degree of freedom, at whatever energy the gas has arrived."""
    found = point(COOLED, {"profiles": {"bins": 1}}, r=0.5)
    assert found.E_trans < 1e-2
    flow = found.flow_profile.values
    assert np.mean(found.temperature_profile + flow**2) == pytest.approx(2.0, rel=1e-9)


def energy(frame):
    return 0.5 * np.mean(frame.thermal_velocity**2)


energy.long_name, energy.units = "translational energy", "m a^2 T^-2"


def test_a_function_sees_what_the_point_measures():
    """The mean of the same samples, over whole periods, with the same error."""
    found = point(SHEARED, {"energy": energy})
    assert found.energy == pytest.approx(float(found.E_trans), rel=1e-12)
    assert found.energy_stderr == pytest.approx(float(found.E_trans_stderr), rel=1e-6)
    assert found.energy.long_name == "translational energy"
    assert found.energy.reduced_units == "m a^2 T^-2"


@pytest.mark.parametrize(
    ("observe", "message"),
    [
        ({"R": energy}, r"^variable of R = R: must have a name that no other variable"),
        ({"words": lambda frame: "many"}, r"^observe\.words = str: must return a number, an array"),
        (
            {"none": lambda frame: None},
            r"^observe\.none = NoneType: must return a number, an array",
        ),
        ({"none": lambda frame: {}}, r"^observe\.none = dict: must return a number, an array"),
        (
            {"odd": lambda frame: np.zeros(int(frame.time) % 3)},
            r"^observe\.odd: shapes = .*: must be the same at every observation, as at the first",
        ),
    ],
)
def test_what_cannot_be_watched_is_refused_in_one_line(observe, message):
    with pytest.raises(InputError, match=message) as found:
        point(SHEARED, observe)
    assert "\n" not in str(found.value)


MIXED = [{"fraction": 0.5, "radius": 0.7}, {"fraction": 0.5, "radius": 1.3, "mass": 3.0}]


def test_of_species_what_depends_on_the_particle_takes_its_size_and_mass():
    found = point(COOLED, {"profiles": {"bins": 1}}, species=MIXED, r=1.0, beta=-1)
    assert found.packing_profile.item() == pytest.approx(found.packing, rel=1e-12)
    assert np.mean(found.temperature_profile) == pytest.approx(2.0, rel=0.02)
    mass = {"heavy": lambda frame: frame.mass[frame.species_of == 1].mean()}
    assert point(COOLED, mass, species=MIXED).heavy == 3.0
    alike = {"alike": lambda frame: frame.species_of is None}
    assert point(COOLED, alike).alike == 1.0


def test_the_command_line_watches_and_reduced_datasets_hold_what_was_seen(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "config.yaml").write_text(CONFIG, encoding="utf-8")
    run = ["run", "gas", "--r", "0.9", "--seed", "1", "2", "--beta"]
    assert main([*run, "0", "-o", "a1.nc", "a2.nc"]) == 0
    assert main([*run, "0.5", "--observe", "cumulants", "-o", "b1.nc", "b2.nc"]) == 0
    seeds = [read_point(f"b{seed}.nc") for seed in (1, 2)]
    assert main([*shlex.split(seeds[0].command)[1:-1], "again.nc"]) == 0
    again = without_cost(read_point("again.nc"))
    assert again.drop_attrs().identical(without_cost(seeds[0]).drop_attrs())
    reduce_points(["a1.nc", "a2.nc", "b1.nc", "b2.nc"], "all.nc")
    found = read_reduced("all.nc").isel(r=0)
    assert found.packing_profile.dims == ("beta", "height") and found.height.size == 5
    for name in ("a20", "T_rot_profile"):
        mean = np.mean([seed[name].values for seed in seeds], axis=0)
        assert found[name].sel(beta=0.5).values == pytest.approx(mean, rel=1e-12)
        errors = found[f"{name}_stderr"].sel(beta=0.5)
        assert np.all(errors.values > 0) and np.all(found[f"{name}_dof"].sel(beta=0.5) >= 1)
    assert np.isnan(found.a20.sel(beta=0.0))
    assert found.T_rot_profile.long_name == "temperature of the spins in a layer"


CONFIG = f"""
scale: paper
experiments:
  gas:
    particles: 20
    box: [25, 25]
    effects: {{spin: {{inertia: 0.5}}}}
    observables: {{profiles: {{bins: 5}}}}
    sweep: {{r: ["0.9"], beta: ["0"], seeds: 1}}
    schedule: {BRIEF | {"sample_every": 0.5}}
scales: {{paper: {{}}}}
"""
