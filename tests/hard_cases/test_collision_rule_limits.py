"""Limits of the collision rule."""

import numpy as np
import pytest
from brute_force import begin, run, settings, snapshot
from compiled import from_python

from roughgas import theory
from roughgas.effects import Effects
from roughgas.effects.contacts import Spin
from roughgas.kernel import contact
from roughgas.kernel.layout import new_state
from roughgas.kernel.particles import identical_pair
from roughgas.kernel.record import Sampling, allocate_frames, columns, record
from roughgas.kernel.state import COLLISIONS

impulse_and_spin_change = from_python(contact.impulse_and_spin_change)
direction = from_python(contact.direction)
DISKS = settings("gas", 160, [50, 50])
SPHERES = settings("spheres", 64, [12, 12, 12])
ROUNDING = 2.0**-53  # the largest relative error of one operation


def pair(dimension, side):
    """Settings of two particles in a box."""
    return settings("gas" if dimension == 2 else "spheres", 2, [side] * dimension)


def energy(shot, q):
    """Kinetic energy of all particles."""
    return 0.5 * (shot.velocity**2).sum() + 0.5 * q * (shot.spin**2).sum()


def spinning_gas(experiment, beta, seed=2):
    """Scene and state of an elastic gas with random spins."""
    scene, state = begin(experiment, 1.0, beta, seed)
    state.spin[:] = np.random.default_rng(seed).standard_normal(state.spin.shape)
    return scene, state


def run_to(state, scene, collisions):
    """Run to a total number of collisions; a single call may end after a thousand spans."""
    while state.counts[COLLISIONS] < collisions:
        run(state, scene, 1, collisions=int(collisions - state.counts[COLLISIONS]))


@pytest.mark.parametrize("dimension", [2, 3])
def test_elastic_contacts_conserve_energy_and_momentum(margins, dimension):
    """At r = 1 and beta = +-1, up to roundings.

    The energy drifts in proportion to the collisions, by the mean error of the normals (see
    test_normals_are_unit_vectors_on_average) and by the rounding of 1/(1 + q). The bound is a
    rounding of the total energy in ten collisions, 1e-17 per collision.

    The momentum makes a random walk of roundings, two per collision along each axis, whose rms is
    at most 1e-16: by chance one in 1e8 exceeds six times its length.
    """
    experiment = DISKS if dimension == 2 else SPHERES
    q, collisions = theory.moment_of_inertia(dimension), margins.size(100_000, 10_000_000)
    tried = {"tried": collisions, "unit": "collisions"}
    for beta in (-1.0, 1.0):
        scene, state = spinning_gas(experiment, beta)
        spin, start = state.spin.copy(), energy(snapshot(state, scene), q)
        run_to(state, scene, collisions)
        end = snapshot(state, scene)
        drift = abs(energy(end, q) / start - 1.0) / collisions * 1e7
        quantity = f"drift of the energy in 1e7 collisions, beta = {beta:g}, D = {dimension}"
        margins.at_most(quantity, drift, 1e-10, **tried)
        momentum = np.abs(end.velocity.sum(axis=0)).max() / np.sqrt(2.0 * collisions)
        quantity = (
            f"momentum, over the root of the roundings [m a/T], beta = {beta:g}, D = {dimension}"
        )
        margins.at_most(quantity, momentum, 6e-16, **tried)
        if beta == -1.0:
            quantity = f"spins that changed, beta = -1, D = {dimension}"
            margins.at_most(quantity, (spin != state.spin).sum(), 0, **tried)


@pytest.mark.parametrize("dimension", [2, 3])
def test_normals_are_unit_vectors_on_average(margins, dimension):
    """The mean of n.n - 1, the share of its normal energy that a contact adds, over pairs anywhere
    in a box of 25 a.

    A contact adds rms 1e-16; over 1e5 contacts the mean is known to 3e-19. The bound is a quarter
    of a rounding; the remainder comes from the grid of the components.
    """
    rng, contacts = np.random.default_rng(dimension), margins.size(100_000, 1_000_000)
    normals = rng.standard_normal((contacts, dimension))
    normals *= 2.0 / np.linalg.norm(normals, axis=1)[:, None]
    positions = rng.uniform(2.0, 23.0, normals.shape)
    computed = np.array(
        [direction(2.0, x) for x in map(tuple, (positions + normals - positions).tolist())]
    )
    excess = (computed.astype(np.longdouble) ** 2).sum(axis=1) - 1  # to 1e-19
    quantity, tried = f"mean of n.n - 1, D = {dimension}", {"tried": contacts, "unit": "contacts"}
    margins.at_most(quantity, abs(excess.mean()), ROUNDING / 4.0, **tried)
    margins.at_most(
        f"largest of n.n - 1, D = {dimension}", abs(excess).max(), 6 * ROUNDING, **tried
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_contacts_conserve_the_angular_momentum(margins, dimension):
    """About a fixed point some ten radii away, relative to the sum of the sizes of its terms.

    Some ten roundings: of positions, velocities and spins, before and after.
    """
    scene, _ = begin(pair(dimension, 20), 1.0, 1.0)
    q, rng = theory.moment_of_inertia(dimension), np.random.default_rng(dimension)
    pairs_tried, largest_change = margins.size(500, 10_000), 0.0
    for _ in range(pairs_tried):
        scene = scene._replace(restitution=rng.uniform(0, 1), roughness=rng.uniform(-1, 1))
        n, across = np.linalg.qr(rng.standard_normal((dimension, 2)))[0].T
        position = 10.0 + np.array([0.0 * n, 2.5 * n])
        velocity = rng.standard_normal(dimension) + np.array([0.0 * n, 0.2 * across - n])
        spin = rng.standard_normal((2, 2 * dimension - 3))
        state = new_state(scene, position, velocity, spin)
        before, largest = angular_momentum(snapshot(state, scene), q)
        run(state, scene, 1, interval=1.0)
        assert state.counts[COLLISIONS] == 1
        change = angular_momentum(snapshot(state, scene), q)[0] - before
        largest_change = max(largest_change, np.linalg.norm(change) / largest)
    quantity = f"change of the angular momentum, over its largest value, D = {dimension}"
    margins.at_most(quantity, largest_change, 10 * ROUNDING, tried=pairs_tried, unit="contacts")


def angular_momentum(shot, q):
    """(angular momentum of all particles about the origin, sum of the sizes of its terms)."""
    pad = ((0, 0), (0, 3 - shot.position.shape[1]))
    x, v = np.pad(shot.position, pad), np.pad(shot.velocity, pad)
    w = np.pad(shot.spin, ((0, 0), (3 - shot.spin.shape[1], 0)))
    sizes = np.linalg.norm(x, axis=1) * np.linalg.norm(v, axis=1) + q * np.linalg.norm(w, axis=1)
    return (np.cross(x, v) + q * w).sum(axis=0), sizes.sum()


@pytest.mark.parametrize("dimension", [2, 3])
def test_inverse_coefficients_undo_a_contact(margins, dimension):
    """The rule with 1/r and 1/beta undoes the rule with r and beta, down to 1e-3 in size.

    It multiplies roundings of the speed by 1/r and 1/beta: the bound is some ten of these.
    """
    rng, largest_error = np.random.default_rng(dimension), 0.0
    contacts = margins.size(5000, 100_000)
    q = theory.moment_of_inertia(dimension)
    for _ in range(contacts):
        n = rng.standard_normal(dimension)
        v = rng.standard_normal(dimension) * 10.0 ** rng.uniform(-3, 3)
        w = rng.standard_normal(2 * dimension - 3) * 10.0 ** rng.uniform(-3, 3)
        r, beta = 10.0 ** rng.uniform(-3, 0, 2) * [1.0, rng.choice([-1.0, 1.0])]
        n /= np.linalg.norm(n)
        after = applied((r, beta), q, n, v, w)
        restored = applied((1.0 / r, 1.0 / beta), q, n, *after)
        error = np.hypot(np.linalg.norm(restored[0] - v), np.linalg.norm(restored[1] - w))
        largest_error = max(
            largest_error, error * min(r, abs(beta)) / np.hypot(*map(np.linalg.norm, (v, w)))
        )
    quantity = f"error of what is got back, times r or beta, over the speed, D = {dimension}"
    margins.at_most(quantity, largest_error, 20 * ROUNDING, tried=contacts, unit="contacts")


def applied(material, q, n, v, w):
    """Relative velocity and sum of the spins after a contact."""
    vectors = [tuple(map(float, vector)) for vector in (n, v, w)]
    impulse, spin_change = impulse_and_spin_change(
        Effects(spin=Spin(q)), material, *vectors, 0.5, identical_pair(Spin(q))
    )
    return v - 2.0 * np.array(impulse), w + 2.0 * np.array(spin_change)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_free_pair_collides_once(margins, dimension):
    """For r = 0 and from 1e-16 to 1, and normal velocities from 1e-12 to 1 of the tangential one,
    two free particles never meet again.
    """
    scene, _ = begin(pair(dimension, 14), 0.0, -1.0)
    rng, most_contacts, pairs_tried = (
        np.random.default_rng(dimension),
        0,
        margins.size(1000, 20_000),
    )
    row = np.empty((1, len(columns(scene))))
    for _ in range(pairs_tried):
        r = rng.choice([0.0, 1.0, 1.0]) * 10.0 ** rng.uniform(-16, 0)
        scene = scene._replace(restitution=r, roughness=rng.choice([-1.0, rng.uniform(-1, 1)]))
        n, across = np.linalg.qr(rng.standard_normal((dimension, 2)))[0].T
        approach = 10.0 ** rng.uniform(-12, 0)
        gap = 0.1 * approach * 10.0 ** rng.uniform(-13, 0)
        position = 7.0 + np.array([0.0 * n, (2.0 + gap) * n])
        velocity = rng.standard_normal(dimension) + np.array([0.0 * n, across - approach * n])
        state = new_state(scene, position, velocity, np.zeros((2, 2 * dimension - 3)))
        # a pair that meets again and again is stopped as a collapse; here contacts are counted
        record(state, scene, Sampling(1.0, 100, 0), row, allocate_frames(state, 0))
        most_contacts = max(most_contacts, state.counts[COLLISIONS])
    margins.at_most(f"contacts of a pair, D = {dimension}", most_contacts, 1, pairs_tried, "pairs")
