"""The page docs/data.md: its tables of variables, which are made from the code.

    .venv/bin/python -m tests.schema_page [STUDIES ...]

writes them anew; those of the studies, from files such as results/paper/accuracy.nc.
"""

import re
import sys
from pathlib import Path

import netCDF4
import xarray as xr

from roughgas.data import film
from roughgas.data import point as dataset
from roughgas.data.cf import unit_attributes
from roughgas.results import reduce

PAGE = Path(__file__).parents[2] / "docs" / "data.md"
BEGIN, END = "<!-- {}: made by tests/schema_page.py -->\n", "<!-- until here -->\n"
ALWAYS = "always"
SPIN, COOLING, DRIVEN = "where particles spin", "cooling gas", "driven gas"
SHEARED, TARGET, CONTACT = (
    "sheared gas",
    "with a `target_stderr`",
    "where the contact-time model acts",
)
WHEN = {  # of what is in points of some scenes only
    **dict.fromkeys(dataset.REQUIRED_OF_SPIN, SPIN),
    "R_ci95_trusted": SPIN,
    "R_series": SPIN,
    "E_rot_series": SPIN,
    "autocorrelation_time": SPIN,
    "R_series_stderr": f"{COOLING}, {SPIN}",
    "R_replica": f"{COOLING}, {SPIN}",
    "plateau_end": COOLING,
    "collisions_per_particle": COOLING,
    "time": DRIVEN,
    "input_spin_share": f"{DRIVEN}, {SPIN}",
    "R_unsubtracted": f"{SHEARED}, {SPIN}",
    "E_trans_unsubtracted": SHEARED,
    "E_rot_unsubtracted": f"{SHEARED}, {SPIN}",
    "contact_time": CONTACT,
    "contact_time_fraction": CONTACT,
    **dict.fromkeys((name for name in dataset.VARIABLES if name.startswith("planned_")), TARGET),
    "target_stderr": TARGET,
}


def tables():
    """The tables that follow from the code, by kind of file."""
    return {"point": _point(), "reduced": _reduced(), "film": _film()}


def written(kind):
    """A table that is on the page."""
    return PAGE.read_text(encoding="utf-8").split(BEGIN.format(kind))[1].split(END)[0]


def documented(kind):
    """The (dimensions, meaning) of each variable that the page knows of a kind of file."""
    lines = re.findall(r"^\| `(\w+)` \| ([^|]*) \| .* \| ([^|]*) \|$", written(kind), re.MULTILINE)
    return {name: (tuple(dims.split(", ")) if dims else (), about) for name, dims, about in lines}


def check_study(name, data):
    """Whether the page documents all that the combined data of a study hold, and nothing else."""
    found = {key: (one.dims, one.attrs["long_name"]) for key, one in data.variables.items()}
    assert documented(name) == found


def of_study(data):
    """The table of the group of a study."""
    rows = [
        (name, _dims(one.dims), _unit(one.attrs), one.attrs["long_name"])
        for name, one in data.variables.items()
    ]
    return _table("variable | dimensions | units | meaning", rows)


def _point():
    rows = [
        (name, _dims(one.dims), one.dtype, _units(name), WHEN.get(name, ALWAYS), one.long_name)
        for name, one in dataset.VARIABLES.items()
    ]
    return _table("variable | dimensions | type | units | when | meaning", rows)


def _reduced():
    rows = [
        (name, "grid", _units(name), f"{one.over_seeds} over seeds", one.long_name)
        for name, one in dataset.VARIABLES.items()
        if one.over_seeds and not one.dims and name not in reduce.DERIVED
    ]
    for name, about in reduce.DERIVED.items():
        dims = "grid, seed" if name == "R_seed" else "grid"
        rows.append((name, dims, _units(reduce.LIKE.get(name, "R")), "derived", about))
    return _table("variable | dimensions | units | how | meaning", rows)


def _film():
    rows = [
        (name, _dims(one.dims), one.dtype, _unit(unit_attributes(one.units)), one.long_name)
        for name, one in film.VARIABLES.items()
    ]
    return _table("variable | dimensions | type | units | meaning", rows)


def _dims(dims):
    return ", ".join(dims)


def _units(name):
    """Of a driven gas; after a semicolon of a cooling one, where it has others."""
    when = WHEN.get(name, ALWAYS)
    gases = (True,) if when.startswith(COOLING) else (False,)
    gases = (False, True) if when in (ALWAYS, SPIN) else gases
    found = [_unit(dataset.variable_attributes(name, cooling)) for cooling in gases]
    return "; ".join(dict.fromkeys(found))


def _unit(attributes):
    return attributes.get("reduced_units", attributes.get("units", ""))


def _table(head, rows):
    rule = "| --- " * (head.count("|") + 1) + "|\n"
    lines = (f"| `{name}` | {' | '.join(cells)} |\n" for name, *cells in rows)
    return f"| {head} |\n{rule}" + "".join(lines)


def _write(kind, table):
    text = PAGE.read_text(encoding="utf-8")
    begin = BEGIN.format(kind)
    PAGE.write_text(text.replace(begin + written(kind) + END, begin + table + END), "utf-8")


if __name__ == "__main__":
    for kind, table in tables().items():
        _write(kind, table)
    for path in sys.argv[1:]:
        with netCDF4.Dataset(path) as file:
            names = list(file.groups)
        for name in names:
            _write(name, of_study(xr.load_dataset(path, group=name, engine="netcdf4")))
