"""Spoiled files: with other bytes, attributes or variables, and files of other programs."""

import shutil
from pathlib import Path

import netCDF4
import numpy as np
from hypothesis import strategies as st
from schedules import BRIEF
from tests.entry import main
from tests.files import COMBINE, DRAW, write_all

from roughgas.base import sorted_json
from roughgas.data.netcdf import CHECKSUM_PREFIX

VALUES = [3, -0.5, 1e300, float("nan"), "x", "", "{}", "[]", "null", "a.b", "é", "\n", [1, 2], []]
TEXTS = ["", "text", "[]", "{}", "null", '{"@graph": 3}', '{"@graph": [3]}', "CDF\x01"]
TEXTS += ["\x89HDF\r\n"]
SPIN = {"spin": {"inertia": 0.5}}
SETTINGS = sorted_json({"particles": 5, "box": [20, 20], "effects": SPIN, "schedule": BRIEF})
NUMBERS = [np.nan, np.inf, -np.inf, -1.0, 1.5, 1e300, 0.0]
NAMES = ["file.nc", "file.json", "file", "-file.nc", "a b.nc", "é.nc", "$(x).nc", "=1.nc"]
PAPER = Path(__file__).parents[2] / "studies" / "paper"
COMMANDS = ["show {}", "show --json {}", "reduce {} -o out.nc", "table {} -o out.csv"]
COMMANDS += [f"claims {PAPER} {{}} --title a --json out.json --markdown out.md"]
COMMANDS += ["explore {} --points . -o out.html", "document {} -o out.html"]
COMMANDS += ["run_times {} -o out.md"]
COMMANDS += [COMBINE, DRAW]
COMMANDS += [
    "plot {} -o out.png",
    f"figure {PAPER} fig1a {{}} --shows vibrated -o out.png",
    f"figure {PAPER} fig2b {{}} --shows cooling -o out.png",
]
COMMANDS += ["figure studies/waves waves {} --shows waves.waves -o out.png"]
COMMANDS += ["run gas --settings SETTINGS --r=0.9 --beta=0 --from {} -o out.nc"]
"""Command lines; {} stands for the file, SETTINGS for the settings of a tiny gas."""
SHOW_COMMANDS = [
    f"show{option}{' {}' * times}" for option in ("", " --json") for times in range(1, 9)
]
"""Command lines that take a dataset of any kind."""


def real_files(folder):
    """Paths of a valid file of each kind, and of a point with its final state."""
    folder.mkdir(exist_ok=True)
    state = folder / "state.nc"
    arguments = ["--r=0.9", "--beta=0", "--keep-state", "-o", str(state)]
    assert main(["run", "gas", "--settings", SETTINGS, *arguments]) == 0
    return [*write_all(folder).values(), folder / "task.nc", state, state]


def unspoiled_file(source, target):
    """Copy the file unchanged."""
    shutil.copy(source, target)
    return st.just("as it was")


@st.composite
def spoiled_bytes(draw, source, target):
    """Flip, cut or repeat some bytes of a file, and keep its old checksum."""
    content = bytearray(source.read_bytes())
    sealed = content.rfind(CHECKSUM_PREFIX)
    for _ in range(draw(st.integers(1, 3))):
        position = draw(st.integers(0, len(content) - 1))
        damage = draw(st.sampled_from(["flip", "flip", "cut", "zeros", "repeat"]))
        if damage == "flip":
            content[position] ^= 1 << draw(st.integers(0, 7))
        elif damage == "zeros":
            content[position : position + 64] = bytes(len(content[position : position + 64]))
        elif damage == "repeat":
            content[position:position] = content[position : position + 64]
        elif position:
            del content[position:]
    target.write_bytes(content)
    unharmed = content[:sealed] == source.read_bytes()[:sealed]  # only the end has changed
    return "as it was" if unharmed else "damaged"


@st.composite
def spoiled_contents(draw, source, target):
    """Change attributes or variables, as another program might."""
    shutil.copy(source, target)
    with netCDF4.Dataset(target, "a") as file:
        group = draw(st.sampled_from([file, *file.groups.values()]))
        for _ in range(draw(st.integers(1, 3))):
            if group.variables and draw(st.booleans()):
                _spoil_variable(draw, group)
            else:
                _spoil_attribute(draw, group)
    return "changed"


def _spoil_attribute(draw, group):
    attributes = [name for name in group.ncattrs() if not name.startswith("_")]
    name = draw(
        st.sampled_from([*attributes, "swept", "study", "theory", "scale", "inertia", "mu"])
    )
    if name in attributes and draw(st.booleans()):
        group.delncattr(name)
    else:
        value = draw(st.sampled_from(VALUES))
        group.setncattr(name, value)


def _spoil_variable(draw, group):
    name = draw(st.sampled_from(sorted(group.variables)))
    variable, change = group[name], draw(st.sampled_from(["rename", "values", "attribute"]))
    if change == "rename" and f"other_{name}" not in group.variables:
        group.renameVariable(name, f"other_{name}")
    elif change == "values" and variable.dtype is not str and variable.size:
        values = np.array(variable[...], variable.dtype).ravel()
        number = draw(st.sampled_from(NUMBERS))
        fits_integer = variable.dtype.kind == "i" and np.isfinite(number) and abs(number) < 100
        if variable.dtype.kind == "f" or fits_integer:
            values[draw(st.integers(0, values.size - 1))] = number
            variable[...] = values.reshape(variable.shape)
    elif change == "attribute":
        name = draw(st.sampled_from(["units", "reduced_units", "long_name", "flag_meanings"]))
        variable.setncattr(name, draw(st.sampled_from(VALUES)))


@st.composite
def foreign_files(draw, source, target):
    """A file of another program: text, bytes, a folder, or netCDF of another form."""
    kind = draw(st.sampled_from(["text", "text", "bytes", "netCDF", "folder"]))
    if kind == "text":
        target.write_text(draw(st.sampled_from(TEXTS)), "latin-1")
    elif kind == "bytes":
        target.write_bytes(draw(st.binary(max_size=200)))
    elif kind == "folder":
        target.mkdir()
    else:
        _write_netcdf(draw, target)
    return "foreign"


def _write_netcdf(draw, target):
    form = draw(st.sampled_from(["NETCDF4", "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET"]))
    # chunked variables may have sizes that their data do not fill
    sizes = st.sampled_from([1, 3, *([0, 10**5] if form == "NETCDF4" else [])])
    with netCDF4.Dataset(target, "w", format=form) as file:
        for dimension in ("r", "beta", "seed", "sample"):
            file.createDimension(dimension, draw(sizes))
        for name in ("r", "beta", "n_seeds", "E_trans", "equilibrated", "R", "collisions", "time"):
            dimensions = draw(st.sampled_from([(), ("r",), ("r", "beta"), ("seed",), (name,)]))
            if all(dimension in file.dimensions for dimension in dimensions) and draw(
                st.booleans()
            ):
                chunks = {"zlib": True} if form == "NETCDF4" and dimensions else {}
                file.createVariable(
                    name, draw(st.sampled_from(["f8", "i4", "S1"])), dimensions, **chunks
                )
        for name in ("experiment", "scale", "dimension", "particles", "study", "task", "beta"):
            file.setncattr(name, draw(st.sampled_from([2, 40, 0.5, "vibrated", "coverage"])))


@st.composite
def attempts(draw, sources, folder):
    """Spoil a file in a folder; return its condition ("damaged", ...) and a command line on it."""
    target = folder / draw(st.sampled_from(NAMES))
    source = draw(st.sampled_from(sources))
    spoilers = [spoiled_bytes, spoiled_contents, spoiled_contents, foreign_files]
    spoil = unspoiled_file if draw(st.booleans()) else draw(st.sampled_from(spoilers))
    outcome = draw(spoil(source, target))
    name = f"./{target.name}" if target.name.startswith("-") else target.name
    words = draw(st.sampled_from(SHOW_COMMANDS if spoil is unspoiled_file else COMMANDS)).split(" ")
    return outcome, [SETTINGS if word == "SETTINGS" else word.format(name) for word in words]
