"""Reduced datasets of experiments, over r and beta: the input of figures, tables and verdicts."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import InputError, Interval, unknown_name_error
from roughgas.data import netcdf, variables
from roughgas.data.netcdf import read_netcdf
from roughgas.data.variables import (
    POINT,
    POINT_COORDINATES,
    SCATTER,
    SPECIES_VARIABLES,
    STAGES,
    Variable,
    error_of,
)

if TYPE_CHECKING:
    import xarray

GRID_DIMS = ("r", "beta")
STEADY_SHARE = 0.5
"""Share of seeds in a steady state above which a point counts as steady."""
TRUST_FLAGS = tuple(
    name for name in POINT if name.endswith(variables.TRUSTED_SUFFIX) and name != "R_ci95_trusted"
)
"""Verdicts on the errors of variables other than R."""
VERDICTS = {"equilibrated", "R_ci95_trusted", "target_met", *TRUST_FLAGS}
FRACTION, NON_NEGATIVE, VERDICT_RANGE = (
    Interval("[0, 1]"),
    Interval("[0, inf)"),
    Interval("[-1, 1]"),
)
UNCERTAINTIES = {
    f"{name}_{quality}": Interval("[0, inf]")
    for name in ("R", "R_collisional", "vertical_share", "mean_spin", "E_trans", "E_rot")
    for quality in ("stderr", "dof", "ci95")
}
"""Legal values of uncertainties, which may also be NaN, unknown."""
LEGAL_VALUES = {
    **dict.fromkeys(("R", "R_ratio_of_means", "R_corrected", "vertical_share"), FRACTION),
    **dict.fromkeys(("E_trans", "E_rot", "collisions", "kernel_seconds"), NON_NEGATIVE),
    **dict.fromkeys(sorted(VERDICTS), VERDICT_RANGE),
    **UNCERTAINTIES,
}
"""Legal values of variables of any simulation."""


def read_reduced(path: str | Path) -> "xarray.Dataset":
    """Return the reduced dataset at `path` in memory; the file is closed.

    Raises InputError if the file is no reduced dataset or damaged, or if a number in it is
    impossible; OSError if it cannot be read.
    """
    data = read_netcdf(path, netcdf.REDUCED)
    _check_numbers(path, "n_seeds", data.n_seeds.values)
    for name in LEGAL_VALUES.keys() & data.keys():
        _check_numbers(path, name, data[name].values)
        check_legal(path, name, data[name].where(data.n_seeds > 0, 0.0).values)
    return data


def sweep_axes(data: "xarray.Dataset") -> list[str]:
    """Return the names of the coordinates of the sweep of a reduced dataset: r, beta and others."""
    third = variables.third_axis(data.attrs)
    return [*([third] if third else []), *GRID_DIMS]


def observed_names(data: "xarray.Dataset") -> list[str]:
    """Return the names of the results of observables in a reduced dataset, without their errors."""
    return [
        str(name)
        for name, variable in data.data_vars.items()
        if "observable" in variable.attrs and f"{name}_stderr" in data
    ]


def check_swept(data: "xarray.Dataset", name: str) -> None:
    """Raise InputError unless `name` is a variable of numbers over the sweep of a dataset."""
    is_swept = name in data.data_vars and {*sweep_axes(data)} <= {*data[name].dims}
    if not (is_swept and data[name].dtype.kind in "fiu"):
        raise unknown_name_error("--of", name, ["R"] * ("R" in data) + observed_names(data))


def read_by_name(path: str | Path) -> "dict[str, xarray.Dataset]":
    """Return the reduced dataset at `path` by its experiment, or results of tasks by their study.

    Raises InputError and OSError as `read_reduced`.
    """
    with netcdf.opened(path, netcdf.REDUCED, netcdf.STUDIES) as file:
        is_reduced = netcdf.file_type_of(file) == netcdf.REDUCED
    if not is_reduced:
        return netcdf.read_groups(path)
    data = read_reduced(path)
    return {data.attrs["experiment"]: data}


def check_legal(path: str | Path, name: str, values: Any) -> None:
    """Raise InputError unless all `values` of the variable `name` are numbers in LEGAL_VALUES.

    Messages name the file at `path`. Uncertainties may also be NaN.
    """
    _check_numbers(path, name, np.asarray(values))
    is_legal = LEGAL_VALUES[name].holds(values) | ((name in UNCERTAINTIES) & np.isnan(values))
    illegal = np.atleast_1d(values)[~np.atleast_1d(is_legal)]
    if illegal.size:
        raise InputError(f"{name} of {path}", illegal[0], LEGAL_VALUES[name].legal)


def _check_numbers(path, name, values):
    """Raise InputError unless the array `values` of a variable holds real numbers.

    Text and dates are none.
    """
    if values.dtype.kind not in "iuf":
        raise InputError(f"{name} of {path}", f"of type {values.dtype}", "be real numbers")


def particles_of(data: "xarray.Dataset") -> str:
    """Return the number of particles of a reduced dataset as text; a range if it is swept."""
    if "particles" not in data.coords:
        return str(data.attrs["particles"])
    numbers = data.coords["particles"].values
    return f"{numbers.min():g} to {numbers.max():g}"


def _derived(long_name: str, units: str = "1", dtype: str = "f8") -> Variable:
    """Return the description of a variable over the grid that files of points do not have."""
    return Variable(long_name, units, (variables.GRID_PLACEHOLDER,), dtype, over_seeds="")


def _over_grid(variable: Variable, **changes: Any) -> Variable:
    """Return the description of a point's variable with the dimensions of the grid in front.

    `changes` replace fields of the description.
    """
    dtype = variable.dtype if variable.over_seeds == "sum" else "f8"
    dims = (variables.GRID_PLACEHOLDER, *variable.dims)
    return variable._replace(dims=dims, dtype=dtype, flags="")._replace(**changes)


POOLED = ("R", "R_collisional", "contact_correlation", "vertical_share", "mean_spin")
"""Means over seeds whose error pools their scatter with the errors within each seed."""
SCATTERED = (
    *("R_ratio_of_means", "R_corrected", "R_unsubtracted", "R_drift", "E_trans", "E_rot"),
    *("input_spin_share", "decay_exponent", "shear_rate"),
    *("E_trans_species", "E_rot_species", "R_species", "T_ratio_species"),
    "mean_spin_species",
)
"""Means over seeds with an error from their scatter."""
COOLING_SERIES = ("time_series", "E_trans_series", "R_series", "collisions_per_particle")
"""Series of a cooling gas without a constant R."""
STAGE_VARIABLES = (
    *("E_rot_series", "mean_spin_series", "collisions_series"),
    *("energy_input_series", "energy_gain_series", "stage_begin", "stage_input"),
)
"""Further variables of a gas through stages with more dimensions than r and beta."""
STAGE_VARIABLES_WITH_ERRORS = ("E_trans_series", "R_series", *STAGE_VARIABLES[:-2], "stage_input")
"""Series and inputs of a gas through stages with an error from their scatter over seeds."""
SERIES_OF_SEEDS = ("E_trans_series", "E_rot_series", "collisions_series")
"""Series of a gas through stages that are also kept for each seed, as NAME_seed.

Instants of a series are correlated, and so are a curve and its unit: errors of numbers that are
derived from curves need the seeds."""

_WITHOUT_ERRORS = {
    name: _over_grid(variable)
    for name, variable in POINT.items()
    if variable.over_seeds and variable.dims in ((), ("species",))
} | {
    "species": SPECIES_VARIABLES["species"],
    "T_ratio_species": Variable(
        "E_trans_species over that of the first species: mean of the ratios of the seeds",
        dims=(variables.GRID_PLACEHOLDER, "species"),
        when=(variables.MIXTURE,),
        over_seeds="",
    ),
    "R_drift": _derived(
        "mean of R in the second half of the measured window minus that in the first"
    ),
    "R_seed": Variable("R of each seed", dims=(variables.GRID_PLACEHOLDER, "seed"), over_seeds=""),
    "R_ci95_trusted": _derived(
        "share of seeds whose R_ci95 holds the truth as often as it says; -1 where most have too "
        "little to tell"
    ),
    "equilibrated": _derived(
        "share of seeds that were found in a steady state; 0 for a mixture of two, -1 where most "
        "have too little to tell"
    ),
    **{
        name: _over_grid(
            POINT[name],
            long_name=variables.share_of_trust(name.removesuffix(variables.TRUSTED_SUFFIX)),
            flags="",
        )
        for name in TRUST_FLAGS
    },
    "target_met": _over_grid(
        POINT["target_met"],
        long_name="share of seeds whose R_stderr reached the target_stderr; -1 as for equilibrated",
        over_seeds="",
    ),
    "R_stderr_over_seeds": _derived("standard error of R from the scatter over seeds alone"),
    "R_stderr_within": _derived("standard error of R from within the files, combined over seeds"),
    **{
        name: _over_grid(POINT[name], over_seeds="") for name in (*COOLING_SERIES, *STAGE_VARIABLES)
    },
    **{
        f"{name}_seed": _over_grid(
            POINT[name],
            long_name=f"{name} of each seed",
            dims=(variables.GRID_PLACEHOLDER, "sample", "seed"),
            when=(STAGES,),
            over_seeds="",
        )
        for name in SERIES_OF_SEEDS
    },
    "source": POINT["source"]._replace(when=(STAGES,)),
    "motion": POINT["motion"]._replace(when=(STAGES,)),
    "measured_for": _derived("length of the measured window, mean over seeds", variables.TIME),
    "n_seeds": _derived("number of seeds found", dtype="i8"),
    **{name: variable._replace(dims=(name,)) for name, variable in POINT_COORDINATES.items()},
}


REDUCED: dict[str, Variable] = {}
for name, variable in _WITHOUT_ERRORS.items():
    REDUCED[name] = variable
    if name in POOLED:
        REDUCED |= variables.errors_of(name, variables.POOLED, variable)
    elif name in SCATTERED:
        REDUCED[f"{name}_stderr"] = error_of(name, SCATTER, variable)
    elif name in STAGE_VARIABLES_WITH_ERRORS:
        REDUCED[f"{name}_stderr"] = error_of(name, SCATTER, variable)._replace(when=(STAGES,))

variables.register("reduced", REDUCED)
