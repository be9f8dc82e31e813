"""Mixtures: two species in a bed and in a cooling gas, and disks of many sizes."""

import xarray as xr
from matplotlib.figure import Figure

from .polydisperse import draw as draw_polydisperse
from .two_species import Column, columns_figure

__all__ = ["draw_cooling", "draw_polydisperse", "draw_vibrated"]


def draw_cooling(masses: xr.Dataset, sizes: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of gases of unlike masses, and of unlike radii."""
    temperatures, ratios = "Temperatures nearly follow theory", "R of both follows theory"
    columns = (
        Column(masses, "Cooling gas", temperatures, ratios),
        Column(sizes, "Cooling gas"),
    )
    return columns_figure(columns, "theory of free cooling")


def draw_vibrated(masses: xr.Dataset, sizes: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of beds of unlike masses, and of unlike radii."""
    heavy = "Heavy disks are hotter", "R of both is nearly the same"
    large = "Large disks are mostly colder", "Lun's formula says otherwise"
    columns = Column(masses, "Vibrated bed", *heavy), Column(sizes, "Vibrated bed", *large)
    return columns_figure(columns, "Lun's formula at the measured temperatures")
