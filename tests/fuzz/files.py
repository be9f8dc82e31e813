"""Files that are spoiled: real ones byte by byte, attribute by attribute and variable by variable,
and those of other programs."""

import shutil

import netCDF4
import numpy as np
from hypothesis import strategies as st
from schedules import BRIEF
from tests.entry import main
from tests.files import write_all

from roughgas.config import as_text
from roughgas.data.netcdf import SEAL

VALUES = [3, -0.5, 1e300, float("nan"), "x", "", "{}", "[]", "null", "a.b", "é", "\n", [1, 2], []]
TEXTS = ["", "text", "[]", "{}", "null", '{"@graph": 3}', '{"@graph": [3]}', "CDF\x01"]
TEXTS += ["\x89HDF\r\n"]
SPIN = {"spin": {"inertia": 0.5}}
SETTINGS = as_text({"particles": 5, "box": [20, 20], "effects": SPIN, "schedule": BRIEF})
NUMBERS = [np.nan, np.inf, -np.inf, -1.0, 1.5, 1e300, 0.0]
NAMES = ["file.nc", "file.json", "file", "-file.nc", "a b.nc", "é.nc", "$(x).nc", "=1.nc"]
COMMANDS = ["show {}", "show --json {}", "reduce {} -o out.nc", "table {} -o out.csv"]
COMMANDS += ["claims {} --json out.json --markdown out.md"]
COMMANDS += ["explore {} --points . -o out.html", "document {} -o out.html"]
COMMANDS += ["run_times {} -o out.md"]
COMMANDS += ["accuracy_table {} -o out.md", "accuracy_data {} -o out.nc"]
COMMANDS += ["plot {} -o out.png", "figure fig1a {} -o out.png", "figure fig2b {} -o out.png"]
COMMANDS += ["study_figure studies/waves waves {} --shows waves.waves -o out.png"]
COMMANDS += ["accuracy_figure coverage {} -o out.png"]
COMMANDS += ["run gas --settings SETTINGS --r=0.9 --beta=0 --from {} -o out.nc"]
"""Command lines, {} being the file, and SETTINGS those of a tiny gas."""
FITTING = [f"show{how}{' {}' * times}" for how in ("", " --json") for times in range(1, 9)]
"""Those that take a dataset of any kind."""


def real_files(folder):
    """A file of each kind, as written, and a point with the state that it has ended in."""
    folder.mkdir(exist_ok=True)
    state = folder / "state.nc"
    place = ["--r=0.9", "--beta=0", "--keep-state", "-o", str(state)]
    assert main(["run", "gas", "--settings", SETTINGS, *place]) == 0
    return [*write_all(folder).values(), folder / "task.nc", state, state]


def unspoiled(source, target):
    """The file as it is."""
    shutil.copy(source, target)
    return st.just("as it was")


@st.composite
def spoiled_bytes(draw, source, target):
    """Flip, cut or repeat some bytes of a file; its checksum is the old one, where it is left."""
    content = bytearray(source.read_bytes())
    sealed = content.rfind(SEAL)
    for _ in range(draw(st.integers(1, 3))):
        at = draw(st.integers(0, len(content) - 1))
        what = draw(st.sampled_from(["flip", "flip", "cut", "zeros", "repeat"]))
        if what == "flip":
            content[at] ^= 1 << draw(st.integers(0, 7))
        elif what == "zeros":
            content[at : at + 64] = bytes(len(content[at : at + 64]))
        elif what == "repeat":
            content[at:at] = content[at : at + 64]
        elif at:
            del content[at:]
    target.write_bytes(content)
    unharmed = content[:sealed] == source.read_bytes()[:sealed]  # the end alone was hit
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
    known = [name for name in group.ncattrs() if not name.startswith("_")]
    name = draw(st.sampled_from([*known, "swept", "study", "theory", "scale", "inertia", "mu"]))
    if name in known and draw(st.booleans()):
        group.delncattr(name)
    else:
        value = draw(st.sampled_from(VALUES))
        group.setncattr(name, value)


def _spoil_variable(draw, group):
    name = draw(st.sampled_from(sorted(group.variables)))
    variable, what = group[name], draw(st.sampled_from(["rename", "values", "attribute"]))
    if what == "rename" and f"other_{name}" not in group.variables:
        group.renameVariable(name, f"other_{name}")
    elif what == "values" and variable.dtype is not str and variable.size:
        values = np.array(variable[...], variable.dtype).ravel()
        wrong = draw(st.sampled_from(NUMBERS))
        whole = variable.dtype.kind == "i" and np.isfinite(wrong) and abs(wrong) < 100
        if variable.dtype.kind == "f" or whole:
            values[draw(st.integers(0, values.size - 1))] = wrong
            variable[...] = values.reshape(variable.shape)
    elif what == "attribute":
        name = draw(st.sampled_from(["units", "reduced_units", "long_name", "flag_meanings"]))
        variable.setncattr(name, draw(st.sampled_from(VALUES)))


@st.composite
def foreign_files(draw, source, target):
    """What another program has written: text, or netCDF of another form."""
    what = draw(st.sampled_from(["text", "text", "bytes", "netCDF", "folder"]))
    if what == "text":
        target.write_text(draw(st.sampled_from(TEXTS)), "latin-1")
    elif what == "bytes":
        target.write_bytes(draw(st.binary(max_size=200)))
    elif what == "folder":
        target.mkdir()
    else:
        _write_netcdf(draw, target)
    return "foreign"


def _write_netcdf(draw, target):
    form = draw(st.sampled_from(["NETCDF4", "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET"]))
    # what is chunked claims sizes that it does not fill
    sizes = st.sampled_from([1, 3, *([0, 10**5] if form == "NETCDF4" else [])])
    with netCDF4.Dataset(target, "w", format=form) as file:
        for dim in ("r", "beta", "seed", "sample"):
            file.createDimension(dim, draw(sizes))
        for name in ("r", "beta", "n_seeds", "E_trans", "equilibrated", "R", "collisions", "time"):
            dims = draw(st.sampled_from([(), ("r",), ("r", "beta"), ("seed",), (name,)]))
            if all(dim in file.dimensions for dim in dims) and draw(st.booleans()):
                chunks = {"zlib": True} if form == "NETCDF4" and dims else {}
                file.createVariable(name, draw(st.sampled_from(["f8", "i4", "S1"])), dims, **chunks)
        for name in ("experiment", "scale", "dimension", "particles", "study", "task", "beta"):
            file.setncattr(name, draw(st.sampled_from([2, 40, 0.5, "vibrated", "coverage"])))


@st.composite
def tries(draw, sources, folder):
    """Spoil a file in a folder; return what became of it, and a command line about it."""
    target = folder / draw(st.sampled_from(NAMES))
    source = draw(st.sampled_from(sources))
    spoilers = [spoiled_bytes, spoiled_contents, spoiled_contents, foreign_files]
    spoil = unspoiled if draw(st.booleans()) else draw(st.sampled_from(spoilers))
    became = draw(spoil(source, target))
    name = f"./{target.name}" if target.name.startswith("-") else target.name
    parts = draw(st.sampled_from(FITTING if spoil is unspoiled else COMMANDS)).split(" ")
    return became, [SETTINGS if part == "SETTINGS" else part.format(name) for part in parts]
