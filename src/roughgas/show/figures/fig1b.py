"""Fig. 1b of McNamara & Luding (1998): the vibrated bed between side walls, r = 0.9."""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.base import InputError
from roughgas.show.figures.panel import RESTITUTION, PanelContent, ratio_figure, series
from roughgas.show.style import LOOKS

LABELS = (
    "no side walls",
    "rough elastic walls",
    "walls like the particles",
    "smooth elastic walls",
)


def draw(*beds: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the bed without walls, between rough elastic
    ones, ones of the particles' material, and smooth elastic ones."""
    drawn = []
    for data, label, look in zip(beds, LABELS, LOOKS, strict=False):
        if RESTITUTION not in data.r.values:
            name = data.attrs["experiment"]
            raise InputError(f"r of {name}", data.r.values, f"include {RESTITUTION:g}")
        drawn.append(series(data, label, look, r=RESTITUTION))
    part = PanelContent(
        f"Vibrated bed, $r = {RESTITUTION:g}$",
        beds,
        drawn,
        theory="Lun's formula",
        legend={"loc": "lower right"},
        message="Only rough elastic walls matter: they put in spin",
        # rough walls shift R ten times as much as the others: the scale is that of the others
        scale=lambda drawn: [drawn[0], *drawn[2:]],
        room=0.15,
    )
    return ratio_figure(part)
