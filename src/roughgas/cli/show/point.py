"""A point: one seed of one (r, beta) of an experiment."""

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.cli.layout import columns, decimals_of, unit_of, with_error
from roughgas.data.point import read_point as read
from roughgas.data.variables import POINT
from roughgas.theory.prediction import equation_of, predicted_ratio

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

BLOCKS, WIDTH = "▁▂▃▄▅▆▇█", 48
SHAPES = {2: "disks", 3: "spheres"}


def record(point: "xarray.Dataset") -> dict[str, Any]:
    """Attributes, single numbers, and theory, for a script."""
    scalars = {name: one.item() for name, one in point.data_vars.items() if not one.dims}
    for name in scalars.keys() & POINT.keys():
        if POINT[name].flags:
            scalars[name] = bool(scalars[name])
    return {"attributes": point.attrs, "variables": scalars | _theory(point)}


def text(point: "xarray.Dataset") -> str:
    """For a person."""
    about = point.attrs
    label = f"{about['experiment']}/{about['variant']}" if "variant" in about else None
    rows = [
        ["experiment", f"{label or about['experiment']}, scale {about['scale']}"],
        ["point", f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}"],
        *settings(json.loads(about["experiment_json"]), about["dimension"]),
        ["", ""],
        *_ratio(point),
        *_energies(point),
        ["steady state", _steady(point)],
        ["cost", cost(point)],
    ]
    parts = [columns(rows)]
    if "energy_input" in point:
        parts.append(_books(point))
    parts.append(f"To make it again:\n{about['command']}")
    return "\n\n".join(parts)


def settings(experiment: Mapping[str, Any], dimension: int) -> list[list[str]]:
    """What was simulated, and for how long."""
    box = " x ".join(f"{side:g}" if side != "open" else "open" for side in experiment["box"])
    effects = [f"{name} ({_listed(one)})" for name, one in experiment["effects"].items()]
    rows = [["gas", f"{experiment['particles']} {SHAPES[dimension]}, box {box} a"]]
    rows += [["effects" if k == 0 else "", one] for k, one in enumerate(effects)]
    if "schedule" in experiment:
        rows.append(["schedule", _listed(experiment["schedule"])])
    return rows


def cost(data: "xarray.Dataset") -> str:
    """Collisions and CPU time."""
    collisions, seconds = int(data.collisions), float(data.kernel_seconds)
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return f"{collisions:,} collisions in {seconds:.2f} s of CPU time{rate}"


def _listed(settings: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in settings.items())


def _theory(point: "xarray.Dataset") -> dict[str, float]:
    """R of theory, and what the gas has more, where particles spin."""
    if "R" not in point:
        return {}
    about = point.attrs | {"theory": equation_of(point.attrs, point).kind}
    expected = float(predicted_ratio(about, about["r"], about["beta"]))
    return {"R_theory": expected, "residual": float(point.R) - expected}


def _ratio(point: "xarray.Dataset") -> list[list[str]]:
    if "R" not in point:
        return []
    about, found, R, half = point.attrs, _theory(point), float(point.R), float(point.R_ci95)
    digits = decimals_of(half) if 0.0 < half < 1.0 else 4
    trust = "" if point.R_ci95_trusted else " (the run is too short to trust it)"
    source = equation_of(about, point).name
    return [
        ["R", with_error(R, float(point.R_stderr))],
        ["95 % interval", f"{R - half:.{digits}f} to {R + half:.{digits}f}{trust}"],
        ["theory", f"{found['R_theory']:.4f}, {source}: R is {_off(found['residual'])}"],
        ["R(t)", _line(point.R_series.values)],
    ]


def _off(residual: float) -> str:
    return f"{abs(residual):.4f} {'below' if residual < 0.0 else 'above'} it"


def _line(series: np.ndarray) -> str:
    """A series as a line of blocks, each as high as the mean over its part."""
    parts = np.array([part.mean() for part in np.array_split(series, min(WIDTH, len(series)))])
    low, high = parts.min(), parts.max()
    heights = (parts - low) / ((high - low) or 1.0) * (len(BLOCKS) - 1)
    blocks = "".join(BLOCKS[round(height)] for height in heights)
    return f"{blocks}  {low:.3f} to {high:.3f}"


def _energies(point: "xarray.Dataset") -> list[list[str]]:
    """Energies per degree of freedom."""
    rows = []
    for name in ("E_trans", "E_rot"):
        if name in point:
            error = float(point[f"{name}_stderr"]) if f"{name}_stderr" in point else math.nan
            value, units = with_error(float(point[name]), error), unit_of(point[name].attrs)
            rows.append([name, f"{value} {units}, per degree of freedom"])
    return rows


def _steady(point: "xarray.Dataset") -> str:
    found = "yes" if point.equilibrated else "NOT found: energies or R still drift"
    begin, units = float(point.measured_from), unit_of(point.measured_from.attrs)
    end = f" to {float(point.plateau_end):g}" if "plateau_end" in point else " on"
    return f"{found}; measured from {begin:g}{end}, in {units}"


def _books(point: "xarray.Dataset") -> str:
    """What each source has put into each motion."""
    rows = [["energy put in, per particle", *point.motion.values]]
    for source, energies in zip(point.source.values, point.energy_input.values, strict=True):
        rows.append([f"  {source}", *(f"{one:.6g}" for one in energies)])
    rows.append(["  what the gas has gained", *(f"{one:.6g}" for one in point.energy_gain.values)])
    imbalance = float(point.energy_imbalance)
    units = unit_of(point.energy_gain.attrs)
    return f"{columns(rows, numbers=True)}\n  in {units}; the books miss {imbalance:.1g} of it all"
