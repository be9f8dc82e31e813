"""The interactive page in a real browser: chosen, clicked, shared, copied from."""

import re

import netCDF4
import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.select import Select
from show.page.conftest import SAMPLES, points_in
from tests.houses import EXPERIMENTS

from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.show.explore import write_page
from roughgas.theory.prediction import predicted_ratio

pytestmark = [pytest.mark.browser, pytest.mark.slow]

POINT = re.compile(r"([\d.]+)\((\d+)\)")


@pytest.fixture
def page(ran, browser):
    browser.open(ran.folder / "results/tiny/explore.html")
    browser.wait(lambda: browser.find("#ratios canvas") and browser.find("#energies canvas"))
    yield browser
    assert browser.complaints() == []
    assert browser.requests() == []


def numbers(page):
    """The table of the chosen point."""
    rows = [row.text for row in page.find("#numbers th")]
    return dict(zip(rows, [cell.text for cell in page.find("#numbers td")], strict=True))


def fragment(page):
    return page.script("return decodeURIComponent(location.hash)")


def select(page, name, text):
    chosen = Select(page.find(f"#{name}")[0])
    if name == "experiment":
        chosen.select_by_value(text)
    else:
        chosen.select_by_visible_text(text)


def close(shown, value, error):
    """Whether text such as 0.357(12) says this number and this error, to its last digit."""
    number, digits = POINT.search(shown.replace("−", "-")).groups()
    unit = 10.0 ** -len(number.partition(".")[2])
    return abs(float(number) - value) <= unit and abs(int(digits) * unit - error) <= unit


def shows(page, ran, experiment, r, beta):
    """Whether the page shows the numbers of this point's datasets."""
    data = read_reduced(ran.folder / f"results/tiny/{experiment}.nc")
    place, found = data.sel(r=float(r), beta=float(beta)), numbers(page)
    R, stderr, ci95 = (place[name].item() for name in ("R", "R_stderr", "R_ci95"))
    theory = float(predicted_ratio(data.attrs, float(r), float(beta)))
    assert close(found["R"], R, stderr)
    low, high = map(float, found["95 % interval"].replace("−", "-").split(" to "))
    assert (low, high) == pytest.approx((R - ci95, R + ci95), abs=0.06 * ci95)
    (shown,) = (value for name, value in found.items() if name.startswith("theory"))
    assert float(shown) == pytest.approx(theory, abs=5.1e-5)
    assert close(found["R − theory"].lstrip("+−"), abs(R - theory), stderr)
    steady = "found" if place.equilibrated > 0.5 else "not found"
    if place.equilibrated < 0:
        steady = "not known: too little was measured"
    assert found["steady state"] == steady
    assert int(found["collisions"].replace(",", "")) == place.collisions
    assert float(found["CPU time"].split()[0]) == pytest.approx(
        place.kernel_seconds.item(), rel=6e-3
    )
    assert found["seeds"] == "2"
    target = f"results/tiny/{experiment}/r{r}/beta{beta}/seed1.nc"
    assert page.text("#target") == f"snakemake -j1 --force {target}"
    command = read_point(ran.folder / target).attrs["command"]
    assert page.text("#command") == command
    assert fragment(page) == f"#{experiment}/r{r}/beta{beta}"
    return True


def test_it_begins_with_a_point_and_shows_any_other(page, ran):
    assert shows(page, ran, "vibrated", "0.9", "-0.5")
    select(page, "beta", "0.5")
    assert shows(page, ran, "vibrated", "0.9", "0.5")
    select(page, "r", "0.8")
    assert shows(page, ran, "vibrated", "0.8", "0.5")
    select(page, "experiment", "cooling")
    assert shows(page, ran, "cooling", "0.8", "0.5")
    select(page, "experiment", "vibrated_smooth_walls")
    assert shows(page, ran, "vibrated_smooth_walls", "0.9", "0")


def test_a_click_on_a_point_chooses_it(page, ran):
    page.script("location.hash = '#cooling/r0.9/beta-0.5'")
    page.wait(lambda: page.text("#title").startswith("A freely cooling gas"))
    where = """
        const row = drawnRows().find(one => one.label === "r = 0.8"), u = PLOTS.ratios;
        const box = u.over.getBoundingClientRect(), place = row.places.find(one => one.x === 0.5);
        return [box.x + u.valToPos(place.x, "x"),
          box.y + u.valToPos(place.choice.point.R, "y")].map(Math.round);"""
    actions = ActionChains(page.driver)
    actions.w3c_actions.pointer_action.move_to_location(*page.script(where))
    actions.pause(0.3).perform()
    (said,) = [one.text for one in page.find(".tip") if one.is_displayed()]
    assert said.startswith("r = 0.8, β = 0.5\nR = ")
    actions.click().perform()
    page.wait(lambda: fragment(page).endswith("/r0.8/beta0.5"))
    assert shows(page, ran, "cooling", "0.8", "0.5")


def test_what_is_drawn_are_the_datasets(page, ran):
    select(page, "experiment", "sheared")
    data = read_reduced(ran.folder / "results/tiny/sheared.nc").sel(r=0.8)
    drawn = page.script("""
        const { places } = drawnRows().find(one => one.label === "r = 0.8");
        const points = places.map(one => one.choice.point);
        return [places.map(one => one.x), points.map(one => one.R), points.map(one => one.stderr),
          points.map(difference), PLOTS["over-time"].data[1].length];""")
    assert drawn[:3] == [
        data.beta.values.tolist(),
        data.R.values.tolist(),
        data.R_stderr.values.tolist(),
    ]
    residual = data.R - predicted_ratio(data.attrs, 0.8, data.beta.values)
    assert drawn[3] == pytest.approx(residual.values.tolist(), abs=1e-12)
    assert 0 < drawn[4] <= 200


@pytest.fixture
def made_up(browser, tmp_path):
    """A page of made-up points: of a gas that cools by 90 decades, and of one whose steady state is
    not known."""
    points = points_in(tmp_path / "small")
    for path in (points / "cooling").rglob("seed1.nc"):
        with netCDF4.Dataset(path, "a") as file:
            file["E_trans_series"][...] = 10.0 ** (-0.2 * np.arange(SAMPLES))
    with netCDF4.Dataset(points / "sheared.nc", "a") as file:
        file["equilibrated"][...] = -1.0
    names = ("cooling", "sheared")
    write_page([points / f"{name}.nc" for name in names], points=points, output=tmp_path / "e.html")
    browser.open(tmp_path / "e.html")
    browser.wait(lambda: browser.find("#ratios canvas") and browser.find("#energies canvas"))
    return browser


def test_what_is_not_known_is_said_and_drawn(made_up):
    select(made_up, "experiment", "sheared")
    assert numbers(made_up)["steady state"].startswith("not known")
    middle, beside = made_up.script("""
        const u = PLOTS.ratios, { x, choice } = drawnRows()[0].places.at(-1), px = uPlot.pxRatio;
        const colour = shift => [...u.ctx.getImageData(u.valToPos(x, "x", true) + shift * px,
          u.valToPos(choice.point.R, "y", true), 1, 1).data];
        return [colour(0), colour(-3)];""")
    assert beside[:3] == [255, 255, 255] != middle[:3]  # an open symbol with a dot


def test_a_choice_can_be_shared(ran, browser):
    browser.open(ran.folder / "results/tiny/explore.html", "#sheared/r0.8/beta0")
    assert shows(browser, ran, "sheared", "0.8", "0")
    browser.open(ran.folder / "results/tiny/explore.html", "#sheared/r0.8/beta7")
    assert "no point sheared/r0.8/beta7" in browser.text("#status")
    assert shows(browser, ran, "vibrated", "0.9", "-0.5")
    assert browser.complaints() == []


def test_a_third_axis_is_chosen_too(browser, tmp_path):
    points = points_in(tmp_path / "small")
    write_page(
        [points / f"{name}.nc" for name in ("sheared", "cooling_friction")],
        points=points,
        output=tmp_path / "e.html",
        config=EXPERIMENTS,
    )
    browser.open(tmp_path / "e.html")
    assert not browser.find("#variant")[0].is_displayed()
    select(browser, "experiment", "cooling_friction")
    assert browser.text("#variant-name") == "friction: mu"
    select(browser, "variant", "1")
    assert fragment(browser) == "#cooling_friction/mu1/r0.9/beta-0.5"
    assert browser.text("#title").endswith("with Coulomb friction: 40 disks, friction: mu = 1")
    select(browser, "beta", "0.50")
    assert numbers(browser)["R"] == "0.3510(40)"
    assert browser.text("#target").endswith("/small/cooling_friction/mu1/r0.9/beta0.50/seed1.nc")
    assert "mean over a block of 3 samples" in browser.text("#thinned")
    select(browser, "over", "friction: mu")
    drawn = browser.script("""
        const { places } = drawnRows().find(one => one.label === "β = 0.50");
        return places.map(one => [one.x, one.choice.point.R]);""")
    assert drawn == [[0.1, 0.351], [1, 0.351]]
    assert browser.complaints() == [] and browser.requests() == []


def test_the_command_is_copied(page):
    page.find("button[data-copies=target]")[0].click()
    page.wait(lambda: page.text("button[data-copies=target]") == "Copied")
    page.script("document.body.append(document.createElement('textarea'))")
    (field,) = page.find("textarea")
    field.send_keys(Keys.CONTROL, "v")
    assert field.get_attribute("value") == page.text("#target")


def test_what_is_dragged_over_is_zoomed_to_in_both_plots(page):
    spans = "return [PLOTS.ratios, PLOTS.residuals].map(u => [u.scales.x.min, u.scales.x.max])"
    (low, high), _ = page.script(spans)
    assert (low, high) == pytest.approx((-1.1, 1.1))
    (over,) = page.find("#ratios .u-over")
    actions = ActionChains(page.driver).move_to_element(over).click_and_hold()
    actions.move_by_offset(80, 80).release().perform()
    above, beneath = page.wait(lambda: page.script(spans))
    assert above == pytest.approx(beneath) and -0.1 < above[0] < 0.1 < above[1] < 0.7
    ActionChains(page.driver).double_click(over).perform()
    page.wait(lambda: page.script(spans)[0] == [low, high])
