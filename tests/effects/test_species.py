"""Species: particles of several radii, masses, moments of inertia and materials."""

import numpy as np
import pytest
from brute_force import begin, run, settings

from roughgas import simulate
from roughgas.base import InputError
from roughgas.simulation.energies import energies_of_each
from roughgas.simulation.gas import Gas
from roughgas.statistics.errors import blocking

ALIKE = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 1, "mass": 1.0}]


def everything(experiment, seed=1):
    """All arrays of a state after some collisions, and the columns of its samples, as bytes."""
    scene, state = begin(experiment, 0.9, 0.3, seed)
    columns = run(state, scene, 5, collisions=400)
    parts = [state.trajectory, state.spin, state.counts, state.ledger[:, -1]]
    names = [name for name in columns if "[" not in name and not name.startswith("v_")]
    return [part.tobytes() for part in parts], {name: columns[name].tobytes() for name in names}


@pytest.mark.parametrize(
    ("kernel", "particles", "box"),
    [
        ("gas", 160, [60, 60]),
        pytest.param("gas", 800, [200, 200], marks=pytest.mark.slow),  # in cells
        pytest.param("rubbed bed", 160, [50, "open"], marks=pytest.mark.slow),
        pytest.param("sheared", 160, [50, 50], marks=pytest.mark.slow),
        pytest.param("heated spheres", 64, [12, 12, 12], marks=pytest.mark.slow),
    ],
)
def test_species_that_are_alike_are_one(kernel, particles, box):
    """To the last bit of every place, velocity, spin, count, booked energy and sample."""
    experiment = settings(kernel, particles, box)
    state, alone = everything(experiment)
    of_two, there = everything(experiment | {"species": ALIKE})
    assert of_two == state
    assert "collisions" in there  # but not what contacts carry, of which each pair has its own sums
    assert there == {name: alone[name] for name in there}


MIXED = [
    {"number": 60, "mass": 1},
    {"number": 60, "radius": 0.5, "mass": 0.05, "inertia": 0.3},
    {"number": 40, "radius": 2, "mass": 20.0},
]


def test_an_elastic_mixture_reaches_equipartition():
    """Of translation and rotation, in every species, within the errors; with r = beta = 1."""
    gas = Gas(*begin(settings("gas", 160, [60, 60]) | {"species": MIXED}, 1.0, 1.0, 2))
    gas.in_collisions(20_000, 1)
    columns = gas.in_collisions(100, 4000)
    whole = gas.energies(columns)
    # of all 3 N degrees of freedom, two are fixed by the momentum: those of the heavy ones more
    shared = (2 * whole.translational + whole.rotational) * 160 / (3 * 160 - 2)
    mass = gas.state.bodies.mass
    for number, part in enumerate(energies_of_each(columns, gas.scene, gas.state)):
        fixed = mass[gas.state.bodies.species == number][0] / mass.sum()
        for energy, expected in ((part.translational, 1.0 - fixed), (part.rotational, 1.0)):
            error = blocking(energy / shared)[0]
            assert error < 0.03
            assert abs((energy / shared).mean() - expected) < 4.0 * error


def test_the_energies_of_all_are_those_of_the_species():
    """Weighted with how many there are; and each species' share is what its particles have."""
    gas = Gas(*begin(settings("gas", 160, [60, 60]) | {"species": MIXED}, 0.9, 0.3, 2))
    columns = gas.in_collisions(500, 4)
    total, parts = gas.energies(columns), energies_of_each(columns, gas.scene, gas.state)
    bodies, velocity = gas.state.bodies, gas.state.trajectory[:, 2:4]
    for k, whole in enumerate(total):
        mean = sum(n * part[k] for n, part in zip((60, 60, 40), parts, strict=True)) / 160.0
        assert mean == pytest.approx(whole, rel=1e-12)
    for number, part in enumerate(parts):
        here = bodies.species == number
        own = np.sum(bodies.mass[here, None] * velocity[here] ** 2) / (4.0 * here.sum())
        assert part.translational[-1] == pytest.approx(own, rel=1e-12)
        s = bodies.mass * bodies.inertia
        own = np.sum(s[here] * gas.state.spin[here, 0] ** 2) / (2.0 * here.sum())
        assert part.rotational[-1] == pytest.approx(own, rel=1e-12)


@pytest.mark.parametrize("beta", [0.5, -0.5])
def test_a_run_goes_on_to_the_last_bit_and_from_what_it_leaves(beta):
    """From the kernel's memory, and to rounding from places, velocities, spins and radii alone."""
    spread = {"distribution": "lognormal", "deviation": 0.2}
    more = {"species": [{"fraction": 0.5}, {"fraction": 0.5, "radius": spread}]}
    args = {"r": 0.9, "beta": beta, "scale": "small", "progress": False, "keep_state": True} | more
    args["schedule"] = {"replicas": 2, "plateau": 5, "relaxation_times": 1}
    first = simulate("cooling", **args)
    assert np.ptp(first.last_radius.values) > 0.1
    again = simulate("cooling", initial=first, **args)
    assert again.attrs["initial_exact"] == 1
    bare = first.drop_vars("last_memory")
    other = simulate("cooling", initial=bare, **args)
    assert other.attrs["initial_exact"] == 0
    assert np.array_equal(first.last_radius, other.last_radius)
    start = float(other.E_trans_series[0] / again.E_trans_series[0])
    assert start == pytest.approx(1.0, rel=1e-9)
    with pytest.raises(InputError, match="initial = without species_of: must be in the dataset"):
        simulate("cooling", initial=bare.drop_vars("last_species_of"), **args)
