"""R of a bed by the wave form of its floor.

McNamara & Luding (1998): "changing the wave form does not significantly change R". The residuals
are from the sawtooth, not from theory.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import (
    LEGEND_AT_HALF,
    LINE_STYLES,
    TWO_WIDE,
    WIDTH,
    PanelContent,
    Style,
    judged_title,
    ratio_figure,
    series,
)

LABELS = {
    "sawtooth": "sawtooth (the paper's)",
    "reversed_sawtooth": "reversed sawtooth",
    "triangle": "triangle",
    "sine": "sine",
}

DRAWN = "R of a bed by the wave form of its floor"


def draw(waves: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of a bed shaken in several ways: a panel for each
    r, from nearly elastic downwards, and one message for all."""
    restitutions = sorted(waves.r.values, reverse=True)
    message = judged_title(__file__, "wave_form_changes_nothing", [waves], DRAWN)
    contents = [_content(waves, r, message) for r in restitutions]
    figure = ratio_figure(*contents, width=TWO_WIDE if len(contents) > 1 else WIDTH)
    figure.axes[len(contents)].set_ylabel(r"$R - R_\mathrm{sawtooth}$")
    return figure


def _content(waves: xr.Dataset, r: float, message: str) -> PanelContent:
    """Return one panel; its residuals are from the sawtooth at the same r."""
    drawn = [
        series(waves, label, look, r=r, wave=wave)
        for (wave, label), look in zip(LABELS.items(), LINE_STYLES, strict=False)
    ]
    over_sawtooth = [curve._replace(theory=drawn[0].data.R.values) for curve in drawn]
    style: Style = {"theory": "Lun's formula", "message": message, "legend": LEGEND_AT_HALF}
    return PanelContent(f"Vibrated bed, $r = {r:g}$", [waves], over_sawtooth, **style)
