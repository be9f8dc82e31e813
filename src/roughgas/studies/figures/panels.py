"""What figures of studies share: panels in two columns, with a title each."""

from collections.abc import Callable, Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

Panel = tuple[Callable[[Axes, xr.Dataset], None], str]


def paired_panels(panels: Sequence[Panel], size: tuple[float, float], *data: xr.Dataset) -> Figure:
    """Return a figure of two or four panels, each drawn from its dataset, its title above it."""
    figure = Figure(figsize=size, layout="constrained")
    every = figure.subplots(len(panels) // 2, 2).flat
    for axes, (panel, title), one in zip(every, panels, data, strict=True):
        panel(axes, one)
        axes.set_title(title, loc="left", fontsize=8.5)
    return figure
