"""Figures 1a to 2b of McNamara & Luding (1998), each by its name, from reduced datasets."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from roughgas.base import InputError
from roughgas.show.figures.panel import (
    ANY_R,
    HALF,
    RESTITUTION,
    Panel,
    PanelContent,
    Series,
    averages_of,
    content_for_each_r,
    ratio_figure,
    series,
)
from roughgas.show.style import GREY, LOOKS, Style
from roughgas.theory import sonine_state

WALLS = ("no side walls", "rough elastic walls", "walls like the particles", "smooth elastic walls")
THIN: Style = {"linestyle": "-", "linewidth": 0.7, "zorder": 0.5}
FAINT: Style = {"alpha": 0.5, "markersize": 2.6, "markeredgewidth": 0, "zorder": 0}


def fig1a(bed: xr.Dataset) -> Figure:
    """Draw the vibrated bed for several r, against Lun's formula."""
    message = "The mean of R(t) lies above Lun's formula"
    content = content_for_each_r("Vibrated bed", bed, theory=ANY_R, legend=HALF, message=message)
    return ratio_figure(content, averages=averages_of(bed))


def fig1b(*beds: xr.Dataset) -> Figure:
    """Draw the vibrated bed at r = 0.9 without walls, between rough elastic ones, ones of the
    particles' material, and smooth elastic ones."""
    drawn = []
    for data, label, look in zip(beds, WALLS, LOOKS, strict=False):
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
        message="Rough elastic walls put in spin, others hardly shift R",
        # rough walls shift R ten times as much as the others: the scale is that of the others
        scale=lambda drawn: [drawn[0], *drawn[2:]],
        room=0.15,
    )
    return ratio_figure(part)


def fig2a(sheared: xr.Dataset) -> Figure:
    """Draw the sheared gas for several r, against Lun's formula."""
    message = "Without its mean flow, R is near Lun's formula"
    how = {"theory": ANY_R, "extra": _draw_unsubtracted, "room": 0.1, "legend": HALF}
    return ratio_figure(content_for_each_r("Sheared gas", sheared, message=message, **how))


def _draw_unsubtracted(panel: Panel, drawn: Sequence[Series]) -> None:
    """Draw R with mean flow and mean spin left in, small and faint, since it is not the result."""
    if "R_unsubtracted" not in drawn[0].data:
        return
    main = panel.main
    for one in drawn:
        ratio = one.data.R_unsubtracted.values
        main.plot(one.at, ratio, one.look.marker, color=one.look.colour, **FAINT)
    text = "small, faint: mean flow and mean spin left in"
    main.text(0.98, 0.03, text, transform=main.transAxes, fontsize=7.5, color=GREY, ha="right")


def fig2b(cooling: xr.Dataset) -> Figure:
    """Draw the freely cooling gas for several r, beside its theory."""
    message = "R depends on r, as the theory of free cooling says"
    how = {
        "theories": "lines: theory of free cooling",
        "legend": {"loc": "upper right", "ncols": 2},
        "extra": _draw_sonine,
    }
    return ratio_figure(content_for_each_r("Cooling gas", cooling, message=message, **how))


def _draw_sonine(panel: Panel, drawn: Sequence[Series]) -> None:
    """Draw R without the assumption of Maxwellian velocities, where there is such a state."""
    beta = panel.axis.grid
    for one in drawn:
        about = one.data.attrs
        found = sonine_state(float(one.data.r), beta, about["dimension"], about["inertia"]).R
        panel.main.plot(beta, found, color=one.look.colour, **THIN)
        panel.residuals[0].plot(beta, found - one.predict(beta=beta), color=one.look.colour, **THIN)
    panel.main.plot([], [], color=GREY, label="thin: Sonine", **THIN)
