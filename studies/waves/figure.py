"""The wave form in which the floor shakes a bed.

McNamara & Luding (1998): "changing the wave form does not significantly change R". The residuals
are those from the sawtooth, not from theory.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import (
    HALF,
    LOOKS,
    TWO_WIDE,
    WIDTH,
    PanelContent,
    Style,
    ratio_figure,
    series,
)

LABELS = {
    "sawtooth": "sawtooth (the paper's)",
    "reversed_sawtooth": "reversed sawtooth",
    "triangle": "triangle",
    "sine": "sine",
}

MESSAGE = "The wave form of the floor changes R little"


def draw(waves: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of a bed shaken in several ways: a panel for each
    r, from nearly elastic downwards, and one message for all."""
    restitutions = sorted(waves.r.values, reverse=True)
    first = restitutions[0]
    parts = [_content(waves, r, MESSAGE if r == first else "") for r in restitutions]
    figure = ratio_figure(*parts, width=TWO_WIDE if len(parts) > 1 else WIDTH)
    figure.axes[len(parts)].set_ylabel(r"$R - R_\mathrm{sawtooth}$")
    return figure


def _content(waves: xr.Dataset, r: float, message: str) -> PanelContent:
    """Return one panel; its residuals are those from the sawtooth at the same r."""
    drawn = [
        series(waves, label, look, r=r, wave=wave)
        for (wave, label), look in zip(LABELS.items(), LOOKS, strict=False)
    ]
    beside = [one._replace(theory=drawn[0].data.R.values) for one in drawn]
    how: Style = {"theory": "Lun's formula", "message": message, "legend": HALF}
    return PanelContent(f"Vibrated bed, $r = {r:g}$", [waves], beside, **how)
