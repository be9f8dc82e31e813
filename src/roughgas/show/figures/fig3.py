"""Fig. 3: spheres in three dimensions, in all three scenes, against Eqs. (Goldshtein) and (lun).

McNamara & Luding (1998) leave this open: "simulations in D = 3 are still needed".
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import Part, ratio_figure, series_for_each

FREE = {"theories": "lines: theory, Eq. (Goldshtein)", "loc": "upper right"}
FORCED = {"theory": "theory, Eq. (lun), any $r$"}


def draw(cooling: xr.Dataset, sheared: xr.Dataset, bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the three scenes in space."""
    scenes = (
        ("Cooling spheres", cooling, FREE),
        ("Sheared spheres", sheared, FORCED),
        ("Vibrated spheres", bed, FORCED),
    )
    parts = [Part(name, [one], series_for_each(one, "r", "r"), **how) for name, one, how in scenes]
    return ratio_figure(*parts, width=10.4)
