"""Fig. 1b of McNamara & Luding (1998): the vibrated bed between side walls, r = 0.9."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.base.errors import InputError
from roughgas.show.figures import panel
from roughgas.show.style import LOOKS

RESTITUTION = 0.9
NAMES = {
    "vibrated": "periodic, no walls",
    "vibrated_rough_walls": r"rough elastic walls, $r = \beta = 1$",
    "vibrated_particle_walls": r"walls with the particles' $r$ and $\beta$",
    "vibrated_smooth_walls": r"smooth elastic walls, $r = -\beta = 1$",
}


def draw(bed: xr.Dataset, rough: xr.Dataset, particle: xr.Dataset, smooth: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the bed without walls and with each kind."""
    datasets = (bed, rough, particle, smooth)
    figure, main, residual = panel.ratio_panel()
    drawn = []
    for data, label, look in zip(datasets, NAMES.values(), LOOKS, strict=False):
        if RESTITUTION not in data.r.values:
            name = data.attrs["experiment"]
            raise InputError(f"r of {name}", data.r.values, f"include {RESTITUTION:g}")
        drawn.append(panel.series(data, label, look, r=RESTITUTION))
    panel.draw_series(main, residual, drawn)
    panel.draw_theory(main, bed, r=RESTITUTION)
    # The rough walls shift R by ten times what the others do: the scale is that of the others.
    panel.frame_residuals(residual, drawn, [one for one in drawn if one is not drawn[1]])
    panel.legend(main, drawn, "theory, Eq. (lun)", loc="lower right")
    panel.caption(main, datasets, f"Vibrated bed, $r = {RESTITUTION:g}$")
    return figure
