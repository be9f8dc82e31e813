"""Spheres in three dimensions, in all three scenes, and theory.

McNamara & Luding (1998) leave this open: "simulations in D = 3 are still needed".
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import ANY_R, TWO_WIDE, content_for_each_r, judged_title, ratio_figure

PANELS = {
    "Cooling spheres": ("cooling_spheres_follow_goldshtein", "R, and free cooling"),
    "Sheared spheres": ("sheared_spheres_follow_lun", "R, and Lun's formula"),
    "Vibrated spheres": ("vibrated_spheres_follow_lun", "R, and Lun's formula"),
}
"""Statement that titles a panel where it holds, and its title elsewhere."""


def draw(cooling: xr.Dataset, sheared: xr.Dataset, bed: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the three scenes in three dimensions."""
    free = {"theories": "lines: theory", "legend": {"loc": "upper right"}}
    driven = {"theory": ANY_R}
    contents = []
    for (name, (statement, drawn)), data in zip(
        PANELS.items(), (cooling, sheared, bed), strict=True
    ):
        message = judged_title(__file__, statement, [data], drawn)
        style = free if data is cooling else driven
        contents.append(content_for_each_r(name, data, message=message, **style))
    return ratio_figure(*contents, width=TWO_WIDE)
