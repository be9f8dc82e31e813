"""The third axis of a sweep: variants of an experiment, and how mistakes are named."""

import copy
import math

import pytest

from roughgas import config
from roughgas.base import InputError
from roughgas.config import schema
from roughgas.data.reduced import REDUCED
from roughgas.data.variables import POINT
from roughgas.results.reduce import SAME
from roughgas.simulation.points import variant_attributes

INERTIA = {"extends": "sheared", "sweep": {"r": ["0.9"], "spin.inertia": ["1", "0.50", "1e-3"]}}


@pytest.fixture(scope="session")
def with_experiments(paper):
    def whole(**experiments):
        more = copy.deepcopy(paper)
        more["experiments"] |= experiments
        return more

    return whole


@pytest.fixture(scope="module")
def whole(with_experiments):
    walls = {"extends": "vibrated_rough_walls", "sweep": {"walls.roughness": ["particles", 0.5]}}
    child = {"extends": "spun", "particles": 80}
    still = {"extends": "spun", "sweep": {"spin.inertia": None}}
    found = with_experiments(spun=INERTIA, walls=walls, child=child, still=still)
    found["scales"]["small"]["spun"] = {"sweep": {"spin.inertia": ["0.2"]}}
    schema.check(found)
    return found


def test_a_value_is_a_variant(whole):
    written = config.experiment(whole, "spun", "paper")
    names = config.variants("spun", written)
    assert names == ["spun/inertia1", "spun/inertia0.50", "spun/inertia1e-3"]
    values = [config.experiment(whole, name, "paper")["effects"]["spin"] for name in names]
    assert values == [{"inertia": 1.0}, {"inertia": 0.5}, {"inertia": 0.001}]
    assert written["effects"]["spin"] == {"inertia": 0.5}  # as written: that of `sheared`


def test_a_variant_is_an_experiment_like_others(whole):
    found = config.experiment(whole, "spun/inertia1", "paper")
    plain = config.experiment(whole, "sheared", "paper")
    assert found["sweep"] == plain["sweep"] | {"r": ["0.9"]}
    assert found["effects"] == plain["effects"] | {"spin": {"inertia": 1}}
    assert config.variants("spun/inertia1", found) == ["spun/inertia1"]
    assert config.variants("sheared", plain) == ["sheared"]
    config.check_one_variant("spun/inertia1", found)


CASES = {
    "slow": {"effects": {"floor": {"amplitude": 2, "period": 2}}, "schedule": {"period": 2}},
    "many": {"particles": 320, "box": [100, "open"]},
}


def test_cases_are_settings_that_vary_together(with_experiments):
    """Merged at every depth over the experiment's own, at a scale, too; null removes one."""
    beds = {"extends": "vibrated", "sweep": {"r": ["0.9"], "case": CASES}}
    whole = with_experiments(beds=beds)
    whole["scales"]["small"]["beds"] = {"sweep": {"case": {"many": None}}}
    schema.check(whole)
    written = config.experiment(whole, "beds", "paper")
    assert config.variants("beds", written) == ["beds/caseslow", "beds/casemany"]
    slow, many = (config.experiment(whole, f"beds/case{name}", "paper") for name in CASES)
    plain = config.experiment(whole, "vibrated", "paper")
    floor = plain["effects"]["floor"] | {"amplitude": 2, "period": 2}
    assert slow["effects"] == plain["effects"] | {"floor": floor}
    assert slow["schedule"] == plain["schedule"] | {"period": 2}
    assert (many["particles"], many["box"]) == (320, [100, "open"])
    about = variant_attributes("beds/caseslow", slow)
    expected = {"variant": "caseslow", "swept": "case", "swept_value": "slow"}
    assert about == {"experiment": "beds"} | expected
    small = config.experiment(whole, "beds", "small")
    assert config.variants("beds", small) == ["beds/caseslow"]
    assert "case" not in REDUCED | POINT


def test_a_case_that_is_not_there_is_named(with_experiments):
    sweep = {"r": ["0.9"], "case": CASES}
    whole = with_experiments(beds={"extends": "vibrated", "sweep": sweep})
    with pytest.raises(InputError, match=r"case = 'fast': must be one of many, slow"):
        config.experiment(whole, "beds/casefast", "paper")


def test_the_axis_is_inherited_and_null_removes_it(whole):
    child, still = (config.experiment(whole, name, "paper") for name in ("child", "still"))
    assert config.variants("child", child)[0] == "child/inertia1"
    assert config.variants("still", still) == ["still"]
    assert still["sweep"].keys() == {"r", "beta", "seeds"}


def test_a_scale_has_its_own_values(whole):
    for name in ("spun", "child"):
        found = config.experiment(whole, name, "small")
        assert config.variants(name, found) == [f"{name}/inertia0.2"]


@pytest.mark.parametrize(
    ("key", "label", "part", "value"),
    [
        ("particles", "40", "particles", 40),
        ("box", "25", "box", [25, "open"]),
        ("schedule.measure", "2.5", "schedule", {"measure": 2.5}),
    ],
)
def test_any_number_of_the_settings_is_swept(with_experiments, key, label, part, value):
    whole = with_experiments(sized={"extends": "vibrated", "sweep": {key: [label, "1e2"]}})
    schema.check(whole)
    name = f"sized/{config.parameter_of(key)}{label}"
    settings = config.experiment(whole, name, "paper")
    found = settings[part]
    assert (value.items() <= found.items()) if isinstance(value, dict) else found == value
    about = variant_attributes(name, settings)
    assert about["swept"] == key and about["swept_value"] == float(label)
    with pytest.raises(InputError, match="be the variant that its settings are of"):
        variant_attributes(f"{name}1", settings)


def test_a_quantity_of_a_species_is_a_variant(with_experiments):
    species = [
        {"fraction": 0.5, "name": "light"},
        {"fraction": 0.5, "radius": {"distribution": "uniform", "deviation": 0.1}},
    ]
    heavy = {"extends": "cooling", "species": species, "sweep": {"species.1.mass": ["1", "4"]}}
    wide = {"extends": "cooling", "species": species, "sweep": {"species.1.deviation": ["0.2"]}}
    grown = {"extends": "cooling", "species": species, "sweep": {"species.light.radius": ["3"]}}
    found = with_experiments(heavy=heavy, wide=wide, grown=grown)
    schema.check(found)
    (one, four) = config.variants("heavy", config.experiment(found, "heavy", "paper"))
    assert (one, four) == ("heavy/mass1", "heavy/mass4")
    settings = config.experiment(found, four, "paper")
    assert settings["species"] == [species[0], species[1] | {"mass": 4.0}]
    assert config.swept_value(settings, "species.1.mass") == 4.0
    assert variant_attributes(four, settings)["swept"] == "species.1.mass"
    settings = config.experiment(found, "wide/deviation0.2", "paper")
    assert settings["species"][1]["radius"] == {"distribution": "uniform", "deviation": 0.2}
    settings = config.experiment(found, "grown/radius2", "paper")
    assert settings["species"][0] == {"fraction": 0.5, "name": "light", "radius": 2.0}
    assert species[1]["radius"]["deviation"] == 0.1  # what is written stays as it is


def test_no_parameter_has_a_name_that_datasets_need():
    """A third axis is a dimension named by its parameter; attributes that theory needs give way."""
    taken = set(POINT) | set(REDUCED) | set(SAME)
    effects = schema._validator("experiment").schema["$defs"]["effects"]["properties"]
    parameters = {name for about in effects.values() for name in about["properties"]}
    parameters |= {"particles", "box", *schema._schema()["$defs"]["schedule"]["properties"]}
    definitions = schema._schema()["$defs"]
    parameters |= {*definitions["one_species"]["properties"], *definitions["radii"]["properties"]}
    assert parameters & taken == {"inertia", "mu", "spin_share", "particles"}


def sides(whole, name):
    found = config.experiment(whole, name, "paper")
    return found["particles"], found["box"], found["packing"]


def test_a_packing_is_the_size_of_the_box(with_experiments):
    """It is that of N, radii and shape whatever scale, variant or inheritance has the last word."""
    large = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 3}]
    whole = with_experiments(
        dense={"extends": "cooling", "packing": 0.2},
        wide={"extends": "dense", "box": [3, 1]},
        cubes={"extends": "cooling_spheres", "packing": 0.2, "box": [1, 1, 2]},
        mixed={"extends": "dense", "species": large},
        counted={"extends": "dense", "sweep": {"particles": ["20", "640"]}},
        packed={"extends": "cooling", "sweep": {"packing": ["0.1", "0.4"]}},
        boxed={"extends": "dense", "box": [70, 80]},
    )
    whole["experiments"]["wide"]["packing"] = 0.1
    whole["scales"]["small"]["dense"] = {"particles": 90}
    schema.check(whole)
    for name, packing, volume in (
        ("dense", 0.2, math.pi),
        ("wide", 0.1, math.pi),
        ("cubes", 0.2, 4.0 / 3.0 * math.pi),
        ("mixed", 0.2, 5.0 * math.pi),
        ("counted/particles20", 0.2, math.pi),
        ("counted/particles640", 0.2, math.pi),
        ("packed/packing0.4", 0.4, math.pi),
    ):
        number, box, asked = sides(whole, name)
        assert asked == packing and number * volume / math.prod(box) == pytest.approx(packing)
    (*_, wide, _), (*_, cube, _) = sides(whole, "wide"), sides(whole, "cubes")
    assert wide[0] == pytest.approx(3 * wide[1]) and cube[2] == pytest.approx(2 * cube[0])
    small = config.experiment(whole, "dense", "small")
    assert 90 * math.pi / math.prod(small["box"]) == pytest.approx(0.2)
    assert config.fitted(small, "again") == small  # as the JSON of a point has it
    boxed = config.experiment(whole, "boxed", "paper")
    assert boxed["box"] == [70, 80] and "packing" not in boxed
    about = variant_attributes(
        "packed/packing0.4", config.experiment(whole, "packed/packing0.4", "paper")
    )
    assert about["swept"] == "packing" and about["swept_value"] == 0.4
