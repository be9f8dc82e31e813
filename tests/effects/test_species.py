"""Species: particles of different radii, masses, moments of inertia and materials."""

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas import simulate
from roughgas.base import InputError
from roughgas.simulation.energies import species_energies
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking

IDENTICAL = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1, "mass": 1.0}]


def bytes_of_run(experiment, seed=1):
    """(arrays of a state after some collisions, columns of its samples by name), as bytes."""
    scene, state = begin(experiment, 0.9, 0.3, seed)
    columns = run(state, scene, 5, collisions=400)
    arrays = [state.trajectory, state.spin, state.counts, state.ledger[:, -1]]
    names = [name for name in columns if "[" not in name and not name.startswith("v_")]
    return [array.tobytes() for array in arrays], {name: columns[name].tobytes() for name in names}


@pytest.mark.parametrize(
    ("kernel", "particles", "box"),
    [
        ("gas", 160, [60, 60]),
        pytest.param("gas", 800, [160, 160], marks=pytest.mark.slow),  # in cells
        pytest.param("spheres", 500, [16, 16, 16], marks=pytest.mark.slow),  # on lists
        pytest.param("rubbed bed", 160, [50, "open"], marks=pytest.mark.slow),
        pytest.param("sheared", 160, [50, 50], marks=pytest.mark.slow),
        pytest.param("heated spheres", 64, [12, 12, 12], marks=pytest.mark.slow),
    ],
)
def test_identical_species_have_the_bits_of_a_single_species(kernel, particles, box):
    """In positions, velocities, spins, counts, energies booked and samples."""
    experiment = settings(kernel, particles, box)
    state_of_one, columns_of_one = bytes_of_run(experiment)
    state_of_two, columns_of_two = bytes_of_run(experiment | {"species": IDENTICAL})
    assert state_of_two == state_of_one
    assert (
        "collisions" in columns_of_two
    )  # sums of contacts are left out: each pair of species has its own
    assert columns_of_two == {name: columns_of_one[name] for name in columns_of_two}


MIXED = [
    {"number": 60, "mass": 1},
    {"number": 60, "radius": 0.5, "mass": 0.05, "inertia": 0.3},
    {"number": 40, "radius": 2, "mass": 20.0},
]


def test_an_elastic_mixture_reaches_equipartition():
    """Of translation and rotation, in every species, within 4 errors; with r = beta = 1."""
    gas = Gas(*begin(settings("gas", 160, [60, 60]) | {"species": MIXED}, 1.0, 1.0, 2))
    gas.in_collisions(20_000, 1)
    columns = gas.in_collisions(100, 4000)
    total = gas.energies(columns)
    # the momentum fixes two of the 3 N degrees of freedom, mostly of heavy particles
    shared = (2 * total.translational + total.rotational) * 160 / (3 * 160 - 2)
    mass = gas.state.bodies.mass
    for number, energies in enumerate(species_energies(columns, gas.scene, gas.state)):
        fixed = mass[gas.state.bodies.species == number][0] / mass.sum()
        for energy, expected in ((energies.translational, 1.0 - fixed), (energies.rotational, 1.0)):
            error = blocking(energy / shared)[0]
            assert error < 0.03
            assert abs((energy / shared).mean() - expected) < 4.0 * error


def test_total_energies_are_averages_of_the_species():
    """Weighted by number; and the energy of a species is that summed over its particles."""
    gas = Gas(*begin(settings("gas", 160, [60, 60]) | {"species": MIXED}, 0.9, 0.3, 2))
    columns = gas.in_collisions(500, 4)
    total, species = gas.energies(columns), species_energies(columns, gas.scene, gas.state)
    bodies, velocity = gas.state.bodies, gas.state.trajectory[:, 2:4]
    for k, total_energy in enumerate(total):
        mean = (
            sum(n * energies[k] for n, energies in zip((60, 60, 40), species, strict=True)) / 160.0
        )
        assert mean == pytest.approx(total_energy, rel=1e-12)
    for number, energies in enumerate(species):
        selected = bodies.species == number
        expected = np.sum(bodies.mass[selected, None] * velocity[selected] ** 2) / (
            4.0 * selected.sum()
        )
        assert energies.translational[-1] == pytest.approx(expected, rel=1e-12)
        s = bodies.mass * bodies.inertia
        expected = np.sum(s[selected] * gas.state.spin[selected, 0] ** 2) / (2.0 * selected.sum())
        assert energies.rotational[-1] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("beta", [0.5, -0.5])
def test_a_mixture_continues_exactly_and_from_its_dataset(beta):
    """Exactly with the kernel's memory; to rounding from positions, velocities, spins and radii."""
    spread = {"distribution": "lognormal", "deviation": 0.2}
    species = {"species": [{"fraction": 0.5}, {"fraction": 0.5, "radius": spread}]}
    args = {
        "r": 0.9,
        "beta": beta,
        "scale": "small",
        "progress": False,
        "keep_state": True,
    } | species
    args["schedule"] = {"replicas": 2, "plateau": 5, "relaxation_times": 1}
    first = simulate("cooling", **args)
    assert np.ptp(first.last_radius.values) > 0.1
    again = simulate("cooling", initial=first, **args)
    assert again.attrs["initial_exact"] == 1
    bare = first.drop_vars("last_memory")
    without_memory = simulate("cooling", initial=bare, **args)
    assert without_memory.attrs["initial_exact"] == 0
    assert np.array_equal(first.last_radius, without_memory.last_radius)
    start = float(without_memory.E_trans_series[0] / again.E_trans_series[0])
    assert start == pytest.approx(1.0, rel=1e-9)
    with pytest.raises(InputError, match="initial = without species_of: must be in the dataset"):
        simulate("cooling", initial=bare.drop_vars("last_species_of"), **args)
