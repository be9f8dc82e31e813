"""The living page in a real browser: its dynamics, compared with the kernel, and its controls."""

import functools
import math

import numpy as np
import pytest
from raw import build, measured, protocols, typed
from tests.browser.screens import boxes, emulated_screen

from roughgas import config, theory
from roughgas.kernel.state import EXPONENT, LAST_FIRST, LAST_SECOND
from roughgas.show.living import experiment_of, write_living
from roughgas.simulation.free_flight import in_starting_order, positions_and_velocities

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CONFIGURATION = functools.cache(lambda: config.load("config.yaml"))
PERIODS = {"vibrated": 30.0, "sheared": 50.0}
"""Whole periods of the drive, in T, after which the page continues the kernel's gas."""
COLLISIONS = 60
SHORT_SCHEDULES = {
    "vibrated": {"equilibrate": 150, "measure": 600},
    "sheared": {"equilibrate": 600, "measure": 4000},
    "cooling": {"replicas": 16, "relaxation_times": 8, "plateau": 60},
}
MEASURED_POINTS = [("vibrated", 0.9, 0.5), ("vibrated", 0.8, -0.5), ("sheared", 0.9, 0.0)]
MEASURED_POINTS += [("sheared", 0.8, 0.8), ("cooling", 0.9, 0.5), ("cooling", 0.8, -0.5)]
CHANGED_MATERIALS = [
    ("cooling", {"q": 1}),
    ("cooling", {"mu": 0.3}),
    ("vibrated", {"q": 0.1, "mu": 0.05}),
]
"""Other moments of inertia, and Coulomb friction so weak that contacts slide."""
LONG_RUNS = [
    ("cooling", {"r": 0.9, "beta": 0.5}, 2000),
    ("cooling", {"r": 0.8, "beta": -0.8}, 2000),
]
LONG_RUNS += [
    ("sheared", {"r": 0.9, "beta": 0.5}, 2000),
    ("vibrated", {"r": 0.9, "beta": 0.0}, 2000),
]
LONG_RUNS += [("cooling", {"r": 0.95, "beta": 0.0, "mu": 0.5}, 300)]
LONG_RUNS += [("sheared", {"r": 0.9, "beta": -0.5, "q": 1, "mu": 0.2}, 300)]
LONG_RUNS += [("vibrated", {"r": 0.6, "beta": 1.0, "q": 0.1}, 300)]
"""Scenes, materials, and collisions per disk."""
SEGMENTS = 20
FIRST_COLLISIONS = """
    const [name, material, particles, number] = arguments, found = [];
    const gas = new Gas(SCENES[name], material, particles);
    while (gas.collisions < number) {
      gas.run(Infinity, gas.collisions + 1);
      found.push([...gas.last, gas.time]);
    }
    return found;"""
BEGIN_RUN = """
    const [name, material] = arguments;
    window.long = new Run(SCENES[name], material, 5);
    window.missed = [];
    const { gas } = long, double = gas.doubleSpeeds.bind(gas);
    gas.doubleSpeeds = () => { missed.push(Math.abs(gas.imbalance())); double(); };"""
CONTINUE_RUN = """
    const [more] = arguments, { gas } = long, until = gas.collisions + more * gas.number / 2;
    let sum = 0, samples = 0;
    const { record } = long, add = record.add;
    record.add = energies => { sum += energies.R; samples += 1; add.call(record, energies); };
    for (let k = 0; gas.collisions < until && k < 2e4; k++) long.advance(1);
    record.add = add;
    missed.push(Math.abs(gas.imbalance()));
    const [u, v] = gas.drift(), { translation } = gas.energies();
    return { drift: (u * u + v * v) / (4 * translation), missed: Math.max(...missed),
      gap: gas.leastGap(), R: sum / samples, made: 2 * gas.collisions / gas.number,
      collisional: record.collisional(gas.q) };"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("living") / "living.html"
    write_living(config="config.yaml", output=path)
    return path


@pytest.fixture
def page(file, browser):
    browser.open(file)
    yield browser
    assert browser.complaints() == []
    assert browser.requests() == []


def with_material(name, q=0.5, mu=None):
    """Return the page's settings of an experiment, with another moment of inertia, or friction."""
    experiment = experiment_of(CONFIGURATION(), name).raw
    effects = experiment["effects"] | {"spin": {"inertia": q}}
    return experiment | {"effects": effects | ({"friction": {"mu": mu}} if mu else {})}


def kernel_gas(name, r, beta, **material):
    """Return a gas of the kernel, at the start of a period of the drive, and its particles for the
    page."""
    experiment = typed(with_material(name, **material))
    scene = build(experiment, r, beta)
    gas = protocols.protocol_of(experiment).start(scene, experiment, 1)
    if name in PERIODS:
        gas.in_time(PERIODS[name], 1)
    position, velocity = positions_and_velocities(gas.state, scene, gas.time)
    spin = gas.state.spin[:, 0]
    columns = [*position.T, *velocity.T, spin]
    columns = [in_starting_order(gas.state, column).tolist() for column in columns]
    assert gas.state.counts[EXPONENT] == 0
    return gas, dict(zip(("x", "y", "vx", "vy", "w"), columns, strict=True))


@pytest.mark.parametrize(
    ("name", "r", "beta", "material_changes"),
    [
        *((*point, {}) for point in [*MEASURED_POINTS, ("vibrated", 0.6, 1.0)]),
        *((name, 0.9, 0.5, material_changes) for name, material_changes in CHANGED_MATERIALS),
    ],
)
def test_the_first_collisions_agree_with_the_kernel(page, name, r, beta, material_changes):
    gas, particles = kernel_gas(name, r, beta, **material_changes)
    material = {"r": r, "beta": beta} | material_changes
    collisions = page.script(FIRST_COLLISIONS, name, material, particles, COLLISIONS)
    start = gas.time
    for first, second, time in collisions:
        gas.step(math.inf, 1)
        pair = gas.state.counts[[LAST_FIRST, LAST_SECOND]]
        assert {first, second} == set(pair.tolist())
        assert time == pytest.approx(gas.time - start, rel=1e-11, abs=1e-11)


def kernel_R(name, r, beta, **material):
    """Return the measurement of R of a gas by the kernel, and its schedule."""
    experiment = with_material(name, **material)
    plan = experiment["schedule"] | SHORT_SCHEDULES[name]
    return measured(experiment | {"schedule": plan}, r, beta), plan


@pytest.mark.parametrize(("name", "material", "collisions"), LONG_RUNS)
def test_conservation_laws_and_R_hold_during_a_lecture(page, name, material, collisions):
    page.script(BEGIN_RUN, name, material)
    segments = []
    for segment in range(1, SEGMENTS + 1):
        segments.append(page.script(CONTINUE_RUN, collisions / SEGMENTS))
        assert segments[-1]["made"] >= collisions * segment / SEGMENTS
        assert segments[-1]["drift"] < 1e-20
        assert segments[-1]["missed"] < 1e-12
        assert segments[-1]["gap"] > -1e-9
    if collisions == 2000:
        R = np.array([segment["R"] for segment in segments[SEGMENTS // 4 :]])
        error = R.std(ddof=1) / math.sqrt(len(R))
        kernel, _ = kernel_R(name, **material)
        total_error = math.hypot(error, kernel["R_stderr"])
        assert total_error < 0.01
        assert R.mean() == pytest.approx(kernel["R"], abs=4 * total_error)
        assert R[-1] == pytest.approx(R.mean(), abs=4 * R.std(ddof=1))
        collisional = segments[-1]["collisional"]
        assert (collisional is None) == (name == "cooling") == ("R_collisional" not in kernel)
        if collisional:  # None in a cooling gas
            total_error = math.hypot(collisional["half"] / 2, kernel["R_collisional_stderr"])
            assert total_error < 0.01
            assert collisional["mean"] == pytest.approx(
                kernel["R_collisional"], abs=4 * total_error
            )


def test_theory_agrees_with_the_library(page):
    r, beta = np.meshgrid([0.5, 0.8, 0.99, 1.0], np.linspace(-1.0, 1.0, 9))
    r, beta = r.ravel(), beta.ravel()
    page_values = page.script(
        """const [r, beta] = arguments;
        return beta.map((one, i) =>
          [lun(one, 0.5), cooling(r[i], one, 0.5), lun(one, 0.2, r[i], 0.3)]);""",
        r.tolist(),
        beta.tolist(),
    )
    friction = theory.friction_ratio(r, beta, 0.3, inertia=0.2, spin_share=0)
    friction[beta == -1] = 0  # the library has the limit with spins, the page R without
    expected = [theory.lun_ratio(beta, 0.5), theory.cooling_ratio(r, beta), friction]
    np.testing.assert_allclose(np.transpose(page_values), expected, atol=1e-12)


def test_a_gas_close_to_collapse_continues(page):
    collisions, time, R = page.script(
        """const gas = started(SCENES.cooling, { r: 0.76, beta: -0.95 }, 1);
        for (let k = 1; k <= 300; k++) {
          gas.run(Infinity, 80 * k);
          if (gas.energies().translation < 0.25) gas.doubleSpeeds();
        }
        return [gas.collisions, gas.time, gas.energies().R];"""
    )
    assert collisions == 24000 and math.isfinite(time) and 0 < R < 1


NOISE = """
    const [seeds, samples, memory, transient] = arguments, made = [];
    for (let seed = 1; seed <= seeds; seed++) {
      const random = generator(seed), record = new Record(0, 1, 1, ["R"]);
      const normal = () =>
        Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(2 * Math.PI * random());
      let R = normal();
      for (let k = 0; k < samples; k++) {
        R = memory * R + Math.sqrt(1 - memory * memory) * normal();
        record.add({ R: 1 + 0.1 * R + Math.exp(-k / transient) });
        if (k + 1 === samples) made.push(record.average());
      }
    }
    return made;"""


@pytest.mark.parametrize(("samples", "memory", "transient"), [(400, 0.5, 10), (2000, 0.9, 100)])
def test_intervals_cover_the_mean_of_a_settled_series(page, samples, memory, transient):
    averages = page.script(NOISE, 150, samples, memory, transient)
    known_averages = [average for average in averages if average and average["half"]]
    assert len(known_averages) > 120
    assert min(average["from"] for average in known_averages) >= transient
    covered = np.mean([abs(average["mean"] - 1) < average["half"] for average in known_averages])
    assert covered > 0.95 - 4 * math.sqrt(0.05 * 0.95 / len(known_averages))


def test_short_and_drifting_series_have_no_mean(page):
    short = page.script(NOISE, 50, 23, 0.5, 5)
    drifting = page.script(NOISE, 50, 600, 0.5, 600)
    assert short == [None] * 50
    assert drifting.count(None) >= 48


def test_the_mean_of_a_sheared_gas_excludes_the_transient(page):
    """R is above 0.4 for 170 T, and then 0.3567(8), by the kernel over 60000 T."""
    averages = page.script(
        """const run = new Run(SCENES.sheared, { r: 0.9, beta: 0.5 }, 3), found = [];
        for (let k = 0; k < 250; k++) { run.advance(10); found.push(run.record.average()); }
        return found;"""
    )
    assert averages[:10] == [None] * 10
    known_averages = [average for average in averages if average and average["half"]]
    assert len(known_averages) > 50
    assert min(average["from"] for average in known_averages) > 50
    assert all(abs(average["mean"] - 0.3567) < 2 * average["half"] for average in known_averages)
    assert known_averages[-1]["end"] - known_averages[-1]["from"] > 1000


def state_of(page):
    return page.script(
        "const { gas } = panels[0].run; return [gas.time, gas.collisions, gas.r, gas.beta, name]"
    )


def move_slider(page, key, value):
    page.script(
        """const slider = document.querySelector(`.${arguments[0]}`);
        slider.value = arguments[1];
        slider.dispatchEvent(new Event("input"));""",
        key,
        value,
    )


def press(page, key):
    page.driver.switch_to.active_element.send_keys(key)


def test_the_gas_moves_at_once_and_pauses(page):
    start = state_of(page)[0]
    page.wait(lambda: state_of(page)[0] > start and state_of(page)[1] > 20)
    press(page, " ")
    assert page.text("#pause") == "Play"
    paused = state_of(page)
    page.script("return new Promise(done => setTimeout(done, 200))")
    assert state_of(page) == paused
    page.find("#pause")[0].click()
    page.wait(lambda: state_of(page)[0] > paused[0])


@pytest.mark.parametrize("clicked", [".r", ".beta", "#restart", "input[value=vibrated]"])
def test_the_space_bar_pauses_whatever_was_clicked_before(page, clicked):
    page.find(clicked)[0].click()
    press(page, " ")
    assert page.text("#pause") == "Play"
    press(page, " ")
    assert page.text("#pause") == "Pause"


def test_sliders_act_at_once_and_the_address_stores_them(page):
    move_slider(page, "r", 0.8)
    move_slider(page, "beta", -0.5)
    assert state_of(page)[2:] == [0.8, -0.5, "cooling"]
    shown_theory = page.text(".of-time")
    assert float(shown_theory) == pytest.approx(theory.cooling_ratio(0.8, -0.5), abs=6e-4)
    assert not page.find(".collisional")[0].is_displayed()
    page.find("input[value=sheared]")[0].click()
    assert state_of(page)[2:] == [0.8, -0.5, "sheared"]
    assert float(page.text(".of-time")) == pytest.approx(theory.lun_ratio(-0.5, 0.5), abs=6e-4)
    assert page.script("return location.hash") == "#sheared/r0.8/beta-0.5"
    page.script("location.hash = '#vibrated/r0.7/beta1'")
    page.wait(lambda: state_of(page)[2:] == [0.7, 1, "vibrated"])
    assert page.text(".law") == "Lun's formula, for averages over collisions"
    assert [page.text(f".of-{average}") for average in ("time", "collisions")] == ["none", "0.500"]
    assert page.find(".collisional")[0].is_displayed()
    page.find("input.r")[0].send_keys("\ue014")  # the arrow to the right
    assert state_of(page)[2] == pytest.approx(0.71)


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("toString", "scene = toString: must be one of cooling, vibrated, sheared"),
        ("cooling/r2/beta0", "r = 2: must be from 0.6 to 1"),
        ("cooling/r0.9/beta", "beta: must be r, beta, q or mu with a number, or once vs"),
        ("%", "URI malformed"),
    ],
)
def test_an_illegal_address_is_reported_in_one_line(file, page, address, message):
    page.open(file, f"#{address}")
    expected = f"The address cannot be followed: {message}. This is the first scene."
    assert page.text("#message") == expected
    assert state_of(page)[2:] == [0.9, 0.5, "cooling"]
    move_slider(page, "r", 0.8)
    assert page.text("#message") == ""


def test_two_gases_side_by_side(file, page):
    page.find("#compare")[0].click()
    assert page.script("return location.hash") == "#cooling/r0.9/beta0.5/vs/r0.99/beta0.5"
    assert len(page.find("canvas.gas")) == len(page.find(".present")) == 2
    page.open(file, "#sheared/r0.9/beta-0.5/vs/r0.9/beta1/q1")
    assert [element.text for element in page.find(".of-time")] == ["0.091", "0.500"]
    page.wait(lambda: page.script("return panels[1].run.gas.collisions") > 20)
    times = page.script("return panels.map(({ run }) => run.gas.time)")
    assert times[0] == pytest.approx(times[1], rel=0.05)
    press(page, "c")
    assert len(page.find("canvas.gas")) == 1
    assert page.script("return location.hash") == "#sheared/r0.9/beta-0.5"


@pytest.mark.parametrize("scene", ["vibrated", "sheared"])
@pytest.mark.parametrize("second", ["", "/vs/r0.9/beta0"])
@pytest.mark.parametrize("size", [(1920, 1080), (1280, 720), (1024, 768)])
def test_for_projectors_letters_are_large_and_all_is_visible(file, page, size, second, scene):
    with emulated_screen(page, *size, mobile=False):
        page.open(file, f"#{scene}/r0.9/beta0.5{second}")
        press(page, "p")
        (mode,) = page.find("#projector")
        assert mode.get_attribute("aria-pressed") == "true"
        for selector in ("canvas.gas", "canvas.graph", ".present", ".r", ".beta"):
            for box in boxes(page, selector):
                assert 0 <= box["left"] < box["right"] <= size[0]
                assert 0 <= box["top"] < box["bottom"] <= size[1]
        check_that_it_fits_its_panel(page, ".mean")
        for element in page.find(".present"):
            assert float(element.value_of_css_property("font-size")[:-2]) > size[1] / 36
        assert not any(element.is_displayed() for element in page.find(".more, .question, footer"))
        press(page, "p")
        assert page.find("footer")[0].is_displayed()


ANSWERS = [
    ("cooling", {"r": 0.8, "beta": -0.8}, 0.975),
    ("cooling", {"r": 0.99, "beta": -0.8}, 0.05),
]
ANSWERS += [
    ("vibrated", {"r": 0.9, "beta": 1.0}, 0.50),
    ("vibrated", {"r": 0.95, "beta": 0.0}, 0.215),
]
ANSWERS += [
    ("vibrated", {"r": 0.7, "beta": 0.0}, 0.277),
    ("vibrated", {"r": 0.9, "beta": 0.0}, 0.225),
]
ANSWERS += [("vibrated", {"r": 0.9, "beta": 0.0, "q": 1}, 0.30)]


@pytest.mark.parametrize(("name", "material", "R"), ANSWERS)
def test_answers_to_questions_agree_with_the_kernel(page, name, material, R):
    kernel, _ = kernel_R(name, **material)
    assert kernel["R"] == pytest.approx(R, abs=0.005 + 4 * kernel["R_stderr"])
    assert kernel["R_stderr"] < 0.003
    assert f"{R:.3f}".rstrip("0") in page.script("return QUESTIONS.map(one => one.why).join()")


def check_that_it_fits_its_panel(page, selector):
    """Check that an element fits its panel when it shows the longest mean."""
    page.script(
        "playing = false; go(); for (const one of panels) "
        "for (const name of ['mean', 'collisional']) one.say(name, '0.2222 ±\u00a00.0222')"
    )
    for panel, box in zip(boxes(page, ".results"), boxes(page, selector), strict=True):
        assert panel["left"] - 1 <= box["left"] < box["right"] <= panel["right"] + 1
    assert page.script("return document.documentElement.scrollWidth <= innerWidth")


@pytest.mark.parametrize("scene", ["cooling", "vibrated", "sheared"])
@pytest.mark.parametrize("second", ["", "/vs/r0.8/beta0"])
def test_on_a_phone_the_gas_its_sliders_and_R_are_in_one_view(file, page, scene, second):
    with emulated_screen(page, 390, 844):
        page.open(file, f"#{scene}/r0.9/beta0.5{second}")
        assert page.script("return scrollY") == 0
        for selector in ("canvas.gas", "#pause", ".present", ".mean", ".r", ".beta"):
            rectangles = boxes(page, selector)
            assert rectangles and all(
                0 <= rectangle["top"] < rectangle["bottom"] <= 844 for rectangle in rectangles
            )
            assert all(
                0 <= rectangle["left"] < rectangle["right"] <= 390 for rectangle in rectangles
            )
        check_that_it_fits_its_panel(page, ".mean")
    for width in (320, 390):
        with emulated_screen(page, width, 740):
            assert page.script("return document.documentElement.scrollWidth") <= width
