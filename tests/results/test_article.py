"""The article: its quoted numbers exist, and its metadata agree with CITATION.cff."""

import csv
import json
import shutil
import zipfile
from pathlib import Path

import matplotlib.pyplot as plt
import pytest
from project import Project

from roughgas.base.reading import read_yaml
from roughgas.results.article import COLUMNS, QUOTED_NUMBER
from roughgas.results.crate import full_name
from roughgas.steps import main

ROOT = Path(__file__).parents[2]
ARTICLE = ROOT / "article"
NUMBERS = ROOT / "figures/numbers.json"
FIGURES = ("fig1a", "fig1b", "fig2a", "fig2b", "transport_inertia")
LONG_TABLE = ROOT / "studies/transport/long.csv"
CLAIM = {"quote": "R > 1/2 at <v> [ours]", "ours": False, "verdict": "holds"}
HEAD = ["experiment", "r", "beta", "R", "R_stderr"]
HEAD += ["R_collisional", "R_collisional_stderr", "R_corrected", "R_theory"]


def rows(r=(0.8, 0.9, 0.99)):
    for name in COLUMNS:
        for restitution in r:
            for beta in (-0.8, 0.0, 0.5):
                cooling = name == "cooling"
                collisional = ["", ""] if cooling else [restitution + 0.01, 0.001]
                corrected = [restitution - 0.001] if cooling else [""]
                yield [name, restitution, beta, restitution, 0.002, *collisional, *corrected, 0.25]


@pytest.fixture
def compiled(tmp_path):
    """A function that compiles a folder with made-up results, and returns the exit status."""
    claims = {"scale": "tiny", "claims": [CLAIM | {"numbers": []}]}
    (tmp_path / "claims.json").write_text(json.dumps(claims))
    with open(tmp_path / "R.csv", "w", newline="") as file:
        csv.writer(file).writerows([HEAD, *rows()])
    figures = [str(tmp_path / f"{name}.pdf") for name in FIGURES]
    for path in figures:
        plt.figure().savefig(path)
    plt.close("all")

    def compile_in(folder):
        files = [str(path) for path in [*sorted(folder.iterdir()), LONG_TABLE]]
        results = [f"--{name}={tmp_path / file}" for name, file in RESULT_FILES.items()]
        output = tmp_path / "article.pdf"
        options = [f"--numbers={NUMBERS}", *results, "--figures", *figures, "-o", str(output)]
        return main(["article", *files, *options]), output

    return compile_in


RESULT_FILES = {"claims": "claims.json", "table": "R.csv"}


def test_the_article_compiles_with_made_up_results_to_the_same_bits(compiled):
    status, output = compiled(ARTICLE)
    assert status == 0
    first = output.read_bytes()
    assert first.startswith(b"%PDF-")
    compiled(ARTICLE)
    assert output.read_bytes() == first


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('#n("bed.tim")', "number in article.typ = bed.tim: must be one that numbers.json holds"),
        ("#nothing", "article.typ = unknown variable: nothing: must be what Typst compiles"),
    ],
)
def test_unknown_numbers_and_errors_are_refused_in_one_line(
    compiled, tmp_path, capsys, text, message
):
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "article.typ").write_text(text)
    status, output = compiled(folder)
    assert status == 2 and not output.exists()
    assert capsys.readouterr().err == f"roughgas: error: {message}\n"


@pytest.mark.slow
def test_a_run_writes_the_article_and_a_deposit(tmp_path):
    project = Project(tmp_path)
    shutil.copytree(ARTICLE, tmp_path / "article")
    (tmp_path / "docs").mkdir()
    shutil.copy(ROOT / "docs/results.md", tmp_path / "docs")

    def change(config):  # to the points of the quoted numbers
        tiny = config["scales"]["tiny"]
        tiny["drives.heated"]["sweep"]["thermostat.spin_share"] = ["0"]
        tiny["vibrated_rough_walls"]["sweep"] = {"beta": ["0"]}

    project.configure(change)
    project.succeed("-j2", "--config", "scale=tiny", "--", "article", "deposit")
    article = (tmp_path / "results/tiny/article.pdf").read_bytes()
    with zipfile.ZipFile(tmp_path / "results/tiny/deposit.zip") as archive:
        assert archive.read("results/tiny/article.pdf") == article
        assert {"results/tiny/numbers.json", "article/article.typ"} < set(archive.namelist())


def test_it_quotes_numbers_that_are_known():
    quoted = set(QUOTED_NUMBER.findall((ARTICLE / "article.typ").read_text("utf-8")))
    assert len(quoted) > 15 and quoted <= json.loads(NUMBERS.read_text()).keys()


def test_its_metadata_agree_with_the_citation():
    metadata, cited = read_yaml(ARTICLE / "metadata.yaml"), read_yaml(ROOT / "CITATION.cff")
    (paper,) = cited["references"]
    assert metadata["title"] == f"[Re] {paper['title']}"
    assert [author["name"] for author in metadata["authors"]] == list(
        map(full_name, cited["authors"])
    )
    assert {"doi": paper["doi"]} in metadata["replication"]
    assert metadata["abstract"].startswith("McNamara and Luding (1998)")
