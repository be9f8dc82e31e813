"""Fig. 6: the wave form in which the floor shakes a bed.

McNamara & Luding (1998): "changing the wave form does not significantly change R". The residuals
are those from the sawtooth, not from theory.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas.show.figures import panel
from roughgas.show.style import LOOKS

RESTITUTION = 0.9
REFERENCE = "sawtooth"
NAMES = {
    REFERENCE: "sawtooth (the paper's)",
    "reversed_sawtooth": "reversed sawtooth",
    "triangle": "triangle",
    "sine": "sine",
}


def draw(waves: xr.Dataset) -> Figure:
    """The figure, from the reduced dataset of a bed shaken in several ways."""
    figure, main, residual = panel.ratio_panel()
    drawn = [
        panel.series(waves, label, look, r=RESTITUTION, wave=wave)
        for (wave, label), look in zip(NAMES.items(), LOOKS, strict=False)
    ]
    beside = [one._replace(theory=drawn[0].ratio) for one in drawn]
    panel.draw_series(main, residual, beside)
    panel.draw_theory(main, waves, r=RESTITUTION)
    residual.set_ylabel(r"$R - R_\mathrm{sawtooth}$")
    panel.frame_residuals(residual, beside, beside)
    panel.legend(main, drawn, "theory, Eq. (lun)", loc="upper left")
    panel.caption(main, [waves], f"Vibrated bed, $r = {RESTITUTION:g}$")
    return figure
