"""Paths of the workflow's files, and regular expressions of their wildcards."""

import re
from collections.abc import Iterable
from pathlib import Path

from roughgas.config import PAPER
from roughgas.config.forms import RESERVED

POINT = "results/{scale}/{experiment}/r{r}/beta{beta}/seed{seed}.nc"
KERNEL = "results/{scale}/{experiment}/r{r}/compiled.txt"
REDUCED = "results/{scale}/{experiment}.nc"
TASK = "results/{scale}/{task_folder}/{task}.nc"
COMBINED = "results/{scale}/{combined}.nc"

NAME = r"[\w+.-]+"
"""A name without characters that are special to a shell, since wildcards appear in commands."""
EXPERIMENT = rf"(?!(?:{'|'.join(RESERVED)})[./]){NAME}"
"""An experiment, but no name that is reserved for other rules and products."""
VARIANT = rf"(?:/(?!(?:r|beta|seed)[-+.\d]){NAME})?"
"""The folder of a variant of an experiment, or nothing; not a folder of points."""


def alternatives(labels: Iterable[object]) -> str:
    """Return the regular expression of a wildcard that matches any of the labels.

    Without labels it matches no text.
    """
    return "|".join(re.escape(str(label)) for label in labels) or "(?!)"


def labels_of_point(path: str | Path) -> tuple[str, str, str]:
    """Return the labels of r, beta and the seed in the path of a point."""
    r, beta, seed = str(path).removesuffix(".nc").rsplit("/", 3)[1:]
    return r.removeprefix("r"), beta.removeprefix("beta"), seed.removeprefix("seed")


def folder_of(scale: str) -> str:
    """Return the subfolder of figures/ for a scale, such as "small/": "" for `paper`."""
    return "" if scale == PAPER else f"{scale}/"


def scale_of(folder: str) -> str:
    """Return the scale of the figures in a subfolder of figures/: `paper` for ""."""
    return Path(folder).name or PAPER


def figure_files(
    figures: Iterable[str], scale: str, suffixes: Iterable[str] = (".pdf", ".png")
) -> list[str]:
    """Return the paths of figures, given by their names, at a scale, with each of the suffixes."""
    folder, suffixes = folder_of(scale), list(suffixes)
    return [f"figures/{folder}{figure}{suffix}" for figure in figures for suffix in suffixes]


def documents(scale: str, *names: str) -> list[str]:
    """Return the paths of the report's pages for documents of the catalogue, by their names."""
    return [f"results/{scale}/{name}.html" for name in names]


def with_copy(scale: str, product: str) -> list[str]:
    """Return the paths of a product of a run, and of its copy among the figures.

    The documentation reads the copy.
    """
    return [f"results/{scale}/{product}", f"figures/{folder_of(scale)}{product}"]
