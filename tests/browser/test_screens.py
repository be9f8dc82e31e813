"""All pages on a computer and on a phone, light and dark; the table of verdicts."""

from pathlib import Path

import pytest
from selenium.webdriver.common.keys import Keys
from tests.browser.screens import SCHEMES, SCREENS, boxes, contrasts, emulated_screen

from roughgas.show.living import write_living

pytestmark = [pytest.mark.browser, pytest.mark.slow]

PATTERNS = Path(__file__).parents[2] / "figures/patterns.html"
LEAST_CONTRAST = 4.5
MAX_REPORT_HEIGHT = 4000
PAGES = ("report.html", "explore.html", "claims.html", "living.html", "patterns.html")


@pytest.fixture(scope="session")
def pages(finished_run):
    """Paths of the pages, by name; all but patterns.html are of a tiny run."""
    folder = finished_run.folder / "results/tiny"
    write_living(config="config.yaml", output=folder / "living.html")
    return {name: folder / name for name in PAGES} | {"patterns.html": PATTERNS}


@pytest.fixture(params=[(screen, scheme) for screen in SCREENS for scheme in SCHEMES], ids="-".join)
def screen(request, browser):
    name, scheme = request.param
    with emulated_screen(browser, *SCREENS[name], mobile=name == "phone", scheme=scheme):
        yield name


@pytest.fixture
def report(pages, browser):
    browser.open(pages["report.html"])
    yield browser
    assert browser.complaints() == [] and browser.requests() == []


@pytest.mark.parametrize("name", PAGES)
def test_a_page_fits_the_screen_and_its_text_is_legible(pages, browser, screen, name):
    browser.open(pages[name])
    scheme = browser.script("return matchMedia('(prefers-color-scheme: dark)').matches")
    paper = browser.script("return getComputedStyle(document.body).backgroundColor")
    assert paper == ("rgb(22, 24, 28)" if scheme else "rgb(255, 255, 255)")
    width = SCREENS[screen][0]
    assert browser.script("return document.documentElement.scrollWidth") <= width
    ratios = contrasts(browser)
    assert len(ratios) > 5 and [pair for pair in ratios if pair[0] < LEAST_CONTRAST] == []
    assert browser.complaints() == [] and browser.requests() == []


def test_each_figure_of_the_report_is_one_screen(report, screen):
    window_height = SCREENS[screen][1]
    for picture in boxes(report, ".figure img"):
        assert picture["width"] > 300 and picture["height"] < window_height
    if screen == "computer":
        sections = boxes(report, ".figure")
        assert len(sections) == 4 and all(box["height"] < window_height for box in sections)
        page_height = report.script("return document.documentElement.scrollHeight")
        assert page_height < MAX_REPORT_HEIGHT


def test_on_a_phone_R_is_on_the_first_screen(pages, browser):
    with emulated_screen(browser, *SCREENS["phone"]):
        browser.open(pages["explore.html"])
        browser.wait(lambda: browser.find("#ratios canvas"))
        (ratios,) = boxes(browser, "#ratios")
        assert ratios["top"] > 0 and ratios["bottom"] < 700
        browser.open(pages["living.html"], "#vibrated/r0.9/beta0")
        for box in (*boxes(browser, ".present"), *boxes(browser, ".collisional")):
            assert 0 < box["top"] < box["bottom"] < 250


def visible_rows(report):
    return [
        row.get_attribute("id") for row in report.find("#verdicts tbody tr") if row.is_displayed()
    ]


def test_the_table_of_verdicts_is_filtered_by_words_and_by_verdict(report):
    everything = visible_rows(report)
    verdicts = [row.get_attribute("data-kind") for row in report.find("#verdicts tbody tr")]
    assert len(everything) == 20 and "sheared_follows_lun" in everything
    for button in report.find("#filter button:enabled"):
        button.send_keys(Keys.ENTER)
        assert button.get_attribute("aria-pressed") == "true"
        kind = button.get_attribute("data-kind")
        number = verdicts.count(kind) if kind else len(everything)
        assert len(visible_rows(report)) == number == int(button.text.split()[-1])
        assert report.text("#filter output") == f"{number} of 20 shown"
    report.find("#filter button")[0].send_keys(Keys.ENTER)
    (search,) = report.find("#filter input")
    search.send_keys("EQUIPARTITION holds")
    assert visible_rows(report) == ["forced_equipartition"]
    search.send_keys(Keys.ENTER, "x")
    assert visible_rows(report) == []


def test_a_link_beside_a_figure_opens_its_statement(report):
    report.find("#filter input")[0].send_keys("nothing like it")
    report.find("#fig2b a")[0].send_keys(Keys.ENTER)
    report.wait(lambda: report.find("#verdicts tr:target details[open]"))
    (row,) = report.find("#verdicts tr:target")
    assert len(visible_rows(report)) == 20 and row.is_displayed()
    link = row.find_elements("css selector", "td:last-child a")[0]
    assert link.text == "Fig. 2b"
    link.send_keys(Keys.ENTER)
    report.wait(lambda: abs(boxes(report, "#fig2b")[0]["top"]) < 2)


def test_without_programs_the_table_is_whole_and_has_no_filter(pages, browser):
    browser.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        browser.open(pages["report.html"])
        assert len(visible_rows(browser)) == 20
        assert not browser.find("#filter")[0].is_displayed()
    finally:
        browser.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})
