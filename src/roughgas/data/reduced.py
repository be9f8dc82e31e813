"""The reduced dataset of an experiment, over r and beta: what figures, tables and verdicts read."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base import InputError, Interval
from roughgas.data import netcdf
from roughgas.data.netcdf import read_netcdf
from roughgas.data.variables import (
    ENERGY,
    MIXTURE,
    NAMES,
    POINT,
    RATE,
    STAGES,
    TIME,
    Variable,
    register,
)
from roughgas.data.variables import GRID as OF_GRID

if TYPE_CHECKING:
    import xarray

GRID = ("r", "beta")
EQUILIBRATED = 0.5
"""A point counts as being in a steady state where more than this share of its seeds is."""
VERDICTS = {"equilibrated", "R_ci95_trusted", "target_met"}
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
    return Variable(long_name, units, (OF_GRID,), dtype, over_seeds="")


def _pooled(name: str) -> dict[str, Variable]:
    pooled = f"standard error of {name}: scatter over seeds and error within them, pooled"
    return {
        f"{name}_stderr": _derived(pooled),
        f"{name}_dof": _derived(f"degrees of freedom that {name}_stderr is known with"),
        f"{name}_ci95": _derived(f"half width of the 95 % interval of {name}, by Student's t"),
    }


T_RATIO = Variable(
    "E_trans_species over that of the first species: mean of the ratios of the seeds",
    dims=(OF_GRID, "species"),
    when=(MIXTURE,),
    over_seeds="",
)
OF_SPECIES = {name: POINT[name] for name in ("E_trans_species", "E_rot_species", "R_species")}
OF_SPECIES["T_ratio_species"] = T_RATIO

OF_STAGES = (
    *("E_rot_series", "collisions_series", "energy_input_series", "energy_gain_series"),
    *("stage_begin", "stage_input"),
)
"""What a gas through stages has besides, of those over more than r and beta."""
STAGED = ("E_trans_series", "R_series", *OF_STAGES[:4], "stage_input")
"""Those that carry an error there."""

REDUCED = {
    name: about._replace(
        dims=(OF_GRID, *about.dims),
        dtype=about.dtype if about.over_seeds == "sum" else "f8",
        flags="",
    )
    for name, about in POINT.items()
    if about.over_seeds and about.dims in ((), ("species",))
} | {
    "species": NAMES["species"],
    "T_ratio_species": T_RATIO,
    **{
        f"{name}_stderr": Variable(
            f"standard error of {name}: scatter over seeds",
            about.units,
            (OF_GRID, "species"),
            when=about.when,
            over_seeds="",
        )
        for name, about in OF_SPECIES.items()
    },
    "R_seed": Variable("R of each seed", dims=(OF_GRID, "seed"), over_seeds=""),
    **_pooled("R"),
    "R_ci95_trusted": _derived(
        "share of seeds whose R_ci95 holds the truth as often as it says; -1 where most have too "
        "little to tell"
    ),
    **_pooled("R_collisional"),
    **_pooled("contact_correlation"),
    "R_ratio_of_means_stderr": _derived("standard error of R_ratio_of_means: scatter over seeds"),
    "R_corrected_stderr": _derived("standard error of R_corrected: scatter over seeds"),
    "equilibrated": _derived(
        "share of seeds that were found in a steady state; 0 for a mixture of two, -1 where most "
        "have too little to tell"
    ),
    "target_met": POINT["target_met"]._replace(
        long_name="share of seeds whose R_stderr reached the target_stderr; -1 as for equilibrated",
        dims=(OF_GRID,),
        dtype="f8",
        flags="",
        over_seeds="",
    ),
    "R_stderr_over_seeds": _derived("standard error of R from the scatter over seeds alone"),
    "R_stderr_within": _derived("standard error of R from within the files, combined over seeds"),
    **{
        name: POINT[name]._replace(dims=(OF_GRID, "sample"), over_seeds="")
        for name in ("time_series", "E_trans_series", "R_series", "collisions_per_particle")
    },
    **{
        name: POINT[name]._replace(dims=(OF_GRID, *POINT[name].dims), over_seeds="")
        for name in OF_STAGES
    },
    **{
        f"{name}_stderr": Variable(
            f"standard error of {name}: scatter over seeds",
            POINT[name].units,
            (OF_GRID, *POINT[name].dims),
            when=(STAGES,),
            over_seeds="",
        )
        for name in STAGED
    },
    "source": POINT["source"]._replace(when=(STAGES,)),
    "motion": POINT["motion"]._replace(when=(STAGES,)),
    "decay_exponent_stderr": _derived("standard error of decay_exponent: scatter over seeds"),
    "shear_rate_stderr": _derived("standard error of shear_rate: scatter over seeds", RATE),
    "R_unsubtracted_stderr": _derived("standard error of R_unsubtracted: scatter over seeds"),
    "E_trans_stderr": _derived("standard error of E_trans: scatter over seeds", ENERGY),
    "E_rot_stderr": _derived("standard error of E_rot: scatter over seeds", ENERGY),
    "input_spin_share_stderr": _derived("standard error of input_spin_share: scatter over seeds"),
    "R_drift": _derived(
        "mean of R in the second half of the measured window minus that in the first"
    ),
    "R_drift_stderr": _derived("standard error of R_drift: scatter over seeds"),
    "measured_for": _derived("length of the measured window, mean over seeds", TIME),
    "n_seeds": _derived("number of seeds found", dtype="i8"),
    "r": Variable("normal restitution", dims=("r",)),
    "beta": Variable("tangential restitution", dims=("beta",)),
    "seed": Variable("seed of the random generator", dims=("seed",), dtype="i8"),
}

register("reduced", REDUCED)
