"""Mixtures: two species in a bed and in a cooling gas, and disks of many sizes."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import judged_title

from .polydisperse import draw as draw_polydisperse
from .two_species import Column, columns_figure

__all__ = ["draw_cooling", "draw_polydisperse", "draw_vibrated"]

COOLING, VIBRATED = "T and R of two cooling species", "T and R of two vibrated species"
"""Titles where the statements fail."""


def draw_cooling(masses: xr.Dataset, sizes: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of gases of unlike masses, and of unlike radii."""
    message = judged_title(__file__, "cooling_species_follow_theory", [masses, sizes], COOLING)
    columns = [Column(data, "Cooling gas", message) for data in (masses, sizes)]
    return columns_figure(columns, "theory of free cooling")


def draw_vibrated(masses: xr.Dataset, sizes: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of beds of unlike masses, and of unlike radii."""
    message = judged_title(__file__, "vibrated_species_follow_lun", [masses, sizes], VIBRATED)
    columns = [Column(data, "Vibrated bed", message) for data in (masses, sizes)]
    return columns_figure(columns, "Lun's formula at the measured temperatures")
