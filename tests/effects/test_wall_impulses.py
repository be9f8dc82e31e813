"""What walls receive: momentum and angular momentum, against the brute force, and in balance."""

import numpy as np
import pytest
from brute_force import begin, run, scene_of, settings, snapshot
from brute_force.comparison import brute_force_from
from raw import build
from slow_cases import slow_but

from roughgas.kernel.layout import new_state
from roughgas.kernel.state import EXPONENT

TWO = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1.5, "mass": 3.0, "inertia": 0.3}]
BRUTE_NAMES = {"left": "left_wall", "right": "right_wall"}
GASES = {
    "walled": settings("walled", 16, [14, "open"], floor={"amplitude": 1.0}),
    "container": settings("container", 16, [16, 16]),
    "layer": settings("layer", 16, [7, 8, "open"]),
    "closed spheres": settings("closed spheres", 16, [8, 9, 10]),
    "two species": settings("container", 12, [16, 18]) | {"species": TWO},
}
WALLED = slow_but({"walled", "container", "layer"}, GASES)


def passed(rows, row=-1):
    """Momentum (3) and angular momentum (3) that each wall has received at a sample, by wall."""
    received = {}
    for name, column in rows.items():
        if name[:2] in ("J_", "L_"):
            quantity, wall = name.split()
            index = 3 * (quantity[0] == "L") + "xyz".index(quantity[-1])
            received.setdefault(wall, np.zeros(6))[index] = column[row]
    return received


@pytest.mark.parametrize("name", WALLED)
def test_walls_receive_what_particles_lose_in_the_brute_force(name):
    """Compared after each of 120 collisions; the brute force starts anew every ten."""
    scene, world = scene_of(GASES[name], 0.9, 0.3)
    _, state = begin(GASES[name], 0.9, 0.3, 4)
    run(state, scene, 1, collisions=50)
    met = set()
    for _ in range(12):
        before = passed(run(state, scene, 1, collisions=0))
        brute = brute_force_from(world, snapshot(state, scene))
        for _ in range(10):
            brute.run(1)
            now = passed(run(state, scene, 1, collisions=1))
            lost = {BRUTE_NAMES.get(wall, wall): x for wall, x in brute.lost_to_walls.items()}
            assert lost.keys() <= now.keys()
            for wall, received in now.items():
                expected = lost.get(wall, np.zeros(6))
                assert received - before[wall] == pytest.approx(expected, abs=1e-7)
        met |= lost.keys()
    assert met == now.keys()


@pytest.mark.parametrize("name", WALLED)
def test_the_momentum_of_a_gas_goes_to_walls_and_comes_from_gravity(name):
    """Its change plus the momentum that walls receive is the weight times time, to rounding."""
    scene, state = begin(GASES[name], 0.8, 0.3, 2)
    first, last = (run(state, scene, 1, collisions=k) for k in (20, 4000))
    axes = "xyz"[: len(scene.box)]
    change = np.array([last[f"p_{k}"][0] - first[f"p_{k}"][0] for k in axes])
    start, end = (sum(passed(rows).values())[: len(axes)] for rows in (first, last))
    weight = np.zeros(len(axes))
    if scene.effects.gravity is not None:
        weight[-1] = -16.0 * scene.effects.gravity.acceleration
    elapsed = last["time"][0] - first["time"][0]
    assert change + end - start == pytest.approx(weight * elapsed, abs=1e-9)
    assert np.abs(end - start).min() > 0.0


def bed_of_one(position, velocity):
    """A disk between rough elastic walls 20 a apart, above a smooth elastic floor at rest."""
    experiment = settings("walled", 1, [20, "open"], floor={"amplitude": 0.0})
    scene = build(experiment, 1.0, 1.0)
    return scene, new_state(scene, np.array([position]), np.array([velocity]), np.zeros((1, 1)))


def test_a_bouncing_particle_reverses_its_momentum_at_each_bounce():
    """2 m sqrt(2 g h) at each, 2 sqrt(2 h/g) apart."""
    scene, state = bed_of_one([10.0, 9.0], [0.0, 0.0])  # h = 8, 4 T to fall
    rows = run(state, scene, 10, interval=8.0)
    for k in range(10):
        received = passed(rows, k)
        assert received["floor"] == pytest.approx([0.0, -8.0 * (k + 1), 0, 0, 0, 0], abs=1e-9)
        assert not received["left_wall"].any() and not received["right_wall"].any()


def test_a_falling_particle_turns_at_a_rough_wall():
    """With beta = 1 and q = 1/2 the wall receives 2/3 m v_y, and as much angular momentum."""
    scene, state = bed_of_one([5.0, 1000.0], [1.0, 0.0])
    rows = run(state, scene, 2, interval=20.0)  # at the right wall at 14 T, at the left at 32 T
    falling = 2.0 / 3.0 * -14.0
    expected = [2.0, falling, 0.0, 0.0, 0.0, falling]
    assert passed(rows, 0)["right_wall"] == pytest.approx(expected, abs=1e-9)
    assert not passed(rows, 0)["left_wall"].any()
    spin = -falling / 0.5
    slip = -14.0 - falling - 18.0 - spin  # v_y - w n_x
    expected = [-2.0, slip / 3.0 * 2.0, 0.0, 0.0, 0.0, -slip / 3.0 * 2.0]
    assert passed(rows, 1)["left_wall"] == pytest.approx(expected, abs=1e-9)


@pytest.mark.slow  # compiles a kernel
def test_a_log_of_contacts_leaves_thermal_walls_out():
    experiment = settings("container", 16, [16, 16])
    experiment["effects"] |= {"contact_log": {"most": 10_000}}
    scene, state = begin(experiment, 0.9, 0.3, 1)
    rows = run(state, scene, 1, collisions=300)
    logged = state.log.rows[: state.log.made[0]]
    walls = logged[logged[:, 2] == -1.0]
    assert (walls[:, 3] == -1.0).any() and not (walls[:, 3] == 1.0).any()  # n_x of right and left
    assert passed(rows)["left_wall"][0] < 0.0 < passed(rows)["right_wall"][0]


@pytest.mark.slow  # compiles a kernel
def test_impulses_of_a_cooling_gas_stay_in_their_first_units():
    """The momentum balance holds through rescalings of the velocities."""
    experiment = settings("smooth", 30, [20, 20])
    experiment["effects"] = {
        "walls": {"restitution": 0.5, "roughness": -1.0},
        "wall_impulses": {},
    }
    scene, state = begin(experiment, 0.7, -1.0, 1)
    first = run(state, scene, 1, collisions=0)
    last = run(state, scene, 20, collisions=60, refresh=1)
    assert state.counts[EXPONENT] < -2
    momenta = [np.ldexp(rows["p_x"][-1], int(rows["exponent"][-1])) for rows in (first, last)]
    received = passed(last)
    assert momenta[1] - momenta[0] == pytest.approx(
        -received["left_wall"][0] - received["right_wall"][0], abs=1e-12
    )
    assert received["right_wall"][0] > 1.0
