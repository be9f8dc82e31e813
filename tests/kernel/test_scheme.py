"""The scheme for candidates of contacts follows from the scene, the same on all machines."""

import math

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas.kernel.scheme import (
    BREAK_EVEN,
    BREAK_EVEN_OF_KICKS,
    DENSE,
    PACKINGS,
    PER_CELL,
    break_even,
    particles_per_cell,
)


def gas(packing, number=600, dimension=2, **changes):
    """Settings of a gas of disks or spheres at a packing fraction."""
    unit_sphere = math.pi if dimension == 2 else 4.0 * math.pi / 3.0
    side = (number * unit_sphere / packing) ** (1.0 / dimension)
    name = "gas" if dimension == 2 else "spheres"
    return settings(name, number, [side] * dimension) | changes


def is_swept(experiment):
    _, state = begin(experiment, 0.9, 0.2, 1)
    assert (state.sweep is None) == (state.cells is not None)
    return state.cells is None


@pytest.mark.parametrize("dimension", BREAK_EVEN)
@pytest.mark.parametrize("kicked", [False, True])
def test_the_break_even_number_falls_with_the_packing(dimension, kicked):
    numbers = BREAK_EVEN_OF_KICKS if kicked else BREAK_EVEN[dimension]
    assert [break_even(dimension, packing, kicked) for packing in PACKINGS] == list(numbers)
    everywhere = [break_even(dimension, packing, kicked) for packing in np.geomspace(1e-4, 0.9, 50)]
    assert everywhere == sorted(everywhere, reverse=True)
    assert everywhere[0] == numbers[0] and everywhere[-1] == numbers[-1]


@pytest.mark.parametrize("dimension", [2, 3])
def test_particles_are_swept_up_to_the_break_even_number(dimension):
    few = break_even(dimension, 0.05)
    assert is_swept(gas(0.05, few, dimension))
    assert not is_swept(gas(0.05, few + 10, dimension))


def test_a_dilute_gas_is_swept_where_a_dense_one_is_in_cells():
    assert is_swept(gas(0.001)) and not is_swept(gas(0.5))


KICKS = {
    "thermostat": {"power": 1.0, "spin_share": 0.5, "interval": 0.1},
    "langevin": {"drag": 0.1, "spin_drag": 0.1, "temperature": 1.0, "interval": 0.1},
}


@pytest.mark.parametrize("effect", KICKS)
def test_kicks_let_cells_cost_less_than_a_sweep_at_fewer_particles(effect):
    few = break_even(2, 0.005, kicked=True)
    assert few < break_even(2, 0.005) / 3
    for number, swept in ((few, True), (few + 10, False)):
        dilute = gas(0.005, number, 2)
        assert is_swept(dilute)
        assert is_swept(dilute | {"effects": dilute["effects"] | {effect: KICKS[effect]}}) is swept


def test_times_of_contacts_are_no_kicks():
    dilute = gas(0.005, break_even(2, 0.005, kicked=True) + 10, 2)
    assert is_swept(dilute | {"effects": dilute["effects"] | {"contact_time": {"duration": 1e-6}}})


def test_a_bed_of_five_hundred_is_swept():
    bed = settings("bed", 500, [50, "open"])
    assert is_swept(bed) and not is_swept(bed | {"particles": 520})


@pytest.mark.parametrize(
    ("choice", "number", "swept"),
    [("sweep", 2000, True), ("cells", 100, False), ("cells", 40, True), ("cheapest", 100, True)],
)
def test_a_user_may_choose_the_scheme(choice, number, swept):
    """Forty disks at this packing leave no room for eight cells along an axis."""
    assert is_swept(gas(0.5, number, neighbours=choice)) == swept


def test_cells_of_a_dilute_gas_hold_more():
    """As many as the table says, to the rounding of the numbers of cells along the axes."""
    for dimension, number in ((2, 4000), (3, 6000)):
        fewest, most = PER_CELL[dimension]
        for packing, expected in ((0.001, most), (DENSE, fewest)):
            _, state = begin(gas(packing, number, dimension), 0.9, 0.2, 1)
            per_cell = number / len(state.cells.first)
            assert particles_per_cell(dimension, packing) == pytest.approx(expected)
            assert expected <= per_cell < expected * (1 + 1.2 * dimension / 12)


@pytest.mark.parametrize(("dimension", "packing"), [(2, 0.8), (3, 0.5)])
def test_a_dense_gas_has_neighbour_lists(dimension, packing):
    """Not so one half as dense, nor one of two sizes."""
    number = 2000
    _, dense = begin(gas(packing, number, dimension), 0.9, 0.2, 1)
    _, half_as_dense = begin(gas(packing / 2, number, dimension), 0.9, 0.2, 1)
    sizes = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 0.9}]
    _, mixture = begin(gas(packing, number, dimension, species=sizes), 0.9, 0.2, 1)
    assert dense.cells.neighbours is not None
    assert half_as_dense.cells.neighbours is None and mixture.cells.neighbours is None
