"""The living page in a real browser: its dynamics against the kernel's, and what a person does."""

import math

import numpy as np
import pytest

from roughgas import config, theory
from roughgas.kernel.state import EXPONENT, LAST_FIRST, LAST_SECOND
from roughgas.scene import build
from roughgas.show.living.assemble import SCENES, scenes, settings, write_living
from roughgas.simulation import schedule
from roughgas.simulation.instant import in_order, whereabouts
from roughgas.simulation.recorder import Recorder

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CONFIGURATION = config.load("config.yaml")
PERIODS = {"vibrated": 30.0, "sheared": 50.0}
"""Whole periods of the drive, in T, after which the kernel hands its gas over."""
COLLISIONS = 60
SHORT = {
    "vibrated": {"equilibrate": 150, "measure": 600},
    "sheared": {"equilibrate": 600, "measure": 4000},
    "cooling": {"replicas": 16, "relaxation_times": 8, "plateau": 60},
}
POINTS = [
    ("vibrated", 0.9, 0.5),
    ("vibrated", 0.8, -0.5),
    ("sheared", 0.9, 0.0),
    ("sheared", 0.8, 0.8),
    ("cooling", 0.9, 0.5),
    ("cooling", 0.8, -0.5),
]
FIRST_COLLISIONS = """
    const [name, r, beta, particles, number] = arguments, found = [];
    const gas = new Gas(SCENES[name], r, beta, particles);
    while (gas.collisions < number) {
      gas.run(Infinity, gas.collisions + 1);
      found.push([...gas.last, gas.time]);
    }
    return found;"""
STEADY = """
    const [name, r, beta, equilibrate, measure, every] = arguments, values = [];
    const gas = started(SCENES[name], r, beta, 7);
    gas.run(equilibrate);
    for (let k = 1; k <= measure / every; k++) {
      gas.run(equilibrate + k * every - gas.begun);
      values.push(gas.energies().R);
    }
    return values;"""
COOLED = """
    const [name, r, beta, replicas, transient, plateau] = arguments, values = [];
    for (let seed = 1; seed <= replicas; seed++) {
      const gas = started(SCENES[name], r, beta, seed);
      let sum = 0;
      for (let k = 1; k <= transient + plateau; k++) {
        gas.run(Infinity, k * gas.number / 2);
        if (k > transient) sum += gas.energies().R / plateau;
        if (gas.energies().translation < 0.25) gas.doubleSpeeds();
      }
      values.push(sum);
    }
    return values;"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("living") / "living.html"
    write_living("config.yaml", path)
    return path


@pytest.fixture
def page(file, browser):
    browser.open(file)
    yield browser
    assert browser.complaints() == []
    assert browser.requests() == []


def kernel_gas(name, r, beta):
    """A gas of the kernel, its drive at the start of a period, and what the page needs of it."""
    experiment = settings(CONFIGURATION, name)
    scene = build(experiment, r, beta)
    gas = schedule.of(experiment).start(scene, experiment, 1)
    if name in PERIODS:
        gas.in_time(PERIODS[name], 1)
    position, velocity = whereabouts(gas.state, scene, gas.time)
    spin = gas.state.spin[:, 0]
    columns = [*position.T, *velocity.T, spin]
    columns = [in_order(gas.state, one).tolist() for one in columns]
    assert gas.state.counts[EXPONENT] == 0
    return gas, dict(zip(("x", "y", "vx", "vy", "w"), columns, strict=True))


@pytest.mark.parametrize(("name", "r", "beta"), [*POINTS, ("vibrated", 0.6, 1.0)])
def test_the_first_collisions_are_the_kernels(page, name, r, beta):
    gas, particles = kernel_gas(name, r, beta)
    found = page.script(FIRST_COLLISIONS, name, r, beta, particles, COLLISIONS)
    begun = gas.time
    for first, second, time in found:
        gas.step(math.inf, 1)
        pair = gas.state.counts[[LAST_FIRST, LAST_SECOND]]
        assert {first, second} == set(pair.tolist())
        assert time == pytest.approx(gas.time - begun, rel=1e-11, abs=1e-11)


def error_of(values, parts=20):
    """The mean of a series and its standard error, from means over parts of it."""
    means = [part.mean() for part in np.array_split(np.array(values), parts)]
    return np.mean(means), np.std(means, ddof=1) / math.sqrt(parts)


@pytest.mark.parametrize(("name", "r", "beta"), POINTS)
def test_R_is_the_kernels(page, name, r, beta):
    experiment = settings(CONFIGURATION, name)
    plan = experiment["schedule"] | SHORT[name]
    scene, kind = build(experiment, r, beta), schedule.of(experiment)
    kernel = kind.run(scene, experiment | {"schedule": plan}, 1, Recorder())
    if name == "cooling":
        given = plan["replicas"], math.ceil(kernel["measured_from"]), plan["plateau"]
        values = page.script(COOLED, name, r, beta, *given)
        mean, error = error_of(values, len(values))
    else:
        given = plan["equilibrate"], plan["measure"], plan["sample_every"]
        mean, error = error_of(page.script(STEADY, name, r, beta, *given))
    together = math.hypot(error, kernel["R_stderr"])
    assert together < 0.012
    assert mean == pytest.approx(kernel["R"], abs=4 * together)


@pytest.mark.parametrize("beta", [-1, 1])
def test_nothing_is_lost_where_contacts_lose_nothing(page, beta):
    found = page.script(
        """const gas = new Gas(SCENES.cooling, 1, arguments[0], atStart(SCENES.cooling, 3));
        for (let i = 0; i < gas.number; i++) gas.w[i] = Math.sin(i);
        const all = () => {
          const sum = one => one.reduce((a, b) => a + b);
          const { translation, rotation } = gas.energies();
          return [2 * translation + rotation, sum(gas.vx), sum(gas.vy)];
        };
        const before = all();
        gas.run(Infinity, 4000);
        return [before, all()];""",
        beta,
    )
    assert found[1] == pytest.approx(found[0], rel=1e-12, abs=1e-10)


def test_its_theory_is_that_of_the_library(page):
    r, beta = np.meshgrid([0.5, 0.8, 0.99, 1.0], np.linspace(-1.0, 1.0, 9))
    r, beta = r.ravel(), beta.ravel()
    found = page.script(
        """const [r, beta] = arguments;
        return beta.map((one, i) => [lun(one, 0.5), cooling(r[i], one, 0.5)]);""",
        r.tolist(),
        beta.tolist(),
    )
    expected = [theory.lun_ratio(beta, 0.5), theory.cooling_ratio(r, beta)]
    np.testing.assert_allclose(np.transpose(found), expected, atol=1e-13)


def test_a_gas_that_would_collapse_goes_on(page):
    collisions, time, R = page.script(
        """const gas = started(SCENES.cooling, 0.76, -0.95, 1);
        for (let k = 1; k <= 300; k++) {
          gas.run(Infinity, 80 * k);
          if (gas.energies().translation < 0.25) gas.doubleSpeeds();
        }
        return [gas.collisions, gas.time, gas.energies().R];"""
    )
    assert collisions == 24000 and math.isfinite(time) and 0 < R < 1


# ---------------------------------------------------------------- the page


def now(page):
    return page.script("return [gas.time, gas.collisions, gas.r, gas.beta, name]")


def slide(page, name, value):
    page.script(
        """const slider = document.getElementById(arguments[0]);
        slider.value = arguments[1];
        slider.dispatchEvent(new Event("input"));""",
        name,
        value,
    )


def test_it_moves_at_once_and_pauses(page):
    begun = now(page)[0]
    page.wait(lambda: now(page)[0] > begun and now(page)[1] > 20)
    page.find("body")[0].send_keys(" ")
    assert page.text("#pause") == "Play"
    stopped = now(page)
    page.script("return new Promise(done => setTimeout(done, 200))")
    assert now(page) == stopped
    page.find("#pause")[0].click()
    page.wait(lambda: now(page)[0] > stopped[0])


def test_it_rests_while_its_tab_is_hidden(page):
    hide = """const [value] = arguments;
        Object.defineProperty(document, "hidden", { value, configurable: true });
        document.dispatchEvent(new Event("visibilitychange"));
        return new Promise(done => setTimeout(() => done(gas.time), 200));"""
    hidden = page.script(hide, True)
    page.script("return new Promise(done => setTimeout(done, 200))")
    assert now(page)[0] == hidden
    assert page.script(hide, False) > hidden


def test_sliders_act_at_once_and_the_address_keeps_them(page):
    slide(page, "r", 0.8)
    slide(page, "beta", -0.5)
    assert now(page)[2:] == [0.8, -0.5, "cooling"]
    assert float(page.text("#theory")) == pytest.approx(theory.cooling_ratio(0.8, -0.5), abs=6e-4)
    page.find("input[value=sheared]")[0].click()
    assert now(page)[2:] == [0.8, -0.5, "sheared"]
    assert float(page.text("#theory")) == pytest.approx(theory.lun_ratio(-0.5, 0.5), abs=6e-4)
    assert page.script("return location.hash") == "#sheared/r0.8/beta-0.5"
    page.script("location.hash = '#vibrated/r0.7/beta1'")
    page.wait(lambda: now(page)[2:] == [0.7, 1, "vibrated"])
    page.find("input#r")[0].send_keys("\ue014")  # the arrow to the right
    assert now(page)[2] == pytest.approx(0.71)


def test_it_says_what_one_should_know_of_the_gas(page):
    page.script("location.hash = '#sheared/r1/beta1'")
    page.wait(lambda: page.text("#note") == "nothing is lost: it heats up without end")
    slide(page, "r", 0.9)
    page.wait(lambda: page.text("#note") == "")
    page.script("location.hash = '#vibrated/r0.9/beta0'")
    page.wait(lambda: now(page)[4] == "vibrated")
    page.script("gas.vy.fill(100); gas.foreseeAll()")
    page.wait(lambda: page.text("#note") == "many disks are above the picture")


def test_disks_are_drawn_with_their_spins(page):
    page.script("document.getElementById('speed').value = '64'; speed = 64;")
    page.wait(lambda: page.script("return gas.energies().R") > 0.1)
    colours = page.script(
        """const canvas = document.getElementById("gas");
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        const found = new Set();
        for (let k = 0; k < data.length; k += 4) if (data[k + 3] === 255)
          found.add(data[k] >> 5 << 6 | data[k + 1] >> 5 << 3 | data[k + 2] >> 5);
        return found.size;"""
    )
    assert colours > 20


def test_a_question_sets_the_scene_and_answers(page):
    page.find("#answers button")[0].click()
    assert now(page)[2:] == [0.8, -0.8, "cooling"]
    assert page.text("#verdict").startswith("No: near 1")
    page.find("#another")[0].click()
    page.find("#answers button")[1].click()
    assert page.text("#verdict").startswith("Yes.")
    assert now(page)[2:] == [0.9, 1, "vibrated"]


def emulate(page, **features):
    media = [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": media})


def test_it_is_still_where_that_is_asked_for_and_dark_where_it_is_dark(file, browser):
    emulate(browser, prefers_reduced_motion="reduce", prefers_color_scheme="dark")
    try:
        browser.open(file)
        assert browser.text("#pause") == "Play"
        assert browser.script("return playing") is False
        paper = browser.script("return getComputedStyle(document.body).backgroundColor")
        assert sum(map(int, paper[4:-1].split(","))) < 120
    finally:
        emulate(browser)


def test_it_fits_on_a_phone(page):
    for width in (320, 390):
        page.driver.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": 740, "deviceScaleFactor": 2, "mobile": True},
        )
        try:
            page.wait(lambda width=width: page.script("return innerWidth") == width)
            assert page.script("return document.documentElement.scrollWidth") <= width
        finally:
            page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def test_it_is_small(file):
    assert file.stat().st_size < 40_000
    assert set(scenes(CONFIGURATION)) == set(SCENES)
