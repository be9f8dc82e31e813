"""Snakemake's report in a real browser: headings, pictures with their captions, tables."""

import hostile
import pytest
from project import Project

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SNAKEMAKE_WARNINGS = (
    "cdn.tailwindcss.com should not be used in production",
    "The input spec uses Vega-Lite v3",
)
"""Warnings of Snakemake's page for any workflow: on its style sheet, and on the version of its
statistics. Nothing is loaded from that address."""


JOINER = "\u2060"  # invisible; prevents text of a caption from becoming markup


@pytest.fixture(scope="session")
def attacked(tmp_path_factory):
    """The report of a study whose texts attack it."""
    return hostile.report_of(Project(tmp_path_factory.mktemp("attacked")))


@pytest.fixture
def report(finished_run, browser):
    yield from checked_report(finished_run.folder / "report.html", browser)


@pytest.fixture
def hostile_report(attacked, browser):
    yield from checked_report(attacked, browser)


def checked_report(path, browser):
    """Yield a report in the browser; then check that there were no complaints and no requests."""
    browser.open(path)
    browser.wait(lambda: browser.find("nav li"))
    yield browser
    complaints = browser.complaints()
    assert [
        complaint
        for complaint in complaints
        if not any(known_warning in complaint for known_warning in SNAKEMAKE_WARNINGS)
    ] == []
    assert browser.requests() == []


def follow(report, text):
    """Return to the menu, and click on a heading."""
    report.find("nav a")[1].click()  # home
    entries = report.wait(lambda: [link for link in report.find("nav li a") if link.text == text])
    entries[0].click()


def buttons(report, product):
    """Return the two buttons of a product: to show it, and to show its caption."""
    rows = report.wait(lambda: [row for row in report.find("nav tbody tr") if row.text == product])
    return rows[0].find_elements("css selector", "a")


def caption(report, product):
    buttons(report, product)[1].click()
    return report.wait(lambda: report.find("nav .prose"))[0].text


def test_the_report_opens_on_its_description(report):
    assert "scale tiny" in report.wait(lambda: report.find("#app .prose"))[0].text
    headings = [link.text for link in report.find("nav li a") if link.text]
    assert headings == ["Workflow", "Statistics", "About", "1 The paper", "6 This run"]


def test_every_figure_is_shown_with_the_parameters_of_this_run(report):
    titles = {
        "Fig. 1a: a vibrated bed": "fig1a",
        "Fig. 1b: its side walls": "fig1b",
        "Fig. 2a: a sheared gas": "fig2a",
        "Fig. 2b: a freely cooling gas": "fig2b",
    }
    for title, name in titles.items():
        follow(report, "1 The paper")
        buttons(report, title)[0].click()
        selector = f"#app .grow img[src*='filename={name}.png']"
        (picture,) = report.wait(lambda selector=selector: report.find(selector))
        report.wait(lambda shown=picture: report.script("return arguments[0].naturalWidth", shown))
        text = caption(report, title)
        assert "What to notice." in text and "scale tiny" in text
        assert "10 particles in a box of" in text and "2 seeds of each point" in text
    assert "cooling: A freely cooling gas" in text and "beta: -0.5, 0, 0.5" in text
    assert "replicas 3" in text and "plateau 20" in text


TRACES = "return [window.hacked, document.title, document.querySelectorAll(arguments[0]).length]"
ELEMENTS = "img[src=x], a[href^='javascript:'], [onerror]"


def visible_text(report):
    """Return the visible text, after a check that no script of the study has run."""
    assert report.script(TRACES, ELEMENTS) == [None, "Snakemake Report", 0]
    assert hostile.ATTACK not in report.script("return document.documentElement.outerHTML")
    return report.text("body").replace(JOINER, "")


def test_texts_of_a_study_are_escaped_in_the_report(hostile_report):
    report = hostile_report
    title = f"'It' {hostile.ATTACK} {{study}} $(touch harmed)"
    texts = {}
    table = f"{title}: Table: every number (CSV, to download)"
    for product in (title, f"{title}: hostile"):
        follow(report, "Results")  # of one heading alone
        rows = report.wait(lambda: report.find("nav tbody tr"))
        by_product = {row.text.replace(JOINER, ""): row for row in rows}
        assert by_product.keys() == {title, f"{title}: hostile", table}
        by_product[product].find_elements("css selector", "a")[1].click()
        report.wait(lambda: report.find("nav .prose"))
        texts[product] = visible_text(report)
    page, figure = texts.values()
    assert f"title={title}" in page
    assert ".. include:: README.md" in figure and ".. raw:: html" in figure
    assert f"\n{hostile.ATTACK}\n" in figure
    assert "`a <javascript:alert(1)>`_ {{ x }}" in figure


def test_texts_of_a_study_are_escaped_on_its_page(attacked, browser):
    browser.open(attacked.parent / "results/tiny/hostile/page.html")
    assert browser.script(TRACES, ELEMENTS)[::2] == [None, 0]
    assert hostile.ATTACK in browser.text("body")
    assert browser.complaints() == [] and browser.requests() == []
