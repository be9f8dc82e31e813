"""The report: captions, front page, tables and configurations as HTML."""

import base64
import json
import re
import time
from html import unescape
from pathlib import Path
from types import SimpleNamespace

import pytest
from docutils.core import publish_parts
from jinja2 import Environment
from snakemake.iocontainers import Params
from tests.configurations import EXPERIMENTS
from tests.entry import main
from tests.study_modules import FOLDERS

from roughgas import config
from roughgas.base import all_in_rst, in_rst, in_rst_with_bold
from roughgas.data.reduced import read_reduced
from roughgas.results.tables import write_times
from roughgas.show.catalogue import FIGURES, figures_of
from roughgas.show.pages import PICTURE_LINK, captions
from roughgas.show.report import RELATIVE_LINK
from roughgas.show.verdicts import figures_on, in_symbols

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[3]
CAPTIONS = ROOT / "rules" / "captions"
NAMES = figures_of("paper")


def rendered(caption, **attributes):
    """Return a caption as Snakemake renders it; warnings raise errors."""
    environment = Environment(trim_blocks=True, lstrip_blocks=True)
    text = environment.from_string((CAPTIONS / f"{caption}.rst").read_text("utf-8"))
    settings = {"halt_level": 2, "report_level": 5}
    source = text.render(snakemake=SimpleNamespace(**attributes))
    return publish_parts(source, writer="html", settings_overrides=settings)["body"]


@pytest.fixture(scope="module")
def loaded():
    return config.load(EXPERIMENTS)


@pytest.fixture(scope="module")
def studied():
    return config.load(ROOT / "config.yaml").studies


@pytest.mark.parametrize("figure", NAMES)
def test_a_caption_is_rendered_and_says_how_it_was_made(figure, loaded):
    params = {"caption": captions(ROOT / "studies/paper", NAMES)[figure]}
    params["experiments"] = {"cooling": loaded.experiment("cooling", "paper").raw}
    text = rendered("figure", wildcards=SimpleNamespace(folder=""), params=Params(fromdict=params))
    assert "21 values from -0.95 to 1" in text


def test_a_caption_of_accuracy_has_the_settings_of_tasks(loaded):
    params = {"caption": captions(ROOT / "studies" / "coverage", ["coverage"])["coverage"]}
    params["experiments"] = {}
    params["studies"] = {"coverage": loaded.accuracy_at("paper")["coverage"]}
    text = rendered("figure", wildcards=SimpleNamespace(folder=""), params=Params(fromdict=params))
    assert "repetitions 600" in text and "How often stated intervals contain the truth" in text


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_readme_of_a_study_has_a_caption_for_each_figure(folder, studied):
    figures = {*(studied[folder.name].figures or studied[folder.name].experiments)}
    captions_by_figure = captions(folder, [*figures])
    assert captions_by_figure.keys() == figures
    for caption in captions_by_figure.values():
        params = Params(fromdict={"caption": caption, "experiments": {}})
        rendered("figure", wildcards=SimpleNamespace(folder=""), params=params)


HOSTILE = r"""
.. include:: /etc/passwd

.. raw:: html

   <script>alert(1)</script>

.. image:: javascript:alert(1)
.. role:: raw-html(raw)
   :format: html

:raw-html:`<script>alert(1)</script>` `a <javascript:alert(1)>`_ |name| Workflow_ [1]_
\`b <javascript:alert(1)>`_ \\`c <javascript:alert(1)>`_ **d `e <javascript:alert(1)>`_**
http://example.org mail@example.org

.. _Workflow: javascript:alert(1)

{{ snakemake.config }} {% for x in y %} ** ** ** f</script><!-- \x00`g`_ Statistics_::

Heading
=======

**h**i **j**."""
TAG = re.compile(r"<(?!/?(?:p|strong|ul|li|div|blockquote|tt)\b)[^>]*>")
LINKS = """

.. _Workflow: javascript:show_panel('workflow')
.. _Statistics: javascript:show_panel('statistics')
"""


def words(text):
    return " ".join(text.split())


def test_markup_in_a_readme_or_in_settings_is_escaped_in_the_report(tmp_path):
    """Directives, roles, links, HTML and Jinja. Snakemake adds link targets, and renders once."""
    (tmp_path / "README.md").write_text(f"# Mine\n\n![x](mine.png)\n{HOSTILE.strip()}\n")
    caption = captions(tmp_path, ["mine"])["mine"]
    template = f"{(CAPTIONS / 'figure.rst').read_text('utf-8')}{LINKS}"
    line = words(HOSTILE)
    params = {"caption": caption, "experiments": {}, "studies": {"mine": all_in_rst({line: line})}}
    environment = Environment(trim_blocks=True, lstrip_blocks=True)
    snakemake = SimpleNamespace(
        params=Params(fromdict=params), wildcards=SimpleNamespace(folder="")
    )
    source = environment.from_string(template).render(snakemake=snakemake)
    settings = {"halt_level": 2, "report_level": 5}  # a warning is an error
    body = publish_parts(source, writer="html", settings_overrides=settings)["body"]
    assert TAG.findall(body) == []
    text = words(unescape(re.sub(r"<[^>]*>", "", body)))
    for sentence in (".. include:: /etc/passwd", "{{ snakemake.config }} {% for x in y %}"):
        assert text.count(sentence) == 3
    assert "<strong>h</strong>i <strong>j</strong>." in body and "Heading =======" in text
    assert not re.search(r"</|<!--", str(params))  # these are within a script


def test_names_and_numbers_are_verbatim_in_captions():
    assert [in_rst(text) for text in ("lees_edwards", "-0.5", "1e-08", "a_")] == [
        *("lees_edwards", "-0.5", "1e-08", r"a\_")
    ]
    assert in_rst_with_bold("**What.** x\ny\n\nz") == "\\ **What\\.**\\  x y\n\nz"


@pytest.mark.parametrize("text", ["![", "![](", "![](/a.", "[", "[](", "![](a.png", "](", "a."])
def test_a_long_readme_is_searched_in_linear_time(text):
    """It would take minutes to follow each opening bracket to the end of the text."""
    long = f"![]({(text * 200_000)[:200_000]}"
    begin = time.process_time()
    PICTURE_LINK.split(long), RELATIVE_LINK.sub(r"\1", long)
    assert time.process_time() - begin < 5


def test_captions_have_no_comments(tmp_path):
    """Such as the marks of numbers; what is no comment stays."""
    text = "![x](mine.png)\n\n0.5(2)<!--mine.x--> % <!-- a\nb\n--> of <!-- all"
    (tmp_path / "README.md").write_text(text)
    assert captions(tmp_path, ["mine"])["mine"] == in_rst("0.5(2) %  of <!-- all")


def claim(name, verdict="holds", ci95=0.0009, experiments=("vibrated",)):
    """Return a statement as it stands in claims.json."""
    number = {"label": "largest difference", "value": -0.0512, "ci95": ci95, "text": "-0.0512 (-)"}
    return {
        "id": name,
        "text": f"“R of {name} < 1, at beta = 1”",
        "criterion": "It is.",
        "fixed": "before its data",
        "mark": "",
        "experiments": list(experiments),
        "verdict": verdict,
        "reason": f"Reason of {name}.",
        "detectable": None,
        "numbers": [number],
    }


CLAIMS = {
    "title": "The verdict",
    "scale": "paper",
    "reservation": "",
    "how_to_read": "How to <read> it.",
    "summary": "Of 2 statements: holds 1, fails 1.",
    "claims": [
        claim("first"),
        claim("second", "fails", ci95=None, experiments=("vibrated", "cooling")),
    ],
}
SHOWS = {"fig1a": ["vibrated"], "fig1b": ["vibrated", "walls"], "fig2a": ["sheared"]}
SHOWS |= {"fig2b": ["cooling"]}


@pytest.fixture
def files(tmp_path):
    """A folder of pictures and verdicts with known content."""
    (tmp_path / "claims.json").write_text(json.dumps(CLAIMS))
    for name in NAMES:
        (tmp_path / f"{name}.png").write_bytes(name.encode())
    return tmp_path


def front(folder, figures=NAMES, captions=NAMES):
    """Run the step `front`, which writes report.html; return its exit status."""
    texts = (
        f"![{name}](figures/{name}.png)\n\nWhat {name}\nshows.\n\n**What to notice.** x < y.\n\n"
        for name in captions
    )
    (folder / "README.md").write_text("# The paper\n\n" + "".join(texts))
    options = ["--figures", *(str(folder / f"{name}.png") for name in figures)]
    options += ["--shows", json.dumps(SHOWS), "--readme", str(folder / "README.md")]
    return main(["front", str(folder / "claims.json"), *options, "-o", str(folder / "report.html")])


def test_the_front_page_has_figures_with_captions_and_alternative_texts(files):
    assert front(files) == 0
    text = (files / "report.html").read_text("utf-8")
    positions = []
    for name in NAMES:
        positions.append(text.index(base64.b64encode(name.encode()).decode()))
        assert f'alt="{FIGURES[name].title}. What {name} shows."' in unescape(text)
        assert f"<h2>{FIGURES[name].title}</h2>" in text
        assert f"<p>What {name}\nshows.</p>" in text
    assert positions == sorted(positions) and positions[-1] < text.index("<h2>The verdict</h2>")
    assert "<strong>What to notice.</strong> x &lt; y." in text


def test_verdicts_link_to_figures_and_figures_to_verdicts(files):
    assert front(files) == 0
    text = (files / "report.html").read_text("utf-8")
    rows = text.partition("<tbody>")[2].split("<tr ")[1:]
    assert [row.partition(">")[0] for row in rows] == [
        'id="first" data-kind="holds"',
        'id="second" data-kind="fails"',
    ]
    assert "largest difference: −0.05120\u00a0±\u00a00.00090" in rows[0]
    assert '<a href="#fig1a">Fig. 1a</a>' in rows[0] and "fig2b" not in rows[0]
    assert '<a href="#fig1a">Fig. 1a</a> <a href="#fig2b">Fig. 2b</a>' in rows[1]
    assert "largest difference: −0.0512 (-)" in rows[1] and "could have seen: not known" in rows[1]
    assert "How to &lt;read&gt; it." in text
    counts = re.findall(r'data-kind="\w*"( disabled)?>([\w ]+)</button>', text)
    names = ["holds 1", "holds with a qualification 0", "fails 1", "not tested 0"]
    assert [name for _, name in counts] == ["all 2", *names]
    assert [name for disabled, name in counts if disabled] == names[1::2]
    sections = text.split('<section class="figure"')[1:]
    assert [section.count('href="#first"') for section in sections] == [1, 0, 0, 0]


def test_criteria_of_other_data_are_not_said_to_be_fixed(files):
    (files / "claims.json").write_text(json.dumps(CLAIMS | {"reservation": RESERVED}))
    assert front(files) == 0
    text = (files / "report.html").read_text("utf-8")
    assert "Fixed before" not in text and text.count(RESERVED) == 1 + len(CLAIMS["claims"])


def test_all_verdicts_of_several_studies_are_one_table(files, tmp_path):
    claims_of_walls = CLAIMS | {
        "claims": [claim("first", experiments=("walls.bed",)), claim("none")]
    }
    (tmp_path / "walls.json").write_text(json.dumps(claims_of_walls))
    paper = {"title": "The paper", "page": "report.html", "shows": SHOWS}
    walls = {"title": "Walls", "page": "walls/page.html", "shows": {"walls": ["walls.bed"]}}
    arguments = ["verdicts", str(files / "claims.json"), str(tmp_path / "walls.json")]
    arguments += ["--studies", json.dumps({"paper": paper, "walls": walls})]
    assert main([*arguments, "--output", str(tmp_path / "verdicts.html")]) == 0
    text = (tmp_path / "verdicts.html").read_text("utf-8")
    names = ["paper.first", "paper.second", "walls.first", "walls.none"]
    assert re.findall(r'<tr id="([\w.]+)"', text) == names
    assert re.findall(r'<td><a href="(.*)">(.*)</a> </td>', text) == [
        ("report.html#fig1a", "The paper"),
        ("report.html#fig1a", "The paper"),
        ("walls/page.html#walls", "Walls"),
        ("walls/page.html", "Walls"),
    ]
    assert "4 statements of 2 studies." in text and "holds 3" in text and "fails 1" in text


def test_a_figure_that_shows_all_data_of_a_statement_stands_for_the_others():
    assert figures_on(["vibrated"], SHOWS) == ["fig1a"]
    assert figures_on(["vibrated", "walls"], SHOWS) == ["fig1b"]
    assert figures_on(["sheared", "vibrated"], SHOWS) == ["fig2a", "fig1a"]
    assert figures_on(["dsmc"], SHOWS) == []


def test_symbols_of_a_statement_are_html():
    text = "E_rot < E_trans at beta_p = -1, beta=1/2 and alphabeta-1: -.5"
    assert in_symbols(text) == (
        "E<sub>rot</sub> &lt; E<sub>trans</sub> at β<sub>p</sub> = −1, β=1/2 and alphabeta-1: −.5"
    )


def test_a_figure_without_a_caption_or_an_entry_is_refused(files, capsys):
    assert front(files, captions=NAMES[:1]) == 2
    assert "captions = fig1a: must have one of fig1b" in capsys.readouterr().err
    (files / "mine.png").write_bytes(b"")
    assert front(files, figures=["mine"]) == 2
    assert "figure = mine: must be one of" in capsys.readouterr().err
    assert not (files / "report.html").exists()


def html(source, tmp_path):
    assert main(["document", str(source), "--output", str(tmp_path / "shown.html")]) == 0
    return (tmp_path / "shown.html").read_text("utf-8")


def test_pictures_near_a_text_are_embedded(tmp_path):
    for name in ("secret.png", "a/pictures/fig 1.png", "a/key.txt"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(name.encode())
    sources = ["pictures/fig%201.png", "../secret.png", "key.txt", "none.png", "http://x.org/a.png"]
    table = "| ![t](pictures/fig%201.png) |\n| --- |\n"
    (tmp_path / "a/page.md").write_text(
        "\n\n".join([f"![p]({source})" for source in sources] + [table])
    )
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


RESERVED = "Findings were written for the data of another study, friction."
STUDY_README = """\
# Friction

Does R depend on friction?

## Findings

It does.

![R over friction](figures/mine.png)

Points of a bed. **What to notice.** They rise.
"""


def study_page(folder, *options):
    """Run the step `study_page` of a study with a picture and verdicts; return its text."""
    (folder / "README.md").write_text(STUDY_README)
    (folder / "mine.png").write_bytes(b"picture")
    (folder / "claims.json").write_text(json.dumps(CLAIMS))
    arguments = ["study_page", str(folder), "--title", "Friction", *options]
    arguments += ["--figures", str(folder / "mine.png"), "--claims", str(folder / "claims.json")]
    assert main([*arguments, "--output", str(folder / "page.html")]) == 0
    return (folder / "page.html").read_text("utf-8")


def test_a_page_of_other_data_has_a_question_and_no_findings(tmp_path, monkeypatch):
    """Its picture and its verdicts are there, since they are of its data."""
    monkeypatch.chdir(tmp_path)
    judged = study_page(Path())
    assert "It does." in judged and "They rise." in judged and "Not judged yet" not in judged
    reserved = study_page(Path(), f"--reservation={RESERVED}")
    assert "It does." not in reserved and "They rise." not in reserved
    assert f"<strong>Not judged yet.</strong> {RESERVED}" in reserved
    for shared in ("Does R depend on friction?", base64.b64encode(b"picture").decode(), "<h2>"):
        assert shared in judged and shared in reserved
    assert "The verdict" in reserved


def test_the_front_page_of_other_data_has_no_captions(files):
    assert front(files) == 0
    arguments = [
        "front",
        str(files / "claims.json"),
        "--shows",
        "{}",
        f"--reservation={RESERVED}",
        "--figures",
    ]
    arguments += [*(str(files / f"{name}.png") for name in NAMES)]
    arguments += ["--readme", str(files / "README.md"), "-o", str(files / "other.html")]
    assert main(arguments) == 0
    text = (files / "other.html").read_text("utf-8")
    assert "What to notice" not in text and text.count(RESERVED) >= len(NAMES)
