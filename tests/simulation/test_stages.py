"""A gas whose settings change from stage to stage."""

import math

import numpy as np
import pytest
from brute_force import Beside, begin, compare, scene_of, settings, snapshot
from brute_force.beside import brute_force_from

from roughgas import config, simulate, trajectory
from roughgas.base import InputError
from roughgas.cli.show import theory_beside
from roughgas.config import merged
from roughgas.effects.species import packing
from roughgas.simulation import change, schedule
from roughgas.simulation.gas import Gas
from roughgas.tasks import dsmc
from roughgas.theory.prediction import ratio_of_point

GAS = settings("gas", 40, [30, 30])
HEATED = settings("heated", 40, [30, 30])
BED = settings("bed", 20, [12.5, "open"])


def stages(*parts, every=0.5):
    return {"kind": "stages", "sample_every": every, "stages": list(parts)}


def point(experiment, *parts, r=0.9, beta=0.2, every=0.5, **more):
    """The dataset of a gas that goes through stages."""
    own = {"schedule": stages(*parts, every=every), "progress": False} | more
    return simulate(r=r, beta=beta, **(experiment | own))


def ratio_to_error(values, reference, errors):
    return np.max(np.abs(values - reference) / errors)


def test_a_stage_that_changes_nothing_leaves_all_bits_as_they_are():
    """In one piece and in three; named again are a power and an r that are the same."""
    whole = point(HEATED, {"duration": 30})
    again = {"effects": {"thermostat": {"power": 1.0}}, "r": 0.9}
    cut = point(HEATED, {"duration": 10}, {"duration": 15} | again, {"duration": 5})
    assert whole.energy_input.sel(source="stages").values.tolist() == [0.0, 0.0]
    for name in ("E_trans_series", "R_series", "energy_input_series", "collisions_series"):
        np.testing.assert_array_equal(whole[name], cut[name])
    assert cut.stage_begin.values.tolist() == [0.0, 10.0, 25.0]


def test_stages_are_what_a_steady_run_is():
    """The same samples, in two stages of which the first is not measured."""
    lengths = {"equilibrate": 20, "measure": 30, "sample_every": 0.5, "kind": "steady"}
    steady = simulate(r=0.9, beta=0.2, **(HEATED | {"schedule": lengths, "progress": False}))
    ours = point(HEATED, {"duration": 20, "measure": False}, {"duration": 30})
    late = ours.isel(sample=ours.time > 20.0)
    np.testing.assert_array_equal(steady.E_trans_series[-len(late.time) :], late.E_trans_series)
    for name in ("R", "R_stderr", "E_rot", "energy_input") if len(late.time) == 60 else ():
        known = ours[name].values[: len(steady[name].values)] if ours[name].ndim else ours[name]
        np.testing.assert_allclose(known, steady[name], rtol=1e-12)


CHANGES = {  # an experiment, and what changes in it
    "kicks": (HEATED, {"thermostat": {"power": 5.0, "spin_share": 1.0}}),
    "interval of kicks": (HEATED, {"thermostat": {"interval": 0.2}}),
    "bath": (settings("bath", 20, [20, 20]), {"langevin": {"drag": 1.0, "interval": 0.3}}),
    "gravity": (BED, {"gravity": {"acceleration": 2.5}}),
    "floor": (BED, {"floor": {"amplitude": 3.0, "restitution": 0.9}}),
    "shear": (settings("sheared", 20, [20, 20]), {"shear": {"velocity": 3.7}}),
    "walls": (
        settings("container", 20, [20, 20]),
        {"left_wall": {"temperature": 5.0, "velocity": -1.0}, "bottom_wall": {"velocity": 2.0}},
    ),
}


@pytest.mark.parametrize("name", CHANGES)
def test_across_a_change_the_gas_makes_the_collisions_of_the_brute_force(name):
    """The state that the change begins with is that of the brute force at the same instant; from
    there on both make the same collisions under the new settings, of which r and beta are two."""
    experiment, effects = CHANGES[name]
    old, world = scene_of(experiment, 0.9, 0.2)
    new, then = scene_of(merged(experiment, {"effects": effects}), 0.7, -0.3)
    gas = Gas.start(old, experiment, np.random.default_rng(3))
    gas.in_time(0.25, 15)
    begun = snapshot(gas.state, old)
    brute = brute_force_from(world, begun)
    gas.in_time(0.25, 1)
    brute.run_until(4.0)
    assert compare(snapshot(gas.state, old), brute) < 1e-7  # chaos has had a quarter of a T
    new = change.going_on(old, new, 4.0)
    before, books = gas.balance(), brute.v.copy()
    put_in = change.change(gas, new, 4.0)
    shear = new.effects.shear
    if shear is None:
        assert compare(snapshot(gas.state, new), brute) < 1e-7
    else:
        then = then._replace(slide=shear.begun)
        rate = (3.7 - 2.0) / 20.0
        brute.v[:, 0] += rate * (brute.x[:, 1] - 10.0)
        brute.world = then
        assert compare(snapshot(gas.state, new), brute) < 1e-7
        assert put_in[0] == pytest.approx(0.5 * (brute.v**2 - books**2).sum(), rel=1e-6)
    Beside(gas.state, new, then).assert_same(8, 10)
    after = gas.balance()
    gained = after.energy - before.energy - (after.ledger - before.ledger).sum(axis=0)
    np.testing.assert_allclose(gained, put_in, atol=1e-10 * abs(after.ledger).sum())


def test_the_images_of_a_sheared_gas_do_not_jump():
    old, _ = scene_of(CHANGES["shear"][0], 0.9, 0.2)
    new, _ = scene_of(merged(CHANGES["shear"][0], {"effects": {"shear": {"velocity": 7.0}}}), 1, 0)
    for time in (0.0, 3.3, 1234.5):
        after = change.going_on(old, new, time).effects.shear
        shift = change.displacement(old.effects.shear, time)
        away = (change.displacement(after, time) - shift + 10.0) % 20.0 - 10.0
        assert abs(away) < 1e-9


def test_what_a_change_of_gravity_puts_in_is_the_change_of_potential_energy():
    own = dict(r=0.9, beta=0.2, **BED, progress=False)
    parts = ({"duration": 10}, {"duration": 10, "effects": {"gravity": {"acceleration": 2.0}}})
    found = simulate(**own, schedule=stages(*parts))
    shot = trajectory(**own, schedule=stages(*parts), times=[10.0])
    height = float(shot.position.sel(axis="y").mean())
    assert found.stage_input.values[1] == pytest.approx([height, 0.0], rel=1e-9)


def test_an_elastic_gas_follows_its_bath_to_another_temperature():
    """T(t) = T_2 + (T_1 - T_2) exp(-2 gamma t), within 4 sigma of the scatter over ten seeds; steps

    of particles follow one another, so that the decay begins half an interval later at most.
    """
    still = {name: 0.0 for name in ("spin_drag", "spin_power")}
    bath = {"drag": 0.2, "temperature": 1.0, "interval": 0.05} | still
    experiment = settings("bath", 400, [200, 200], langevin=bath)
    parts = (
        {"duration": 15, "measure": False},
        {"duration": 10, "effects": {"langevin": {"temperature": 3.0}}},
    )
    runs = [point(experiment, *parts, r=1.0, beta=-1.0, seed=seed) for seed in range(10)]
    T = 2.0 * np.array([one.E_trans_series.values for one in runs])
    late = runs[0].time.values >= 15.0
    passed = runs[0].time.values[late] - 15.0
    expected = 3.0 - 2.0 * np.exp(-0.4 * passed)
    error = T[:, late].std(axis=0, ddof=1) / math.sqrt(10)
    assert error.max() < 0.1
    # 4 sigma of Student's t with 9 degrees of freedom are 6.6 standard errors
    assert ratio_to_error(T[:, late].mean(axis=0), expected + 0.01, error + 0.01) < 6.6


@pytest.mark.parametrize("name", CHANGES)
def test_the_energy_books_close_through_all_stages(name):
    """All sources and the beginnings of stages make the gain of energy, at every sample."""
    experiment, effects = CHANGES[name]
    more = {"duration": 4, "r": 0.8, "effects": effects}
    found = point(experiment, {"duration": 6}, more, {"duration": 2, "beta": -0.5})
    total = found.energy_input_series.sum("source")
    exchanged = float(np.abs(found.energy_input).sum())
    assert float(np.abs(total - found.energy_gain_series).max()) < 1e-11 * exchanged
    assert float(found.energy_imbalance) < 1e-11
    jump = found.energy_input_series.sel(source="stages").isel(sample=[11, 12, 19, 20, 23]).values
    assert (abs(jump[1, 0]) > 1e-3) == (name in ("gravity", "shear"))
    np.testing.assert_array_equal(jump[0], 0.0)
    np.testing.assert_allclose(jump[1:], np.broadcast_to(jump[1], (4, 2)), atol=1e-12)


def test_temperatures_that_are_set_are_exact():
    """Elastic rough disks whose spins are stopped, then of T_trans 4 and T_rot 0.25: what the
    stages put in is the difference, and the sum is kept."""
    parts = [{"duration": 5}, {"duration": 5, "temperature": 4.0, "spin_temperature": 0.25}]
    found = point(GAS, *parts, r=1.0, beta=1.0, spin_temperature=2.0)
    total = 2.0 * found.E_trans_series + found.E_rot_series  # two degrees of freedom, and one
    before, after = total.values[:10], total.values[10:]
    np.testing.assert_allclose(after, 4.0 + 0.125, rtol=1e-12)
    np.testing.assert_allclose(before, before[0], rtol=1e-12)
    assert found.stage_input.values[1].sum() == pytest.approx(4.125 - before[0], rel=1e-11)
    stopped = point(GAS, {"duration": 5, "spin_temperature": 0.0}, beta=-1.0, spin_temperature=2.0)
    np.testing.assert_array_equal(stopped.E_rot_series, 0.0)


@pytest.mark.slow
def test_a_relaxation_after_a_quench_is_that_of_a_gas_without_positions():
    """A cooling gas whose r and beta change when T_rot/T_tr is set: the ratio of the temperatures
    over collisions against the DSMC, at four instants, averaged over 24 seeds. A dilute gas, whose
    correlations are weaker than 4 combined errors show (4 values: fails by chance once in 4000)."""
    experiment = settings("gas", 160, [200, 200])
    quench = {"duration": 600, "r": 0.8, "beta": 0.0, "temperature": 1.0, "spin_temperature": 2.0}
    parts = ({"duration": 20}, quench)
    own = {"schedule": stages(*parts, every=4), "progress": False, "spin_temperature": 1.0}
    found = simulate(r=1.0, beta=-1.0, seed=range(24), **(experiment | own)).isel(r=0, beta=0)
    made = found.collisions_series.values
    since = made - made[4]
    crowding = packing(experiment) / math.pi
    runs, wanted = [], (1.0, 3.0, 6.0, 9.0)
    for seed in range(24):
        rng = np.random.default_rng(seed)
        gas = dsmc.new_gas(2000, 2.0, rng)
        runs.append(dsmc.run(gas, dsmc.material(0.8, 0.0, crowding=crowding), rng, 0.1, 120))
    R = np.array([run.R for run in runs])
    at = runs[0].collisions_per_particle
    places = [int(np.argmin(np.abs(since - n))) for n in wanted]
    ours, error = found.R_series.values[places], found.R_series_stderr.values[places]
    theirs = np.array([np.interp(since[k], at, R.mean(axis=0)) for k in places])
    scatter = np.array([np.interp(since[k], at, R.std(axis=0)) for k in places]) / math.sqrt(24)
    assert ratio_to_error(ours, theirs, np.hypot(error, scatter)) < 4.0
    assert np.all(np.abs(since[places] - wanted) < 0.3)
    assert ours[0] - ours[-1] > 20.0 * error[0]  # it does relax


def test_a_trajectory_goes_through_the_stages_of_its_point():
    parts = ({"duration": 10.5}, {"duration": 7, "r": 0.5, "effects": CHANGES["kicks"][1]})
    parts += ({"duration": 3.5, "temperature": 3.0, "spin_temperature": 1.0},)
    own = HEATED | {"schedule": stages(*parts, every=0.7), "progress": False}
    known = simulate(r=0.9, beta=0.2, keep_state=True, **own)
    shot = trajectory(r=0.9, beta=0.2, times=[3.0, 10.5, 21.0], **own)
    np.testing.assert_array_equal(shot.velocity[-1], known.last_velocity[0])
    np.testing.assert_allclose(shot.position[-1], known.last_position[0], atol=1e-11)
    again = simulate(r=0.5, beta=0.2, initial=known, **own)  # through the stages once more
    assert again.stage_begin.values.tolist() == [21.0, 31.5, 38.5]
    assert again.E_trans_series[-1] == pytest.approx(1.5, rel=0.3)


def test_a_run_goes_on_to_the_last_bit_from_its_last_stage():
    last = {"thermostat": {"power": 3.0}}
    parts = ({"duration": 5}, {"duration": 5, "effects": last}, {"duration": 5})
    whole = point(HEATED, *parts)
    kept = point(HEATED, *parts[:2], keep_state=True)
    rest = point(merged(HEATED, {"effects": last}), parts[2], initial=kept)
    assert rest.attrs["initial_exact"] == 1
    np.testing.assert_array_equal(rest.R_series, whole.R_series[20:])


def test_what_is_watched_counts_in_measured_stages_only():
    parts = ({"duration": 5, "measure": False}, {"duration": 5})
    found = point(HEATED, *parts, observe={"energy": lambda frame: np.mean(frame.velocity**2) / 2})
    assert found.energy == pytest.approx(float(found.E_trans), rel=1e-12)
    late = found.E_trans_series[found.time > 5.0]
    assert float(found.E_trans) == pytest.approx(float(late.mean()), rel=1e-12)


def test_no_theory_of_a_steady_state_is_held_against_it():
    parts = ({"duration": 5}, {"duration": 5, "temperature": 2.0})
    found = point(HEATED, *parts)
    assert math.isnan(ratio_of_point(found)) and found.attrs["stages"] == 2
    assert theory_beside(found, 0.5, math.nan) == "none: settings change in 2 stages"


def test_seeds_are_averaged_with_errors():
    parts = ({"duration": 5}, {"duration": 5, "temperature": 2.0})
    whole = point(HEATED, *parts, seed=[1, 2, 3]).isel(r=0, beta=0)
    each = [point(HEATED, *parts, seed=seed) for seed in (1, 2, 3)]
    for name in ("R_series", "E_rot_series", "energy_input_series", "stage_input"):
        values = np.array([one[name].values for one in each])
        np.testing.assert_allclose(whole[name], values.mean(axis=0), rtol=1e-12)
        error = values.std(axis=0, ddof=1) / math.sqrt(3)
        np.testing.assert_allclose(whole[f"{name}_stderr"], error, rtol=1e-9, atol=1e-15)
    assert whole.source.values.tolist() == ["thermostat", "contacts", "stages"]
    np.testing.assert_array_equal(whole.time_series, each[0].time)


def test_a_floor_may_not_jump():
    half = {"effects": {"floor": {"amplitude": 3.0}}}
    with pytest.raises(InputError, match=r"stages\[1\].effects.floor = 2.5 and 1.5 a: must change"):
        point(BED, {"duration": 10.5}, {"duration": 5} | half)
    with pytest.raises(InputError, match="of another kind"):
        point(BED, {"duration": 5, "effects": {"floor": {"wave": "sine"}}})
    point(BED, {"duration": 2}, {"duration": 1} | half)  # between two strokes


def test_temperatures_are_not_set_in_a_gas_that_flows():
    with pytest.raises(InputError, match=r"stages\[0\].temperature = 1: must not be given where"):
        point(CHANGES["shear"][0], {"duration": 5, "temperature": 1})


def test_a_schedule_of_another_kind_takes_nothing_from_the_one_before():
    known = config.load_experiment(config.SHIPPED, "sheared", "small")
    mine = config.changed_by(known, {"schedule": stages({"duration": 5})})
    assert set(mine["schedule"]) == {"kind", "sample_every", "stages"}
    schedule.check(config.validated(config.point_settings(mine), "mine"))
    kept = config.changed_by(known, {"schedule": {"kind": "steady", "measure": 5}})
    assert kept["schedule"]["equilibrate"] == known["schedule"]["equilibrate"]


def test_spins_that_are_all_zero_cannot_be_scaled():
    scene, state = begin(GAS, 0.9, -1.0)
    gas = Gas(scene, state)
    with pytest.raises(InputError, match="scaling changes nothing"):
        change.change(gas, scene, 0.0, change.Temperatures(rotation=1.0))
