"""The report: captions, its front page, tables and configurations as HTML."""

import base64
from html import unescape
from pathlib import Path
from types import SimpleNamespace

import pytest
from docutils.core import publish_parts
from jinja2 import Environment
from snakemake.iocontainers import Params
from tests.entry import main
from tests.houses import FOLDERS

from roughgas import config
from roughgas.data.reduced import read_reduced
from roughgas.results.products import write_times
from roughgas.show.catalogue import FIGURES, figures_of
from roughgas.show.pages import captions

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
CAPTIONS = ROOT / "rules" / "captions"
NAMES = figures_of("paper")


def rendered(caption, **about):
    """A caption as Snakemake renders it; a warning is an error."""
    environment = Environment(trim_blocks=True, lstrip_blocks=True)
    text = environment.from_string((CAPTIONS / f"{caption}.rst").read_text("utf-8"))
    settings = {"halt_level": 2, "report_level": 5}
    source = text.render(snakemake=SimpleNamespace(**about))
    return publish_parts(source, writer="html", settings_overrides=settings)["body"]


@pytest.fixture(scope="module")
def loaded():
    return config.load(ROOT / "tests" / "experiments.yaml")


@pytest.fixture(scope="module")
def studied():
    return config.load(ROOT / "config.yaml")["folders"]


@pytest.mark.parametrize("figure", [*figures_of("paper"), *figures_of("accuracy")])
def test_a_caption_is_rendered_and_says_how_it_was_made(figure, loaded):
    about = {"caption": (CAPTIONS / f"{figure}.rst").read_text("utf-8")}
    about["experiments"] = {"cooling": config.experiment(loaded, "cooling", "paper")}
    about["studies"] = config.accuracy(loaded, "paper")
    wildcards = SimpleNamespace(figure=figure, study_figure=figure, folder="")
    template = "figure" if figure in NAMES else "study"
    text = rendered(template, wildcards=wildcards, params=Params(fromdict=about))
    assert ("21 values from -0.95 to 1" if figure in NAMES else "repetitions 600") in text


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda one: one.name)
def test_readme_of_a_study_has_a_caption_for_each_figure(folder, studied):
    figures = studied[folder.name]["figures"]
    found = captions(folder, [*figures])
    assert found.keys() == figures.keys()
    for caption in found.values():
        params = Params(fromdict={"caption": caption, "experiments": {}})
        rendered("figure", wildcards=SimpleNamespace(folder=""), params=params)


TABLE = "| R | verdict |\n| --- | --- |\n| 1 | **holds** |"
CLAIMS = f"# The verdict\n\nHow to <read> it.\n\n{TABLE}\n\nEnd.\n"


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


def test_a_figure_without_a_caption_or_a_place_is_refused(files, capsys):
    assert front(files, captions=NAMES[:1]) == 2
    assert "captions = fig1a: must have one of fig1b" in capsys.readouterr().err
    (files / "mine.png").write_bytes(b"")
    assert front(files, figures=["mine"]) == 2
    assert "figure = mine: must be one of" in capsys.readouterr().err
    assert not (files / "report.html").exists()


def html(source, tmp_path):
    assert main(["document", str(source), "--output", str(tmp_path / "shown.html")]) == 0
    return (tmp_path / "shown.html").read_text("utf-8")


def test_pictures_beside_a_text_are_part_of_its_page(tmp_path):
    for name in ("secret.png", "a/pictures/fig 1.png", "a/key.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    named = ["pictures/fig%201.png", "../secret.png", "key.txt", "none.png", "http://x.org/a.png"]
    table = "| ![t](pictures/fig%201.png) |\n| --- |\n"
    (tmp_path / "a/page.md").write_text("\n\n".join([f"![p]({one})" for one in named] + [table]))
    text = html(tmp_path / "a/page.md", tmp_path)
    data = base64.b64encode(b"a/pictures/fig 1.png").decode()
    assert text.count(f'src="data:image/png;base64,{data}"') == 2 and text.count("base64,") == 2
    assert "img-src data:" in text


def test_run_times_are_sums_over_points_and_seeds(points, tmp_path):
    write_times([points / "sheared.nc", points / "cooling.nc"], output=tmp_path / "times.md")
    rows = [line for line in (tmp_path / "times.md").read_text().splitlines() if line[:1] == "|"]
    assert rows[2:] == [
        "| sheared | 40 | 2 | 4 | 4,936 | 1.0 | 4,936 |",
        "| cooling | 40 | 4 | 4 | 4,936 | 1.0 | 4,936 |",
        "| together |  | 6 | 8 | 9,872 | 2.0 | 4,936 |",
    ]
    assert read_reduced(points / "sheared.nc").kernel_seconds.sum().item() == 1.0
