"""Where springs and time steps stand beside events, and what the Maxwellian theory misses."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.studies.figures.accuracy import PANELS, draw_panels


def draw_figure(discretisation: xr.Dataset, models: xr.Dataset) -> Figure:
    """Return the figure, from the datasets of two studies."""
    return draw_panels(PANELS[2:], discretisation, models)
