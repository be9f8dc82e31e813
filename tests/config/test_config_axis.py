"""The third axis of a sweep: variants of an experiment, and how mistakes are named."""

import math

import pytest
from raw import typed
from tests.configurations import checked, raw_configuration

from roughgas.base import InputError, labels
from roughgas.config import WrittenExperiment
from roughgas.data.reduced import REDUCED
from roughgas.data.variables import POINT
from roughgas.effects import EFFECTS
from roughgas.effects.species import RadiiSettings, SpeciesSettings
from roughgas.results.reduce import COMMON_ATTRIBUTES
from roughgas.simulation import protocols
from roughgas.simulation.run_points import variant_attributes

INERTIA = {"extends": "sheared", "sweep": {"r": ["0.9"], "spin.inertia": ["1", "0.50", "1e-3"]}}


def with_experiments(small=None, **experiments):
    """Return the configuration with further experiments, and with changes at the scale `small`."""
    raw = raw_configuration()
    raw["experiments"] |= experiments
    raw["scales"]["small"] |= small or {}
    return checked(raw)


@pytest.fixture(scope="module")
def configuration():
    walls = {"extends": "vibrated_rough_walls", "sweep": {"walls.roughness": ["particles", 0.5]}}
    child = {"extends": "spun", "particles": 80}
    still = {"extends": "spun", "sweep": {"spin.inertia": None}}
    small = {"spun": {"sweep": {"spin.inertia": ["0.2"]}}}
    return with_experiments(small, spun=INERTIA, walls=walls, child=child, still=still)


def test_a_value_is_a_variant(configuration):
    written = configuration.experiment("spun", "paper").raw
    names = WrittenExperiment(written).variants("spun")
    assert names == ["spun/inertia1", "spun/inertia0.5", "spun/inertia0.001"]
    values = [configuration.experiment(name, "paper").raw["effects"]["spin"] for name in names]
    assert values == [{"inertia": 1.0}, {"inertia": 0.5}, {"inertia": 0.001}]
    assert written["effects"]["spin"] == {"inertia": 0.5}  # as written, inherited from `sheared`


def test_a_variant_is_an_experiment_like_others(configuration):
    variant = configuration.experiment("spun/inertia1", "paper").raw
    plain = configuration.experiment("sheared", "paper").raw
    assert variant["sweep"] == plain["sweep"] | {"r": ["0.9"]}
    assert variant["effects"] == plain["effects"] | {"spin": {"inertia": 1}}
    assert WrittenExperiment(variant).variants("spun/inertia1") == ["spun/inertia1"]
    assert WrittenExperiment(plain).variants("sheared") == ["sheared"]
    WrittenExperiment(variant).check_has_points("spun/inertia1")


CASES = {
    "slow": {"effects": {"floor": {"amplitude": 2, "period": 2}}, "schedule": {"period": 2}},
    "many": {"particles": 320, "box": [100, "open"]},
}


def test_cases_are_settings_that_vary_together():
    """Merged at every depth over the experiment's own, also at a scale; null removes one."""
    beds = {"extends": "vibrated", "sweep": {"r": ["0.9"], "case": CASES}}
    configuration = with_experiments({"beds": {"sweep": {"case": {"many": None}}}}, beds=beds)
    written = configuration.experiment("beds", "paper").raw
    assert WrittenExperiment(written).variants("beds") == ["beds/caseslow", "beds/casemany"]
    slow, large = (configuration.experiment(f"beds/case{name}", "paper").raw for name in CASES)
    plain = configuration.experiment("vibrated", "paper").raw
    floor = plain["effects"]["floor"] | {"amplitude": 2, "period": 2}
    assert slow["effects"] == plain["effects"] | {"floor": floor}
    assert slow["schedule"] == plain["schedule"] | {"period": 2}
    assert (large["particles"], large["box"]) == (320, [100, "open"])
    attributes = variant_attributes("beds/caseslow", typed(slow))
    expected = {"variant": "caseslow", "swept": "case", "swept_value": "slow"}
    assert attributes == {"experiment": "beds"} | expected
    small = configuration.experiment("beds", "small").raw
    assert WrittenExperiment(small).variants("beds") == ["beds/caseslow"]
    assert "case" not in REDUCED | POINT


def test_a_case_that_is_not_there_is_named():
    sweep = {"r": ["0.9"], "case": CASES}
    configuration = with_experiments(beds={"extends": "vibrated", "sweep": sweep})
    with pytest.raises(InputError, match=r"case = 'fast': must be one of many, slow"):
        configuration.experiment("beds/casefast", "paper")


def test_the_axis_is_inherited_and_null_removes_it(configuration):
    child, still = (configuration.experiment(name, "paper").raw for name in ("child", "still"))
    assert WrittenExperiment(child).variants("child")[0] == "child/inertia1"
    assert WrittenExperiment(still).variants("still") == ["still"]
    assert still["sweep"].keys() == {"r", "beta", "seeds"}


def test_a_scale_has_its_own_values(configuration):
    for name in ("spun", "child"):
        experiment = configuration.experiment(name, "small").raw
        assert WrittenExperiment(experiment).variants(name) == [f"{name}/inertia0.2"]


@pytest.mark.parametrize(
    ("key", "label", "section", "value"),
    [
        ("particles", "40", "particles", 40),
        ("box", "25", "box", [25, "open"]),
        ("schedule.measure", "2.5", "schedule", {"measure": 2.5}),
    ],
)
def test_any_number_of_the_settings_is_swept(key, label, section, value):
    configuration = with_experiments(sized={"extends": "vibrated", "sweep": {key: [label, "1e2"]}})
    name = f"sized/{labels.parameter_of(key)}{label}"
    settings = configuration.experiment(name, "paper").raw
    swept = settings[section]
    assert (value.items() <= swept.items()) if isinstance(value, dict) else swept == value
    attributes = variant_attributes(name, typed(settings))
    assert attributes["swept"] == key and attributes["swept_value"] == float(label)
    with pytest.raises(InputError, match="be the variant that its settings are of"):
        variant_attributes(f"{name}1", typed(settings))


def test_a_quantity_of_a_species_is_a_variant():
    species = [
        {"fraction": 0.5, "name": "light"},
        {"fraction": 0.5, "radius": {"distribution": "uniform", "deviation": 0.1}},
    ]
    heavy = {"extends": "cooling", "species": species, "sweep": {"species.1.mass": ["1", "4"]}}
    wide = {"extends": "cooling", "species": species, "sweep": {"species.1.deviation": ["0.2"]}}
    grown = {"extends": "cooling", "species": species, "sweep": {"species.light.radius": ["3"]}}
    configuration = with_experiments(heavy=heavy, wide=wide, grown=grown)
    (first, four) = configuration.experiment("heavy", "paper").variants("heavy")
    assert (first, four) == ("heavy/mass1", "heavy/mass4")
    settings = configuration.experiment(four, "paper").raw
    assert settings["species"] == [species[0], species[1] | {"mass": 4.0}]
    assert labels.level_in(settings, "species.1.mass") == 4.0
    assert variant_attributes(four, typed(settings))["swept"] == "species.1.mass"
    settings = configuration.experiment("wide/deviation0.2", "paper").raw
    assert settings["species"][1]["radius"] == {"distribution": "uniform", "deviation": 0.2}
    settings = configuration.experiment("grown/radius2", "paper").raw
    assert settings["species"][0] == {"fraction": 0.5, "name": "light", "radius": 2.0}
    assert species[1]["radius"]["deviation"] == 0.1  # the written settings are unchanged


def test_no_parameter_has_a_name_that_datasets_need():
    """A third axis is a dimension named by its parameter; attributes that theory needs give way."""
    taken = set(POINT) | set(REDUCED) | set(COMMON_ATTRIBUTES)
    structs = [kind.settings for kind in EFFECTS.values()] + [SpeciesSettings, RadiiSettings]
    structs += [kind.SETTINGS for kind in protocols.PROTOCOLS.values()]
    parameters = {name for struct in structs for name in struct.__struct_fields__}
    parameters |= {"particles", "box"}
    assert parameters & taken == {"inertia", "mu", "spin_share", "particles"}


def sides(configuration, name):
    experiment = configuration.experiment(name, "paper").raw
    return experiment["particles"], experiment["box"], experiment["packing"]


def test_a_packing_is_the_size_of_the_box():
    """It holds for N, radii and shape of the last scale, variant or inheritance."""
    large = [{"fraction": 0.5}, {"fraction": 0.5, "radius": 3}]
    configuration = with_experiments(
        {"dense": {"particles": 90}},
        dense={"extends": "cooling", "packing": 0.2},
        wide={"extends": "dense", "box": [3, 1], "packing": 0.1},
        cubes={"extends": "cooling_spheres", "packing": 0.2, "box": [1, 1, 2]},
        mixed={"extends": "dense", "species": large},
        counted={"extends": "dense", "sweep": {"particles": ["20", "640"]}},
        packed={"extends": "cooling", "sweep": {"packing": ["0.1", "0.4"]}},
        boxed={"extends": "dense", "box": [70, 80], "packing": None},
        shaped={"extends": "dense", "box": [1, 3]},
    )
    for name, packing, volume in (
        ("dense", 0.2, math.pi),
        ("wide", 0.1, math.pi),
        ("cubes", 0.2, 4.0 / 3.0 * math.pi),
        ("mixed", 0.2, 5.0 * math.pi),
        ("shaped", 0.2, math.pi),
        ("counted/particles20", 0.2, math.pi),
        ("counted/particles640", 0.2, math.pi),
        ("packed/packing0.4", 0.4, math.pi),
    ):
        number, box, setting = sides(configuration, name)
        assert setting == packing and number * volume / math.prod(box) == pytest.approx(packing)
    (*_, wide, _), (*_, cube, _) = sides(configuration, "wide"), sides(configuration, "cubes")
    assert wide[0] == pytest.approx(3 * wide[1]) and cube[2] == pytest.approx(2 * cube[0])
    (*_, shaped, _) = sides(configuration, "shaped")
    assert shaped[1] == pytest.approx(3 * shaped[0])
    small = configuration.experiment("dense", "small").raw
    assert 90 * math.pi / math.prod(small["box"]) == pytest.approx(0.2)
    assert WrittenExperiment(small).fitted("again").raw == small  # as the JSON of a point has it
    boxed = configuration.experiment("boxed", "paper").raw
    assert boxed["box"] == [70, 80] and "packing" not in boxed
    packed = configuration.experiment("packed/packing0.4", "paper").raw
    attributes = variant_attributes("packed/packing0.4", typed(packed))
    assert attributes["swept"] == "packing" and attributes["swept_value"] == 0.4


def test_a_box_does_not_take_an_inherited_packing_away_in_silence():
    message = r"box = \[70, 80\]: must not stand beside packing = 0.2; .* `packing: null` takes"
    with pytest.raises(InputError, match=message):
        with_experiments(
            dense={"extends": "cooling", "packing": 0.2},
            boxed={"extends": "dense", "box": [70, 80]},
        )
