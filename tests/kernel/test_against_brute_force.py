"""Every scene, collision by collision, against a slow simulation written from the paper."""

import pytest
from brute_force import Beside, BruteForce, begin, compare, scene_of, settings, snapshot
from brute_force import run as run_kernel

CASES = {
    # experiment, r, beta, seed
    "gas": (settings("gas", 8, [12, 12]), 0.98, 0.2, 1),
    "smallest box": (settings("gas", 3, [4.01, 8.0]), 0.99, 0.5, 2),
    "dense gas": (settings("gas", 12, [8.5, 8.5]), 0.98, -0.6, 3),
    "dilute gas": (settings("gas", 16, [90, 110]), 1.0, 1.0, 4),
    "smooth gas": (settings("smooth", 8, [12, 12]), 0.98, -1.0, 5),
    "sheared": (settings("sheared", 8, [12, 12]), 0.9, 0.2, 6),
    "fast shear": (settings("sheared", 6, [9, 11], shear={"velocity": 50.0}), 0.9, 0.2, 7),
    "slow gas, fast shear": (settings("sheared", 5, [9, 7], shear={"velocity": 2e3}), 0.5, 1.0, 8),
    "bed": (settings("bed", 16, [10, "open"]), 0.8, 0.2, 9),
    "bed on an inelastic, rough floor": (
        settings("bed", 16, [10, "open"], floor={"restitution": 0.8, "roughness": 0.5}),
        0.9,
        -0.5,
        10,
    ),
    "bed, small strokes": (
        settings("bed", 12, [9, "open"], floor={"amplitude": 0.3, "period": 0.2}),
        0.7,
        0.2,
        11,
    ),
    "bed between rough walls": (settings("walled", 16, [12, "open"]), 0.8, 0.2, 12),
    "bed between walls, contact time": (
        settings(
            "walled",
            16,
            [12, "open"],
            walls={"restitution": 0.7, "roughness": -0.4},
            floor={"restitution": 0.9, "roughness": 0.5},
            contact_time={"duration": 0.05},
        ),
        0.7,
        0.2,
        13,
    ),
    "gas between shaken walls": (
        settings("shaken", 12, [12, 12], shaken_walls={"restitution": 0.9, "amplitude": 0.5}),
        0.95,
        0.2,
        16,
    ),
    "viscoelastic gas": (settings("viscoelastic", 8, [12, 12]), 0.9, 0.2, 19),
    "slow viscoelastic gas": (
        settings(
            "viscoelastic", 8, [12, 12], viscoelastic={"speed": 50.0}, threshold={"speed": 0.2}
        ),
        0.6,
        0.2,
        20,
    ),
    "tabulated bed": (
        settings("tabulated bed", 16, [10, "open"], floor={"restitution": 0.9, "roughness": 0.5}),
        0.85,
        0.2,
        21,
    ),
    "spheres": (settings("spheres", 8, [7, 7, 7]), 0.98, 0.2, 14),
    "sheared spheres": (settings("sheared", 8, [8, 7, 9], spin={"inertia": 0.4}), 0.9, 0.2, 17),
    "bed of spheres": (settings("bed", 16, [7, 8, "open"], spin={"inertia": 0.4}), 0.8, 0.2, 18),
    "spheres, contact time": (
        settings("spheres", 12, [7, 8, 6.5], contact_time={"duration": 0.1}),
        0.9,
        -0.7,
        15,
    ),
}
SEGMENTS, COLLISIONS = 40, 10
RARE = {"sheared spheres", "bed of spheres", "tabulated bed"}  # kernels that no other test compiles


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[pytest.mark.slow] * (case in RARE)) for case in CASES]
)
def test_the_kernel_makes_the_same_collisions(case):
    """The same 400 pairs in the same order, from the same state every ten collisions."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    beside = Beside(state, scene, world)
    beside.assert_same(SEGMENTS, COLLISIONS)
    if world.floor:
        assert beside.events["floor"] > 20
    if world.walls:
        assert beside.events["left"] > 20 and beside.events["right"] > 20
    if world.contact_time > 1e-3:
        assert 10 < state.counts[4] < 0.9 * (SEGMENTS * COLLISIONS)


@pytest.mark.parametrize("case", ["gas", "sheared", "bed", "spheres"])
def test_without_restarts_until_chaos_separates_them(case):
    """From one start, with a tolerance that grows by 10^1.5 with each collision per particle."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    shot = snapshot(state, scene)
    brute = BruteForce(world, shot.position, shot.velocity, shot.spin)
    for collisions in range(5, 65, 5):
        brute.run(5)
        run_kernel(state, scene, 1, collisions=5)
        growth = 10.0 ** (1.5 * 2.0 * collisions / len(state.changes))
        assert compare(snapshot(state, scene), brute) < 1e-12 * growth


@pytest.mark.parametrize("case", ["gas", "sheared", "bed between rough walls", "spheres"])
def test_states_at_instants_between_collisions(case):
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    shot = snapshot(state, scene)
    brute = BruteForce(world, shot.position, shot.velocity, shot.spin)
    for k in range(1, 9):
        row = run_kernel(state, scene, 1, interval=0.125)
        brute.run_until(0.125 * k)
        assert row["time"] == pytest.approx(0.125 * k, abs=1e-15)
        assert compare(snapshot(state, scene), brute) < 1e-9
        middle = scene.middle
        assert row["y"] == pytest.approx((brute.x[:, 1] - middle).sum(), rel=1e-9, abs=1e-9)
        assert row["yy"] == pytest.approx(((brute.x[:, 1] - middle) ** 2).sum(), rel=1e-9)
        flow = ((brute.x[:, 1] - middle) * brute.v[:, 0]).sum()
        assert row["yv_x"] == pytest.approx(flow, rel=1e-9, abs=1e-8)
        for axis, name in enumerate("xyz"[: len(scene.box)]):
            assert row[f"vv_{name}"] == pytest.approx((brute.v[:, axis] ** 2).sum(), rel=1e-9)
            assert row[f"p_{name}"] == pytest.approx(brute.v[:, axis].sum(), abs=1e-8)
        assert row["ww"] == pytest.approx((brute.w**2).sum(), rel=1e-9, abs=1e-12)
