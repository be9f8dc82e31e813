"""What the summaries of several kinds of datasets share."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray

SHAPES = {2: "disks", 3: "spheres"}


def scalars(data: "xarray.Dataset") -> dict[str, Any]:
    """Return the single numbers of a dataset by name, flags as True and False."""
    return {
        name: bool(one) if "flag_meanings" in one.attrs else one.item()
        for name, one in data.variables.items()
        if not one.dims
    }


def settings(experiment: Mapping[str, Any], dimension: int) -> list[list[str]]:
    """Return rows with what was simulated, and for how long."""
    box = " x ".join(f"{side:g}" if side != "open" else "open" for side in experiment["box"])
    effects = [f"{name} ({_listed(one)})" for name, one in experiment["effects"].items()]
    rows = [["gas", f"{experiment['particles']} {SHAPES[dimension]}, box {box} a"]]
    rows += [["effects" if k == 0 else "", one] for k, one in enumerate(effects)]
    if "schedule" in experiment:
        rows.append(["schedule", _listed(experiment["schedule"])])
    return rows


def cost(data: "xarray.Dataset") -> str:
    """Return collisions and CPU time."""
    collisions, seconds = int(data.collisions), float(data.kernel_seconds)
    rate = f", {float(f'{collisions / seconds:.2g}'):,.0f} a second" if seconds > 0.0 else ""
    return f"{collisions:,} collisions in {seconds:.2f} s of CPU time{rate}"


def _listed(settings: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in settings.items())
