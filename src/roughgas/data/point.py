"""The dataset of one simulated point: what it may hold, and how it is written and read.

Units: particle radius a = particle mass m = time unit T = 1. A freely cooling gas has no lasting
time scale: there, times are counted in collisions per particle, energies in the initial E_trans.

Written with netCDF4 alone, since importing xarray would double the start-up time of a point's job.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from roughgas.base.files import whole_file
from roughgas.data.cf import COMMON_ATTRIBUTES, ancillary, check_schema, unit_attributes

if TYPE_CHECKING:
    import netCDF4
    import xarray

TIME = "T"
ENERGY = "m a^2 T^-2"
COOLING_UNITS = {TIME: "collisions per particle", ENERGY: "initial E_trans"}


class Variable(NamedTuple):
    """What a variable is, and how a reduced dataset combines it over seeds: "mean", "sum" or ""."""

    long_name: str
    units: str = "1"
    dims: tuple[str, ...] = ()
    dtype: str = "f8"
    over_seeds: str = "mean"
    flags: str = ""  # what 0, 1, ... mean, a word each


def _series(long_name: str, units: str = "1") -> Variable:
    return Variable(long_name, units, ("sample",), "f8", "")


VARIABLES = {
    "R": Variable("share of rotation in the energy, mean of E_rot / (E_rot + E_trans)"),
    "R_stderr": Variable("standard error of R within this file", over_seeds=""),
    "R_dof": Variable("degrees of freedom that R_stderr is known with", over_seeds=""),
    "R_ci95": Variable("half width of the 95 % interval of R, by Student's t", over_seeds=""),
    "R_ci95_trusted": Variable(
        "whether R_ci95 holds the truth as often as it says", dtype="i1", flags="untrusted trusted"
    ),
    "R_ratio_of_means": Variable("share of rotation in the energy, from the mean energies"),
    "E_trans": Variable("translational energy per degree of freedom", ENERGY),
    "E_trans_stderr": Variable("standard error of E_trans within this file", ENERGY, over_seeds=""),
    "E_rot": Variable("rotational energy per degree of freedom", ENERGY),
    "collisions": Variable("collisions simulated", dtype="i8", over_seeds="sum"),
    "kernel_seconds": Variable("CPU time spent in the kernel", "s", over_seeds="sum"),
    "equilibrated": Variable(
        "whether a steady state was found", dtype="i1", flags="drifting equilibrated"
    ),
    "measured_from": Variable("begin of the measured window", TIME),
    "autocorrelation_time": Variable("integrated autocorrelation time of R", TIME),
    "target_stderr": Variable("standard error of R that was asked for"),
    "planned_seeds": Variable("seeds that its pilot run said the point would need"),
    "planned_stderr": Variable("standard error of R expected from these"),
    "planned_collisions": Variable("collisions expected in all of them"),
    "planned_seconds": Variable("CPU time of the kernel expected in all of them", "s"),
    "contact_time": Variable("contact time t_c of the contact-time model", TIME),
    "contact_time_fraction": Variable("share of contacts changed by the contact-time model"),
    "R_unsubtracted": Variable("R with the mean flow and the mean spin left in"),
    "E_trans_unsubtracted": Variable("E_trans with the mean flow left in", ENERGY),
    "E_rot_unsubtracted": Variable("E_rot with the mean spin left in", ENERGY),
    "plateau_end": Variable("end of the plateau of R", TIME),
    "R_replica": Variable("plateau mean of R of each replica", "1", ("replica",), "f8", ""),
    "energy_imbalance": Variable("energy that the books miss, over all that was exchanged"),
    "source": Variable("what exchanged energy with the gas", "", ("source",), "str", ""),
    "motion": Variable("motion that holds the energy", "", ("motion",), "str", ""),
    "energy_input": Variable(
        "energy per particle that a source has put in since the start (negative: taken out)",
        ENERGY,
        ("source", "motion"),
        over_seeds="",
    ),
    "input_spin_share": Variable("share of rotation in the energy that all drives have put in"),
    "energy_gain": Variable(
        "change of the energy per particle, kinetic and potential, since the start",
        ENERGY,
        ("motion",),
        over_seeds="",
    ),
    "time": _series("time since the start", TIME),
    "collisions_per_particle": _series("collisions per particle since the start", TIME),
    "R_series": _series("share of rotation in the energy"),
    "R_series_stderr": _series("standard error of R_series over replicas"),
    "E_trans_series": _series("translational energy per degree of freedom", ENERGY),
    "E_rot_series": _series("rotational energy per degree of freedom", ENERGY),
}
OF_SETTINGS = ("contact_time",)
"""Variables that are in T in a cooling gas, too, since the settings are."""
CLOCKS = ("time", "collisions_per_particle")
REQUIRED = ("E_trans", "collisions", "kernel_seconds", "equilibrated")
REQUIRED_OF_SPIN = ("R", "R_stderr", "R_dof", "R_ci95", "R_ratio_of_means", "E_rot")
"""What a point holds besides where particles spin, and so has the attribute `inertia`."""
REQUIRED_ATTRIBUTES = ("experiment", "scale", "r", "beta", "seed", "dimension", "particles")
WALL_CLOCK = ("kernel_seconds", "planned_seconds")
"""The only variables that differ when the same point is run again."""


class Point(NamedTuple):
    """One (experiment, r, beta, seed): variables by the names in VARIABLES, and global attributes.

    Attributes are strings, ints or floats; REQUIRED and REQUIRED_ATTRIBUTES must be there, where
    particles spin REQUIRED_OF_SPIN, too.
    """

    variables: dict[str, Any]
    attributes: dict[str, str | int | float]


def write_point(path: str | Path, point: Point) -> None:
    """Write `point` to `path` (netCDF4), whole or not at all; parent folders are created.

    Raises ValueError for variables that VARIABLES does not know, for missing ones, and for shapes
    that disagree; OSError when the file cannot be written, as on a full disk.
    """
    import netCDF4

    lengths = _dimensions(point)
    with whole_netcdf(path) as draft, netCDF4.Dataset(draft, "w") as file:
        _fill(file, point, lengths)


def as_dataset(point: Point) -> "xarray.Dataset":
    """What `read_point` gives of the file that `write_point` makes of `point`, without that file.

    Raises ValueError as `write_point` does.
    """
    import netCDF4
    import xarray

    lengths = _dimensions(point)
    file = netCDF4.Dataset("point.nc", "w", memory=1)  # which never gets to a disk
    _fill(file, point, lengths)
    file = netCDF4.Dataset("point.nc", memory=file.close())
    return xarray.load_dataset(xarray.backends.NetCDF4DataStore(file))  # which closes it


@contextmanager
def whole_netcdf(path: str | Path) -> Iterator[Path]:
    """`whole_file` for the netCDF library, which has other names for a full disk."""
    try:
        with whole_file(path) as draft:
            yield draft
    except (RuntimeError, PermissionError) as error:
        reason = f"{error}; is the disk full or the folder read-only?"
        raise OSError(f"cannot write {path}: {reason}") from error


def read_point(path: str | Path) -> "xarray.Dataset":
    """The dataset at `path` as an xarray.Dataset in memory, the file closed.

    Raises InputError where it is of a newer schema.
    """
    import xarray

    found = xarray.load_dataset(path, engine="netcdf4")
    check_schema(found.attrs, path)
    return found


def variable_attributes(name: str, cooling: bool) -> dict[str, str]:
    """long_name and units of a variable of a cooling gas or of a forced one."""
    about = VARIABLES[name]
    counted = cooling and name not in OF_SETTINGS
    units = COOLING_UNITS.get(about.units, about.units) if counted else about.units
    return {"long_name": about.long_name, **unit_attributes(units)}


def _fill(file: "netCDF4.Dataset", point: Point, lengths: dict[str, int]) -> None:
    file.setncatts(COMMON_ATTRIBUTES | point.attributes)
    for name, length in lengths.items():
        file.createDimension(name, length)
    for name in VARIABLES:
        if name in point.variables:
            _write_variable(file, name, point.variables)


def _write_variable(file: "netCDF4.Dataset", name: str, variables: dict[str, Any]) -> None:
    _, _, dims, dtype, _, flags = VARIABLES[name]
    words = dtype == "str"
    layout = {"compression": "zlib", "complevel": 1, "shuffle": True} if dims and not words else {}
    if dtype == "f8" and name not in CLOCKS:
        layout["fill_value"] = np.nan
    target = file.createVariable(name, str if words else dtype, dims, **layout)
    target.setncatts(variable_attributes(name, cooling=CLOCKS[1] in variables))
    target.setncatts(ancillary(name, variables))
    if flags:
        values = np.arange(len(flags.split()), dtype=dtype)
        target.setncatts({"flag_values": values, "flag_meanings": flags})
    clock = next((clock for clock in CLOCKS if clock in variables), None)
    if dims == ("sample",) and clock and name not in CLOCKS:
        target.coordinates = clock
    target[...] = np.array(variables[name], object) if words else variables[name]


def _dimensions(point: Point) -> dict[str, int]:
    """Length of each dimension; raises ValueError where `point` is not what VARIABLES says."""
    _refuse("unknown variables", set(point.variables) - set(VARIABLES))
    required = REQUIRED + (REQUIRED_OF_SPIN if "inertia" in point.attributes else ())
    _refuse("missing variables", set(required) - set(point.variables))
    _refuse("missing attributes", set(REQUIRED_ATTRIBUTES) - set(point.attributes))
    lengths: dict[str, int] = {}
    for name, values in point.variables.items():
        shape, dims = np.shape(values), VARIABLES[name].dims
        if len(shape) != len(dims):
            raise ValueError(f"{name} has shape {shape}, but dimensions {dims}")
        for dim, length in zip(dims, shape, strict=True):
            if lengths.setdefault(dim, length) != length:
                raise ValueError(f"{name} has {length} values along {dim}, others {lengths[dim]}")
    return lengths


def _refuse(what: str, names: set[str]) -> None:
    if names:
        raise ValueError(f"{what} of a point: {', '.join(sorted(names))}")
