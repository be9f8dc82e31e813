"""The collision rule by itself: what it conserves, what it takes, and that it can be undone."""

import numpy as np
import pytest
from compiled import from_python

from roughgas import theory
from roughgas.effects import Effects
from roughgas.effects.spin import Spin
from roughgas.kernel.contact import response as compiled_response

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
