"""A vibrated bed of two species: how they share energy, over the ratio of masses and of radii."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.two_species import Column, columns_figure

THEORIES = "Lun's formula at the measured temperatures"


def draw(masses: xr.Dataset, sizes: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of beds of unlike masses, and of unlike radii."""
    columns = (
        Column(masses, "Vibrated bed", "Heavy disks are hotter", "R of both is nearly the same"),
        Column(
            sizes, "Vibrated bed", "Large disks are mostly colder", "Lun's formula says otherwise"
        ),
    )
    return columns_figure(columns, THEORIES)
