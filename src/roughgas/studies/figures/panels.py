"""What figures of studies share: four panels with a title each."""

from collections.abc import Callable, Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

Panel = tuple[Callable[[Axes, xr.Dataset], None], str]


def four_panels(panels: Sequence[Panel], size: tuple[float, float], *data: xr.Dataset) -> Figure:
    """Return a figure with each of four panels drawn from its dataset, and its title above it."""
    figure = Figure(figsize=size, layout="constrained")
    for axes, (panel, title), one in zip(figure.subplots(2, 2).flat, panels, data, strict=True):
        panel(axes, one)
        axes.set_title(title, loc="left", fontsize=9)
    return figure
