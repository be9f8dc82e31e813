"""The log of contacts: against the energy balance, against brute force, and what it costs."""

import numpy as np
import pytest
from brute_force import BruteForce, begin, run, scene_of, settings, snapshot
from schedules import COOLING

from roughgas.base import as_json
from roughgas.cli.show import summary
from roughgas.data.point import read_point, write_point
from roughgas.effects.contacts import COUNTS, HEAT, STRESSES, columns_of_pairs
from roughgas.kernel.state import BASE, EXPONENT
from roughgas.scene import build
from roughgas.simulation.contact_log import logged
from roughgas.simulation.energies import balance
from roughgas.simulation.gas import Gas
from roughgas.simulation.point import run_point
from roughgas.simulation.recorder import Recorder

TWO = {"species": [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "inertia": 0.3}]}
SHEARED = settings("sheared", 40, [25, 25])
GASES = {
    "walled": settings("walled", 40, [25, "open"]),
    "spheres": settings("spheres", 40),
    "two species": settings("heated", 40, [30, 30]) | TWO,
    "sheared": SHEARED | {"effects": SHEARED["effects"] | {"contact_log": {"most": 3000}}},
}
OWN = [pytest.param(name, marks=pytest.mark.slow) for name in ("two species", "sheared")]
EACH = ["walled", "spheres", *OWN]  # the slow ones have kernels of their own


def gas_of(name, seed=1):
    scene = build(GASES[name], 0.8, 0.3)
    return Gas.start(scene, GASES[name], np.random.default_rng(seed))


def gains(found, q):
    """The energy that each contact gives to translation and to rotation, (contacts, 2)."""
    return gains_of_each(found, q).sum(axis=-1).T


def gains_of_each(found, q):
    """The same of each partner, (2, contacts, partners)."""
    mass = found.get("logged_mass", np.ones_like(found["logged_partner"]))
    inertia = found.get("logged_inertia", np.full(mass.shape, q)) * mass
    parts = []
    for values, weight in ((found["logged_velocity"], mass), (found["logged_spin"], inertia)):
        square = (values**2).sum(axis=-1)
        change = np.where(found["logged_partner"] < 0, 0.0, square[:, 1] - square[:, 0])
        parts.append(0.5 * np.nan_to_num(weight * change))
    return np.array(parts)


@pytest.mark.parametrize("name", EACH)
def test_what_logged_contacts_take_is_what_the_books_say(name):
    """Of pairs and, in a bed, of floor and walls, to rounding."""
    gas = gas_of(name)
    gas.in_time(5.0, 3)
    found, booked = logged(gas, gas.state.log), gas.balance().ledger
    assert 100 < gas.collisions < len(found["logged_time"]) + 1 <= 3000
    gained = gains(found, gas.scene.effects.spin.inertia)
    pairs = found["logged_partner"][:, 1] >= 0
    assert pairs.sum() == gas.collisions and found["contacts_lost"] == 0
    assert gained[pairs].sum(axis=0) == pytest.approx(booked[-1], rel=1e-9)
    if name == "walled":
        assert (~pairs).sum() > 10
        assert gained[~pairs].sum(axis=0) == pytest.approx(booked[:-1].sum(axis=0), rel=1e-9)


@pytest.mark.parametrize("name", ["spheres", OWN[0]])
def test_contacts_of_each_pair_of_species_are_those_of_the_log(name):
    """Their number, and the energy that they take, to rounding."""
    gas = gas_of(name)
    columns = gas.in_time(5.0, 3)
    found, kinds = logged(gas, gas.state.log), 2 if name == "two species" else 1
    species = found.get("logged_species", np.zeros_like(found["logged_partner"]))
    place = species @ [kinds, 1]
    lost = -gains(found, gas.scene.effects.spin.inertia).sum(axis=1)
    sums = sums_of_pairs(columns, COUNTS, kinds).T
    assert sums[0].tolist() == np.bincount(place, minlength=kinds**2).tolist()
    assert sums[1] == pytest.approx(np.bincount(place, lost, kinds**2), rel=1e-9)
    assert sums[0].min() > 5


def sums_of_pairs(columns, names, kinds):
    """The last running sums, (pairs of species, names)."""
    names = columns_of_pairs(names, kinds)
    return np.array([columns[one][-1] for one in names]).reshape(kinds**2, -1)


@pytest.mark.slow  # compiles a kernel
def test_what_contacts_of_each_pair_carry_is_that_of_the_log():
    """The momentum that passes to one partner, and half of what energy one gains and the other
    loses, from centre to centre; to rounding."""
    gas = gas_of("two species")
    columns = gas.in_time(5.0, 3)
    found = logged(gas, gas.state.log)
    place = found["logged_species"] @ [2, 1]
    far = found["logged_radius"].sum(axis=1)[:, None] * found["logged_normal"]
    velocity, spun = found["logged_velocity"], gains_of_each(found, 0.5).sum(axis=0)
    passed = found["logged_mass"][:, :1] * (velocity[:, 1, 0] - velocity[:, 0, 0])
    energy = (spun[:, 0] - spun[:, 1]) / 2.0
    stress = sums_of_pairs(columns, STRESSES, 2).reshape(4, 3, 3)[:, :2, :2]
    heat = sums_of_pairs(columns, HEAT, 2)[:, :2]
    for pair in range(4):
        own = place == pair
        expected = passed[own].T @ far[own]
        assert stress[pair] == pytest.approx(expected, rel=1e-9)
        assert heat[pair] == pytest.approx(energy[own] @ far[own], rel=1e-9)
        assert own.sum() > 5 and abs(expected).min() > 0.0


def test_a_gas_that_cools_by_powers_of_two_is_logged_in_its_first_units():
    """And not while it is thermalised."""
    gas = gas_of("spheres")
    gas.thermalise(5)
    gas.cool(40)
    assert len(logged(gas, gas.state.log)["logged_time"]) == 0
    before = gas.balance().ledger[-1]
    gas.in_collisions(40, 50)
    found = logged(gas, gas.state.log)
    assert gas.state.counts[EXPONENT] < -3 and len(found["logged_time"]) == 2000
    booked = gas.balance().ledger[-1] - before
    assert gains(found, 0.4).sum(axis=0) == pytest.approx(booked, rel=1e-9)
    assert np.all(np.diff(found["logged_time"]) >= 0.0)
    assert found["logged_time"][-1] == pytest.approx(gas.time, rel=1e-12)


class Logging(BruteForce):
    """Notes of each contact its time and partners, and velocities and spins before and after."""

    def _resolve(self, kind, i, j):
        self.noted = getattr(self, "noted", [])
        before = self.v.copy(), self.w.copy()
        super()._resolve(kind, i, j)
        partners = [i] if j < 0 else [i, j]
        rows = [one[partners] for one in (*before, self.v, self.w)]
        self.noted.append((self.time, partners, *rows))


@pytest.mark.parametrize("name", EACH)
def test_each_contact_is_as_brute_force_has_it(name):
    """Time, partners, velocities and spins of twenty events in a row, from where the kernel stands;

    of a sheared gas as far as partners are in the same image.
    """
    experiment = GASES[name]
    scene, world = scene_of(experiment, 0.8, 0.3)
    _, state = begin(experiment, 0.8, 0.3, 4)
    run(state, scene, 1, collisions=100)
    shot, had = snapshot(state, scene), int(state.log.made[0])
    *particles, drive, company, word = shot[1:]
    brute = Logging(world, *particles, shot.time, None, drive, company, word)
    brute.run(20)
    noted = [one for one in brute.noted if len(one[1]) == 2 or name == "walled"]
    base = state.clock[BASE]
    run(state, scene, 1, collisions=20)
    assert state.clock[BASE] >= base
    gas = Gas(scene, state)
    found = logged(gas, state.log)
    D, compared = len(scene.box), 0
    own = {key: one[had:] for key, one in found.items() if key.startswith("logged_")}
    assert len(own["logged_time"]) == len(noted)
    for k, (time, partners, v, w, after_v, after_w) in enumerate(noted):
        assert own["logged_time"][k] == pytest.approx(time, abs=1e-9)
        there = own["logged_partner"][k][: len(partners)]
        assert {*there} == {*partners}
        order = [partners.index(one) for one in there]
        for instant, (velocity, spin) in enumerate(((v, w), (after_v, after_w))):
            spins = spin[order][:, 6 - 2 * D :]
            assert own["logged_spin"][k, instant][: len(there)] == pytest.approx(spins, abs=1e-7)
            seen = own["logged_velocity"][k, instant][: len(there)]
            shift = (seen - velocity[order])[-1, 0] / (world.shear or 1.0)
            assert shift == pytest.approx(round(shift), abs=1e-7)
            expected = velocity[order]
            expected[-1, 0] += round(shift) * world.shear
            assert seen == pytest.approx(expected, abs=1e-7)
        compared += 1
    assert compared >= 20


def test_the_normal_is_that_of_the_collision_rule():
    """What passes between smooth partners is along it: here the normal part of the change."""
    gas = gas_of("spheres")
    gas.in_time(5.0, 1)
    found = logged(gas, gas.state.log)
    n, v = found["logged_normal"], found["logged_velocity"]
    assert np.linalg.norm(n, axis=1) == pytest.approx(1.0, abs=1e-14)
    before, after = (np.einsum("cd,cd->c", n, v[:, k, 0] - v[:, k, 1]) for k in range(2))
    assert after == pytest.approx(-0.8 * before, rel=1e-9)


@pytest.mark.slow  # compiles a kernel
def test_a_log_changes_no_bit():
    """Beside the same gas without one."""
    ends = []
    without = {k: v for k, v in GASES["two species"]["effects"].items() if "contact_" not in k}
    for experiment in (GASES["two species"], GASES["two species"] | {"effects": without}):
        scene, state = begin(experiment, 0.8, 0.3, 1)
        run(state, scene, 10, interval=1.0)
        ends.append((state.trajectory.tobytes(), balance(state, scene).ledger.tobytes()))
    assert ends[0] == ends[1]


def test_of_many_replicas_only_the_logged_one_is_kept(monkeypatch):
    recorders = []

    def noted(*arguments):
        recorders.append(Recorder(*arguments))
        return recorders[-1]

    monkeypatch.setattr("roughgas.simulation.point.Recorder", noted)
    experiment = GASES["spheres"] | {"schedule": COOLING}
    found = run_point(build(experiment, 0.8, 0.3), experiment, 1).variables
    assert len(found["R_replica"]) > 1 and len(recorders[0].gases) == 1


def test_a_full_log_has_the_last_contacts_and_says_so(tmp_path):
    experiment = GASES["spheres"] | {"schedule": COOLING}
    found = []
    for most in (50, 3000):
        effects = experiment["effects"] | {"contact_log": {"most": most}}
        settings = experiment | {"effects": effects}
        found.append(run_point(build(settings, 0.8, 0.3), settings, 1))
    short, whole = (one.variables for one in found)
    made = len(whole["logged_time"])
    assert whole["contacts_lost"] == 0 and short["contacts_lost"] == made - 50 > 0
    for name in whole:
        if name.startswith("logged_"):
            assert np.array_equal(short[name], whole[name][-50:]), name
    about = {"experiment": "one", "scale": "small", "command": "none"}
    found[0].attributes.update(about, experiment_json=as_json(experiment, indent=None))
    path = tmp_path / "point.nc"
    write_point(path, found[0])
    data = read_point(path)
    assert data.logged_velocity.dims == ("contact", "instant", "partner", "axis")
    assert np.array_equal(data.logged_velocity.sel(instant="after"), short["logged_velocity"][:, 1])
    assert f"the last 50; {made - 50:,} before them are lost" in summary(path)
