"""Figures 1a to 2b of McNamara & Luding (1998), each by its name, from reduced datasets."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.figure import Figure

from roughgas.plotting import (
    ANY_R,
    GREY,
    LEGEND_AT_HALF,
    LINE_STYLES,
    RESTITUTION,
    InputError,
    Panel,
    PanelContent,
    Row,
    Series,
    Style,
    content_for_each_r,
    judged_title,
    ratio_figure,
    rows_of,
    series,
)
from roughgas.theory import sonine_state

WALLS = ("no side walls", "rough elastic walls", "walls like the particles", "smooth elastic walls")
THIN: Style = {"linestyle": "-", "linewidth": 0.7, "zorder": 0.5}
FAINT: Style = {"alpha": 0.5, "markersize": 2.6, "markeredgewidth": 0, "zorder": 0}


def fig1a(bed: xr.Dataset) -> Figure:
    """Draw the vibrated bed for several r, against Lun's formula."""
    drawn = "R of a vibrated bed, beside Lun's formula"
    message = judged_title(__file__, "theory_underestimates", [bed], drawn)
    content = content_for_each_r(
        "Vibrated bed", bed, theory=ANY_R, legend=LEGEND_AT_HALF, message=message
    )
    return ratio_figure(content, rows=rows_of(bed))


def fig1b(*beds: xr.Dataset) -> Figure:
    """Draw the vibrated bed at r = 0.9 without walls, between rough elastic walls, walls of the
    particles' material, and smooth elastic walls."""
    drawn = []
    for data, label, look in zip(beds, WALLS, LINE_STYLES, strict=False):
        if RESTITUTION not in data.r.values:
            name = data.attrs["experiment"]
            raise InputError(f"r of {name}", data.r.values, f"include {RESTITUTION:g}")
        drawn.append(series(data, label, look, r=RESTITUTION))
    content = PanelContent(
        f"Vibrated bed, $r = {RESTITUTION:g}$",
        beds,
        drawn,
        theory="Lun's formula",
        legend={"loc": "lower right"},
        message=judged_title(
            __file__, "only_rough_walls_matter", beds, "R of a vibrated bed between side walls"
        ),
        room=0.15,
    )
    # the shift by rough walls is ten times the others: a second row shows these
    return ratio_figure(content, rows=[Row(), Row(scale=lambda drawn: [drawn[0], *drawn[2:]])])


def fig2a(sheared: xr.Dataset) -> Figure:
    """Draw the sheared gas for several r, against Lun's formula."""
    drawn = "R of a sheared gas without its mean flow"
    message = judged_title(__file__, "sheared_follows_lun", [sheared], drawn)
    options = {"theory": ANY_R, "extra": _draw_unsubtracted, "room": 0.1, "legend": LEGEND_AT_HALF}
    return ratio_figure(content_for_each_r("Sheared gas", sheared, message=message, **options))


def _draw_unsubtracted(panel: Panel, drawn: Sequence[Series]) -> None:
    """Draw R with mean flow and mean spin left in, small and faint, since it is not the result."""
    if "R_unsubtracted" not in drawn[0].data:
        return
    main = panel.main
    for curve in drawn:
        ratio = curve.data.R_unsubtracted.values
        main.plot(curve.x, ratio, curve.line_style.marker, color=curve.line_style.colour, **FAINT)
    text = "small, faint: mean flow and mean spin left in"
    main.text(0.98, 0.03, text, transform=main.transAxes, fontsize=7.5, color=GREY, ha="right")


def fig2b(cooling: xr.Dataset) -> Figure:
    """Draw the freely cooling gas for several r, beside its theory."""
    drawn = "R of a cooling gas, beside its theory"
    message = judged_title(__file__, "cooling_depends_on_r", [cooling], drawn)
    options = {
        "theories": "lines: theory of free cooling",
        "legend": {"loc": "upper right", "ncols": 2},
        "extra": _draw_sonine,
    }
    return ratio_figure(content_for_each_r("Cooling gas", cooling, message=message, **options))


def _draw_sonine(panel: Panel, drawn: Sequence[Series]) -> None:
    """Draw R without the assumption of Maxwellian velocities, where such a state exists."""
    beta = panel.axis.grid
    for curve in drawn:
        attributes = curve.data.attrs
        ratio = sonine_state(
            float(curve.data.r), beta, attributes["dimension"], attributes["inertia"]
        ).R
        panel.main.plot(beta, ratio, color=curve.line_style.colour, **THIN)
        panel.residuals[0].plot(
            beta, ratio - curve.predict(beta=beta), color=curve.line_style.colour, **THIN
        )
    panel.main.plot([], [], color=GREY, label="thin: Sonine", **THIN)
