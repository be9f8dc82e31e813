"""A film of a gas that forms clusters."""

import json
from typing import TYPE_CHECKING, Any

from roughgas.base.layout import columns
from roughgas.cli.show.parts import cost, scalars, settings
from roughgas.data.film import read_film as read

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

ROWS = 8  # instants that are shown
HEAD = ["frame", "collisions per particle", "time / T", "E_trans / initial", "R"]
SHOWN = ("collisions_per_particle", "time", "E_trans", "R")


def record(film: "xarray.Dataset") -> dict[str, Any]:
    """Return attributes and single numbers."""
    return {"attributes": film.attrs, "frames": film.sizes["frame"], "variables": scalars(film)}


def text(film: "xarray.Dataset") -> str:
    """Return a summary for a person."""
    about, frames = film.attrs, film.sizes["frame"]
    head = [
        ["point", f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}"],
        *settings(json.loads(about["settings_json"]), 2),
        ["packing", f"{about['packing']:.4g}"],
        ["frames", f"{frames}, of {film.sizes['x']} x {film.sizes['y']} cells"],
        ["cost", cost(film)],
    ]
    shown = sorted({round(k * (frames - 1) / (ROWS - 1)) for k in range(ROWS)})
    table = [[str(k), *(f"{float(film[name][k]):.5g}" for name in SHOWN)] for k in shown]
    again = f"To make it again:\n{about['command']}"
    return "\n\n".join([columns(head), columns([HEAD, *table], numbers=True), again])
