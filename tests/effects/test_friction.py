"""Coulomb friction: contacts stick or slide."""

import itertools

import numpy as np
import pytest
from brute_force import Beside, begin, run, scene_of, settings
from compiled import from_python

from roughgas import theory
from roughgas.effects import Effects
from roughgas.effects.friction import Friction
from roughgas.effects.spin import Spin
from roughgas.kernel.contact import response as compiled_response

PAIR, WALL = 0.5, 1.0
response = from_python(compiled_response)
MATERIALS = [(r, beta) for r in (0.0, 0.5, 1.0) for beta in (-1.0, -0.3, 0.4, 1.0)]


def exchange(mu, material, n, v, w, share):
    """(push, turn) of one contact; without friction where mu is None."""
    q = theory.moment_of_inertia(len(n))
    spin, friction = Spin(q), None if mu is None else Friction(mu, q)
    vectors = [tuple(map(float, vector)) for vector in (n, v, w)]
    effects = Effects(spin=spin, friction=friction)
    push, turn = response(spin, effects, material, *vectors, share, None)
    return np.array(push), np.array(turn)


def contacts(dimension, count=60):
    """Random normals, approaching relative velocities, and sums of spins.

    The tangential velocity is from a thousandth to a thousand times the normal one.
    """
    rng = np.random.default_rng(dimension)
    for _ in range(count):
        n, along, w = rng.standard_normal((3, dimension))
        n /= np.linalg.norm(n)
        along -= (along @ n) * n
        w = w[: 2 * dimension - 3]
        size = 10.0 ** rng.uniform(-3, 3)
        yield n, -abs(rng.standard_normal()) * n + size * along, size * w


def slip(n, v, w):
    """Tangential relative velocity of the surfaces."""
    dimension = len(n)
    n, v = (np.append(x, 0.0)[:3] for x in (n, v))
    w = np.array([0.0, 0.0, *w]) if dimension == 2 else w
    g = v - np.cross(w, n)
    return (g - (g @ n) * n)[:dimension]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("share", [PAIR, WALL])
def test_a_contact_sticks_inside_the_cone_and_slides_on_it(dimension, share):
    """|J_t| <= mu |J_n|, and equal to it where sticking would take more; both occur."""
    slides = []
    for mu, material in itertools.product((1e-3, 0.1, 0.5, 3.0), MATERIALS):
        for n, v, w in contacts(dimension):
            push, turn = exchange(mu, material, n, v, w, share)
            stuck, stuck_turn = exchange(None, material, n, v, w, share)
            normal, along, needed = push @ n, push - (push @ n) * n, stuck - (stuck @ n) * n
            most = mu * abs(normal)
            size, rounding = np.linalg.norm(along), 1e-15 * np.linalg.norm(v)
            assert normal == pytest.approx(stuck @ n, abs=10 * rounding)
            slides.append(np.linalg.norm(needed) > most + rounding)
            if slides[-1]:
                assert size == pytest.approx(most, rel=1e-12, abs=10 * rounding)
                g = slip(n, v, w)
                assert along @ g == pytest.approx(size * np.linalg.norm(g), abs=1e-9 * (g @ g))
            elif np.linalg.norm(needed) < most - rounding:
                assert np.array_equal(push, stuck) and np.array_equal(turn, stuck_turn)
    assert 0.2 < np.mean(slides) < 0.8


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("share", [PAIR, WALL])
def test_walton_s_roughness(dimension, share):
    """The slip is reflected by min{beta_0, -1 + mu (1 + r)(1 + 1/q) |g_n|/|g_t|}."""
    q, bodies = theory.moment_of_inertia(dimension), 1.0 / share
    for mu, (r, beta) in itertools.product((0.1, 0.7), MATERIALS):
        for n, v, w in contacts(dimension):
            push, turn = exchange(mu, (r, beta), n, v, w, share)
            before, after = slip(n, v, w), slip(n, v - bodies * push, w + bodies * turn)
            ratio = abs(v @ n) / np.linalg.norm(before)
            effective = min(beta, -1.0 + mu * (1.0 + r) * (1.0 + 1.0 / q) * ratio)
            assert after == pytest.approx(-effective * before, abs=1e-12 * (1 + abs(before).max()))


@pytest.mark.parametrize("dimension", [2, 3])
def test_no_contact_gains_energy(dimension):
    q = theory.moment_of_inertia(dimension)
    rng = np.random.default_rng(7)
    for mu, material in itertools.product((0.0, 0.1, 0.7, 1e300), MATERIALS):
        for n, v, w in contacts(dimension):
            one = rng.uniform() * w  # of the two spins, whose sum is w
            push, turn = exchange(mu, material, n, v, w, PAIR)
            gained = push @ push - v @ push + q * (w @ turn + turn @ turn)
            apart = sum(0.5 * q * ((x + turn) @ (x + turn) - x @ x) for x in (one, w - one))
            assert apart == pytest.approx(q * (w @ turn + turn @ turn), abs=1e-12 * (1 + w @ w))
            assert gained <= 1e-14 * (v @ v + w @ w)


def test_endless_friction_is_the_rough_gas():
    """The same bits after 1000 collisions."""
    ends = []
    for kernel, own in (("gas", {}), ("friction", {"friction": {"mu": 1e300}})):
        scene, state = begin(settings(kernel, 40, [25, 25], **own), 0.9, 0.3, 1)
        rows = run(state, scene, 5, collisions=200)
        ends.append((state.trajectory.tobytes(), state.spin.tobytes(), rows["ww"].tobytes()))
    assert ends[0] == ends[1]


@pytest.mark.parametrize("beta", [-0.5, 1.0])
def test_no_friction_is_the_smooth_gas(beta):
    """The same bits after 1000 collisions, and not one of any spin has changed."""
    ends = []
    for kernel, rough, own in (("gas", -1.0, {}), ("friction", beta, {"friction": {"mu": 0.0}})):
        scene, state = begin(settings(kernel, 40, [25, 25], **own), 0.9, rough, 1)
        state.spin[:] = np.random.default_rng(2).standard_normal(state.spin.shape)
        spin = state.spin.tobytes()
        rows = run(state, scene, 5, collisions=200)
        assert state.spin.tobytes() == spin
        ends.append((state.trajectory.tobytes(), rows["time"].tobytes()))
    assert ends[0] == ends[1]


CASES = {
    # experiment, r, beta, seed
    "disks": (settings("friction", 8, [12, 12], friction={"mu": 0.3}), 0.98, 0.8, 1),
    "disks, next to smooth": (settings("friction", 8, [12, 12], friction={"mu": 0.02}), 0.9, 1, 2),
    "spheres": (settings("heated spheres", 8, [7, 7, 7], friction={"mu": 0.2}), 0.98, 0.5, 3),
    "rough floor and walls": (
        settings(
            "rubbed bed",
            16,
            [12, "open"],
            floor={"restitution": 0.9, "roughness": 0.7},
            walls={"restitution": 0.8, "roughness": 0.4},
            friction={"mu": 0.25},
        ),
        0.85,
        0.6,
        4,
    ),
}
RARE = {"spheres", "rough floor and walls"}  # kernels that no other test compiles


@pytest.mark.parametrize(
    "case", [pytest.param(case, marks=[pytest.mark.slow] * (case in RARE)) for case in CASES]
)
def test_the_kernel_makes_the_same_collisions_as_brute_force(case):
    """The same 200 pairs in the same order, from the same state every ten collisions."""
    *point, seed = CASES[case]
    scene, world = scene_of(*point)
    _, state = begin(*point, seed)
    beside = Beside(state, scene, world)
    beside.assert_same(segments=20, collisions=10)
    if world.floor:
        assert beside.events["floor"] > 20
        assert beside.events["left"] > 5 and beside.events["right"] > 5
