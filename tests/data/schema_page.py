"""The pages docs/data.md and docs/trajectories.md: their tables of variables, made from the code.

    .venv/bin/python -m tests.data.schema_page

writes them anew.
"""

import re
from pathlib import Path

from roughgas.base.formatting import markdown
from roughgas.data.film import FILM
from roughgas.data.reduced import REDUCED
from roughgas.data.trajectory import TRAJECTORY
from roughgas.data.variables import COOLING, GRID, POINT, SPIN
from roughgas.studies import STUDIES
from roughgas.studies.tasks import VARIABLES
from roughgas.tasks import variables

DOCS = Path(__file__).parents[2] / "docs"
BEGIN, END = "<!-- {}: made by tests/data/schema_page.py -->\n", "<!-- until here -->\n"
ALWAYS = "always"


def tables():
    """The tables that follow from the code, by kind of file."""
    studies = {name: _study(variables(VARIABLES, name)) for name in STUDIES}
    others = {"film": _film(), "trajectory": _trajectory()}
    return {"point": _point(), "reduced": _reduced()} | others | studies


def page_of(kind):
    """The page that a table is on."""
    return DOCS / ("trajectories.md" if kind == "trajectory" else "data.md")


def written(kind):
    """A table that is on its page."""
    return page_of(kind).read_text(encoding="utf-8").split(BEGIN.format(kind))[1].split(END)[0]


def documented(kind):
    """The (dimensions, meaning) of each variable that the page knows of a kind of file."""
    lines = re.findall(r"^\| `(\w+)` \| ([^|]*) \| .* \| ([^|]*) \|$", written(kind), re.MULTILINE)
    return {name: (tuple(dims.split(", ")) if dims else (), about) for name, dims, about in lines}


def check_study(name, data):
    """Whether the combined data of a study hold all that the page documents, and nothing else."""
    found = {key: (one.dims, one.attrs["long_name"]) for key, one in data.variables.items()}
    assert documented(name) == found


def _point():
    rows = [
        (name, _dims(v.dims), v.dtype, _units(v), ", ".join(v.when) or ALWAYS, v.long_name)
        for name, v in POINT.items()
    ]
    return _table("variable | dimensions | type | units | when | meaning", rows)


def _reduced():
    rows = [
        (name, _dims(v.dims), _units(v), _combination(v), v.long_name)
        for name, v in REDUCED.items()
    ]
    return _table("variable | dimensions | units | how | meaning", rows)


def _film():
    rows = [(name, _dims(v.dims), v.dtype, v.units, v.long_name) for name, v in FILM.items()]
    return _table("variable | dimensions | type | units | meaning", rows)


def _trajectory():
    rows = [
        (name, _dims(v.dims), v.units, ", ".join(v.when) or ALWAYS, v.long_name)
        for name, v in TRAJECTORY.items()
    ]
    return _table("variable | dimensions | units | when | meaning", rows)


def _study(known):
    rows = [(name, _dims(v.dims), v.units, v.long_name) for name, v in known.items()]
    return _table("variable | dimensions | units | meaning", rows)


def _combination(v):
    if GRID not in v.dims:
        return "axis"
    return f"{v.over_seeds} over seeds" if v.over_seeds else "derived"


def _dims(dims):
    return ", ".join(dims)


def _units(v):
    """Of a driven gas; after a semicolon of a cooling one, where it has others."""
    gases = (True,) if COOLING in v.when else (False,)
    gases = (False, True) if set(v.when) <= {SPIN} else gases
    return "; ".join(dict.fromkeys(v.units_of(cooling) for cooling in gases))


def _table(head, rows):
    rows = [(f"`{name}`", *cells) for name, *cells in rows]
    return markdown(head.split(" | "), rows)


def _write(kind, table):
    text = page_of(kind).read_text(encoding="utf-8")
    begin = BEGIN.format(kind)
    page_of(kind).write_text(
        text.replace(begin + written(kind) + END, begin + table + END), "utf-8"
    )


if __name__ == "__main__":
    for kind, table in tables().items():
        _write(kind, table)
