"""The report's front page: figures with their captions, verdicts first, mistakes in one line."""

import base64
from html import unescape

import pytest
from tests.entry import main

from roughgas.show.catalogue import FIGURES, figures_of

NAMES = figures_of("paper")
TABLE = "| R | verdict |\n| --- | --- |\n| 1 | **holds** |"
CLAIMS = f"# The verdict\n\nHow to <read> it.\n\n{TABLE}\n\nEnd.\n"
CAPTION = "What {name}\nshows.\n\n**What to notice.** x < y.\n"


@pytest.fixture
def files(tmp_path):
    """Pictures, captions and verdicts, with known content."""
    (tmp_path / "claims.md").write_text(CLAIMS)
    for name in NAMES:
        (tmp_path / f"{name}.png").write_bytes(name.encode())
        (tmp_path / f"{name}.rst").write_text(
            f"What {name}\nshows.\n\n**What to notice.** x < y.\n"
        )
    return tmp_path


def front(folder, figures=NAMES, captions=NAMES):
    """The exit status of the step `front`, which writes report.html."""
    parts = ["--figures", *(str(folder / f"{name}.png") for name in figures)]
    parts += ["--captions", *(str(folder / f"{name}.rst") for name in captions)]
    return main(["front", str(folder / "claims.md"), *parts, "-o", str(folder / "report.html")])


def test_it_opens_on_the_figures_each_with_its_caption_and_words_for_who_cannot_see_it(files):
    assert front(files) == 0
    text = (files / "report.html").read_text("utf-8")
    places = []
    for name in NAMES:
        places.append(text.index(base64.b64encode(name.encode()).decode()))
        assert f'alt="{FIGURES[name].title}. What {name} shows."' in unescape(text)
        assert f"<h2>{FIGURES[name].title}</h2>\n<p>What {name}\nshows.</p>" in text
    assert places == sorted(places) and places[-1] < text.index("<h1>The verdict</h1>")
    assert "<strong>What to notice.</strong> x &lt; y." in text


def test_verdicts_come_before_how_to_read_them(files):
    assert front(files) == 0
    text = (files / "report.html").read_text("utf-8")
    table, reading = text.index("<td><strong>holds"), text.index("How to &lt;read&gt; it.")
    assert text.index("<h1>The verdict</h1>") < table < reading < text.index("<p>End.</p>")


def test_a_figure_without_a_caption_or_a_place_is_refused(files, capsys):
    assert front(files, captions=NAMES[:1]) == 2
    assert "captions = fig1a: must have one of fig1b" in capsys.readouterr().err
    (files / "mine.png").write_bytes(b"")
    assert front(files, figures=["mine"]) == 2
    assert "figure = mine: must be one of" in capsys.readouterr().err
    assert not (files / "report.html").exists()
