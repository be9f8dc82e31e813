"""Profiles across a gas, and averages of R from them.

Over the slices of a vibrated bed, and the phases of its floor: density, temperatures, R, and the
collision frequency. Lun's formula is about averages over collisions; temperatures of slices,
weighted by the collisions there, should therefore be closer to it than the mean of R(t). For a
sheared gas: deviations of the flow from a linear one, and the quantities in theory.transport.

A temperature is m times the mean square velocity along an axis, or q times the mean square spin.
The mean velocity along the axis of the slices is subtracted, slice by slice and phase by phase; in
a sheared gas the mean flow and the mean spin are.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.tasks import (
    Estimate,
    dataset,
    markdown,
    read_variables,
    slices_along,
    stack_rows,
    table_cell,
    with_minus_signs,
)
from roughgas.theory import lun_ratio, moment_of_inertia, shear_factor

from .tasks import point_name

VARIABLES = Path(__file__).with_name("variables.yaml")
BED_COLUMNS = {
    "R": "mean of R(t)",
    "R_quarters": "at the paper's four phases",
    "R_ratio_of_means": "ratio of means",
    "R_weighted": "slices and phases, by their contacts",
    "R_level": "pairs at one height, by relative speed",
    "R_meeting": "those near that approach",
    "R_collisional": "at contacts",
    "R_lun": "Lun's formula",
    "speed_factor": "{g³}/{g}, over Maxwellian",
}
SHEARED_COLUMNS = {
    "theta": "θ",
    "factor": "theory.shear's factor",
    "rate": "g",
    "stress": "p",
    "difference": "d",
    "spin_over_vorticity": "spin over half the vorticity",
    "flow_deviation": "flow beyond linear, over thermal",
    "R_collisional": "R at contacts, flow included",
}
QUARTERS = 4
"""Phases of the floor that the paper samples."""
GRID = ("phase", "slice")


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return profiles and averages at every point, from all tasks; errors are over runs."""
    points, rows = settings["points"], []
    for point in points:
        runs = [task_results[f"{point_name(point)}-{k}"] for k in range(settings["runs"])]
        sheared = float(runs[0].shear_rate) > 0.0
        run_averages = [
            _run_averages(run, point) | (_shear_numbers(run) if sheared else NO_SHEAR)
            for run in runs
        ]
        rows.append(_estimates(run_averages) | _pooled(runs, point))
    values = stack_rows(rows) | {"point": [point_name(point) for point in points]}
    values |= {key: [point[key] for point in points] for key in ("experiment", "r", "beta")}
    values["phase"] = np.arange(settings["phases"]) / settings["phases"]
    values["slice"] = range(settings["slices"])
    return dataset(read_variables(VARIABLES), values, seed=settings["seed"], runs=settings["runs"])


def fields(run: xr.Dataset, width: float) -> xr.Dataset:
    """Return density, mean velocity and temperatures in the slices at each phase, (phase, slice).

    They are NaN in empty slices. `width` is the width of a slice in a.
    """
    number = run.particles.where(run.particles > 0)
    rising, spin = run.v / number, _mean_spin(run)
    values = {
        "density": run.particles / (run.samples * run.area * width),
        "velocity": rising,
        "T_across": run.uu / number,
        "T_along": run.vv / number - rising**2,
        "T_rot": run.inertia * (run.ww / number - spin**2) / (2 * run.dimension - 3),
    }
    return xr.Dataset(values)


def translational(temperatures: xr.Dataset, dimension: int) -> xr.DataArray:
    """Return the mean of the translational temperature over all axes."""
    return ((dimension - 1) * temperatures.T_across + temperatures.T_along) / dimension


def ratio_at_contacts(sums: xr.Dataset, inertia: float) -> xr.DataArray:
    """Return R by averages over contacts: q <v_r^2>/(<v_t^2> + q <v_r^2>)."""
    rotational = inertia * sums["v_r^2"]
    return rotational / (rotational + sums["v_t^2"]).where(sums.contacts > 0)


def _run_averages(run, point) -> dict[str, np.ndarray]:
    """Return all quantities with an error bar: by slice, by phase, and scalars."""
    run_fields, q, D = fields(run, point["slice"]), float(run.inertia), int(run.dimension)
    mean = run_fields.weighted(run.particles).mean("phase")
    measured = float(run.samples) * point["period"]
    particles = run.particles.sum("phase") / (run.samples * run.sizes["phase"])
    meeting = run_fields.weighted(run.contacts).mean(GRID)
    E_trans, E_rot, quarter = run.E_trans, run.E_rot, run.sizes["phase"] // QUARTERS
    R = run.R / run.samples
    averages = {
        "density": run_fields.density.mean("phase"),
        "T_across": mean.T_across,
        "T_along": mean.T_along,
        "T_rot": mean.T_rot,
        "R_slice": _ratio(mean.T_rot, translational(mean, D)),
        "R_slice_collisional": ratio_at_contacts(run.sum("phase"), q),
        "frequency": 2 * run.contacts.sum("phase") / (particles.where(particles > 0) * measured),
        "E_trans_phase": E_trans / run.samples,
        "E_rot_phase": E_rot / run.samples,
        "R_phase": R,
        "R_collisional_phase": ratio_at_contacts(run.sum("slice"), q),
        "R": R.mean(),
        "R_quarters": R[:: max(1, quarter)].mean(),
        "R_ratio_of_means": _ratio(E_rot.sum(), E_trans.sum()),
        "R_weighted": _ratio(meeting.T_rot, translational(meeting, D)),
        "R_collisional": ratio_at_contacts(run.sum(GRID), q),
        **_pair_averages(run),
    }
    return {name: average.values for name, average in averages.items()}


def _pair_averages(run):
    """Return R by averages over pairs, weighted by their relative speed g as contacts are.

    {b^2 (2 b)^(D-2)} = D/6 (McNamara & Luding 1998, above Lun's formula). `speed_factor` is
    {g^3}/{g} over its Maxwellian value (D + 1)/D {g^2}.
    """
    q, D, number = run.inertia, run.dimension, run.pairs.where(run.pairs > 0)
    weighted = q * run["g s^2"] / (q * run["g s^2"] + D / 6 * run["g^3"].where(run.g > 0))
    factor = run["g^3"] / run.g / ((D + 1) / D * run["g^2"] / number)
    ratios = {f"R_{name}": weighted.sel(company=name) for name in ("level", "meeting")}
    return ratios | {"speed_factor": factor.sel(company="level")}


def _shear_numbers(run) -> dict[str, float]:
    """Return the scalars of a sheared gas, over all slices: see theory.transport.

    `theta` is the ratio of E_rot and E_trans, without the mean spin of each instant;
    `flow_deviation` the root mean square velocity of slices, beyond the linear mean flow, over the
    thermal velocity of a particle.
    """
    total = run.sum(GRID)
    number, rate = float(total.particles), float(run.shear_rate)
    T_x, T_y = float(total.uu) / number, float(total.vv) / number
    T, spin = (T_x + T_y) / 2, float(total.w) / number
    stress, difference = -float(total.uv) / number / T, (T_x - T_y) / (2 * T)
    flow = (run.u.sum("phase") / run.particles.sum("phase")).values
    return {
        "theta": float(run.E_rot.sum() / run.E_trans.sum()),
        "factor": float(shear_factor(rate / math.sqrt(T), stress, difference)),
        "rate": rate / math.sqrt(T),
        "stress": stress,
        "difference": difference,
        "spin_over_vorticity": -spin / (rate / 2),
        "flow_deviation": math.sqrt(np.nanmean(flow**2) / T),
    }


NO_SHEAR = dict.fromkeys([name for name in SHEARED_COLUMNS if name != "R_collisional"], math.nan)


def _pooled(runs, point) -> dict[str, Any]:
    """Return all quantities without an error bar: fields of all runs together, and constants of the
    point."""
    first, total = runs[0], xr.concat(runs, "run").sum("run")
    names = ("area", "dimension", "inertia", "shear_rate")
    pooled = total.assign({name: first[name] for name in names})
    pooled_fields = fields(pooled, point["slice"])
    values = {f"{name}_at_phase": field.values for name, field in pooled_fields.items()}
    measured = float(total.samples) * point["period"] / total.sizes["phase"]
    meeting = 2 * total.contacts / (total.particles / total.samples * measured)
    q = float(first.inertia)
    return values | {
        "frequency_at_phase": meeting.where(total.particles > 0).values,
        "height": point["slice"] * (np.arange(total.sizes["slice"]) + 0.5),
        "R_lun": float(lun_ratio(float(point["beta"]), q)),
        "inertia": q,
        "dimension": int(first.dimension),
        "particles": round(float(first.particles.sum() / first.samples / first.sizes["phase"])),
        "measured": float(total.samples) * point["period"],
        "collisions": int(total.collisions),
        "imbalance": max(imbalance(run) for run in runs),
        "cpu_seconds": float(total.cpu_seconds),
    }


def imbalance(run: xr.Dataset) -> float:
    """Return the relative difference between energies summed over slices and the energies of the
    whole gas.

    The spins of a sheared gas are left out, since the mean spin of each instant is subtracted
    there.
    """
    D, sums = int(run.dimension), run.sum("slice")
    squares = {"E_trans": ((D - 1) * sums.uu + sums.vv) / D}
    if not run.shear_rate > 0:
        squares["E_rot"] = run.inertia * sums.ww / (2 * D - 3)
    number = sums.particles / run.samples
    misses = [abs(square / (2 * number * run[name]) - 1).max() for name, square in squares.items()]
    return max(map(float, misses))


def _estimates(averages_of_runs) -> dict[str, Estimate]:
    """Return means over runs and their standard errors."""
    rows, root = stack_rows(averages_of_runs), math.sqrt(len(averages_of_runs))
    return {
        name: Estimate(values.mean(axis=0), values.std(axis=0, ddof=1) / root)
        for name, values in rows.items()
    }


def _mean_spin(run):
    """Return the mean spin of a sheared gas; a bed has none."""
    return (run.w.sum() / run.particles.sum()).where(run.shear_rate > 0, 0.0)


def _ratio(rotational, trans):
    return rotational / (rotational + trans)


def table(data: xr.Dataset) -> str:
    """Return R of beds by each average, and the factors of R in sheared gases, Markdown."""
    points = slices_along(data, "point")
    beds = [point for point in points if np.isnan(point.theta)]
    head = ["bed", *BED_COLUMNS.values()]
    rows = [[point_label(bed), *(_cell_text(bed, name) for name in BED_COLUMNS)] for bed in beds]
    sheared = ["sheared gas", *SHEARED_COLUMNS.values()]
    gases = [
        [point_label(gas), *(_cell_text(gas, name) for name in SHEARED_COLUMNS)]
        for gas in points
        if np.isfinite(gas.theta)
    ]
    return (
        f"## Averages of R in a bed\n\n{markdown(head, rows)}\n"
        f"## Sheared gases\n\n{markdown(sheared, gases)}"
    )


def point_label(point: xr.Dataset) -> str:
    """Return the label of a point: particles, r, beta and an unusual q."""
    shape = "spheres" if int(point.dimension) == 3 else "disks"
    usual = moment_of_inertia(int(point.dimension))
    q = "" if float(point.inertia) == usual else f", q = {float(point.inertia):g}"
    beta = with_minus_signs(str(point.beta.values))
    return f"{shape}, r = {point.r.values}, β = {beta}{q}"


def _cell_text(data, name):
    """Return a value as text, with its error if it has one."""
    if f"{name}_stderr" not in data:
        return f"{float(data[name]):.4f}"
    return table_cell(data, name, "")
