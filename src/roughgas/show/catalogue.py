"""Catalogue of all figures and documents that the pipeline makes, read from catalogue.yaml.

The rules, the report, and the checks of docs/results.md use it. It loads quickly, and no figure
depends on it: a new title does not redraw the figure.
"""

from pathlib import Path
from typing import NamedTuple

import yaml


class FigureEntry(NamedTuple):
    """A figure, with its heading and its title in the report."""

    name: str
    section: str  # of the catalogue: paper, beyond, hard_cases, accuracy
    heading: str
    title: str


class DocumentEntry(NamedTuple):
    """A table or a movie that has a separate page in the report, with the path of its `source`;
    {scale} and {folder} in paths are placeholders."""

    name: str
    heading: str
    title: str
    source: str
    caption: str


CATALOGUE = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
HEADINGS = {name: section["heading"] for name, section in CATALOGUE.items()}
FIGURES = {
    name: FigureEntry(name, section_name, section["heading"], figure["title"])
    for section_name, section in CATALOGUE.items()
    for name, figure in section["figures"].items()
}
DOCUMENTS = {
    name: DocumentEntry(name, section["heading"], **document)
    for section in CATALOGUE.values()
    for name, document in section["documents"].items()
}


def figures_of(*sections: str) -> list[str]:
    """Return the names of all figures in the catalogue's sections called `sections`, such as
    paper."""
    return [entry.name for entry in FIGURES.values() if entry.section in sections]
