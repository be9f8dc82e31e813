"""The collision rule: contact by contact, what gases conserve, and their statistics."""

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from compiled import from_python

from roughgas import theory
from roughgas.effects import Effects
from roughgas.effects.spin import Spin
from roughgas.kernel.contact import response as compiled_response
from roughgas.kernel.memory import new_state
from roughgas.kernel.state import BOUNDARY_HITS, COLLISIONS, EXPONENT
from roughgas.simulation.energies import energies, ratio
from roughgas.statistics.errors import blocking_stderr

PAIR, WALL = 0.5, 1.0
response = from_python(compiled_response)
MATERIALS = [(r, beta) for r in (0.0, 0.3, 0.9, 1.0) for beta in (-1.0, -0.4, 0.0, 0.7, 1.0)]


def contacts(dimension, count=40):
    """Random normals n and approaching relative velocities, and the spins of both particles."""
    rng = np.random.default_rng(dimension)
    for _ in range(count):
        n, v, *spins = rng.standard_normal((4, dimension))
        n /= np.linalg.norm(n)
        yield n, -v * np.sign(v @ n), *(w[: 2 * dimension - 3] for w in spins)


def exchange(material, n, v, w, share=PAIR):
    """(push, turn): what the kernel's rule takes from particle 1 and adds to each spin."""
    q = theory.moment_of_inertia(len(n))
    spin = Spin(q)
    vectors = [tuple(map(float, vector)) for vector in (n, v, w)]
    push, turn = response(spin, Effects(spin=spin), material, *vectors, share, None)
    return np.array(push), np.array(turn)


def in_space(vector):
    """A velocity or a spin in the plane as a vector in space."""
    if len(vector) == 1:
        return np.array([0.0, 0.0, *vector])
    return np.array([*vector, 0.0])[:3]


def slip(n, v, w):
    """Contact velocity g = v - a w x n."""
    return (in_space(v) - np.cross(in_space(w), in_space(n)))[: len(n)]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("material", MATERIALS)
def test_the_contact_velocity_is_reflected_by_r_and_beta(dimension, material):
    r, beta = material
    for n, v, w1, w2 in contacts(dimension):
        push, turn = exchange(material, n, v, w1 + w2)
        before = slip(n, v, w1 + w2)
        after = slip(n, v - 2.0 * push, w1 + w2 + 2.0 * turn)
        normal = (before @ n) * n
        assert after @ n == pytest.approx(-r * (before @ n), abs=1e-14)
        assert after - (after @ n) * n == pytest.approx(-beta * (before - normal), abs=1e-14)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("material", MATERIALS)
def test_energies_change_by_the_papers_equations(dimension, material):
    """Eqs. (deltaEt) and (deltaEr), one collision at a time."""
    r, beta = material
    q = theory.moment_of_inertia(dimension)
    for n, v, w1, w2 in contacts(dimension):
        push, turn = exchange(material, n, v, w1 + w2)
        v_n = (v @ n) * n
        v_t, v_r = v - v_n, slip(n, 0.0 * v, w1 + w2)
        squares = v_t @ v_t, v_t @ v_r, v_r @ v_r
        translational = theory.translational_energy_change(v_n @ v_n, *squares, r, beta, q)
        rotational = theory.rotational_energy_change(*squares, beta, q)
        # v1 = v/2 and v2 = -v/2 in the frame of the pair
        assert push @ push - v @ push == pytest.approx(translational, abs=1e-13)
        gained = sum((w + turn) @ (w + turn) - w @ w for w in (w1, w2))
        assert 0.5 * q * gained == pytest.approx(rotational, abs=1e-13)


@pytest.mark.parametrize("dimension", [2, 3])
def test_smooth_particles_do_not_turn_and_elastic_ones_lose_nothing(dimension):
    q = theory.moment_of_inertia(dimension)
    for n, v, w1, w2 in contacts(dimension):
        push, turn = exchange((0.9, -1.0), n, v, w1 + w2)
        assert np.all(turn == 0.0)
        assert push == pytest.approx(0.95 * (v @ n) * n, abs=1e-14)
        push, turn = exchange((1.0, 1.0), n, v, w1 + w2, WALL)
        w = w1 + w2
        gained = (v - push) @ (v - push) - v @ v + q * ((w + turn) @ (w + turn) - w @ w)
        assert gained == pytest.approx(0.0, abs=1e-13)


def test_a_scene_without_spin_knows_the_normal_part_only():
    push, turn = response(None, Effects(), (0.5, 0.7), (1.0, 0.0), (-2.0, 3.0), None, PAIR, None)
    assert push == (-1.5, 0.0) and turn is None


GAS = settings("gas", 40, [25, 25])
SPHERES = settings("spheres", 64, [12, 12, 12])
SHEARED = settings("sheared", 40, [25, 25])
BED = settings("bed", 40, [12.5, "open"], floor={"restitution": 0.95, "roughness": 0.3})
WALLED = settings("walled", 40, [12.5, "open"])


def energy(shot, q):
    """Translational and rotational kinetic energy."""
    rotational = 0.0 if shot.spin is None else 0.5 * q * (shot.spin**2).sum()
    return 0.5 * (shot.velocity**2).sum(), rotational


def test_momentum_of_dissipative_gases():
    """Of the sheared gas, relative to the mean flow; of the bed, along the smooth floor."""
    scene, state = begin(settings("gas", 40, [25, 25]), 0.9, 0.3, 3)
    row = run(state, scene, 20, collisions=400)
    assert np.abs([row["p_x"], row["p_y"]]).max() < 1e-12

    scene, state = begin(SHEARED, 0.9, 0.3, 3)
    row = run(state, scene, 100, interval=1.0)
    rate = 2.0 / 25.0
    assert np.abs(row["p_y"]).max() < 1e-11
    assert np.abs(row["p_x"] - rate * row["y"]).max() < 1e-10

    scene, state = begin(settings("bed", 40, [12.5, "open"]), 0.9, 0.3, 3)
    assert np.abs(run(state, scene, 100, interval=1.0)["p_x"]).max() < 1e-11


@pytest.mark.parametrize(
    "experiment",
    [GAS, SHEARED, BED, WALLED, SPHERES],
    ids=["gas", "sheared", "bed", "walled", "spheres"],
)
def test_the_ledger_explains_every_change_of_energy(experiment):
    """Kinetic energy gained = what contacts, floor, walls and shear booked, and the weight's work.

    Of velocities as they are in the images that the particles last collided in.
    """
    q = experiment["effects"]["spin"]["inertia"]
    scene, state = begin(experiment, 0.9, 0.3, 4)
    state.spin[:] = np.random.default_rng(1).standard_normal(state.spin.shape)
    gravity = scene.effects.gravity
    exchanged = 0.0
    last = snapshot(state, scene)
    for _ in range(50):
        run(state, scene, 1, interval=0.5)
        shot = snapshot(state, scene)
        booked = state.ledger.sum(axis=(0, 1))
        state.ledger[:] = 0.0
        # no axis along which gravity pulls is periodic, so that heights need no unfolding
        fallen = 0.0 if gravity is None else (last.position - shot.position)[:, -1].sum()
        gained = np.subtract(energy(shot, q), energy(last, q))
        exchanged += np.abs(booked).sum()
        assert gained == pytest.approx(booked + np.array([fallen, 0.0]), abs=1e-10)
        last = shot
    assert exchanged > 1.0
    if scene.effects.floor is not None:
        assert state.counts[BOUNDARY_HITS] > 40


def test_a_pair_without_restitution_parts():
    """At r = 0 what is left of the normal velocity is rounding, which must bring no pair together

    again and again: here 100 pairs, one contact each.
    """
    scene, _ = begin(settings("gas", 2, [14, 14]), 0.0, 0.0)
    rng = np.random.default_rng(0)
    for _ in range(100):
        n = rng.standard_normal(2)
        n /= np.linalg.norm(n)
        position = np.array([[7.0, 7.0], 7.0 + 2.5 * n])
        velocity = (
            np.array([0.0 * n, -n]) + 0.1 * rng.standard_normal((2, 2)) + rng.standard_normal(2)
        )
        state = new_state(scene, position, velocity, np.zeros((2, 1)))
        run(state, scene, 1, interval=1.0, collisions=20)
        assert state.counts[COLLISIONS] < 5


@pytest.mark.parametrize("experiment", [GAS, SPHERES], ids=["disks", "spheres"])
def test_refreshing_takes_out_the_momentum_and_keeps_everything_else(experiment):
    scene, state = begin(experiment, 0.6, 0.2, 9)
    refreshed = run(state, scene, 400, collisions=len(state.changes), refresh=4)
    assert state.counts[EXPONENT] < -10  # so many halvings of the velocities
    unit = np.ldexp(1.0, refreshed["exponent"].astype(int))
    assert np.all(np.diff(refreshed["time"]) > 0.0)
    speeds = np.sqrt(refreshed["vv_x"] + refreshed["vv_y"])
    assert np.all((speeds > 0.1) & (speeds < 100.0))  # in the units of the moment
    assert np.max(np.abs(refreshed["p_x"]) / speeds) < 1e-13
    # Haff's law: the energy falls like t^-2 in the end; 30 seeds scatter by .0015 about -.9998
    t, v = refreshed["time"], speeds * unit
    slope = np.log(v[-1] / v[100]) / np.log(t[-1] / t[100])
    assert slope == pytest.approx(-1.0, abs=4 * 0.0015)


def test_refreshing_alone_changes_no_collision():
    """Momentum apart, which is taken out beforehand: the same pairs at the same times."""
    plain, refreshed = [], []
    for times, refresh in ((plain, 0), (refreshed, 1)):
        scene, state = begin(GAS, 0.8, 0.2, 10)
        for _ in range(8):
            times += list(run(state, scene, 1, collisions=20, refresh=refresh)["time"])
    assert refreshed == pytest.approx(plain, rel=1e-9)


def test_a_rough_elastic_gas_shares_its_energy_equally():
    """E_rot is its share of the total, 1/(3 - 2/N), within 4 sigma: 1e-4 of seeds fail.

    N spins share equally with 2 N - 2 translational degrees of freedom: momentum is conserved.
    """
    number = 40
    scene, state = begin(settings("gas", number, [25, 25]), 1.0, 1.0, 1)
    run(state, scene, 1, collisions=50 * number)
    E = energies(run(state, scene, 4000, collisions=number), number, 0.5)
    total = 2 * E.translational + E.rotational
    assert np.ptp(total) < 1e-9 * total[0]
    share = (E.rotational / total).mean()
    expected = 1.0 / (3.0 - 2.0 / number)
    error = blocking_stderr(E.rotational / total)
    assert error < 0.003
    assert abs(share - expected) < 4.0 * error


@pytest.mark.parametrize(
    ("kernel", "number", "box", "dimension"),
    [("smooth", 160, [50, 50], 2), ("smooth", 160, [100, 100], 2), ("spheres", 216, [20] * 3, 3)],
)
def test_collision_frequency_of_an_elastic_gas(kernel, number, box, dimension):
    """Enskog's within 2.5 %, of which 1 % is left to noise (1e5 collisions) and O(1/N)."""
    scene, state = begin(settings(kernel, number, box), 1.0, -1.0, 2)
    run(state, scene, 1, collisions=10 * number)
    rows = run(state, scene, 100, collisions=1000)
    time = rows["time"][-1] - rows["time"][0]
    frequency = 2.0 * 99_000 / number / time
    squares = sum(rows[f"vv_{axis}"][0] for axis in "xyz"[:dimension])
    # particles meet with the relative velocities of a gas without total momentum
    T_tr = squares / (dimension * (number - 1))
    packing = number * {2: np.pi, 3: 4 * np.pi / 3}[dimension] / np.prod(box)
    expected = theory.collision_frequency(T_tr, packing, dimension)
    assert frequency == pytest.approx(expected, rel=0.025)


def test_velocities_of_an_elastic_gas_are_maxwellian():
    """<v^4>/<v^2>^2 of 160 disks that start equally fast, within 4 sigma."""
    number = 160
    scene, state = begin(settings("smooth", number, [50, 50]), 1.0, -1.0, 3)
    state.trajectory[:, 2:4] /= np.linalg.norm(state.trajectory[:, 2:4], axis=1)[:, None]
    state.trajectory[:, 2:4] -= state.trajectory[:, 2:4].mean(axis=0)
    run(state, scene, 1, collisions=20 * number)
    fourth = []
    for _ in range(200):
        run(state, scene, 1, collisions=2 * number)
        squares = (state.trajectory[:, 2:4] ** 2).sum(axis=1)
        fourth.append((squares**2).mean() / squares.mean() ** 2)
    # on the sphere of n = 2 N - 2 velocities <v^4>/<v^2>^2 = 2 n/(n + 2) up to 1/N^2
    n = 2 * number - 2
    error = blocking_stderr(np.array(fourth))
    assert abs(np.mean(fourth) - 2.0 * n / (n + 2)) < 4.0 * error + 2.0 / number**2
    assert error < 0.02


def test_a_cooling_gas_keeps_its_plateau_long_after_its_rounding_errors_would_move_it():
    """With its residual momentum left in, R falls to 0.02 after 350 collisions per particle."""
    number = 40
    scene, state = begin(settings("gas", number, [50, 50]), 0.9, 0.0, 5)
    rows = run(state, scene, 600, collisions=number // 2, refresh=4)
    R = ratio(energies(rows, number, 0.5))
    # one gas of 40: R(t) scatters by 0.05, its mean over 150 correlated samples by about 0.01
    assert R[450:].mean() == pytest.approx(R[50:200].mean(), abs=0.06)
    speed = np.sqrt((rows["vv_x"] + rows["vv_y"]) / number)
    assert np.all((speed > 0.3) & (speed < 3.0))
    assert np.max(np.abs(rows["p_x"]) / speed) < 1e-12
