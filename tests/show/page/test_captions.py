"""Captions of the report: there for every product, valid, with the parameters of the run."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from docutils.core import publish_parts
from jinja2 import Environment
from tests.houses import FOLDERS

from roughgas import config, studies
from roughgas.show.catalogue import DOCUMENTS, figures_of
from roughgas.show.studies import captions

ROOT = Path(__file__).parents[3]
CAPTIONS = ROOT / "rules" / "captions"


def rendered(caption, **about):
    """A caption as Snakemake renders it; a warning is an error."""
    environment = Environment(trim_blocks=True, lstrip_blocks=True)
    text = environment.from_string((CAPTIONS / f"{caption}.rst").read_text("utf-8"))
    settings = {"halt_level": 2, "report_level": 5}
    source = text.render(snakemake=SimpleNamespace(**about))
    return publish_parts(source, writer="html", settings_overrides=settings)["body"]


def caption_of(name):
    """The words of a figure's own caption, as the rules hand them on."""
    return (CAPTIONS / f"{name}.rst").read_text("utf-8")


@pytest.fixture(scope="module")
def loaded():
    return config.load(ROOT / "tests" / "experiments.yaml")


@pytest.mark.parametrize("figure", figures_of("paper"))
def test_a_figure_says_what_it_shows_and_how_it_was_made(figure, loaded):
    experiments = {"cooling": config.experiment(loaded, "cooling", "paper")}
    experiments["waves"] = config.experiment(loaded, "waves", "small")
    wildcards = SimpleNamespace(figure=figure, folder="")
    params = SimpleNamespace(experiments=experiments, caption=caption_of(figure))
    text = re.sub(r"\s+", " ", rendered("figure", wildcards=wildcards, params=params))
    assert "What to notice." in text
    assert "160 particles in a box of 100 × 100" in text
    assert "21 values from -0.95 to 1" in text
    assert "4 seeds of each point" in text
    assert "sawtooth, reversed_sawtooth, triangle, sine" in text


@pytest.mark.parametrize("figure", figures_of("accuracy", "questions"))
def test_a_study_says_how_it_was_made(figure, loaded):
    settings = {name: config.study(loaded, name, "paper")["study"] for name in studies.STUDIES}
    wildcards = SimpleNamespace(study_figure=figure, folder="")
    params = SimpleNamespace(studies=settings, caption=caption_of(figure))
    text = rendered("study", wildcards=wildcards, params=params)
    assert "What to notice." in text and "repetitions 600" in text


@pytest.mark.parametrize("document", DOCUMENTS.values(), ids=DOCUMENTS)
def test_a_document_says_what_it_is(document):
    assert "<p>" in rendered("document", params=SimpleNamespace(caption=document.caption))


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda one: one.name)
def test_a_figure_of_a_study_says_what_it_shows(folder, loaded):
    """README.md has each of its figures, and what follows it is a caption."""
    figures = config.load(ROOT / "config.yaml")["folders"][folder.name]["figures"]
    found = captions(folder, [*figures])
    assert found.keys() == figures.keys()
    for caption in found.values():
        experiments = {"cooling": config.experiment(loaded, "cooling", "paper")}
        params = SimpleNamespace(caption=caption, experiments=experiments)
        text = rendered("figure", wildcards=SimpleNamespace(folder=""), params=params)
        assert "What to notice." in text and "21 values from -0.95 to 1" in text
