"""A layer by Gamma, f*, diameters and cycles: the settings derived from these."""

import math

import pytest
from raw import build, protocols

from roughgas.config import WrittenExperiment
from roughgas.kernel.scheme import LISTS

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
    return (
        WrittenExperiment(STRIPES | {"layer": STRIPES["layer"] | cycles}).experiment("stripes").raw
    )


def test_gamma_and_f_star_follow_from_the_floor():
    """Computed from the built scene by other formulas: the largest acceleration of the floor, and
    the time of its fall through the depth."""
    experiment = settings()
    floor, g = build(experiment, 0.7, 0.35).effects.floor, 2.5
    omega = 2.0 * math.pi / floor.period
    heights = [type(floor).hooks.displacement(floor, t * floor.period) for t in (0.0, 0.5)]
    assert 0.5 * (heights[1] - heights[0]) * omega**2 == pytest.approx(3.0 * g)
    falls = math.sqrt(2.0 * 2.0 * 5.42 / g)
    assert falls / math.sqrt(2.0) / floor.period == pytest.approx(0.44)
    assert experiment["effects"]["floor"]["wave"] == "sine"
    assert experiment["box"] == [20, 20, "open"]
    assert build(experiment, 0.7, 0.35).scheme == LISTS
    period = floor.period
    lengths = [experiment["schedule"][key] for key in ("equilibrate", "measure", "sample_every")]
    assert lengths == pytest.approx([40 * period, 8 * period, period / 32])
    assert experiment["schedule"]["period"] == pytest.approx(4 * period)
    protocols.check_experiment(experiment)


def test_reading_of_read_settings_changes_nothing():
    experiment = settings()
    assert WrittenExperiment(experiment).experiment("again").raw == experiment
    assert WrittenExperiment(experiment).changed({}).raw["layer"] == experiment["layer"]


def test_a_change_of_the_layer_changes_the_derived_settings():
    """As if it had been set so; also for gravity."""
    changed = (
        WrittenExperiment(settings()).changed({"layer": {"gamma": 6, "width": 7}}).fitted("x").raw
    )
    assert changed == settings(gamma=6, width=7)
    heavy = {"effects": {"gravity": {"acceleration": 1.0}}}
    light = WrittenExperiment(settings()).changed(heavy).fitted("x").raw
    assert light["effects"]["floor"]["period"] == pytest.approx(
        math.sqrt(2.5) * settings()["effects"]["floor"]["period"]
    )


def test_cases_of_a_layer_have_floors_of_their_own():
    cases = {"b": {"layer": {"f_star": 0.44}}, "g": {"layer": {"gamma": 6, "f_star": 0.84}}}
    sweep = {"r": ["0.7"], "beta": ["0.35"], "seeds": 1, "case": cases}
    variants = WrittenExperiment(settings() | {"sweep": sweep}).every_variant("x")
    b, g = (variants[f"x/case{name}"].raw["effects"]["floor"] for name in "bg")
    assert b == settings()["effects"]["floor"]
    assert g["period"] == pytest.approx(b["period"] * 0.44 / 0.84)
    assert g["amplitude"] == pytest.approx(b["amplitude"] * 2.0 * (0.44 / 0.84) ** 2)
