"""Snakemake's report in a real browser: headings, pictures with their captions, tables."""

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.slow]

OF_SNAKEMAKE = (
    "cdn.tailwindcss.com should not be used in production",
    "The input spec uses Vega-Lite v3",
)
"""What Snakemake's own page warns of, whatever the workflow: how its style sheet is made, and the
version that its statistics are written for. Nothing is loaded from that address."""


@pytest.fixture
def report(ran, browser):
    browser.open(ran.folder / "report.html")
    browser.wait(lambda: browser.find("nav li"))
    yield browser
    complaints = browser.complaints()
    assert [one for one in complaints if not any(known in one for known in OF_SNAKEMAKE)] == []
    assert browser.requests() == []


def follow(report, text):
    """Click on a heading of the menu, from the menu."""
    report.find("nav a")[1].click()  # home
    entries = report.wait(lambda: [one for one in report.find("nav li a") if one.text == text])
    entries[0].click()


def buttons(report, product):
    """The eye of a product, and the symbol of its caption."""
    rows = report.wait(lambda: [one for one in report.find("nav tbody tr") if one.text == product])
    return rows[0].find_elements("css selector", "a")


def caption(report, product):
    buttons(report, product)[1].click()
    return report.wait(lambda: report.find("nav .prose"))[0].text


def test_it_opens_on_what_it_is_about(report):
    assert "scale tiny" in report.wait(lambda: report.find("#app .prose"))[0].text
    headings = [one.text for one in report.find("nav li a") if one.text]
    assert headings == ["Workflow", "Statistics", "About", "1 The paper", "5 This run"]


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
        wanted = f"#app .grow img[src*='filename={name}.png']"
        (picture,) = report.wait(lambda wanted=wanted: report.find(wanted))
        report.wait(lambda shown=picture: report.script("return arguments[0].naturalWidth", shown))
        text = caption(report, title)
        assert "What to notice." in text and "scale tiny" in text
        assert "10 particles in a box of" in text and "2 seeds of each point" in text
    assert "cooling: A freely cooling gas" in text and "beta: -0.5, 0, 0.5" in text
    assert "replicas 3" in text and "plateau 20" in text
