"""Places for particles that differ: no overlaps, whatever the sizes."""

import numpy as np
import pytest
from brute_force import begin, settings

from roughgas.base import InputError
from roughgas.scene import check_places
from roughgas.scene.places import places_for

SPREAD = {"distribution": "uniform", "deviation": 0.2}
WALLS = {"walls": {"restitution": 1.0, "roughness": -1.0}}
CASES = {
    "ratio 100": ([{"number": 1, "radius": 100}, {"number": 500}], [450, 450], {}),
    "packed": ([{"number": 200, "radius": SPREAD}], [30, 30], {}),  # 0.7 of the box
    "two sizes, packed": ([{"fraction": 0.5}, {"fraction": 0.5, "radius": 2}], [70, 70], {}),
    "between walls": ([{"number": 3, "radius": 8}, {"number": 160}], [50, 50], WALLS),
    "spheres": ([{"number": 2, "radius": 6}, {"number": 500}], [30, 30, 30], {}),
    "a bed": ([{"number": 3, "radius": 8}, {"number": 160}], [50, "open"], None),
}


@pytest.mark.parametrize("case", CASES)
def test_nothing_overlaps(case):
    species, box, effects = CASES[case]
    number = sum(one.get("number", 200) for one in species)
    effects = settings("bed")["effects"] if effects is None else effects
    experiment = {"particles": number, "box": box, "effects": effects, "species": species}
    scene, state = begin(experiment, 0.9, 0.3 if "spin" in effects else -1.0, 1)
    places, radius = state.trajectory[:, : len(box)], state.bodies.radius
    check_places(scene, places, 0.0, radius)
    assert np.bincount(state.bodies.species).tolist() == [one.get("number", 200) for one in species]
    if case == "packed":
        assert 0.65 < np.pi * np.sum(radius**2) / 900.0
    if case == "a bed":
        assert np.ptp(places[:, 1]) < 250.0  # no lattice of the largest


def test_particles_end_where_they_are_pushed_on_the_side_that_is_free():
    """One axis repeats, the other does not."""
    radius, rng = np.full(6, 1.0), np.random.default_rng(0)
    found = places_for(radius, [11.5, 3.5], [True, False], rng)  # a lattice has five sites
    assert found[:, 1].min() >= 1.0 and found[:, 1].max() <= 2.5
    assert places_for(radius, [11.5, 1.6], [True, False], rng) is None


def test_a_giant_among_dwarfs_takes_no_lattice_of_dwarfs():
    """Its sites would be 2.5e9."""
    radius = np.array([10.0, *[0.001] * 99])
    found = places_for(radius, [100.0, 100.0], [True, True], np.random.default_rng(1))
    apart = found[1:] - found[0]
    apart -= 100.0 * np.round(apart / 100.0)
    assert len(found) == 100 and np.hypot(*apart.T).min() > 10.001
    assert np.ptp(found, axis=0).min() > 50.0


def test_what_fits_nowhere_is_refused():
    experiment = settings("smooth", 130, [20, 20]) | {
        "species": [{"fraction": 1, "radius": SPREAD}]
    }
    with pytest.raises(InputError, match="particles = 130: must be fewer or smaller"):
        begin(experiment, 0.9, -1.0)
