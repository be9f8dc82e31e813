"""A point: one seed of one (r, beta) of an experiment."""

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base.layout import columns
from roughgas.cli.show.parts import cost, scalars, settings
from roughgas.data.cf import unit_of
from roughgas.data.netcdf import read_netcdf as read
from roughgas.statistics.estimate import Estimate, decimals_of
from roughgas.theory.prediction import equation_of, predicted_ratio

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

BLOCKS, WIDTH = "▁▂▃▄▅▆▇█", 48


def record(point: "xarray.Dataset") -> dict[str, Any]:
    """Return attributes, single numbers, and theory where particles spin."""
    found = scalars(point)
    if "R" in found:
        expected = _theory(point)
        found |= {"R_theory": expected, "residual": found["R"] - expected}
    return {"attributes": point.attrs, "variables": found}


def text(point: "xarray.Dataset") -> str:
    """Return a summary for a person."""
    about = point.attrs
    variant = f"/{about['variant']}" if "variant" in about else ""
    rows = [
        ["experiment", f"{about['experiment']}{variant}, scale {about['scale']}"],
        ["point", f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}"],
        *settings(json.loads(about["experiment_json"]), about["dimension"]),
        ["", ""],
        *(_ratio(point) if "R" in point else []),
        *(_energy(point, name) for name in ("E_trans", "E_rot") if name in point),
        ["steady state", _steady(point)],
        ["cost", cost(point)],
    ]
    parts = [columns(rows)]
    if "energy_input" in point:
        parts.append(_books(point))
    return "\n\n".join([*parts, f"To make it again:\n{about['command']}"])


def _theory(point: "xarray.Dataset") -> float:
    about = point.attrs | {"theory": equation_of(point.attrs, point).kind}
    return float(predicted_ratio(about, about["r"], about["beta"]))


def _ratio(point: "xarray.Dataset") -> list[list[str]]:
    about, R, half, expected = point.attrs, float(point.R), float(point.R_ci95), _theory(point)
    digits = decimals_of(half) if 0.0 < half < 1.0 else 4
    trust = "" if point.R_ci95_trusted else " (the run is too short to trust it)"
    off = f"{abs(R - expected):.4f} {'below' if R < expected else 'above'}"
    return [
        ["R", f"{Estimate(R, float(point.R_stderr))}"],
        ["95 % interval", f"{R - half:.{digits}f} to {R + half:.{digits}f}{trust}"],
        ["theory", f"{expected:.4f}, {equation_of(about, point).name}: R is {off} it"],
        ["R(t)", _line(point.R_series.values)],
    ]


def _line(series: np.ndarray) -> str:
    """Return a series as a line of blocks, each as high as the mean over its part."""
    parts = np.array([part.mean() for part in np.array_split(series, min(WIDTH, len(series)))])
    low, high = parts.min(), parts.max()
    heights = (parts - low) / ((high - low) or 1.0) * (len(BLOCKS) - 1)
    blocks = "".join(BLOCKS[round(height)] for height in heights)
    return f"{blocks}  {low:.3f} to {high:.3f}"


def _energy(point: "xarray.Dataset", name: str) -> list[str]:
    error = float(point.get(f"{name}_stderr", math.nan))
    value = Estimate(float(point[name]), error)
    return [name, f"{value} {unit_of(point[name].attrs)}, per degree of freedom"]


def _steady(point: "xarray.Dataset") -> str:
    found = "yes" if point.equilibrated else "NOT found: energies or R still drift"
    begin, units = float(point.measured_from), unit_of(point.measured_from.attrs)
    end = f" to {float(point.plateau_end):g}" if "plateau_end" in point else " on"
    return f"{found}; measured from {begin:g}{end}, in {units}"


def _books(point: "xarray.Dataset") -> str:
    """Return what each source has put into each motion."""
    rows = [["energy put in, per particle", *point.motion.values]]
    for source, energies in zip(point.source.values, point.energy_input.values, strict=True):
        rows.append([f"  {source}", *(f"{one:.6g}" for one in energies)])
    rows.append(["  what the gas has gained", *(f"{one:.6g}" for one in point.energy_gain.values)])
    imbalance, units = float(point.energy_imbalance), unit_of(point.energy_gain.attrs)
    return f"{columns(rows, numbers=True)}\n  in {units}; the books miss {imbalance:.1g} of it all"
