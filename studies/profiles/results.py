"""Profiles across a gas, and the averages of R that they tell apart.

Over the slices of a vibrated bed, and the phases of its floor: density, temperatures, R, and how
often particles meet. Lun's formula is about averages over collisions; temperatures of slices,
weighted by the collisions there, should therefore be closer to it than the mean of R(t) is. Of a
sheared gas: whether the flow is linear, and what theory.transport needs to know.

A temperature is m times the mean square velocity along an axis, or q times that of the spin. The
mean velocity along the axis of the slices is taken from it, slice by slice and phase by phase; in a
sheared gas the mean flow and the mean spin are.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas.tasks import Estimate, along, cell, dataset, markdown, stacked, variables
from roughgas.theory import lun_ratio, moment_of_inertia, shear_factor

from .tasks import point_name

VARIABLES = Path(__file__).with_name("variables.yaml")
BED = {
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
SHEARED = {
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


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return profiles and averages at every point, from all tasks; errors are those over runs."""
    points, rows = settings["points"], []
    for point in points:
        runs = [parts[f"{point_name(point)}-{k}"] for k in range(settings["runs"])]
        sheared = float(runs[0].shear_rate) > 0.0
        found = [_found(run, point) | (_shear(run) if sheared else NO_SHEAR) for run in runs]
        rows.append(_estimates(found) | _exact(runs, point))
    every = stacked(rows) | {"point": [point_name(point) for point in points]}
    every |= {key: [point[key] for point in points] for key in ("experiment", "r", "beta")}
    every["phase"] = np.arange(settings["phases"]) / settings["phases"]
    every["slice"] = range(settings["slices"])
    return dataset(variables(VARIABLES), every, seed=settings["seed"], runs=settings["runs"])


def fields(run: xr.Dataset, width: float) -> xr.Dataset:
    """Return density, mean velocity and temperatures in the slices at each phase, (phase, slice).

    They are NaN where no particle was found. `width` is that of a slice in a.
    """
    number = run.particles.where(run.particles > 0)
    rising, spin = run.v / number, _mean_spin(run)
    found = {
        "density": run.particles / (run.samples * run.area * width),
        "velocity": rising,
        "T_across": run.uu / number,
        "T_along": run.vv / number - rising**2,
        "T_rot": run.inertia * (run.ww / number - spin**2) / (2 * run.dimension - 3),
    }
    return xr.Dataset(found)


def translational(found: xr.Dataset, dimension: int) -> xr.DataArray:
    """Return the mean of the temperature over all axes."""
    return ((dimension - 1) * found.T_across + found.T_along) / dimension


def ratio_at_contacts(sums: xr.Dataset, inertia: float) -> xr.DataArray:
    """Return R by averages over contacts: q <v_r^2>/(<v_t^2> + q <v_r^2>)."""
    rotational = inertia * sums["v_r^2"]
    return rotational / (rotational + sums["v_t^2"]).where(sums.contacts > 0)


def _found(run, point) -> dict[str, np.ndarray]:
    """Return all that has an error bar: by slice, by phase, and scalars."""
    now, q, D = fields(run, point["slice"]), float(run.inertia), int(run.dimension)
    mean = now.weighted(run.particles).mean("phase")
    measured = float(run.samples) * point["period"]
    particles = run.particles.sum("phase") / (run.samples * run.sizes["phase"])
    meeting = now.weighted(run.contacts).mean(GRID)
    E_trans, E_rot, quarter = run.E_trans, run.E_rot, run.sizes["phase"] // QUARTERS
    R = run.R / run.samples
    found = {
        "density": now.density.mean("phase"),
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
        **_by_pairs(run),
    }
    return {name: values.values for name, values in found.items()}


def _by_pairs(run):
    """Return R by averages over pairs, weighted by their relative speed g as contacts are.

    {b^2 (2 b)^(D-2)} = D/6 (McNamara & Luding 1998, above Lun's formula). `speed_factor` is
    {g^3}/{g} over its Maxwellian value (D + 1)/D {g^2}, which would make it 1.
    """
    q, D, number = run.inertia, run.dimension, run.pairs.where(run.pairs > 0)
    weighted = q * run["g s^2"] / (q * run["g s^2"] + D / 6 * run["g^3"].where(run.g > 0))
    factor = run["g^3"] / run.g / ((D + 1) / D * run["g^2"] / number)
    found = {f"R_{name}": weighted.sel(company=name) for name in ("level", "meeting")}
    return found | {"speed_factor": factor.sel(company="level")}


def _shear(run) -> dict[str, float]:
    """Return what a sheared gas is like, over all slices: see theory.transport.

    `theta` is that of E_rot and E_trans, without the mean spin of each instant; `flow_deviation`
    the root mean square velocity of slices, beyond the linear mean flow, over that of a particle.
    """
    all_over = run.sum(GRID)
    number, rate = float(all_over.particles), float(run.shear_rate)
    T_x, T_y = float(all_over.uu) / number, float(all_over.vv) / number
    T, spin = (T_x + T_y) / 2, float(all_over.w) / number
    stress, difference = -float(all_over.uv) / number / T, (T_x - T_y) / (2 * T)
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


NO_SHEAR = dict.fromkeys([name for name in SHEARED if name != "R_collisional"], math.nan)


def _exact(runs, point) -> dict[str, Any]:
    """Return what has no error bar: fields of all runs together, and what is known beforehand."""
    first, every = runs[0], xr.concat(runs, "run").sum("run")
    names = ("area", "dimension", "inertia", "shear_rate")
    pooled = every.assign({name: first[name] for name in names})
    now = fields(pooled, point["slice"])
    found = {f"{name}_at_phase": values.values for name, values in now.items()}
    measured = float(every.samples) * point["period"] / every.sizes["phase"]
    meeting = 2 * every.contacts / (every.particles / every.samples * measured)
    q = float(first.inertia)
    return found | {
        "frequency_at_phase": meeting.where(every.particles > 0).values,
        "height": point["slice"] * (np.arange(every.sizes["slice"]) + 0.5),
        "R_lun": float(lun_ratio(float(point["beta"]), q)),
        "inertia": q,
        "dimension": int(first.dimension),
        "particles": round(float(first.particles.sum() / first.samples / first.sizes["phase"])),
        "measured": float(every.samples) * point["period"],
        "collisions": int(every.collisions),
        "imbalance": max(imbalance(run) for run in runs),
        "cpu_seconds": float(every.cpu_seconds),
    }


def imbalance(run: xr.Dataset) -> float:
    """Return by how much energies summed over slices miss those of the whole gas, relatively.

    That of the spins of a sheared gas is left out, since there the mean spin of each instant is
    taken from it.
    """
    D, sums = int(run.dimension), run.sum("slice")
    squares = {"E_trans": ((D - 1) * sums.uu + sums.vv) / D}
    if not run.shear_rate > 0:
        squares["E_rot"] = run.inertia * sums.ww / (2 * D - 3)
    number = sums.particles / run.samples
    misses = [abs(one / (2 * number * run[name]) - 1).max() for name, one in squares.items()]
    return max(map(float, misses))


def _estimates(found) -> dict[str, Estimate]:
    """Return means over runs and their standard errors."""
    rows, root = stacked(found), math.sqrt(len(found))
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
    """Return R of beds by each average, and what makes R of sheared gases what it is."""
    points = along(data, "point")
    beds = [one for one in points if np.isnan(one.theta)]
    head = ["bed", *BED.values()]
    rows = [[point_label(one), *(_written(one, name) for name in BED)] for one in beds]
    sheared = ["sheared gas", *SHEARED.values()]
    gases = [
        [point_label(one), *(_written(one, name) for name in SHEARED)]
        for one in points
        if np.isfinite(one.theta)
    ]
    return (
        f"## Averages of R in a bed\n\n{markdown(head, rows)}\n"
        f"## Sheared gases\n\n{markdown(sheared, gases)}"
    )


def point_label(point: xr.Dataset) -> str:
    """Return what a point of the study of profiles is called."""
    what = "spheres" if int(point.dimension) == 3 else "disks"
    usual = moment_of_inertia(int(point.dimension))
    q = "" if float(point.inertia) == usual else f", q = {float(point.inertia):g}"
    beta = str(point.beta.values).replace("-", "−")
    return f"{what}, r = {point.r.values}, β = {beta}{q}"


def _written(data, name):
    """Return a value with its error if it has one."""
    if f"{name}_stderr" not in data:
        return f"{float(data[name]):.4f}"
    return cell(data, name, "")
