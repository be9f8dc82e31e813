"""A cooling gas of two species beside theory, over the ratio of masses and of radii."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.two_species import Column, columns_figure

THEORIES = "theory of free cooling"


def draw(masses: xr.Dataset, sizes: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of gases of unlike masses, and of unlike radii."""
    columns = (
        Column(
            masses, "Cooling gas", "Temperatures nearly follow theory", "R of both follows theory"
        ),
        Column(sizes, "Cooling gas"),
    )
    return columns_figure(columns, THEORIES)
