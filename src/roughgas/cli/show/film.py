"""A film of a gas that forms clusters."""

import json
from typing import TYPE_CHECKING, Any

from roughgas.cli.layout import columns
from roughgas.cli.show.point import cost, settings
from roughgas.data.film import read_film as read

if TYPE_CHECKING:
    import xarray

__all__ = ["read", "record", "text"]

ROWS = 8  # instants that are shown


def record(film: "xarray.Dataset") -> dict[str, Any]:
    """Attributes, and single numbers, for a script."""
    scalars = {name: one.item() for name, one in film.data_vars.items() if not one.dims}
    return {"attributes": film.attrs, "frames": film.sizes["frame"], "variables": scalars}


def text(film: "xarray.Dataset") -> str:
    """For a person."""
    about = film.attrs
    frames = film.sizes["frame"]
    head = [
        ["point", f"r = {about['r']:g}, beta = {about['beta']:g}, seed {about['seed']}"],
        *settings(json.loads(about["settings_json"]), 2),
        ["packing", f"{about['packing']:.4g}"],
        ["frames", f"{frames}, of {film.sizes['x']} x {film.sizes['y']} cells"],
        ["cost", cost(film)],
    ]
    table = [["frame", "collisions per particle", "time / T", "E_trans / initial", "R"]]
    for k in sorted({round(k * (frames - 1) / (ROWS - 1)) for k in range(ROWS)}):
        names = ("collisions_per_particle", "time", "E_trans", "R")
        table.append([str(k), *(f"{float(film[name][k]):.5g}" for name in names)])
    again = f"To make it again:\n{about['command']}"
    return "\n\n".join([columns(head), columns(table, numbers=True), again])
