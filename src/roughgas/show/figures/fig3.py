"""Fig. 3: spheres in three dimensions, in all three scenes, against Eqs. (Goldshtein) and (lun).

McNamara & Luding (1998) leave this open: "simulations in D = 3 are still needed".
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.figures.axis import BETA

NAMES = {
    "cooling_spheres": "Cooling spheres",
    "sheared_spheres": "Sheared spheres",
    "vibrated_spheres": "Vibrated spheres",
}


def draw(cooling: xr.Dataset, sheared: xr.Dataset, bed: xr.Dataset) -> Figure:
    """The figure, from the reduced datasets of the three scenes in space."""
    figure, panels = panel.ratio_panels([BETA] * 3, width=panel.THREE_WIDE)
    every = []
    for data, name, (main, residual, _) in zip(
        (cooling, sheared, bed), NAMES.values(), panels, strict=True
    ):
        drawn = panel.series_of_all_r(data)
        panel.draw_series(main, residual, drawn)
        if data is cooling:
            for r, one in zip(sorted(data.r.values, reverse=True), drawn, strict=True):
                panel.draw_theory(main, data, one.look, r=r)
            panel.legend(
                main, drawn, "", title="lines: theory, Eq. (Goldshtein)", loc="upper right"
            )
        else:
            panel.draw_theory(main, data, r=1.0)
            panel.legend(main, drawn, "theory, Eq. (lun), any $r$", loc="upper left")
        panel.caption(main, [data], name)
        every += drawn
    for _, residual, _ in panels:
        panel.frame_residuals(residual, every, every)
    return figure
