"""The work-precision figure: error of R against CPU seconds, a panel a study, and the map of what
the Maxwellian theory misses."""

from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from roughgas.studies.accuracy import PANELS
from roughgas.studies.accuracy.files import read_study
from roughgas.studies.figures.accuracy import discretisation, models, statistical

SIZE = (10.2, 8.6)  # inches


def draw(path: str | Path) -> Figure:
    """The figure, from the combined dataset of the studies at `path`."""
    data = {name: read_study(path, name) for name in PANELS}
    figure = Figure(figsize=SIZE, layout="constrained")
    (first, second), (third, fourth) = figure.subplots(2, 2)
    statistical.draw(first, data["statistical"])
    models.draw(second, data["models"])
    discretisation.draw(third, data["discretisation"])
    models.draw_map(fourth, data["models"])
    titles = (
        f"(a) noise: three scenes, {_material(data['statistical'])}",
        f"(b) models of a cooling gas, {_material(data['models'])}",
        f"(c) springs and time steps: cooling gas, {_material(data['discretisation'])}",
        "(d) what the Maxwellian theory of a cooling gas misses",
    )
    for axes, title in zip((first, second, third, fourth), titles, strict=True):
        axes.set_title(title, loc="left", fontsize=9)
    return figure


def _material(data: xr.Dataset) -> str:
    return rf"$r = {float(data.attrs['r']):g}$, $\beta = {float(data.attrs['beta']):g}$"
