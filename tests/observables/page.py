"""The page docs/observables.md: its table, made from the observables' files.

    .venv/bin/python -m tests.observables.page

writes it anew.
"""

from pathlib import Path

from roughgas.base.formatting import markdown
from roughgas.observables import KINDS

PAGE = Path(__file__).parents[2] / "docs" / "observables.md"
BEGIN, END = "<!-- observables: made by tests/observables/page.py -->\n", "<!-- until here -->\n"
HEAD = ("observable", "variables", "dimensions", "units", "when", "meaning")
SETTINGS = ("observable", "what it is", "settings")


def table():
    """What observables there are, and what lands in a dataset."""
    settings = markdown(SETTINGS, (_settings(name, kind) for name, kind in KINDS.items()))
    rows = [row for name, kind in KINDS.items() for row in _variables(name, kind)]
    return f"{settings}\n{markdown(HEAD, rows)}"


def written():
    """The table that is on the page."""
    return PAGE.read_text(encoding="utf-8").split(BEGIN)[1].split(END)[0]


def _settings(name, kind):
    told = "<br>".join(_setting(key, one) for key, one in kind.settings.items())
    return f"`{name}`", kind.__doc__, told


def _setting(key, one):
    legal = getattr(one, "interval", None) or f"[{one.low}, {one.high}]"
    given = "" if one.default is None else f", {one.default:g} if not given"
    return f"`{key}` in {legal}{given}: {one.description.removesuffix('.')}"


def _variables(name, kind):
    for variable, about in kind.variables.items():
        dims, when = ", ".join(about.dims), ", ".join(about.when)
        yield f"`{name}`", f"`{variable}`", dims, about.units, when, about.long_name


if __name__ == "__main__":
    before, after = PAGE.read_text(encoding="utf-8").split(BEGIN + written() + END)
    PAGE.write_text(before + BEGIN + table() + END + after, encoding="utf-8")
