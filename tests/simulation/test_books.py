"""The books of a point's energy."""

import numpy as np
import pytest
from brute_force import begin, run, settings
from schedules import COOLING, STEADY

from roughgas.data.point import read_point, write_point
from roughgas.scene import build
from roughgas.simulation.books import books, exchange, imbalance
from roughgas.simulation.point import run_point

SOURCES = {
    "bed": (settings("bed", 20, [10, "open"]) | {"schedule": STEADY}, ["floor", "contacts"]),
    "walled": (
        settings("walled", 20, [10, "open"]) | {"schedule": STEADY},
        ["floor", "walls", "contacts"],
    ),
    "sheared": (settings("sheared", 20, [18, 18]) | {"schedule": STEADY}, ["shear", "contacts"]),
    "gas": (settings("gas", 20, [25, 25]) | {"schedule": COOLING}, ["contacts"]),
}


@pytest.mark.parametrize("name", SOURCES)
def test_a_point_says_what_each_source_has_put_in(name, tmp_path):
    experiment, sources = SOURCES[name]
    point = run_point(build(experiment, 0.9, 0.2), experiment, 3)
    point.attributes.update(experiment="one", scale="small")
    write_point(tmp_path / "point.nc", point)
    data = read_point(tmp_path / "point.nc")
    assert list(data.source.values) == sources
    assert list(data.motion.values) == ["translation", "rotation"]
    total = data.energy_input.sum("source").values
    scale = np.abs(data.energy_input.values).sum()
    assert data.energy_gain.values == pytest.approx(total, abs=1e-12 * scale)
    assert 0.0 <= data.energy_imbalance < 1e-12
    # contacts turn translation into rotation, and take more than they give
    by_contacts = data.energy_input.sel(source="contacts")
    assert by_contacts.sum() < 0.0
    if name != "gas":
        assert data.energy_input.sel(source=sources[0], motion="translation") > 0.0


def test_the_books_of_a_refreshed_gas_are_in_the_units_of_the_start():
    scene, state = begin(settings("gas", 40, [25, 25]), 0.6, 0.2, 9)
    before = books(state, scene)
    run(state, scene, 100, collisions=40, refresh=4)
    found = exchange(before, books(state, scene), scene, 40)
    assert found["energy_input"].sum() == pytest.approx(-before.energy.sum() / 40, rel=1e-6)
    assert found["energy_imbalance"] < 1e-13


def test_what_is_missing_is_seen():
    booked = np.array([[3.0, 0.0], [-1.0, -0.5]])
    assert imbalance(booked, np.array([2.0, -0.5])) == 0.0
    assert imbalance(booked, np.array([2.0, -0.05])) == pytest.approx(0.1)
    assert imbalance(np.zeros((2, 2)), np.array([0.0, 0.25])) == 0.25
