"""Every figure and document that the pipeline makes, as catalogue.yaml registers them.

The rules, the report, and the checks of docs/results.md read this. It loads quickly, and no figure
depends on it: a new title draws nothing anew.
"""

from pathlib import Path
from typing import NamedTuple

import yaml


class FigureEntry(NamedTuple):
    """A figure, and where the report shows it."""

    name: str
    part: str  # of the catalogue: paper, beyond, hard_cases, accuracy
    heading: str
    title: str
    shows: tuple[str, ...] = ()  # experiments or studies


class DocumentEntry(NamedTuple):
    """A table or a movie that the report shows as a page of its own."""

    name: str
    heading: str
    title: str
    source: str
    caption: str


CATALOGUE = yaml.safe_load(Path(__file__).with_suffix(".yaml").read_text(encoding="utf-8"))
HEADINGS = {name: part["heading"] for name, part in CATALOGUE.items()}
FIGURES = {
    name: FigureEntry(name, part_name, part["heading"], one["title"], tuple(one.get("shows", ())))
    for part_name, part in CATALOGUE.items()
    for name, one in part["figures"].items()
}
DOCUMENTS = {
    name: DocumentEntry(name, part["heading"], **one)
    for part in CATALOGUE.values()
    for name, one in part["documents"].items()
}


def figures_of(*parts: str) -> list[str]:
    """Return the names of all figures in parts of the catalogue."""
    return [entry.name for entry in FIGURES.values() if entry.part in parts]


def shown_in(*parts: str) -> list[str]:
    """Return the experiments or studies that the figures of these parts show, each once."""
    shown = [one for name in figures_of(*parts) for one in FIGURES[name].shows]
    return list(dict.fromkeys(shown))
