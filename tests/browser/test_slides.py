"""Slides in a real browser: a slider turns them."""

import pytest
from selenium.webdriver.common.keys import Keys

from roughgas.show import slides

pytestmark = [pytest.mark.browser, pytest.mark.slow]

SLIDES = """
from matplotlib.figure import Figure

def draw():
    for name in ("first", "second", "third"):
        yield name, f"**{name}** text", Figure(figsize=(1, 1))
"""


def test_arrow_keys_turn_the_slides(tmp_path, browser):
    (tmp_path / "slides.py").write_text(SLIDES)
    page = tmp_path / "page.html"
    slides.write_slides(tmp_path, [], title="Slides", output=page)
    browser.open(page)
    (slider,) = browser.find("input")
    for name in ("first", "second", "third", "third"):
        visible = [section.text for section in browser.find("section") if section.is_displayed()]
        assert visible == [f"{name}\n{name} text"] and browser.text("output") == name
        slider.send_keys(Keys.ARROW_RIGHT)
    assert browser.complaints() == [] and browser.requests() == []
