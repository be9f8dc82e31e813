"""Made-up layers judged by the published patterns: settling, wavelength, order and period."""

import math

import numpy as np
import pytest
import xarray as xr
from tests.show.figures.legibility import faults
from tests.study_modules import ROOT, module_of_study
from tests.synthetic import reduced

from roughgas import config, simulate
from roughgas.base.files import study_module
from roughgas.base.reading import read_yaml
from roughgas.claims.verdicts import FAILS, HOLDS, NOT_TESTED, QUALIFIED
from roughgas.results.row_verdicts import NOT_KNOWN, verdicts
from roughgas.show import slides

STUDY = ROOT / "studies" / "patterns"
REPEATS = {"a": 2, "b": 2, "cd": 2, "e": 4, "f": 4, "g": 4, "h": 4}
WAVELENGTH = {"a": 33.3, "b": 20, "cd": 25, "e": 16.7, "f": 33.3, "g": 20, "h": 25}
ORDER = {"a": 0.833, "b": 0.851, "cd": 0.486, "f": 0.758, "g": 0.874}
FOLD = {"a": 4, "b": 2, "cd": 6, "f": 4, "g": 2}
THE_WAVELENGTH, THE_ORDER = "the_wavelength_is_published", "the_order_is_published"
IT_REPEATS = "it_repeats_when_published"


def layers(width, cases=tuple(REPEATS), stretch=1.0, less=0.0, repeats=None, fading=1.0):
    """Return published layers, or layers with wavelengths `stretch` times as long, orders `less`
    smaller, other periods, and patterns whose correlation is `fading` times as large after each
    cycle."""
    data = reduced("layers", r=(0.7,), beta=(0.35,), third=("case", cases))
    data.attrs["particles"] = 6 * width**2
    cells = np.arange(width) * 2.0 + 1.0
    delays, grid = np.arange(17), ("case", "r", "beta")
    shape = (len(cases), 1, 1)
    periods = [(repeats or REPEATS)[case] for case in cases]
    lags = np.array([np.cos(2 * np.pi * delays / n) * fading**delays for n in periods])
    orders = np.zeros((len(cases), 3))
    for row, case in enumerate(cases):
        orders[row, (2, 4, 6).index(FOLD.get(case, 2))] = ORDER.get(case, 0.0) - less
    lengths = np.array([2.0 * stretch * WAVELENGTH[case] for case in cases]).reshape(shape)
    wave = 10.0 + np.cos(cells)
    heights = np.broadcast_to(wave, (*shape, 4, width, width))
    values = {
        "wavelength": (grid, lengths),
        "wavelength_resolution": (grid, lengths**2 / (4.0 * width)),
        "fold_order": ((*grid, "fold"), orders[:, None, None]),
        "mean_height": ((*grid, "pattern_phase", "cell_x", "cell_y"), heights),
        "height_autocorrelation": ((*grid, "pattern_delay"), lags[:, None, None]),
        "layer_height": ((*grid, "layer_phase"), np.full((*shape, 64), 12.0)),
    }
    errors = {f"{name}_stderr": (dims, 0.01 * np.abs(x)) for name, (dims, x) in values.items()}
    freedom = {f"{name}_dof": (dims, np.full(x.shape, 9.0)) for name, (dims, x) in values.items()}
    axes = {"cell_x": cells, "cell_y": cells, "fold": [2, 4, 6], "layer_phase": np.arange(64) / 64}
    begin = {"measured_from": (grid, np.full(shape, 300.0))}
    return data.assign(values | errors | freedom | begin).assign_coords(axes)


def test_layers_as_published_hold(judged):
    every = layers(100)
    for name in (THE_WAVELENGTH, THE_ORDER, IT_REPEATS):
        assert judged(name, every).verdict == HOLDS


def test_wavelengths_of_another_mode_fail(judged):
    """Of 100 D/20 D a mode less is 25 D; with 100 D/33.3 D a mode less is half as long again."""
    assert judged(THE_WAVELENGTH, layers(100, ("b", "g"), stretch=1.2)).verdict == HOLDS
    assert judged(THE_WAVELENGTH, layers(100, ("b", "g"), stretch=1.3)).verdict == FAILS
    mixed = judged(THE_WAVELENGTH, layers(100, ("a", "b"), stretch=1.3))
    assert mixed.verdict == QUALIFIED and "a: 43.3 D (33.3 published)" in mixed.reason


def test_orders_that_are_too_low_fail(judged):
    assert judged(THE_ORDER, layers(100, less=0.09)).verdict == HOLDS
    assert judged(THE_ORDER, layers(100, less=0.11)).verdict == FAILS


def test_periods_are_told_apart(judged):
    swapped = {case: 6 - repeats for case, repeats in REPEATS.items()}
    assert judged(IT_REPEATS, layers(100, repeats=swapped)).verdict == FAILS
    assert judged(IT_REPEATS, layers(100, repeats=REPEATS | {"g": 2})).verdict == QUALIFIED


def test_unsettled_patterns_and_small_boxes_are_not_judged(judged):
    """After 16 cycles 0.98^12 of the correlation after 4 is 0.785; and 33 D in a box of 40 D."""
    for name in (THE_WAVELENGTH, THE_ORDER, IT_REPEATS):
        assert judged(name, layers(100, fading=0.98)).verdict == NOT_TESTED
        assert judged(name, layers(100, fading=0.99)).verdict != NOT_TESTED
    assert judged(THE_WAVELENGTH, layers(40, ("a", "f"))).verdict == NOT_TESTED
    assert judged(THE_ORDER, layers(40, ("a", "cd", "f", "h"))).verdict == NOT_TESTED
    assert judged(IT_REPEATS, layers(40, ("a", "f"))).verdict == HOLDS


def test_evidence_has_no_value_of_unsettled_patterns():
    rows = study_module(STUDY, "evidence").rows
    by_panel = {(row.at[:7], row.quantity): row for row in rows(layers(100))}
    wavelength = by_panel["panel g", "wavelength/D"]
    # the side of the box quantises wavelengths, so that it could not see a tenth
    assert abs(wavelength.t) < 1 and verdicts([wavelength]) == ["not tested"]
    assert by_panel["panel d", "Q_6"].theirs.value == 0.49
    assert ("panel d", "wavelength/D") not in by_panel  # c has the same
    for row in rows(layers(100, fading=0.9)):
        assert np.isnan(row.ours.value) and verdicts([row]) == [NOT_KNOWN]


def test_pictures_of_large_layers_come_first_and_all_are_named_by_what_is_seen():
    """A box of fewer than four waves names no pattern; unsettled layers are named, too."""
    small, large = layers(20, ("b", "cd", "g"), fading=0.9), layers(100, ("g",))
    draw = module_of_study("patterns", "figure").draw
    assert faults(lambda: draw(small, large)) == []
    pictures = [axes for axes in draw(small, large).axes if axes.images]
    assert [axes.get_title("left") for axes in pictures] == [
        *("(g) straight stripes", "(b) 1.0 waves: too few"),
        *("(c) 0.8 waves: too few", "(d) 0.8 waves: too few"),
    ]
    texts = [" ".join(axes.get_xlabel().split()) for axes in pictures]
    assert texts[0].endswith("published: stripes, λ 20 D, Q₂ 0.87, 4 cycles 100 D = 5.0 λ")
    assert ["not settled" in text for text in texts] == [False, True, True, True]


def directions(*angles):
    """Return waves of 20 D at these angles on a layer of 100 D, (x, y)."""
    x, y = np.meshgrid(np.arange(100.0), np.arange(100.0), indexing="ij")
    return sum(np.cos(np.pi / 10 * (x * np.cos(a) + y * np.sin(a))) for a in angles)


RIGHT, SIXTH = np.pi / 2, np.pi / 3
DOMAINS = np.where(np.arange(100)[:, np.newaxis] < 50, directions(0.0), directions(RIGHT))
WAVES_BY_NAME = {
    "straight stripes": (directions(0.3), (0.9, 0.1, 0.1)),
    "bent stripes": (DOMAINS, (0.3, 0.3, 0.1)),
    "squares": (directions(0.0, RIGHT), (0.1, 0.8, 0.2)),
    "hexagons": (directions(0.0, 2 * SIXTH, 4 * SIXTH), (0.1, 0.1, 0.5)),
    "separate hills": (directions(0.0, 2 * SIXTH, 4 * SIXTH), (0.1, 0.3, 0.3)),
    "separate hollows": (-directions(0.0, 2 * SIXTH, 4 * SIXTH), (0.1, 0.3, 0.3)),
    "no order": (directions(0.0, 0.7, 1.1, 1.9, 2.9), (0.1, 0.2, 0.3)),
}


@pytest.mark.parametrize("name", WAVES_BY_NAME)
def test_a_pattern_has_the_name_of_its_waves(name):
    heights, orders = WAVES_BY_NAME[name]
    made_up = layers(100, ("g",))
    made_up.mean_height.values = np.broadcast_to(heights, made_up.mean_height.shape)
    made_up.fold_order.values = np.reshape(orders, made_up.fold_order.shape)
    study = module_of_study("patterns", "appearance")
    ((panel, layer),) = module_of_study("patterns", "published").layers_of_panels(made_up)
    assert study.appearance(panel, layer) == name


def test_the_full_size_is_the_published_one():
    configuration = config.load(ROOT / "config.yaml", read_yaml(STUDY / "full.yaml"))
    b = configuration.experiment("patterns.layers/caseb", "full").raw
    assert (b["particles"], b["box"]) == (60000, [200.0, 200.0, "open"])
    cycle = b["effects"]["floor"]["period"]
    assert b["schedule"]["equilibrate"] == pytest.approx(2700 * cycle)


def test_half_the_size_has_the_same_spheres_per_area():
    configuration = config.load(ROOT / "config.yaml", read_yaml(STUDY / "half.yaml"))
    h = configuration.experiment("patterns.layers/caseh", "half").raw
    assert (h["particles"], h["box"]) == (15000, [100.0, 100.0, "open"])
    assert [*configuration.experiment("patterns.layers", "half").raw["sweep"]["case"]] == [
        *REPEATS
    ][2:]


def test_published_numbers_match_their_table():
    published = module_of_study("patterns", "published").panels()
    assert [panel.panel for panel in published] == list("abcdefgh")
    for panel in published:
        assert (panel.repeats, panel.wavelength) == (REPEATS[panel.case], WAVELENGTH[panel.case])
    settings = config.load(ROOT / "config.yaml")
    for panel in published:
        case = settings.experiment(f"patterns.layers/case{panel.case}", "paper").raw
        assert (case["layer"]["gamma"], case["layer"]["f_star"]) == (panel.gamma, panel.f_star)


@pytest.mark.slow
def test_a_ball_that_does_not_bounce_flies_for_a_cycle_between_its_thresholds():
    """sqrt(1 + pi^2) = 3.297 and sqrt(4 + pi^2) = 3.724; and shorter where the floor is slower."""
    flights = module_of_study("patterns", "ball").flights
    for gamma in (3.32, 3.5, 3.68):
        assert flights(gamma) == pytest.approx([1.0], abs=2e-3)
    (shorter,) = flights(3.29)
    assert 0.99 < shorter < 1.0
    low, high = flights(3.74)
    assert low + high == pytest.approx(2.0, abs=2e-3) and high - low > 0.02
    (length,) = flights(1.5)
    start = math.asin(1.0 / 1.5)
    end = start + 2.0 * math.pi * length
    fall = (end - start) ** 2 / (2.0 * 1.5)
    rise = math.sin(start) + math.cos(start) * (end - start)
    assert rise - fall == pytest.approx(math.sin(end), abs=1e-9)


@pytest.mark.parametrize("gamma", [1.5, 3.0, 4.0, 5.0, 7.0])
def test_a_ball_lies_on_the_floor_or_falls_freely(gamma):
    """It stays on the floor as long as the floor does not fall away faster than g."""
    phase = np.linspace(0.0, 8.0 * math.pi, 20001)
    height, floor = module_of_study("patterns", "ball").ball_heights(gamma, phase), np.sin(phase)
    flies = height > floor + 1e-6
    assert np.all(height >= floor - 1e-12) and 0.5 < np.mean(flies)
    acceleration = np.diff(height, 2) / phase[1] ** 2
    falls = np.abs(acceleration + 1.0 / gamma) < 1e-3
    # but where it lands and leaves at once
    assert np.mean(falls[flies[:-2] & flies[1:-1] & flies[2:]]) > 0.999
    assert np.mean(~flies & (floor > 1.0 / gamma + 0.03)) < 1e-3


@pytest.mark.slow
def test_each_layer_has_a_slide_with_the_published_values(tmp_path, monkeypatch):
    data = {"layers.nc": layers(20, ("cd", "g"), fading=0.9), "large.nc": layers(100, ("g",))}
    monkeypatch.setattr(slides, "read_reduced", data.get)
    page = tmp_path / "patterns.html"
    slides.write_slides(STUDY, [*data], title="Patterns", output=page)
    text = page.read_text("utf-8")
    assert text.count("<section>") == 3
    assert text.count("data:image/webp;base64,") == 6  # for light and dark pages
    assert text.count("not settled") == 1 and "λ 20 D, Q₂ 0.87, 4 cycles" in text
    assert "http" not in text.partition("<body>")[2] and len(text) < 1e6


@pytest.mark.slow  # a minute
def test_the_small_layer_turns_over_with_each_cycle_without_overlap_or_loss_of_energy():
    layer = simulate(
        "patterns.layers/casecd", r=0.7, beta=0.35, scale="small", keep_state=True, progress=False
    )
    after = layer.height_autocorrelation.values
    assert after[1] < -0.5 and after[2] > 0.8
    assert layer.energy_imbalance < 1e-11
    position = layer.last_position.values[0]
    order = np.argsort(position[:, 0])
    for shift in range(1, 600):  # at least 7 a wide, six spheres to each D^2
        first, second = position[order[shift:]], position[order[:-shift]]
        distance = np.linalg.norm(first - second, axis=1)
        assert distance.min() > 2.0 - 1e-9
        if (first[:, 0] - second[:, 0]).min() > 2.0:
            return
    raise AssertionError("not all pairs were seen")


def test_copies_of_a_layer_are_mirror_images_of_their_neighbours():
    """Distances and speeds are conserved; in a mirror image, velocity times spin changes its
    sign."""
    rng = np.random.default_rng(4)
    dimensions = {
        n: ("run", "particle", n) for n in ("last_position", "last_velocity", "last_spin")
    }
    values = {name: (dims, rng.uniform(1.0, 9.0, (1, 20, 3))) for name, dims in dimensions.items()}
    layer = xr.Dataset(values | {"last_time": ("run", [7.0])})
    copies = module_of_study("patterns", "straight").mirrored(layer, 3, 10.0)
    first, second, third = copies.position.values.reshape(3, 20, 3)
    assert first == pytest.approx(layer.last_position.values[0])
    assert first + second == pytest.approx(np.array([2.0, 0.0, 2.0]) * first + [0.0, 20.0, 0.0])
    assert third - first == pytest.approx(np.broadcast_to([0.0, 20.0, 0.0], (20, 3)))
    turning = (copies.velocity.values * copies.spin.values).sum(axis=1).reshape(3, 20)
    assert turning[1] == pytest.approx(-turning[0]) and turning[2] == pytest.approx(turning[0])
    assert (copies.velocity**2).sum() == pytest.approx(3.0 * float((layer.last_velocity**2).sum()))
    assert float(copies.time) == 7.0


def test_boxes_that_hide_long_waves_are_named(judged):
    """In a box of two wavelengths a single one differs by one mode, which agrees."""
    words = "one wave across the box would agree, too"
    wide, narrow = (judged(THE_WAVELENGTH, layers(width)).reason for width in (100, 40))
    assert words not in wide
    assert narrow.count(words) == 4  # b, cd, g and h; a and f are too narrow, e has 2.4
