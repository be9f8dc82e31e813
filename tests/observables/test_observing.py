"""Observables of a run: they change no bit, are in the dataset, and are refused if illegal."""

import shlex

import numpy as np
import pytest
from schedules import BRIEF, COOLING, STEADY

from roughgas import simulate
from roughgas.base import InputError
from roughgas.cli import main
from roughgas.data.point import WALL_CLOCK, read_point
from roughgas.data.reduced import read_reduced
from roughgas.observables import OBSERVABLES
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
LAYER_OBSERVABLES = ("layer", "pattern")
WITHOUT_EFFECTS = [
    name for name in OBSERVABLES if not OBSERVABLES[name].effects and name not in LAYER_OBSERVABLES
]


def point(scene, observe=None, r=0.9, beta=0.5, **changes):
    return simulate(r=r, beta=beta, observe=observe, progress=False, **(scene | changes))


def without_run_times(dataset):
    return dataset.drop_vars(WALL_CLOCK, errors="ignore")


@pytest.mark.parametrize("scene", [SHEARED, COOLED], ids=["sheared", "cooling"])
def test_observing_changes_no_other_number(scene):
    plain, observed = point(scene), point(scene, WITHOUT_EFFECTS)
    for name, values in without_run_times(plain).variables.items():
        assert values.identical(observed.variables[name]), name
    added = observed.data_vars.keys() - plain.data_vars.keys()
    for name in OBSERVABLES["cumulants"].variables:
        assert {name, f"{name}_stderr", f"{name}_dof"} <= added


def test_a_continued_run_is_observed_and_keeps_its_bits():
    """A cooling gas is refreshed at the same instants, wherever the first part has ended."""
    longer = COOLED["schedule"] | {"plateau": 41.0}
    first = point(COOLED, keep_state=True)
    plain, observed = (
        point(COOLED, observe, schedule=longer, initial=first, keep_state=True)
        for observe in (None, {"cumulants": {"every": 3}})
    )
    assert observed.initial_exact == 1
    assert observed.last_position.identical(plain.last_position)
    assert observed.R_series.identical(plain.R_series)


def test_observables_of_a_cooling_gas_are_scaled_to_energy_1():
    """Per degree of freedom, however low the energy of the gas has become."""
    dataset = point(COOLED, {"profiles": {"bins": 1}}, r=0.5)
    assert dataset.E_trans < 1e-2
    flow = dataset.flow_profile.values
    assert np.mean(dataset.temperature_profile + flow**2) == pytest.approx(2.0, rel=1e-9)


def energy(frame):
    return 0.5 * np.mean(frame.thermal_velocity**2)


energy.long_name, energy.units = "translational energy", "m a^2 T^-2"


def test_a_function_has_the_mean_and_error_of_the_point():
    """The mean of the same samples, over whole periods, with the same error."""
    dataset = point(SHEARED, {"energy": energy})
    assert dataset.energy == pytest.approx(float(dataset.E_trans), rel=1e-12)
    assert dataset.energy_stderr == pytest.approx(float(dataset.E_trans_stderr), rel=1e-6)
    assert dataset.energy.long_name == "translational energy"
    assert dataset.energy.reduced_units == "m a^2 T^-2"


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
def test_unusable_functions_are_refused_in_one_line(observe, message):
    with pytest.raises(InputError, match=message) as refusal:
        point(SHEARED, observe)
    assert "\n" not in str(refusal.value)


MIXED = [{"fraction": 0.5, "radius": 0.7}, {"fraction": 0.5, "radius": 1.3, "mass": 3.0}]


def test_observables_of_a_mixture_use_the_size_and_mass_of_particles():
    dataset = point(COOLED, {"profiles": {"bins": 1}}, species=MIXED, r=1.0, beta=-1)
    assert dataset.packing_profile.item() == pytest.approx(dataset.packing, rel=1e-12)
    assert np.mean(dataset.temperature_profile) == pytest.approx(2.0, rel=0.02)
    mass = {"heavy": lambda frame: frame.mass[frame.species_of == 1].mean()}
    assert point(COOLED, mass, species=MIXED).heavy == 3.0
    alike = {"alike": lambda frame: frame.species_of is None}
    assert point(COOLED, alike).alike == 1.0


def test_the_command_line_observes_and_reduced_datasets_hold_the_results(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "config.yaml").write_text(CONFIG, encoding="utf-8")
    run = ["run", "gas", "--r", "0.9", "--seed", "1", "2", "--beta"]
    assert main([*run, "0", "-o", "a1.nc", "a2.nc"]) == 0
    assert main([*run, "0.5", "--observe", "cumulants", "-o", "b1.nc", "b2.nc"]) == 0
    seeds = [read_point(f"b{seed}.nc") for seed in (1, 2)]
    assert main([*shlex.split(seeds[0].command)[1:-1], "again.nc"]) == 0
    again = without_run_times(read_point("again.nc"))
    assert again.drop_attrs().identical(without_run_times(seeds[0]).drop_attrs())
    reduce_points(["a1.nc", "a2.nc", "b1.nc", "b2.nc"], "all.nc")
    reduced = read_reduced("all.nc").isel(r=0)
    assert reduced.packing_profile.dims == ("beta", "height") and reduced.height.size == 5
    for name in ("a20", "T_rot_profile"):
        mean = np.mean([seed[name].values for seed in seeds], axis=0)
        assert reduced[name].sel(beta=0.5).values == pytest.approx(mean, rel=1e-12)
        errors = reduced[f"{name}_stderr"].sel(beta=0.5)
        assert np.all(errors.values > 0) and np.all(reduced[f"{name}_dof"].sel(beta=0.5) >= 1)
    assert np.isnan(reduced.a20.sel(beta=0.0))
    assert reduced.T_rot_profile.long_name == "temperature of the spins in a layer"


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
