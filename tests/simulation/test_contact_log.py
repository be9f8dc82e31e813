"""The log of contacts, against the energy balance and against the brute force."""

import numpy as np
import pytest
from brute_force import BruteForce, begin, run, scene_of, settings, snapshot
from raw import build, run_point, start_gas
from schedules import COOLING

from roughgas.base import as_json
from roughgas.cli.show import summary
from roughgas.data.point import read_point, write_point
from roughgas.effects.contacts import COUNTS, HEAT, STRESSES, columns_of_pairs
from roughgas.kernel.state import BASE, EXPONENT
from roughgas.simulation.contact_log import contact_log_variables
from roughgas.simulation.energy_balance import balance
from roughgas.simulation.gas import Gas

TWO = {"species": [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "inertia": 0.3}]}
SHEARED = settings("sheared", 40, [25, 25])
GASES = {
    "walled": settings("walled", 40, [25, "open"]),
    "spheres": settings("spheres", 40),
    "two species": settings("heated", 40, [30, 30]) | TWO,
    "sheared": SHEARED | {"effects": SHEARED["effects"] | {"contact_log": {"most": 3000}}},
}
SLOW_GASES = [pytest.param(name, marks=pytest.mark.slow) for name in ("two species", "sheared")]
ALL_GASES = ["walled", "spheres", *SLOW_GASES]  # SLOW_GASES compile other kernels


def gas_of(name, seed=1):
    """A Gas at its start."""
    scene = build(GASES[name], 0.8, 0.3)
    return start_gas(scene, GASES[name], np.random.default_rng(seed))


def energy_gains(log, q):
    """The energy that each contact adds to translation and to rotation, (contacts, 2)."""
    return energy_gains_of_partners(log, q).sum(axis=-1).T


def energy_gains_of_partners(log, q):
    """The same for each partner, (2, contacts, partners)."""
    mass = log.get("logged_mass", np.ones_like(log["logged_partner"]))
    inertia = log.get("logged_inertia", np.full(mass.shape, q)) * mass
    gains_of_motions = []
    for values, weight in ((log["logged_velocity"], mass), (log["logged_spin"], inertia)):
        square = (values**2).sum(axis=-1)
        change = np.where(log["logged_partner"] < 0, 0.0, square[:, 1] - square[:, 0])
        gains_of_motions.append(0.5 * np.nan_to_num(weight * change))
    return np.array(gains_of_motions)


@pytest.mark.parametrize("name", ALL_GASES)
def test_energy_of_logged_contacts_is_that_of_the_energy_balance(name):
    """For pairs and, in a bed, for floor and walls, to rounding."""
    gas = gas_of(name)
    gas.in_time(5.0, 3)
    log, booked = contact_log_variables(gas, gas.state.log), gas.balance().ledger
    assert 100 < gas.collisions < len(log["logged_time"]) + 1 <= 3000
    gained = energy_gains(log, gas.scene.effects.spin.inertia)
    pairs = log["logged_partner"][:, 1] >= 0
    assert pairs.sum() == gas.collisions and log["contacts_lost"] == 0
    assert gained[pairs].sum(axis=0) == pytest.approx(booked[-1], rel=1e-9)
    if name == "walled":
        assert (~pairs).sum() > 10
        assert gained[~pairs].sum(axis=0) == pytest.approx(booked[:-1].sum(axis=0), rel=1e-9)


@pytest.mark.parametrize("name", ["spheres", SLOW_GASES[0]])
def test_contacts_of_each_pair_of_species_are_those_of_the_log(name):
    """Their number and the energy they dissipate, to rounding."""
    gas = gas_of(name)
    columns = gas.in_time(5.0, 3)
    log, kinds = contact_log_variables(gas, gas.state.log), 2 if name == "two species" else 1
    species = log.get("logged_species", np.zeros_like(log["logged_partner"]))
    pair_index = species @ [kinds, 1]
    lost = -energy_gains(log, gas.scene.effects.spin.inertia).sum(axis=1)
    sums = sums_of_pairs(columns, COUNTS, kinds).T
    assert sums[0].tolist() == np.bincount(pair_index, minlength=kinds**2).tolist()
    assert sums[1] == pytest.approx(np.bincount(pair_index, lost, kinds**2), rel=1e-9)
    assert sums[0].min() > 5


def sums_of_pairs(columns, names, kinds):
    """The last running sums, (pairs of species, components)."""
    names = columns_of_pairs(names, kinds)
    return np.array([columns[name][-1] for name in names]).reshape(kinds**2, -1)


@pytest.mark.slow  # compiles a kernel
def test_fluxes_of_each_pair_of_species_are_those_of_the_log():
    """Momentum and energy that contacts pass between partners, times the distance of centres.

    The energy passed is half the difference of the partners' gains. To rounding.
    """
    gas = gas_of("two species")
    columns = gas.in_time(5.0, 3)
    log = contact_log_variables(gas, gas.state.log)
    pair_index = log["logged_species"] @ [2, 1]
    centre_distances = log["logged_radius"].sum(axis=1)[:, None] * log["logged_normal"]
    velocity, gained = log["logged_velocity"], energy_gains_of_partners(log, 0.5).sum(axis=0)
    momentum = log["logged_mass"][:, :1] * (velocity[:, 1, 0] - velocity[:, 0, 0])
    energy_passed = (gained[:, 0] - gained[:, 1]) / 2.0
    stress = sums_of_pairs(columns, STRESSES, 2).reshape(4, 3, 3)[:, :2, :2]
    heat = sums_of_pairs(columns, HEAT, 2)[:, :2]
    for pair in range(4):
        selected = pair_index == pair
        expected = momentum[selected].T @ centre_distances[selected]
        assert stress[pair] == pytest.approx(expected, rel=1e-9)
        assert heat[pair] == pytest.approx(
            energy_passed[selected] @ centre_distances[selected], rel=1e-9
        )
        assert selected.sum() > 5 and abs(expected).min() > 0.0


def test_a_gas_that_cools_by_powers_of_two_is_logged_in_its_first_units():
    """Contacts during the thermalisation are not logged."""
    gas = gas_of("spheres")
    gas.thermalise(5)
    gas.cool(40)
    assert len(contact_log_variables(gas, gas.state.log)["logged_time"]) == 0
    before = gas.balance().ledger[-1]
    gas.in_collisions(40, 50)
    log = contact_log_variables(gas, gas.state.log)
    assert gas.state.counts[EXPONENT] < -3 and len(log["logged_time"]) == 2000
    booked = gas.balance().ledger[-1] - before
    assert energy_gains(log, 0.4).sum(axis=0) == pytest.approx(booked, rel=1e-9)
    assert np.all(np.diff(log["logged_time"]) >= 0.0)
    assert log["logged_time"][-1] == pytest.approx(gas.time, rel=1e-12)


class Logging(BruteForce):
    """A brute force that records time, partners, and velocities and spins around each contact."""

    def _resolve(self, kind, i, j):
        self.noted = getattr(self, "noted", [])
        before = self.v.copy(), self.w.copy()
        super()._resolve(kind, i, j)
        partners = [i] if j < 0 else [i, j]
        rows = [values[partners] for values in (*before, self.v, self.w)]
        self.noted.append((self.time, partners, *rows))


@pytest.mark.parametrize("name", ALL_GASES)
def test_each_logged_contact_is_that_of_the_brute_force(name):
    """Time, partners, velocities and spins of twenty contacts in a row, from the kernel's state.

    In a sheared gas, velocities up to the difference between images.
    """
    experiment = GASES[name]
    scene, world = scene_of(experiment, 0.8, 0.3)
    _, state = begin(experiment, 0.8, 0.3, 4)
    run(state, scene, 1, collisions=100)
    shot, contacts_before = snapshot(state, scene), int(state.log.made[0])
    *particles, drive, bodies, word = shot[1:]
    brute = Logging(world, *particles, shot.time, None, drive, bodies, word)
    brute.run(20)
    noted = [contact for contact in brute.noted if len(contact[1]) == 2 or name == "walled"]
    base = state.clock[BASE]
    run(state, scene, 1, collisions=20)
    assert state.clock[BASE] >= base
    gas = Gas(scene, state)
    log = contact_log_variables(gas, state.log)
    D, compared = len(scene.box), 0
    new_log = {
        key: values[contacts_before:] for key, values in log.items() if key.startswith("logged_")
    }
    assert len(new_log["logged_time"]) == len(noted)
    for k, (time, partners, v, w, after_v, after_w) in enumerate(noted):
        assert new_log["logged_time"][k] == pytest.approx(time, abs=1e-9)
        logged_partners = new_log["logged_partner"][k][: len(partners)]
        assert {*logged_partners} == {*partners}
        order = [partners.index(partner) for partner in logged_partners]
        for instant, (velocity, spin) in enumerate(((v, w), (after_v, after_w))):
            spins = spin[order][:, 6 - 2 * D :]
            assert new_log["logged_spin"][k, instant][: len(logged_partners)] == pytest.approx(
                spins, abs=1e-7
            )
            logged_velocity = new_log["logged_velocity"][k, instant][: len(logged_partners)]
            shift = (logged_velocity - velocity[order])[-1, 0] / (world.shear or 1.0)
            assert shift == pytest.approx(round(shift), abs=1e-7)
            expected = velocity[order]
            expected[-1, 0] += round(shift) * world.shear
            assert logged_velocity == pytest.approx(expected, abs=1e-7)
        compared += 1
    assert compared >= 20


def test_the_normal_is_that_of_the_collision_rule():
    """The normal component of the relative velocity is reversed by r."""
    gas = gas_of("spheres")
    gas.in_time(5.0, 1)
    log = contact_log_variables(gas, gas.state.log)
    n, v = log["logged_normal"], log["logged_velocity"]
    assert np.linalg.norm(n, axis=1) == pytest.approx(1.0, abs=1e-14)
    before, after = (np.einsum("cd,cd->c", n, v[:, k, 0] - v[:, k, 1]) for k in range(2))
    assert after == pytest.approx(-0.8 * before, rel=1e-9)


@pytest.mark.slow  # compiles a kernel
def test_a_log_changes_no_bit():
    """The same bits as without a log."""
    ends = []
    without = {k: v for k, v in GASES["two species"]["effects"].items() if "contact_" not in k}
    for experiment in (GASES["two species"], GASES["two species"] | {"effects": without}):
        scene, state = begin(experiment, 0.8, 0.3, 1)
        run(state, scene, 10, interval=1.0)
        ends.append((state.trajectory.tobytes(), balance(state, scene).ledger.tobytes()))
    assert ends[0] == ends[1]


def test_the_log_of_many_replicas_is_that_of_the_first():
    """With the same seed, gases of 2 and of 5 replicas have the same first replica."""
    logs = []
    for replicas in (2, 5):
        experiment = GASES["spheres"] | {"schedule": COOLING | {"replicas": replicas}}
        point = run_point(build(experiment, 0.8, 0.3), experiment, 1).variables
        assert len(point["R_replica"]) == replicas
        logs.append(point["logged_time"])
    np.testing.assert_array_equal(*logs)


def test_a_full_log_has_the_last_contacts_and_says_so(tmp_path):
    experiment = GASES["spheres"] | {"schedule": COOLING}
    points = []
    for capacity in (50, 3000):
        effects = experiment["effects"] | {"contact_log": {"most": capacity}}
        settings = experiment | {"effects": effects}
        points.append(run_point(build(settings, 0.8, 0.3), settings, 1))
    short, complete = (point.variables for point in points)
    contacts_made = len(complete["logged_time"])
    assert complete["contacts_lost"] == 0 and short["contacts_lost"] == contacts_made - 50 > 0
    for name in complete:
        if name.startswith("logged_"):
            assert np.array_equal(short[name], complete[name][-50:]), name
    attributes = {"experiment": "one", "scale": "small", "command": "none"}
    points[0].attributes.update(attributes, experiment_json=as_json(experiment, indent=None))
    path = tmp_path / "point.nc"
    write_point(path, points[0])
    data = read_point(path)
    assert data.logged_velocity.dims == ("contact", "instant", "partner", "axis")
    assert np.array_equal(data.logged_velocity.sel(instant="after"), short["logged_velocity"][:, 1])
    assert f"the last 50; {contacts_made - 50:,} before them are lost" in summary(path)
