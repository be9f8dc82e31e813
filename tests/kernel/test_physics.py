"""Gases whose statistics are known."""

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas import theory
from roughgas.simulation.energies import energies, ratio
from roughgas.statistics.errors import blocking_stderr


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
