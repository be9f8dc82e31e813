"""Laws of restitution that depend on the normal speed: viscoelastic, a power, tabulated."""

import math
from decimal import Decimal
from types import SimpleNamespace

import numpy as np
import pytest
from brute_force import KERNELS, begin, run, settings
from raw import build

from roughgas.effects.restitution import ABOVE, B_1, B_2, B_3, B_4, fifth_root
from roughgas.kernel.layout import new_state
from roughgas.kernel.state import EXPONENT

TABLE = KERNELS["tabulated bed"]["effects"]["restitution_table"]


def state_with_exponent(exponent):
    """A stand-in for a state: the laws read only its exponent of the unit of velocity."""
    return SimpleNamespace(counts={EXPONENT: exponent})


def gas(**effects):
    """Settings of a viscoelastic gas."""
    return settings("viscoelastic", **effects)


def test_the_series_is_that_of_the_literature():
    """C_1 to C_4 of Ramirez et al. (1999), in powers of x = C_1 A alpha^(2/5) g^(1/5)."""
    C = 1.15344, 0.79826, 0.483582, 0.285279
    below, series = [1.0, B_1, B_2, B_3, B_4], [1.0]
    for k in range(1, 5):
        rest = sum(below[j] * series[k - j] for j in range(1, k + 1))
        series.append((ABOVE if k == 1 else 0.0) - rest)
    expected = [(-1) ** k * C[k - 1] / C[0] ** k for k in range(1, 5)]
    assert series[1:] == pytest.approx(expected, abs=1.5e-3)


def test_fifth_roots_are_accurate():
    """Directly and scaled by powers of two, beyond the range of doubles."""
    rng = np.random.default_rng(1)
    for x in np.concatenate([10.0 ** rng.uniform(-300, 300, 60), [1.0, 32.0, 5e-324]]):
        root = float(Decimal(float(x)) ** Decimal("0.2"))
        assert fifth_root(float(x), 0) == pytest.approx(root, rel=1e-15)
        assert fifth_root(float(x), -35) == math.ldexp(fifth_root(float(x), 0), -7)
    assert fifth_root(1.0, -5000) == pytest.approx(math.ldexp(1.0, -1000), rel=1e-15)
    assert fifth_root(0.0, 12) == 0.0


def restitution_law(r, name="restitution_table", settings=TABLE):
    """A law of restitution as plain Python: (speed in a/T, material's r) -> restitution."""
    experiment = {"particles": 2, "box": [20, 20], "effects": {name: settings}}
    effect = getattr(build(experiment, r, -1.0).effects, name)

    def law(speed, coefficient=r, exponent=0):
        state, normal_velocity = state_with_exponent(exponent), -math.ldexp(speed, -exponent)
        return type(effect).hooks.restitution(
            effect, 0, coefficient, state, 0, 1, 0.0, normal_velocity
        )

    return law


def test_a_table_is_read_along_straight_lines():
    speeds, values, reference = TABLE.values()
    r = float(np.interp(reference, speeds, values))
    restitution = restitution_law(r)
    for speed in (0.0, 0.1, 0.5, 0.6, 1.0, 2.0, 3.7, 5.0, 100.0):
        assert restitution(speed) == pytest.approx(np.interp(speed, speeds, values), rel=1e-14)
        assert restitution(speed, exponent=-40) == restitution(speed)


def test_losses_of_other_materials_are_in_proportion_to_the_table():
    speeds, values, reference = TABLE.values()
    restitution, reference_loss = restitution_law(0.6), 1.0 - np.interp(reference, speeds, values)
    assert restitution(reference) == pytest.approx(0.6, rel=1e-14)
    assert restitution(0.5) == pytest.approx(1.0 - 0.4 * (1.0 - 0.9) / reference_loss, rel=1e-14)
    assert restitution(5.0) == 0.0  # in proportion it would be negative
    assert [restitution(v, 1.0) for v in (0.1, 5.0)] == [1.0, 1.0]


BIZON = {"speed": math.sqrt(2.0), "exponent": 0.75, "least": 0.7}  # g = a/T^2, D = 2 a


@pytest.mark.parametrize("exponent", [0.25, 0.75, 1.0, 2.5])
def test_a_power_law_follows_its_closed_form(exponent):
    """Above its lowest value 1 - r follows the power, to a few roundings, in any unit."""
    restitution = restitution_law(0.7, "power_law", BIZON | {"exponent": exponent})
    for speed in np.geomspace(1e-12, 1.0, 40) * BIZON["speed"]:
        lost = 0.3 * (speed / BIZON["speed"]) ** exponent
        assert restitution(speed) == pytest.approx(1.0 - lost, abs=2e-16)
        assert restitution(speed, exponent=-40) == restitution(speed)
    for speed in (1.5, 10.0, 1e9):
        assert restitution(speed) == 0.7
    assert restitution(0.0) == 1.0


def test_the_lowest_restitution_bounds_more_elastic_contacts():
    """Material of r = 0.4 at the reference speed keeps it in faster contacts.

    Without a lowest value r falls to 0; elastic material is elastic at all speeds.
    """
    restitution = restitution_law(0.7, "power_law", BIZON)
    v = 0.01 * BIZON["speed"]
    assert restitution(v, 0.4) == pytest.approx(1.0 - 0.6 * 0.01**0.75, rel=1e-15)
    assert [restitution(x, 0.4) for x in (1.5, 9.0)] == [0.4, 0.4]
    assert [restitution(x, 1.0) for x in (v, 1e9)] == [1.0, 1.0]
    bare = restitution_law(0.7, "power_law", {"speed": 1.0, "exponent": 1})
    assert [bare(x) for x in (2.0, 9.0)] == [pytest.approx(0.4), 0.0]


def test_two_spheres_lose_energy_by_the_power_law():
    """In a head-on contact, the share 1 - r^2 of the energy of relative motion m v^2/4.

    They fly along the second axis, along which gravity does not act, far above the floor.
    """
    for speed in (0.01, 0.3, 1.0, 3.0):
        scene, _ = begin(settings("layer", 2, [40, 40, "open"]), 0.7, 0.35)
        position = np.array([[20.0, 18.999, 30.0], [20.0, 21.001, 30.0]])
        velocity = np.array([[0.0, 0.5 * speed, 0.0], [0.0, -0.5 * speed, 0.0]])
        state = new_state(scene, position, velocity, np.zeros((2, 3)))
        run(state, scene, 1, collisions=1)
        r = max(0.7, 1.0 - 0.3 * (speed / math.sqrt(2.0)) ** 0.75)
        final_velocity = state.trajectory[:, 4]
        assert 0.5 * (final_velocity**2).sum() == pytest.approx(0.25 * (r * speed) ** 2, rel=1e-12)


@pytest.mark.slow
def test_a_gas_is_the_same_in_any_unit_of_velocity():
    """The same bits with velocities in units of 2^20 a/T and of 1 a/T."""
    ends = []
    for power in (0, 20):
        unit = math.ldexp(1.0, power)
        scene, state = begin(gas(), 0.8, 0.2, 4)
        state.trajectory[:, 2:4] /= unit
        state.counts[EXPONENT] = power
        run(state, scene, 1, collisions=1000)
        ends.append((state.trajectory[:, :4] * [1.0, 1.0, unit, unit], state.spin * unit))
    assert np.array_equal(*(trajectory for trajectory, _ in ends))
    assert np.array_equal(*(spin for _, spin in ends))
