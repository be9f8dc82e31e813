"""A point from its settings to its variables."""

import numpy as np
import pytest
from brute_force import settings
from schedules import COOLING, STEADY

from roughgas.base import InputError
from roughgas.scene import build
from roughgas.simulation.point import compile_kernels, run_point

SWEEP = {"r": ["0.9"], "beta": ["0"], "seeds": 1}
POINTS = {
    "bed": settings("bed", 20, [10, "open"]) | {"schedule": STEADY, "sweep": SWEEP},
    "sheared": settings("sheared", 20, [18, 18]) | {"schedule": STEADY, "sweep": SWEEP},
    "gas": settings("gas", 20, [25, 25]) | {"schedule": COOLING, "sweep": SWEEP},
}


def point(experiment, r, beta, seed, tell=None):
    return run_point(build(experiment, r, beta), experiment, seed, tell)


@pytest.mark.parametrize("name", POINTS)
def test_the_same_point_twice_and_another_seed(name):
    one, same, other = (point(POINTS[name], 0.9, 0.2, seed) for seed in (3, 3, 4))
    for key, value in one.variables.items():
        if key != "kernel_seconds":
            np.testing.assert_array_equal(value, same.variables[key], err_msg=key)
    assert one.variables["R"] != other.variables["R"]
    assert one.variables["kernel_seconds"] > 0.0
    assert one.attributes["seed"] == 3 and one.attributes["particles"] == 20
    assert one.attributes["inertia"] == 0.5 and one.attributes["dimension"] == 2
    filled = {"sheared": 20 * np.pi / 18**2, "gas": 20 * np.pi / 25**2}  # the bed is open above
    assert one.attributes.get("packing") == (filled.get(name) and pytest.approx(filled[name]))


@pytest.mark.parametrize("name", POINTS)
def test_what_a_point_holds(name):
    found = point(POINTS[name], 0.9, 0.2, 3)
    for key in ("R", "R_stderr", "R_ratio_of_means", "E_trans", "E_rot", "autocorrelation_time"):
        assert np.isfinite(found.variables[key]), key
    assert 0.0 < found.variables["R"] < 0.5
    assert found.variables["collisions"] > 100
    assert not {"contact_time", "contact_time_fraction"} & set(found.variables)
    assert ("R_unsubtracted" in found.variables) == (name == "sheared")
    assert ("R_replica" in found.variables) == (name == "gas")
    assert ("collisions_per_particle" if name == "gas" else "time") in found.variables


def test_progress_is_told():
    told = []
    point(POINTS["bed"], 0.9, 0.2, 3, lambda *progress: told.append(progress))
    times, collisions = zip(*told, strict=True)
    assert 20 <= len(told) <= 60 and times[-1] == pytest.approx(60.0)
    assert list(times) == sorted(times) and list(collisions) == sorted(collisions)


@pytest.mark.parametrize(("r", "beta"), [(1.5, 0.0), (0.9, -2.0), (np.nan, 0.0)])
def test_illegal_points(r, beta):
    with pytest.raises(InputError):
        point(POINTS["gas"], r, beta, 1)


def test_a_gas_that_comes_to_rest_on_its_floor_is_refused():
    """Its contacts would never end; one that loses nothing, or is driven otherwise, does not."""
    bed = settings("bed", 20, [10, "open"], floor={"amplitude": 0, "roughness": -1})
    bed |= {"schedule": STEADY | {"equilibrate": 1, "measure": 2}}
    with pytest.raises(
        InputError, match=r"^effects\.floor\.amplitude = 0\.0: must be 0\.001 a/T t"
    ):
        point(bed, 0.9, 0.2, 1)
    assert point(bed, 1.0, -1.0, 1).variables["collisions"] > 0


def test_each_composition_is_compiled_once():
    assert compile_kernels([POINTS["gas"], POINTS["gas"], POINTS["bed"]], 0.9) == 2
