"""The reduced dataset of an experiment, over r and beta: what figures, tables and verdicts read."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import InputError, Interval
from roughgas.data import netcdf, variables
from roughgas.data.netcdf import read_netcdf
from roughgas.data.variables import NAMES, POINT, SCATTER, STAGES, Variable, error_of

if TYPE_CHECKING:
    import xarray

GRID = ("r", "beta")
EQUILIBRATED = 0.5
"""A point counts as being in a steady state where more than this share of its seeds is."""
TRUSTED = tuple(
    name for name in POINT if name.endswith(variables.TRUSTED) and name != "R_ci95_trusted"
)
"""Verdicts on the errors of other numbers than R."""
VERDICTS = {"equilibrated", "R_ci95_trusted", "target_met", *TRUSTED}
SHARE, AMOUNT, VERDICT = Interval("[0, 1]"), Interval("[0, inf)"), Interval("[-1, 1]")
UNSURE = {
    f"{name}_{quality}": Interval("[0, inf]")
    for name in ("R", "R_collisional", "E_trans", "E_rot")
    for quality in ("stderr", "dof", "ci95")
}
"""Those that may be unknown, which is NaN."""
SOUND = {
    **dict.fromkeys(("R", "R_ratio_of_means", "R_corrected"), SHARE),
    **dict.fromkeys(("E_trans", "E_rot", "collisions", "kernel_seconds"), AMOUNT),
    **dict.fromkeys(sorted(VERDICTS), VERDICT),
    **UNSURE,
}
"""What numbers of a simulation lie in, whatever was simulated."""


def read_reduced(path: str | Path) -> "xarray.Dataset":
    """Return a reduced dataset in memory; the file is closed.

    Raises InputError if the file is something else or damaged, or if a number in it cannot be
    right; OSError if there is none.
    """
    data = read_netcdf(path, netcdf.REDUCED)
    for name in SOUND.keys() & data.keys():
        check_sound(path, name, data[name].where(data.n_seeds > 0, 0.0).values)
    return data


def read_by_name(path: str | Path) -> "dict[str, xarray.Dataset]":
    """Return a reduced dataset by its experiment, or what tasks have found by their study.

    Raises InputError and OSError as `read_reduced`.
    """
    with netcdf.opened(path, netcdf.REDUCED, netcdf.STUDIES) as file:
        is_reduced = netcdf.kind_of(file) == netcdf.REDUCED
    if not is_reduced:
        return netcdf.read_groups(path)
    data = read_reduced(path)
    return {data.attrs["experiment"]: data}


def check_sound(path: str | Path, name: str, values: Any) -> None:
    """Raise InputError for the first of `values`, of one of SOUND, that cannot be right."""
    right = SOUND[name].holds(values) | ((name in UNSURE) & np.isnan(values))
    wrong = np.atleast_1d(values)[~np.atleast_1d(right)]
    if wrong.size:
        raise InputError(f"{name} of {path}", wrong[0], SOUND[name].legal)


def third_axis(attributes: Mapping[str, Any]) -> str | None:
    """Return the dimension besides r and beta of a dataset with these attributes; None without it.

    The parameter in `swept` names it: `inertia` for spin.inertia.
    """
    return attributes["swept"].rpartition(".")[2] if "swept" in attributes else None


def particles_of(data: "xarray.Dataset") -> str:
    """Return the number of particles as text: a range where it is swept."""
    if "particles" not in data.coords:
        return str(data.attrs["particles"])
    numbers = data.coords["particles"].values
    return f"{numbers.min():g} to {numbers.max():g}"


def _derived(long_name: str, units: str = "1", dtype: str = "f8") -> Variable:
    return Variable(long_name, units, (variables.GRID,), dtype, over_seeds="")


def _over_grid(about: Variable, **changes: Any) -> Variable:
    dtype = about.dtype if about.over_seeds == "sum" else "f8"
    dims = (variables.GRID, *about.dims)
    return about._replace(dims=dims, dtype=dtype, flags="")._replace(**changes)


POOLED = ("R", "R_collisional", "contact_correlation")
"""Means over seeds whose error pools their scatter with the errors of the seeds themselves."""
SCATTERED = (
    *("R_ratio_of_means", "R_corrected", "R_unsubtracted", "R_drift", "E_trans", "E_rot"),
    *("input_spin_share", "decay_exponent", "shear_rate"),
    *("E_trans_species", "E_rot_species", "R_species", "T_ratio_species"),
)
"""Those that carry an error from their scatter."""
OF_COOLING = ("time_series", "E_trans_series", "R_series", "collisions_per_particle")
"""What a cooling gas without an R for all times has over time."""
OF_STAGES = (
    *("E_rot_series", "collisions_series", "energy_input_series", "energy_gain_series"),
    *("stage_begin", "stage_input"),
)
"""What a gas through stages has besides, of those over more than r and beta."""
STAGED = ("E_trans_series", "R_series", *OF_STAGES[:4], "stage_input")
"""Those that carry an error there."""

_WITHOUT_ERRORS = {
    name: _over_grid(about)
    for name, about in POINT.items()
    if about.over_seeds and about.dims in ((), ("species",))
} | {
    "species": NAMES["species"],
    "T_ratio_species": Variable(
        "E_trans_species over that of the first species: mean of the ratios of the seeds",
        dims=(variables.GRID, "species"),
        when=(variables.MIXTURE,),
        over_seeds="",
    ),
    "R_drift": _derived(
        "mean of R in the second half of the measured window minus that in the first"
    ),
    "R_seed": Variable("R of each seed", dims=(variables.GRID, "seed"), over_seeds=""),
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
            long_name=variables.share_of_trust(name.removesuffix(variables.TRUSTED)),
            flags="",
        )
        for name in TRUSTED
    },
    "target_met": _over_grid(
        POINT["target_met"],
        long_name="share of seeds whose R_stderr reached the target_stderr; -1 as for equilibrated",
        over_seeds="",
    ),
    "R_stderr_over_seeds": _derived("standard error of R from the scatter over seeds alone"),
    "R_stderr_within": _derived("standard error of R from within the files, combined over seeds"),
    **{name: _over_grid(POINT[name], over_seeds="") for name in (*OF_COOLING, *OF_STAGES)},
    "source": POINT["source"]._replace(when=(STAGES,)),
    "motion": POINT["motion"]._replace(when=(STAGES,)),
    "measured_for": _derived("length of the measured window, mean over seeds", variables.TIME),
    "n_seeds": _derived("number of seeds found", dtype="i8"),
    "r": Variable("normal restitution", dims=("r",)),
    "beta": Variable("tangential restitution", dims=("beta",)),
    "seed": Variable("seed of the random generator", dims=("seed",), dtype="i8"),
}


REDUCED: dict[str, Variable] = {}
for name, about in _WITHOUT_ERRORS.items():
    REDUCED[name] = about
    if name in POOLED:
        REDUCED |= variables.errors_of(name, variables.POOLED, about)
    elif name in SCATTERED:
        REDUCED[f"{name}_stderr"] = error_of(name, SCATTER, about)
    elif name in STAGED:
        REDUCED[f"{name}_stderr"] = error_of(name, SCATTER, about)._replace(when=(STAGES,))

variables.register("reduced", REDUCED)
