"""What observables have found in a point, over a coordinate: a line for each species or pair."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from roughgas.base import not_one_of
from roughgas.data.netcdf import unit_of
from roughgas.show.figures.sweep import title_of_point
from roughgas.show.style import LOOKS

SIZE = 6.0, 3.2  # inches


def draw(point: xr.Dataset, name: str) -> Figure:
    """Draw a variable of a point, with one standard error to either side.

    Raises InputError for a variable that is over no numbers.
    """
    known = [str(one) for one in point.data_vars if _axis(point, one) is not None]
    if name not in known:
        shown = [one for one in known if f"{one}_stderr" in point]
        raise not_one_of("--of", name, shown or known)
    axis = _axis(point, name)
    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.subplots()
    at = point[axis].values
    values = point[name].transpose(..., axis)
    errors = point.get(f"{name}_stderr", values * np.nan).transpose(..., axis)
    for number, place in enumerate(_places(values)):
        look = LOOKS[number % len(LOOKS)]
        line, error = values.values[place], errors.values[place]
        axes.plot(at, line, color=look.colour, linestyle=look.line, label=_label(values, place))
        axes.fill_between(
            at, line - error, line + error, color=look.colour, alpha=0.25, linewidth=0
        )
    said = name.removesuffix("_species").replace("_", " ")
    axes.set(xlabel=_said(point[axis]), ylabel=f"{said}{_unit(values)}")
    axes.set_title(title_of_point(point), fontsize=8)
    if values.ndim > 1:
        axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


def _axis(point: xr.Dataset, name: Any) -> str | None:
    """Return the last dimension of a variable that has numbers along it, None without any."""
    dims = [str(dim) for dim in point[name].dims if dim in point.coords]
    return next((dim for dim in dims[::-1] if point[dim].dtype.kind in "fiu"), None)


def _places(values: xr.DataArray) -> list[tuple[int, ...]]:
    """Return the index of each line; of a pair of species in one of the two orders."""
    places, dims = np.ndindex(values.shape[:-1]), values.dims
    if "other" not in dims:
        return list(places)
    one, other = dims.index("species"), dims.index("other")
    return [place for place in places if place[one] <= place[other]]


def _label(values: xr.DataArray, place: tuple[int, ...]) -> str:
    names = ["species" if dim == "other" else dim for dim in values.dims[:-1]]
    pairs = zip(names, place, strict=True)
    return ", ".join(str(values[n].values[k]) if n in values.coords else str(k) for n, k in pairs)


def _said(values: xr.DataArray) -> str:
    return f"{values.attrs.get('long_name', values.name)}{_unit(values)}"


def _unit(values: xr.DataArray) -> str:
    unit = unit_of(values.attrs)
    return "" if unit in ("", "1") else f" / ({unit})" if " " in unit else f" / {unit}"
