"""A layer by Gamma, f*, diameters and cycles: what follows from it, once, and for whom."""

import math

import pytest

from roughgas import config
from roughgas.scene import build
from roughgas.simulation import schedule

RUBBER = {"restitution": "particles", "roughness": "particles"}
STRIPES = {
    "particles": 600,
    "layer": {"gamma": 3.0, "f_star": 0.44, "depth": 5.42, "width": 10},
    "effects": {"spin": {"inertia": 0.4}, "gravity": {"acceleration": 2.5}, "floor": dict(RUBBER)},
    "schedule": {"kind": "steady"},
}
CYCLES = {"equilibrate": 40, "measure": 8, "samples": 32, "repeat": 4}


def settings(**layer):
    cycles = {"cycles": CYCLES} | layer
    return config.validated(STRIPES | {"layer": STRIPES["layer"] | cycles}, "stripes")


def test_gamma_and_f_star_are_those_of_the_floor():
    """Backwards from the scene that is built, by other formulas: the largest acceleration of the
    floor, and the time that it takes to fall through the depth."""
    found = settings()
    floor, g = build(found, 0.7, 0.35).effects.floor, 2.5
    omega = 2.0 * math.pi / floor.period
    heights = [type(floor).hooks.displacement(floor, t * floor.period) for t in (0.0, 0.5)]
    assert 0.5 * (heights[1] - heights[0]) * omega**2 == pytest.approx(3.0 * g)
    falls = math.sqrt(2.0 * 2.0 * 5.42 / g)
    assert falls / math.sqrt(2.0) / floor.period == pytest.approx(0.44)
    assert found["effects"]["floor"]["wave"] == "sine"
    assert found["box"] == [20, 20, "open"]
    assert build(found, 0.7, 0.35).lists
    period = floor.period
    lengths = [found["schedule"][key] for key in ("equilibrate", "measure", "sample_every")]
    assert lengths == pytest.approx([40 * period, 8 * period, period / 32])
    assert found["schedule"]["period"] == pytest.approx(4 * period)
    schedule.check(found)


def test_settings_that_have_been_read_are_read_as_they_are():
    found = settings()
    assert config.validated(found, "again") == found
    assert config.changed_by(found, {})["layer"] == found["layer"]


def test_a_change_of_the_layer_changes_all_that_follows():
    """The same as if it had been given so; also of gravity."""
    whole = config.fitted(config.changed_by(settings(), {"layer": {"gamma": 6, "width": 7}}), "x")
    assert whole == settings(gamma=6, width=7)
    heavy = {"effects": {"gravity": {"acceleration": 1.0}}}
    light = config.fitted(config.changed_by(settings(), heavy), "x")
    assert light["effects"]["floor"]["period"] == pytest.approx(
        math.sqrt(2.5) * settings()["effects"]["floor"]["period"]
    )


def test_cases_of_a_layer_have_floors_of_their_own():
    cases = {"b": {"layer": {"f_star": 0.44}}, "g": {"layer": {"gamma": 6, "f_star": 0.84}}}
    sweep = {"r": ["0.7"], "beta": ["0.35"], "seeds": 1, "case": cases}
    found = config.every_variant("x", settings() | {"sweep": sweep})
    b, g = found["x/caseb"]["effects"]["floor"], found["x/caseg"]["effects"]["floor"]
    assert b == settings()["effects"]["floor"]
    assert g["period"] == pytest.approx(b["period"] * 0.44 / 0.84)
    assert g["amplitude"] == pytest.approx(b["amplitude"] * 2.0 * (0.44 / 0.84) ** 2)
