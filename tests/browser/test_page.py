"""The interactive page in a real browser: chosen, clicked, shared, copied from."""

import re

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.support.select import Select

from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
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
    over_time = "R over time" if "R_collisional" in data else "R"
    assert close(found[over_time], R, stderr)
    said = {name: value for name, value in found.items() if name.startswith("R over collisions")}
    assert bool(said) == ("R_collisional" in data)
    for name, value in said.items():
        assert ("unlike Lun's formula" in name) == (experiment == "sheared")
        collisional = (place[f"R_collisional{end}"].item() for end in ("", "_stderr"))
        assert close(value, *collisional)
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


def test_a_choice_can_be_shared(ran, browser):
    browser.open(ran.folder / "results/tiny/explore.html", "#sheared/r0.8/beta0")
    assert shows(browser, ran, "sheared", "0.8", "0")
    browser.open(ran.folder / "results/tiny/explore.html", "#sheared/r0.8/beta7")
    assert "no point sheared/r0.8/beta7" in browser.text("#status")
    assert shows(browser, ran, "vibrated", "0.9", "-0.5")
    assert browser.complaints() == []
