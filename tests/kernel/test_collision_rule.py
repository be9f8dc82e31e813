"""The collision rule contact by contact, and the energy balance of gases."""

import itertools

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from compiled import from_python
from slow_cases import slow_but

from roughgas import theory
from roughgas.effects import Effects
from roughgas.effects.contacts import Friction, Spin
from roughgas.kernel.contact import impulse_and_spin_change as compiled_rule
from roughgas.kernel.particles import identical_pair
from roughgas.kernel.state import BOUNDARY_HITS, EXPONENT

PAIR, WALL = 0.5, 1.0
impulse_and_spin_change = from_python(compiled_rule)
MATERIALS = [(r, beta) for r in (0.0, 0.3, 0.9, 1.0) for beta in (-1.0, -0.4, 0.0, 0.7, 1.0)]


def contacts(dimension, count=60):
    """Random normals, approaching relative velocities, and sums of spins.

    The tangential velocity is from a thousandth to a thousand times the normal one.
    """
    rng = np.random.default_rng(dimension)
    for _ in range(count):
        n, tangential, w = rng.standard_normal((3, dimension))
        n /= np.linalg.norm(n)
        tangential -= (tangential @ n) * n
        size = 10.0 ** rng.uniform(-3, 3)
        yield n, -abs(rng.standard_normal()) * n + size * tangential, size * w[: 2 * dimension - 3]


def exchange(material, n, v, w, share=PAIR, mu=None):
    """(impulse, change of spin) of a contact; without friction if mu is None."""
    q = theory.moment_of_inertia(len(n))
    effects = Effects(spin=Spin(q), friction=None if mu is None else Friction(mu, q))
    vectors = [tuple(map(float, vector)) for vector in (n, v, w)]
    push, turn = impulse_and_spin_change(
        effects, material, *vectors, share, identical_pair(Spin(q))
    )
    return np.array(push), np.array(turn)


def slip(n, v, w):
    """Tangential relative velocity of the surfaces."""
    space = np.append(n, 0.0)[:3]
    g = np.append(v, 0.0)[:3] - np.cross(np.append([0.0, 0.0], w)[-3:], space)
    return (g - (g @ space) * space)[: len(n)]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("share", [PAIR, WALL])
def test_the_contact_velocity_is_reflected_by_r_and_beta(dimension, share):
    bodies = 1.0 / share
    for r, beta in MATERIALS:
        for n, v, w in contacts(dimension):
            push, turn = exchange((r, beta), n, v, w, share)
            rounding = 1e-14 * (1.0 + np.linalg.norm(v) + np.linalg.norm(w))
            after = v - bodies * push, w + bodies * turn
            assert after[0] @ n == pytest.approx(-r * (v @ n), abs=rounding)
            assert slip(n, *after) == pytest.approx(-beta * slip(n, v, w), abs=rounding)


@pytest.mark.parametrize(
    ("dimension", "share"),
    slow_but([(2, PAIR), (3, WALL)], [(2, PAIR), (3, PAIR), (2, WALL), (3, WALL)]),
)
def test_a_contact_sticks_inside_the_cone_and_slides_on_it(dimension, share):
    """|J_t| <= mu |J_n|, with equality if sticking needs more; both cases occur."""
    slides = []
    for mu, material in itertools.product((1e-3, 0.1, 0.5, 3.0), MATERIALS):
        for n, v, w in contacts(dimension):
            push, turn = exchange(material, n, v, w, share, mu)
            stuck, stuck_turn = exchange(material, n, v, w, share)
            normal, tangential, sticking = push @ n, push - (push @ n) * n, stuck - (stuck @ n) * n
            limit = mu * abs(normal)
            size, rounding = np.linalg.norm(tangential), 1e-15 * np.linalg.norm(v)
            assert normal == pytest.approx(stuck @ n, abs=10 * rounding)
            slides.append(np.linalg.norm(sticking) > limit + rounding)
            if slides[-1]:
                assert size == pytest.approx(limit, rel=1e-12, abs=10 * rounding)
                g = slip(n, v, w)
                assert tangential @ g == pytest.approx(size * np.linalg.norm(g), abs=1e-9 * (g @ g))
            elif np.linalg.norm(sticking) < limit - rounding:
                assert np.array_equal(push, stuck) and np.array_equal(turn, stuck_turn)
    assert 0.2 < np.mean(slides) < 0.8


def test_contacts_without_spin_have_no_tangential_impulse():
    n, v = (1.0, 0.0), (-2.0, 3.0)
    push, turn = impulse_and_spin_change(
        Effects(), (0.5, 0.7), n, v, None, PAIR, identical_pair(None)
    )
    assert push == (-1.5, 0.0) and turn is None


@pytest.mark.slow  # compiles a kernel
@pytest.mark.parametrize("beta", [-0.5, 1.0])
def test_no_friction_is_the_smooth_gas(beta):
    """The same bits after 1000 collisions, and no spin has changed."""
    ends = []
    for kernel, rough, effects in (
        ("gas", -1.0, {}),
        ("friction", beta, {"friction": {"mu": 0.0}}),
    ):
        scene, state = begin(settings(kernel, 40, [25, 25], **effects), 0.9, rough, 1)
        state.spin[:] = np.random.default_rng(2).standard_normal(state.spin.shape)
        spin = state.spin.tobytes()
        rows = run(state, scene, 5, collisions=200)
        assert state.spin.tobytes() == spin
        ends.append((state.trajectory.tobytes(), rows["time"].tobytes()))
    assert ends[0] == ends[1]


GAS = settings("gas", 40, [25, 25])
SPHERES = settings("spheres", 64, [12, 12, 12])
SHEARED = settings("sheared", 40, [25, 25])
BED = settings("bed", 40, [12.5, "open"], floor={"restitution": 0.95, "roughness": 0.3})
WALLED = settings("walled", 40, [12.5, "open"])


def energy(shot, q):
    """Translational and rotational kinetic energy."""
    rotational = 0.0 if shot.spin is None else 0.5 * q * (shot.spin**2).sum()
    return 0.5 * (shot.velocity**2).sum(), rotational


@pytest.mark.parametrize(
    "experiment",
    [GAS, SHEARED, BED, WALLED, SPHERES],
    ids=["gas", "sheared", "bed", "walled", "spheres"],
)
def test_the_ledger_explains_every_change_of_energy(experiment):
    """Gain of kinetic energy = entries of contacts, floor, walls and shear + work of gravity.

    Velocities are taken in the image of each particle's last collision.
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


@pytest.mark.parametrize("experiment", [GAS, SPHERES], ids=["disks", "spheres"])
def test_refreshing_takes_out_the_momentum_and_keeps_everything_else(experiment):
    scene, state = begin(experiment, 0.6, 0.2, 9)
    refreshed = run(state, scene, 400, collisions=len(state.changes), refresh=4)
    assert state.counts[EXPONENT] < -10  # halvings of the velocities
    unit = np.ldexp(1.0, refreshed["exponent"].astype(int))
    assert np.all(np.diff(refreshed["time"]) > 0.0)
    speeds = np.sqrt(refreshed["vv_x"] + refreshed["vv_y"])
    assert np.all((speeds > 0.1) & (speeds < 100.0))  # in the present units
    assert np.max(np.abs(refreshed["p_x"]) / speeds) < 1e-13
    # Haff's law: the energy falls like t^-2 in the end; 30 seeds scatter by .0015 about -.9998
    t, v = refreshed["time"], speeds * unit
    slope = np.log(v[-1] / v[100]) / np.log(t[-1] / t[100])
    assert slope == pytest.approx(-1.0, abs=4 * 0.0015)
