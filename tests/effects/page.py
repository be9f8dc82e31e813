"""The page docs/effects.md: its parts, and the table in it that is made from the effects' files.

    .venv/bin/python tests/effects/page.py

writes that table anew.
"""

import math
import re
from pathlib import Path

from roughgas.base.formatting import markdown
from roughgas.effects import KINDS
from roughgas.effects.settings import Numbers, OfParticles, Word

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "effects.md"
AFTER_EXPERIMENTS = "\nshowcase:\n"  # in config.yaml
BEGIN, END = "<!-- made by tests/effects/page.py -->\n", "<!-- until here -->\n"
HEAD = ("effect", "what it does", "parameters", "part in the kernel")


def section(heading):
    """The text under a heading of the second rank."""
    text = PAGE.read_text(encoding="utf-8")
    return text.split(f"\n## {heading}\n")[1].split("\n## ")[0]


def block(text, language):
    """The one fenced block of a language in a text."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return found


def rows(text):
    """The cells of every row of the tables in a text, but for their heads."""
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    cells = [[cell.strip() for cell in line[1:-1].split(" | ")] for line in lines]
    return [row for row in cells if row[0] != "---"][1:]


def config_with(experiment, folder):
    """A copy of config.yaml in a folder, with one experiment more; its path."""
    text = (ROOT / "config.yaml").read_text(encoding="utf-8")
    assert text.count(AFTER_EXPERIMENTS) == 1
    file = folder / "config.yaml"
    changed = text.replace(AFTER_EXPERIMENTS, f"\n{experiment}{AFTER_EXPERIMENTS}")
    file.write_text(changed, encoding="utf-8")
    return file


def table():
    """What effects there are, as a table; those alike share a row."""
    alike = {}
    for name, kind in KINDS.items():
        alike.setdefault(_about(kind), []).append(f"`{name}`")
    return markdown(HEAD, ((", ".join(names), *about) for about, names in alike.items()))


def written():
    """The table that is on the page."""
    return PAGE.read_text(encoding="utf-8").split(BEGIN)[1].split(END)[0]


def _about(kind):
    there = [f"`{hook}`" for hook, own in kind.hooks._asdict().items() if own]
    described = "<br>".join(_parameter(key, one) for key, one in kind.parameters.items())
    return kind.__doc__, described, ", ".join(there)


def _parameter(key, one):
    if isinstance(one, Word):
        legal, about = " or ".join(f"`{word}`" for word in one.words), one.description
    elif isinstance(one, Numbers):
        legal = f"{one.fewest} to {one.most} numbers in {one.interval}"
        about = one.description
    elif isinstance(one, OfParticles):
        legal, about = f"in {one.number.interval} or `particles`", one.number.description
    else:
        legal, about = f"in {one.interval}", one.description
    # a default that is no number of its own, as that of below_r, is described in words
    given = "" if one.default in (None, math.inf) else f", {one.default} if not given"
    return f"`{key}` {legal}{given}: {about.removesuffix('.')}"


if __name__ == "__main__":
    before, after = PAGE.read_text(encoding="utf-8").split(BEGIN + written() + END)
    PAGE.write_text(before + BEGIN + table() + END + after, encoding="utf-8")
