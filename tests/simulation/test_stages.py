"""A gas whose settings change from stage to stage."""

import math

import numpy as np
import pytest
from brute_force import Comparison, begin, compare, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from raw import packing, protocols, start_gas
from slow_cases import slow_but

from roughgas import config, simulate, trajectory
from roughgas.base import InputError, merged
from roughgas.cli.show import theory_comparison
from roughgas.effects.walls import Wall
from roughgas.simulation import scene_switch
from roughgas.simulation.gas import Gas
from roughgas.simulation.wall_types import with_common_wall_types
from roughgas.tasks import dsmc
from roughgas.theory.prediction import ratio_of_point

GAS = settings("gas", 40, [30, 30])
HEATED = settings("heated", 40, [30, 30])
BED = settings("bed", 20, [12.5, "open"])
CONTAINER = settings("container", 20, [20, 20])


def stages(*stage_settings, every=0.5):
    """Settings of a schedule of stages."""
    return {"kind": "stages", "sample_every": every, "stages": list(stage_settings)}


def point(experiment, *stage_settings, r=0.9, beta=0.2, every=0.5, **changes):
    """The dataset of a gas that goes through stages."""
    arguments = {"schedule": stages(*stage_settings, every=every), "progress": False} | changes
    return simulate(r=r, beta=beta, **(experiment | arguments))


def ratio_to_error(values, reference, errors):
    """The largest deviation from a reference, in errors."""
    return np.max(np.abs(values - reference) / errors)


def test_a_stage_that_changes_nothing_leaves_all_bits_as_they_are():
    """As a single stage and as three, the second of which states the same power and r again."""
    single_stage = point(HEATED, {"duration": 30})
    same_settings = {"effects": {"thermostat": {"power": 1.0}}, "r": 0.9}
    three_stages = point(
        HEATED, {"duration": 10}, {"duration": 15} | same_settings, {"duration": 5}
    )
    assert single_stage.energy_input.sel(source="stages").values.tolist() == [0.0, 0.0]
    for name in ("E_trans_series", "R_series", "energy_input_series", "collisions_series"):
        np.testing.assert_array_equal(single_stage[name], three_stages[name])
    assert three_stages.stage_begin.values.tolist() == [0.0, 10.0, 25.0]


def test_stages_have_the_samples_of_a_steady_run():
    """The same samples, in two stages, the first without measurement."""
    lengths = {"equilibrate": 20, "measure": 30, "sample_every": 0.5, "kind": "steady"}
    steady = simulate(r=0.9, beta=0.2, **(HEATED | {"schedule": lengths, "progress": False}))
    staged = point(HEATED, {"duration": 20, "measure": False}, {"duration": 30})
    late = staged.isel(sample=staged.time > 20.0)
    np.testing.assert_array_equal(steady.E_trans_series[-len(late.time) :], late.E_trans_series)
    assert len(late.time) == 60
    for name in ("R", "R_stderr", "E_rot", "energy_input"):
        measured = (
            staged[name].values[: len(steady[name].values)] if staged[name].ndim else staged[name]
        )
        np.testing.assert_allclose(measured, steady[name], rtol=1e-12)


DRIVING = {"gravity", "direction of gravity", "shear"}
"""Changes of CHANGES that supply energy by themselves."""
CHANGES = {  # (experiment, changes of its effects)
    "kicks": (HEATED, {"thermostat": {"power": 5.0, "spin_share": 1.0}}),
    "interval of kicks": (HEATED, {"thermostat": {"interval": 0.2}}),
    "bath": (settings("bath", 20, [20, 20]), {"langevin": {"drag": 1.0, "interval": 0.3}}),
    "gravity": (BED, {"gravity": {"acceleration": 2.5}}),
    "direction of gravity": (
        settings("chute", 20, [12.5, "open"]),
        {"gravity": {"acceleration": 2.5, "direction": [-1.0, -1.0]}},
    ),
    "floor": (BED, {"floor": {"amplitude": 3.0, "restitution": 0.9}}),
    "shear": (settings("sheared", 20, [20, 20]), {"shear": {"velocity": 3.7}}),
    "walls": (
        settings("container", 20, [20, 20]),
        {"left_wall": {"temperature": 5.0, "velocity": -1.0}, "bottom_wall": {"velocity": 2.0}},
    ),
}


@pytest.mark.parametrize("name", slow_but({"kicks", "walls"}, CHANGES))
def test_across_a_change_the_gas_makes_the_collisions_of_the_brute_force(name):
    """At the change, the state agrees with the brute force; then both make the same collisions with
    the new settings, r and beta."""
    experiment, effects = CHANGES[name]
    old, world = scene_of(experiment, 0.9, 0.2)
    new, world_after = scene_of(merged(experiment, {"effects": effects}), 0.7, -0.3)
    gas = start_gas(old, experiment, np.random.default_rng(3))
    gas.in_time(0.25, 15)
    start = snapshot(gas.state, old)
    brute = brute_force_from(world, start)
    gas.in_time(0.25, 1)
    brute.run_until(4.0)
    assert compare(snapshot(gas.state, old), brute) < 1e-7  # after chaos of a quarter of a T
    new = scene_switch.with_images_continued(old, new, 4.0)
    balance_before, velocity_before = gas.balance(), brute.v.copy()
    put_in = scene_switch.switch_scene(gas, new, 4.0)
    shear = new.effects.shear
    if shear is None:
        assert compare(snapshot(gas.state, new), brute) < 1e-7
    else:
        world_after = world_after._replace(slide=shear.initial_offset)
        rate = (3.7 - 2.0) / 20.0
        brute.v[:, 0] += rate * (brute.x[:, 1] - 10.0)
        brute.world = world_after
        assert compare(snapshot(gas.state, new), brute) < 1e-7
        assert put_in[0] == pytest.approx(0.5 * (brute.v**2 - velocity_before**2).sum(), rel=1e-6)
    Comparison(gas.state, new, world_after).assert_same(8, 10)
    balance_after = gas.balance()
    gained = (
        balance_after.energy
        - balance_before.energy
        - (balance_after.ledger - balance_before.ledger).sum(axis=0)
    )
    np.testing.assert_allclose(gained, put_in, atol=1e-10 * abs(balance_after.ledger).sum())


def test_the_images_of_a_sheared_gas_do_not_jump():
    old, _ = scene_of(CHANGES["shear"][0], 0.9, 0.2)
    new, _ = scene_of(merged(CHANGES["shear"][0], {"effects": {"shear": {"velocity": 7.0}}}), 1, 0)
    for time in (0.0, 3.3, 1234.5):
        after = scene_switch.with_images_continued(old, new, time).effects.shear
        shift = scene_switch.displacement(old.effects.shear, time)
        away = (scene_switch.displacement(after, time) - shift + 10.0) % 20.0 - 10.0
        assert abs(away) < 1e-9


def test_a_change_of_gravity_supplies_the_change_of_potential_energy():
    arguments = dict(r=0.9, beta=0.2, **BED, progress=False)
    stage_settings = (
        {"duration": 10},
        {"duration": 10, "effects": {"gravity": {"acceleration": 2.0}}},
    )
    dataset = simulate(**arguments, schedule=stages(*stage_settings))
    shot = trajectory(**arguments, schedule=stages(*stage_settings), times=[10.0])
    height = float(shot.position.sel(axis="y").mean())
    assert dataset.stage_input.values[1] == pytest.approx([height, 0.0], rel=1e-9)


@pytest.mark.slow
def test_an_elastic_gas_follows_its_bath_to_another_temperature():
    """T(t) = T_2 + (T_1 - T_2) exp(-2 gamma t), within 4 sigma of the scatter over ten seeds.

    Steps of particles are spread over an interval: the decay begins up to half an interval later.
    """
    no_spin_drag = {name: 0.0 for name in ("spin_drag", "spin_power")}
    bath = {"drag": 0.2, "temperature": 1.0, "interval": 0.05} | no_spin_drag
    experiment = settings("bath", 400, [200, 200], langevin=bath)
    stage_settings = (
        {"duration": 15, "measure": False},
        {"duration": 10, "effects": {"langevin": {"temperature": 3.0}}},
    )
    runs = [point(experiment, *stage_settings, r=1.0, beta=-1.0, seed=seed) for seed in range(10)]
    T = 2.0 * np.array([dataset.E_trans_series.values for dataset in runs])
    late = runs[0].time.values >= 15.0
    passed = runs[0].time.values[late] - 15.0
    expected = 3.0 - 2.0 * np.exp(-0.4 * passed)
    error = T[:, late].std(axis=0, ddof=1) / math.sqrt(10)
    assert error.max() < 0.1
    # 4 sigma of Student's t with 9 degrees of freedom are 6.6 standard errors
    assert ratio_to_error(T[:, late].mean(axis=0), expected + 0.01, error + 0.01) < 6.6


@pytest.mark.parametrize("name", CHANGES)
def test_the_energy_balance_closes_through_all_stages(name):
    """At each sample, the inputs of all sources and changes of stages sum to the gain of energy."""
    experiment, effects = CHANGES[name]
    changed_stage = {"duration": 4, "r": 0.8, "effects": effects}
    dataset = point(experiment, {"duration": 6}, changed_stage, {"duration": 2, "beta": -0.5})
    total = dataset.energy_input_series.sum("source")
    exchanged = float(np.abs(dataset.energy_input).sum())
    assert float(np.abs(total - dataset.energy_gain_series).max()) < 1e-11 * exchanged
    assert float(dataset.energy_imbalance) < 1e-11
    input_of_stages = (
        dataset.energy_input_series.sel(source="stages").isel(sample=[11, 12, 19, 20, 23]).values
    )
    assert (abs(input_of_stages[1, 0]) > 1e-3) == (name in DRIVING)
    np.testing.assert_array_equal(input_of_stages[0], 0.0)
    np.testing.assert_allclose(
        input_of_stages[1:], np.broadcast_to(input_of_stages[1], (4, 2)), atol=1e-12
    )


def test_set_temperatures_are_exact():
    """Elastic rough disks set to T_trans = 4 and T_rot = 0.25: the input of the stage is the
    difference of energies, and elastic contacts conserve their sum."""
    stage_settings = [
        {"duration": 5},
        {"duration": 5, "temperature": 4.0, "spin_temperature": 0.25},
    ]
    dataset = point(GAS, *stage_settings, r=1.0, beta=1.0, spin_temperature=2.0)
    total = 2.0 * dataset.E_trans_series + dataset.E_rot_series  # two degrees of freedom, and one
    before, after = total.values[:10], total.values[10:]
    np.testing.assert_allclose(after, 4.0 + 0.125, rtol=1e-12)
    np.testing.assert_allclose(before, before[0], rtol=1e-12)
    assert dataset.stage_input.values[1].sum() == pytest.approx(4.125 - before[0], rel=1e-11)
    stopped = point(GAS, {"duration": 5, "spin_temperature": 0.0}, beta=-1.0, spin_temperature=2.0)
    np.testing.assert_array_equal(stopped.E_rot_series, 0.0)


@pytest.mark.slow
def test_the_relaxation_after_a_quench_is_that_of_the_DSMC():
    """R at four numbers of collisions after r, beta, T_tr and T_rot are set, over 24 seeds.

    A dilute gas, whose correlations are smaller than 4 combined errors (4 values: fails by chance
    once in 4000).
    """
    experiment = settings("gas", 160, [200, 200])
    quench = {"duration": 600, "r": 0.8, "beta": 0.0, "temperature": 1.0, "spin_temperature": 2.0}
    stage_settings = ({"duration": 20}, quench)
    arguments = {
        "schedule": stages(*stage_settings, every=4),
        "progress": False,
        "spin_temperature": 1.0,
    }
    dataset = simulate(r=1.0, beta=-1.0, seed=range(24), **(experiment | arguments)).isel(
        r=0, beta=0
    )
    collisions = dataset.collisions_series.values
    since = collisions - collisions[4]
    crowding = packing(experiment) / math.pi
    runs, instants = [], (1.0, 3.0, 6.0, 9.0)
    for seed in range(24):
        rng = np.random.default_rng(seed)
        gas = dsmc.new_gas(2000, 2.0, rng)
        runs.append(dsmc.run(gas, dsmc.material(0.8, 0.0, crowding=crowding), rng, 0.1, 120))
    R = np.array([run.R for run in runs])
    collisions_of_dsmc = runs[0].collisions_per_particle
    sample_indices = [int(np.argmin(np.abs(since - n))) for n in instants]
    measured, error = (
        dataset.R_series.values[sample_indices],
        dataset.R_series_stderr.values[sample_indices],
    )
    expected = np.array(
        [np.interp(since[k], collisions_of_dsmc, R.mean(axis=0)) for k in sample_indices]
    )
    scatter = np.array(
        [np.interp(since[k], collisions_of_dsmc, R.std(axis=0)) for k in sample_indices]
    ) / math.sqrt(24)
    assert ratio_to_error(measured, expected, np.hypot(error, scatter)) < 4.0
    assert np.all(np.abs(since[sample_indices] - instants) < 0.3)
    assert measured[0] - measured[-1] > 20.0 * error[0]  # R does relax


def test_a_trajectory_goes_through_the_stages_of_its_point():
    stage_settings = ({"duration": 10.5}, {"duration": 7, "r": 0.5, "effects": CHANGES["kicks"][1]})
    stage_settings += ({"duration": 3.5, "temperature": 3.0, "spin_temperature": 1.0},)
    arguments = HEATED | {"schedule": stages(*stage_settings, every=0.7), "progress": False}
    dataset = simulate(r=0.9, beta=0.2, keep_state=True, **arguments)
    shot = trajectory(r=0.9, beta=0.2, times=[3.0, 10.5, 21.0], **arguments)
    np.testing.assert_array_equal(shot.velocity[-1], dataset.last_velocity[0])
    np.testing.assert_allclose(shot.position[-1], dataset.last_position[0], atol=1e-11)
    repeated = simulate(
        r=0.5, beta=0.2, initial=dataset, **arguments
    )  # through the stages once more
    assert repeated.stage_begin.values.tolist() == [21.0, 31.5, 38.5]
    assert repeated.E_trans_series[-1] == pytest.approx(1.5, rel=0.3)


def test_a_run_goes_on_to_the_last_bit_from_its_last_stage():
    last = {"thermostat": {"power": 3.0}}
    stage_settings = ({"duration": 5}, {"duration": 5, "effects": last}, {"duration": 5})
    uninterrupted = point(HEATED, *stage_settings)
    first_stages = point(HEATED, *stage_settings[:2], keep_state=True)
    continued = point(merged(HEATED, {"effects": last}), stage_settings[2], initial=first_stages)
    assert continued.attrs["initial_exact"] == 1
    np.testing.assert_array_equal(continued.R_series, uninterrupted.R_series[20:])


def test_observables_average_over_measured_stages_only():
    stage_settings = ({"duration": 5, "measure": False}, {"duration": 5})
    dataset = point(
        HEATED, *stage_settings, observe={"energy": lambda frame: np.mean(frame.velocity**2) / 2}
    )
    assert dataset.energy == pytest.approx(float(dataset.E_trans), rel=1e-12)
    measured_series = dataset.E_trans_series[dataset.time > 5.0]
    assert float(dataset.E_trans) == pytest.approx(float(measured_series.mean()), rel=1e-12)


def test_stages_are_not_compared_with_theory_of_a_steady_state():
    stage_settings = ({"duration": 5}, {"duration": 5, "temperature": 2.0})
    dataset = point(HEATED, *stage_settings)
    assert math.isnan(ratio_of_point(dataset)) and dataset.attrs["stages"] == 2
    assert theory_comparison(dataset, 0.5, math.nan) == "none: settings change in 2 stages"


def test_seeds_are_averaged_with_errors():
    stage_settings = ({"duration": 5}, {"duration": 5, "temperature": 2.0})
    averaged = point(HEATED, *stage_settings, seed=[1, 2, 3]).isel(r=0, beta=0)
    single_seeds = [point(HEATED, *stage_settings, seed=seed) for seed in (1, 2, 3)]
    for name in ("R_series", "E_rot_series", "energy_input_series", "stage_input"):
        values = np.array([dataset[name].values for dataset in single_seeds])
        np.testing.assert_allclose(averaged[name], values.mean(axis=0), rtol=1e-12)
        error = values.std(axis=0, ddof=1) / math.sqrt(3)
        np.testing.assert_allclose(averaged[f"{name}_stderr"], error, rtol=1e-9, atol=1e-15)
    assert averaged.source.values.tolist() == ["thermostat", "contacts", "stages"]
    np.testing.assert_array_equal(averaged.time_series, single_seeds[0].time)


def test_a_floor_may_not_jump():
    half = {"effects": {"floor": {"amplitude": 3.0}}}
    with pytest.raises(InputError, match=r"stages\[1\].effects.floor = 2.5 and 1.5 a: must change"):
        point(BED, {"duration": 10.5}, {"duration": 5} | half)
    with pytest.raises(InputError, match="of another kind"):
        point(BED, {"duration": 5, "effects": {"floor": {"wave": "sine"}}})
    point(BED, {"duration": 2}, {"duration": 1} | half)  # between two strokes


def test_temperatures_are_not_set_in_a_gas_that_flows():
    with pytest.raises(InputError, match=r"stages\[0\].temperature = 1.0: must not be given where"):
        point(CHANGES["shear"][0], {"duration": 5, "temperature": 1})


def test_a_schedule_of_another_kind_takes_nothing_from_the_one_before():
    shipped = config.load_experiment(config.SHIPPED, "sheared", "small")
    staged = shipped.changed({"schedule": stages({"duration": 5})})
    assert set(staged.raw["schedule"]) == {"kind", "sample_every", "stages"}
    protocols.check_experiment(staged.experiment("mine"))
    steady = shipped.changed({"schedule": {"kind": "steady", "measure": 5}}).raw
    assert steady["schedule"]["equilibrate"] == shipped.raw["schedule"]["equilibrate"]


STANDING = {  # (experiment, effects that move, the same at rest); strokes end at whole T
    "floor": (BED, {"floor": {}}, {"floor": {"amplitude": 0}}),
    "sine of a lid": (CONTAINER, {"lid": {}}, {"lid": {"amplitude": 0}}),
    "piston": (
        CONTAINER,
        {"right_wall": {"amplitude": 2, "period": 4, "wave": "triangle"}},
        {"right_wall": {"amplitude": 0}},
    ),
    "wall shaken along itself": (
        CONTAINER,
        {"right_wall": {"amplitude": 2, "period": 2, "shaken": "along", "wave": "sine"}},
        {"right_wall": {"amplitude": 0}},
    ),
    "sliding wall": (CONTAINER, {"bottom_wall": {}}, {"bottom_wall": {"velocity": 0}}),
}


@pytest.mark.parametrize("name", slow_but({"floor"}, STANDING))
def test_walls_that_stand_still_for_a_while_make_the_collisions_of_the_brute_force(name):
    """They move up to 4 T, stand still, and move again from the next multiple of 4 T on."""
    experiment, effects, still = STANDING[name]
    moving = merged(experiment, {"effects": effects})
    worlds = [scene_of(merged(moving, {"effects": changes}), 0.9, 0.2) for changes in ({}, still)]
    new, old = with_common_wall_types([worlds[1][0], worlds[0][0]])
    assert old == worlds[0][0] and scene_switch.kernel_types(
        new.effects
    ) == scene_switch.kernel_types(old.effects)
    gas = start_gas(old, moving, np.random.default_rng(3))
    gas.in_time(0.25, 16)
    for scene, (_, world) in ((new, worlds[1]), (old, worlds[0])):
        time = 4.0 * math.ceil(gas.time / 4.0)
        gas.in_time(time - gas.time, 1)
        scene_switch.check_scene_switch(gas.scene, scene, time, scene_switch.UNCHANGED, "stage")
        scene_switch.switch_scene(gas, scene, time)
        Comparison(gas.state, scene, world).assert_same(6, 10)


def test_a_bed_loses_energy_while_its_floor_stands_still_and_gains_it_again():
    rest, again = ({"effects": {"floor": {"amplitude": amplitude}}} for amplitude in (0, 5))
    stage_settings = ({"duration": 10}, {"duration": 10} | rest, {"duration": 10} | again)
    dataset = point(BED, *stage_settings)
    gain = dataset.energy_gain_series.sum("motion").values
    assert gain[39] < gain[19] - 0.5 and gain[59] > gain[39] + 0.5
    put_in = dataset.energy_input_series.sel(source="floor").sum("motion").values
    assert put_in[39] - put_in[19] == pytest.approx(0.0, abs=1e-3)  # as slow particles hop
    assert put_in[19] > 1.0 and put_in[59] - put_in[39] > 1.0
    assert float(dataset.energy_imbalance) < 1e-11


def test_a_wall_that_stands_still_first_is_shaken_later():
    """A run that is interrupted between the stages continues with the same bits."""
    shaken = {"lid": {"amplitude": 1, "period": 2, "wave": "sine"}}
    experiment = settings("container", 20, [20, 20], lid={"amplitude": 0, "roughness": -1})
    stage_settings = ({"duration": 6}, {"duration": 4, "effects": shaken})
    dataset = point(experiment, *stage_settings)
    put_in = dataset.energy_input_series.sel(source="lid", motion="translation").values
    assert abs(put_in[11]) < 1e-3 < 0.01 < abs(put_in[-1])
    assert float(dataset.energy_imbalance) < 1e-11
    with pytest.raises(InputError, match=r"stages\[1\].effects.lid = 0 and 0.5 a: must change"):
        point(experiment, stage_settings[0] | {"duration": 6.5}, stage_settings[1])
    first_stages = point(
        experiment, stage_settings[0], stage_settings[1] | {"duration": 2}, keep_state=True
    )
    continued = point(
        merged(experiment, {"effects": shaken}), {"duration": 2}, initial=first_stages
    )
    assert continued.attrs["initial_exact"] == 1
    np.testing.assert_array_equal(continued.E_trans_series, dataset.E_trans_series[16:])
    shot = trajectory(r=0.9, beta=0.2, **experiment, schedule=stages(*stage_settings), times=[8.0])
    np.testing.assert_array_equal(shot.velocity[-1], first_stages.last_velocity[0])


def test_a_bed_may_be_at_rest_until_its_floor_is_shaken():
    resting = settings("bed", 20, [12.5, "open"], floor={"amplitude": 0})
    shaken = {"duration": 10, "effects": {"floor": {"amplitude": 5}}}
    dataset = point(resting, {"duration": 4}, shaken)
    put_in = dataset.energy_input_series.sel(source="floor").sum("motion").values
    assert abs(put_in[7]) < 1e-3 < 1.0 < put_in[-1]
    with pytest.raises(InputError, match=r"floor.amplitude = 0.0: must be 0.001 a/T times"):
        point(resting, {"duration": 4})


def test_walls_that_move_in_no_stage_keep_their_types():
    experiment = settings("container", 20, [20, 20])
    scene, _ = scene_of(experiment, 0.9, 0.2)
    changed, _ = scene_of(merged(experiment, {"effects": {"lid": {"amplitude": 2}}}), 0.9, 0.2)
    assert with_common_wall_types([scene, changed]) == [scene, changed]
    assert [
        type(typed_scene.effects.right_wall)
        for typed_scene in with_common_wall_types([scene, changed])
    ] == [Wall] * 2


def test_spins_that_are_all_zero_are_drawn_at_random():
    """At the set temperature, with mean zero; other seeds and stages draw other spins."""
    hot = {"duration": 2, "spin_temperature": 0.5, "sample_start": True}
    arguments = dict(r=0.9, beta=-1.0, keep_state=True)
    first = point(GAS, hot, **arguments)
    np.testing.assert_allclose(first.E_rot_series, 0.25, rtol=1e-12)
    spins = first.last_spin.values.ravel()
    assert abs(spins.mean()) < 1e-14 and 0.5 < abs(spins).max() < 8.0
    assert first.stage_input.values.tolist()[0][1] == pytest.approx(0.25, rel=1e-12)
    filmed = trajectory(r=0.9, beta=-1.0, **GAS, schedule=stages(hot), times=[0.0, 2.0])
    np.testing.assert_array_equal(filmed.spin[-1], first.last_spin[0])
    independent = [
        point(GAS, hot, **arguments, seed=2),
        point(GAS, {"duration": 2, "spin_temperature": 0.0}, hot, **arguments),
    ]
    assert all(np.abs(dataset.last_spin - first.last_spin).max() > 0.1 for dataset in independent)


def test_a_seed_may_be_chosen_where_spins_are_drawn():
    first = point(GAS, {"duration": 2}, beta=-1.0, keep_state=True)
    hot = {"duration": 2, "spin_temperature": 0.5}
    runs = [point(GAS, hot, initial=first, keep_state=True, seed=seed) for seed in (2, 3)]
    assert np.abs(runs[0].last_spin - runs[1].last_spin).max() > 0.1


def test_spins_of_a_mixture_are_drawn_with_their_temperatures():
    """T of each species within 5 sigma; the mean angular velocity vanishes."""
    species = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2, "inertia": 0.3}]
    experiment = settings("gas", 400, [200, 200]) | {"species": species}
    hot = {"duration": 1, "spin_temperature": 2.0}
    dataset = point(experiment, hot, beta=-1.0, keep_state=True)
    np.testing.assert_allclose(2.0 * dataset.E_rot_species, 2.0, rtol=5.0 * math.sqrt(2.0 / 200))
    spin, radius = dataset.last_spin.values[0, :, 0], dataset.last_radius.values[0]
    kinds = dataset.last_species_of.values[0].astype(int)
    moment = np.array([1.0, 4.0])[kinds] * np.array([0.5, 0.3])[kinds] * radius
    assert abs((moment * spin).sum()) < 1e-11
    assert float(dataset.E_rot) == pytest.approx(1.0, rel=1e-12)


def test_velocities_that_are_all_zero_cannot_be_scaled():
    scene, state = begin(GAS, 0.9, -1.0)
    gas = Gas(scene, state)
    state.trajectory[:, 2:4] = 0.0
    with pytest.raises(InputError, match="scaling changes nothing"):
        scene_switch.switch_scene(gas, scene, 0.0, scene_switch.TargetTemperatures(translation=1.0))


SERIES = ("time", "E_trans_series", "R_series", "collisions_series", "energy_input_series")


def test_a_stage_is_sampled_at_the_instants_of_a_list():
    """The same bits as evenly spaced samples of the same gas."""
    even = point(HEATED, {"duration": 10}, {"duration": 8, "r": 0.8})
    later = {"duration": 8, "r": 0.8, "sample_at": [0, 1, 2.5, 7]}
    dataset = point(HEATED, {"duration": 10, "sample_every": 2}, later)
    assert dataset.time.values.tolist() == [2, 4, 6, 8, 10, 10, 11, 12.5, 17, 18]
    sample_indices = [3, 7, 11, 15, 19, 19, 21, 24, 33, 35]
    for name in SERIES:
        np.testing.assert_array_equal(dataset[name], even[name][sample_indices], name)
    assert dataset.stage_begin.values.tolist() == [0.0, 10.0]
    assert float(dataset.energy_imbalance) < 1e-11


def test_a_stage_is_sampled_logarithmically():
    decades = {"duration": 100, "samples_per_decade": 4, "first_sample": 0.1, "sample_start": True}
    dataset = point(GAS, decades | {"temperature": 3.0})
    expected = [0.0, *(0.1 * 10.0 ** (k / 4) for k in range(13))]
    np.testing.assert_allclose(dataset.time, expected, rtol=1e-12, atol=0.0)
    assert dataset.time.values[-1] == 100.0
    assert dataset.E_trans_series.values[0] == pytest.approx(1.5, rel=1e-12)  # after the change
    short = point(GAS, {"duration": 3, "samples_per_decade": 2, "first_sample": 0.5})
    np.testing.assert_allclose(short.time, [0.5, 0.5 * 10.0**0.5, 3.0], rtol=1e-12)


def test_averages_over_uneven_samples_are_over_time_and_have_no_errors():
    stage_settings = ({"duration": 4, "measure": False}, {"duration": 8, "sample_at": [0, 1, 3, 4]})
    dataset = point(settings("heated", 40, [30, 30]), *stage_settings)
    weights = np.array([0.0, 1.0, 2.0, 1.0, 4.0]) / 8.0
    for name in ("E_trans", "E_rot", "R"):
        series = dataset[f"{name}_series"].values[8:]
        assert float(dataset[name]) == pytest.approx(float(weights @ series), rel=1e-12)
    rotational, translational = float(dataset.E_rot), float(dataset.E_trans)
    expected = rotational / (rotational + translational)
    assert float(dataset.R_ratio_of_means) == pytest.approx(expected, rel=1e-12)
    errors = ("R_stderr", "R_dof", "R_ci95", "E_trans_stderr", "E_rot_stderr")
    errors += ("autocorrelation_time", "R_collisional_stderr")
    assert np.isnan([float(dataset[name]) for name in errors]).all()
    assert {int(dataset[name]) for name in dataset if name.endswith("_trusted")} == {-1}
    assert "equal intervals" in dataset.R_ci95_trusted.attrs["comment"]
    assert float(dataset.measured_from) == 4.0
    several = point(HEATED, *stage_settings, seed=[1, 2, 3]).isel(r=0, beta=0)
    assert 0.0 < float(several.R_stderr) == float(several.R_stderr_over_seeds)
    assert math.isnan(several.R_drift)


def test_averages_of_species_are_over_time():
    species = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 2}]
    experiment = settings("gas", 40, [60, 60]) | {"species": species}
    dataset = point(experiment, {"duration": 8, "sample_at": [1, 3]}, spin_temperature=1.0)
    for name in ("E_trans_species", "R_species"):
        expected = (
            dataset[f"{name}_series"].values @ [1 / 8, 2 / 8, 5 / 8] if name[0] == "E" else None
        )
        if expected is not None:
            np.testing.assert_allclose(dataset[name], expected, rtol=1e-12)
        assert np.isnan(dataset[f"{name}_stderr"]).all()


def test_measured_stages_of_one_interval_are_averaged_as_usual():
    """The first stage, which is not measured, may have another interval."""
    stage_settings = ({"duration": 4, "measure": False}, {"duration": 8})
    usual = point(HEATED, *stage_settings)
    samplings = ({"sample_every": 0.5}, {"sample_at": [0.5 * k for k in range(1, 16)]})
    for sampling in samplings:
        dataset = point(HEATED, stage_settings[0], stage_settings[1] | sampling, every=2)
        assert dataset.time.size == 18
        for name in ("R", "R_stderr", "R_dof", "E_rot", "E_rot_stderr", "autocorrelation_time"):
            np.testing.assert_allclose(dataset[name], usual[name], rtol=1e-12, err_msg=name)
        assert float(dataset.measured_from) == 4.0


def test_observables_need_samples_at_equal_intervals():
    key = r"stages\[1\].sample_at = \[1.0\]: must be left out beside observables"
    stage_settings = ({"duration": 4}, {"duration": 4, "sample_at": [1]})
    for observe in (["cumulants"], {"mean": lambda frame: np.mean(frame.velocity**2)}):
        with pytest.raises(InputError, match=key):
            point(HEATED, *stage_settings, observe=observe)
    even_stages = ({"duration": 5, "sample_every": 0.25}, {"duration": 5, "sample_every": 0.25})
    square = {"square": lambda frame: np.mean(frame.velocity**2) / 2}
    dataset = point(HEATED, *even_stages, observe=square)
    assert float(dataset.square) == pytest.approx(float(dataset.E_trans), rel=1e-12)
