"""Captions of the report: there for every product, valid, with the parameters of the run."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from docutils.core import publish_parts
from jinja2 import Environment

from roughgas import config
from roughgas.show.figures import FIGURES
from roughgas.studies import accuracy

ROOT = Path(__file__).parents[3]
CAPTIONS = ROOT / "rules" / "captions"
RULES = (ROOT / "rules" / "report.smk").read_text("utf-8")


def keys(name):
    """The keys of a dictionary in the rules."""
    (body,) = re.findall(rf"^{name} = {{(.*?)^}}", RULES, re.M | re.S)
    return re.findall(r'^    "(\w+)":', body, re.M)


def rendered(caption, **about):
    """A caption as Snakemake renders it; a warning is an error."""
    environment = Environment(trim_blocks=True, lstrip_blocks=True)
    text = environment.from_string((CAPTIONS / f"{caption}.rst").read_text("utf-8"))
    settings = {"halt_level": 2, "report_level": 5}
    source = text.render(snakemake=SimpleNamespace(**about))
    return publish_parts(source, writer="html", settings_overrides=settings)["body"]


@pytest.mark.parametrize("scale", ["paper", "fine"])
@pytest.mark.parametrize("figure", FIGURES)
def test_a_figure_says_what_it_shows_and_how_it_was_made(figure, scale, monkeypatch):
    monkeypatch.chdir(ROOT)
    loaded = config.load("config.yaml")
    experiments = {"cooling": config.experiment(loaded, "cooling", scale)}
    experiments["waves"] = config.experiment(loaded, "waves", "small")
    wildcards = SimpleNamespace(figure=figure, folder="")
    params = SimpleNamespace(experiments=experiments)
    text = re.sub(r"\s+", " ", rendered("figure", wildcards=wildcards, params=params))
    assert figure in keys("TITLES")
    assert "What to notice." in text
    assert "160 particles in a box of 100 × 100" in text
    assert "21 values from -0.95 to 1" in text
    seeds = "4 seeds of each point" if scale == "paper" else "a standard error of 0.002 takes"
    assert seeds in text
    assert "sawtooth, reversed_sawtooth, triangle, sine" in text


@pytest.mark.parametrize("figure", ["accuracy", "coverage"])
def test_a_study_says_how_it_was_made(figure, monkeypatch):
    monkeypatch.chdir(ROOT)
    loaded = config.load("config.yaml")
    studies = {name: config.study(loaded, name, "paper")["study"] for name in accuracy.STUDIES}
    wildcards = SimpleNamespace(study_figure=figure, folder="")
    text = rendered("study", wildcards=wildcards, params=SimpleNamespace(studies=studies))
    assert figure in keys("TITLES") and "What to notice." in text and "repetitions 600" in text


@pytest.mark.parametrize("document", keys("DOCUMENTS"))
def test_a_document_says_what_it_is(document, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert "<p>" in rendered("document", wildcards=SimpleNamespace(document=document))


def test_pictures_of_hard_cases_have_captions():
    pictures = [name for name in keys("TITLES") if name.startswith("hard_cases")]
    assert len(pictures) == 4
    for name in pictures:
        assert "What to notice." in rendered(name, params=SimpleNamespace(size="--full"))


def test_the_showcase_says_how_it_was_made():
    settings = config.showcase(config.load(ROOT / "config.yaml"), "paper")
    text = rendered("clustering", params=SimpleNamespace(showcase=settings))
    assert "particles 200000" in text
