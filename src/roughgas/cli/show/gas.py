"""The summary of one gas: of a point, or of a film."""

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from roughgas.base.layout import columns
from roughgas.data.cf import unit_of
from roughgas.statistics.estimate import Estimate, decimals_of
from roughgas.theory.prediction import equation_of, predicted_ratio

if TYPE_CHECKING:
    import xarray

SHAPES = {2: "disks", 3: "spheres"}
BLOCKS, WIDTH = "▁▂▃▄▅▆▇█", 48
FRAMES = 8  # of a film, that are shown
FILMED = {
    "collisions per particle": "collisions_per_particle",
    "time / T": "time",
    "E_trans / initial": "E_trans",
    "R": "R",
}


def scalars(data: "xarray.Dataset") -> dict[str, Any]:
    """Return the single numbers of a dataset by name, flags as True and False."""
    return {
        name: bool(one) if "flag_meanings" in one.attrs else one.item()
        for name, one in data.variables.items()
        if not one.dims
    }


def cost(data: "xarray.Dataset") -> str:
    """Return collisions and CPU time."""
    collisions, seconds = int(data.collisions), float(data.kernel_seconds)
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return f"{collisions:,} collisions in {seconds:.2f} s of CPU time{rate}"


def point_record(point: "xarray.Dataset") -> dict[str, Any]:
    """Return the single numbers of a point, and those of theory where particles spin."""
    found = scalars(point)
    if "R" in found:
        expected = _theory(point)
        found |= {"R_theory": expected, "residual": found["R"] - expected}
    return {"variables": found}


def point_text(point: "xarray.Dataset") -> str:
    """Return the summary of a point: one seed of one (r, beta) of an experiment."""
    about = point.attrs
    variant = f"/{about['variant']}" if "variant" in about else ""
    rows = [
        ["experiment", f"{about['experiment']}{variant}, scale {about['scale']}"],
        *_settings(about, about["experiment_json"]),
        ["", ""],
        *(_ratio(point) if "R" in point else []),
        *(_energy(point, name) for name in ("E_trans", "E_rot") if name in point),
        ["steady state", _steady(point)],
        ["cost", cost(point)],
    ]
    books = [_books(point)] if "energy_input" in point else []
    return "\n\n".join([columns(rows), *books, f"To make it again:\n{about['command']}"])


def film_record(film: "xarray.Dataset") -> dict[str, Any]:
    """Return the number of frames of a film, and its single numbers."""
    return {"frames": film.sizes["frame"], "variables": scalars(film)}


def film_text(film: "xarray.Dataset") -> str:
    """Return the summary of a film of a gas that forms clusters."""
    about, last = film.attrs, film.sizes["frame"] - 1
    head = [
        *_settings(about, about["settings_json"]),
        ["packing", f"{about['packing']:.4g}"],
        ["frames", f"{last + 1}, of {film.sizes['x']} x {film.sizes['y']} cells"],
        ["cost", cost(film)],
    ]
    table = [["frame", *FILMED]]
    for k in sorted({round(k * last / (FRAMES - 1)) for k in range(FRAMES)}):
        table.append([str(k), *(f"{float(film[name][k]):.5g}" for name in FILMED.values())])
    again = f"To make it again:\n{about['command']}"
    return "\n\n".join([columns(head), columns(table, numbers=True), again])


def _settings(about: Mapping[str, Any], text: str) -> list[list[str]]:
    """Return rows with what was simulated, and for how long, from attributes and settings."""
    experiment = json.loads(text)
    box = " x ".join(f"{side:g}" if side != "open" else "open" for side in experiment["box"])
    shape = SHAPES[len(experiment["box"])]
    effects = [f"{name} ({_listed(one)})" for name, one in experiment["effects"].items()]
    rows = [
        ["point", f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}"],
        ["gas", f"{experiment['particles']} {shape}, box {box} a"],
        *(["" if k else "effects", one] for k, one in enumerate(effects)),
    ]
    if "schedule" in experiment:
        rows.append(["schedule", _listed(experiment["schedule"])])
    return rows


def _listed(settings: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in settings.items())


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
