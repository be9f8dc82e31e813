"""The interactive page in a real browser: chosen, clicked, shared, copied from."""

import re

import netCDF4
import numpy as np
import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.select import Select
from show.page.conftest import SAMPLES, points_in

from roughgas.data.point import read_point
from roughgas.data.reduced import read_reduced
from roughgas.show.page.explore import write_page
from roughgas.theory.prediction import predicted_ratio

pytestmark = [pytest.mark.browser, pytest.mark.slow]

POINT = re.compile(r"([\d.]+)\((\d+)\)")


@pytest.fixture
def page(ran, browser):
    browser.open(ran.folder / "results/tiny/explore.html")
    browser.wait(lambda: browser.find("#ratios .main-svg") and browser.find("#over-time .main-svg"))
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


def test_the_keyboard_is_enough(page, ran):
    page.find("#experiment")[0].send_keys("A gas u", Keys.TAB)
    page.driver.switch_to.active_element.send_keys(Keys.DOWN, Keys.TAB)
    page.driver.switch_to.active_element.send_keys(Keys.DOWN)
    assert shows(page, ran, "sheared", "0.8", "0")


def test_a_click_on_a_point_chooses_it(page, ran):
    page.script("location.hash = '#cooling/r0.9/beta-0.5'")
    page.wait(lambda: page.text("#title").startswith("A freely cooling gas"))
    where = """
        const plot = document.getElementById("ratios"), { xaxis, yaxis } = plot._fullLayout;
        const trace = plot.data.find(one => one.name === "r = 0.8" && one.mode === "markers");
        const box = plot.getBoundingClientRect(), at = trace.x.indexOf(0.5);
        return [box.x + xaxis._offset + xaxis.l2p(trace.x[at]),
          box.y + yaxis._offset + yaxis.l2p(trace.y[at])].map(Math.round);"""
    actions = ActionChains(page.driver)
    actions.w3c_actions.pointer_action.move_to_location(*page.script(where))
    actions.pause(0.3).click().perform()
    page.wait(lambda: fragment(page).endswith("/r0.8/beta0.5"))
    assert shows(page, ran, "cooling", "0.8", "0.5")


def test_what_is_drawn_are_the_datasets(page, ran):
    select(page, "experiment", "sheared")
    data = read_reduced(ran.folder / "results/tiny/sheared.nc").sel(r=0.8)
    drawn = page.script("""
        const [above, beneath] = document.getElementById("ratios").data
          .filter(one => one.legendgroup === "0.8" && one.mode === "markers");
        const over = document.getElementById("over-time").data[0];
        return [above.x, above.y, above.error_y.array, beneath.y, over.y.length];""")
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
    write_page([points / f"{name}.nc" for name in names], points, tmp_path / "e.html")
    browser.open(tmp_path / "e.html")
    browser.wait(lambda: browser.find("#ratios .main-svg") and browser.find("#over-time .main-svg"))
    return browser


def test_a_legend_names_the_theory_and_titles_lie_beside_their_numbers(made_up):
    named = made_up.script("""
        const { data } = document.getElementById("ratios");
        return data.filter(one => one.showlegend !== false).map(one => one.name);""")
    assert "lines: theory of free cooling" in named
    assert made_up.text("#theory") == "theory of free cooling"
    found = made_up.script("""
        const plot = document.getElementById("over-time");
        const left = one => one.getBoundingClientRect().left;
        const title = plot.querySelector(".y2title").getBoundingClientRect();
        const ticks = [...plot.querySelectorAll(".y2tick")];
        return [ticks.length, ticks.some(one => left(one) < title.right)];""")
    assert found[0] > 2 and not found[1]


def test_what_is_not_known_is_said_and_drawn(made_up):
    select(made_up, "experiment", "sheared")
    assert numbers(made_up)["steady state"].startswith("not known")
    symbols = made_up.script("""
        const drawn = document.getElementById("ratios").data;
        return drawn.filter(one => one.customdata).flatMap(one => one.marker.symbol);""")
    assert set(symbols) == {"circle-open-dot"}


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
        points,
        tmp_path / "e.html",
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
        const rows = document.getElementById("ratios").data.filter(one => one.mode === "markers");
        return rows.filter(one => one.legendgroup === "0.50").map(one => [one.x, one.y]);""")
    assert drawn[0] == [[0.1, 1], [0.351, 0.351]]
    assert browser.complaints() == [] and browser.requests() == []


def test_the_command_is_copied(page):
    page.find("button[data-copies=target]")[0].click()
    page.wait(lambda: page.text("button[data-copies=target]") == "Copied")
    page.script("document.body.append(document.createElement('textarea'))")
    (field,) = page.find("textarea")
    field.send_keys(Keys.CONTROL, "v")
    assert field.get_attribute("value") == page.text("#target")


def test_the_scene_is_pictured(page):
    assert page.find("#scene svg .bar") and page.find("#scene svg .disk")
    select(page, "experiment", "cooling")
    assert not page.find("#scene svg .bar")
    assert "freely cooling" in page.find("#scene svg")[0].get_attribute("aria-label")


def test_it_is_dark_where_that_is_asked_for_and_white_on_paper(page):
    def paper():
        return page.script("return document.getElementById('ratios')._fullLayout.paper_bgcolor")

    features = [{"name": "prefers-color-scheme", "value": "dark"}]
    page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    try:
        page.wait(lambda: paper() == "#16181c")
        page.script("dispatchEvent(new Event('beforeprint'))")
        page.wait(lambda: paper() == "#ffffff")
        page.script("dispatchEvent(new Event('afterprint'))")
        page.wait(lambda: paper() == "#16181c")
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        position = page.script("return getComputedStyle(document.querySelector('form')).position")
        assert position == "static"
    finally:
        page.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": []})


def test_the_camera_button_hides_no_legend(page):
    overlap = """
        const plot = document.getElementById("ratios"), { data, layout } = plot;
        const box = one => plot.querySelector(one).getBoundingClientRect();
        await Plotly.newPlot(plot, data, layout, { ...CONFIG, displayModeBar: true });
        const [button, legend] = [".modebar", ".legend"].map(box);
        return [button.width, Math.min(button.right, legend.right) > Math.max(button.x, legend.x)
          && Math.min(button.bottom, legend.bottom) > Math.max(button.y, legend.y)];"""
    width, hidden = page.script(f"return (async () => {{{overlap}}})()")
    assert width > 0 and not hidden


def test_it_fits_on_a_phone(page):
    page.driver.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": 360, "height": 740, "deviceScaleFactor": 2, "mobile": True},
    )
    try:
        page.wait(lambda: page.script("return innerWidth") == 360)
        page.wait(lambda: page.find("#ratios .main-svg")[0].size["width"] <= 360)
        assert page.script("return document.documentElement.scrollWidth") <= 360
    finally:
        page.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
