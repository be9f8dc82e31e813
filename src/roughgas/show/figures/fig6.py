"""Fig. 6: the wave form in which the floor shakes a bed.

McNamara & Luding (1998): "changing the wave form does not significantly change R". The residuals
are those from the sawtooth, not from theory.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures.panel import RESTITUTION, PanelContent, ratio_figure, series
from roughgas.show.style import LOOKS

LABELS = {
    "sawtooth": "sawtooth (the paper's)",
    "reversed_sawtooth": "reversed sawtooth",
    "triangle": "triangle",
    "sine": "sine",
}


def draw(waves: xr.Dataset) -> Figure:
    """Draw the figure from the reduced dataset of a bed shaken in several ways."""
    drawn = [
        series(waves, label, look, r=RESTITUTION, wave=wave)
        for (wave, label), look in zip(LABELS.items(), LOOKS, strict=False)
    ]
    beside = [one._replace(theory=drawn[0].data.R.values) for one in drawn]
    title = f"Vibrated bed, $r = {RESTITUTION:g}$"
    figure = ratio_figure(PanelContent(title, [waves], beside, theory="theory, Eq. (lun)"))
    figure.axes[1].set_ylabel(r"$R - R_\mathrm{sawtooth}$")
    return figure
