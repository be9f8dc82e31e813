"""R against the share of rotation in the power of a drive.

A stochastic drive has the share that is set. For a rough floor, for the floor of a bed between
rough side walls, and for shaken side walls the share is measured, from the work done on both kinds
of motion.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import GREY, LINE_STYLES

from .boundaries import draw as draw_boundaries

__all__ = ["draw", "draw_boundaries"]

DRIVES = {
    "random kicks": "o",
    "rough floor": "^",
    "rough side walls": "v",
    "rough shaken walls": "D",
}
"""Markers of the drives, in the order of the datasets."""
DRAWN = "R over the share of rotation in the drive"


def draw(heated: xr.Dataset, *boundaries: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the drives: colours and lines stand for beta,
    symbols for the drive.

    `boundaries` are the bed on rough floors, the bed between rough walls, and the gas between
    shaken walls.
    """
    rows = plotting.rows_of(heated)
    low = min(0.0, *(float(data.input_spin_share.min()) for data in boundaries))
    axis = plotting.SPIN_SHARE._replace(limits=(low - 0.03, 1.03), drawn=(low, 1))
    figure, (panel,) = plotting.ratio_panels([axis], rows=rows)
    drawn = []
    for data, marker in zip((heated, *boundaries), DRIVES.values(), strict=True):
        looks = [look._replace(marker=marker) for look in LINE_STYLES]
        curves = plotting.series_for_each(data, "beta", line_styles=looks)
        curves = curves if data is heated else [_over_measured_share(series) for series in curves]
        plotting.draw_series(panel, curves, rows)
        drawn += curves
    heated_curves = drawn[: heated.beta.size]
    plotting.draw_theory(panel, heated_curves)
    plotting.frame_rows(panel, drawn, rows)
    drives = [panel.main.plot([], [], mark, color=GREY)[0] for mark in DRIVES.values()]
    panel.main.add_artist(panel.main.legend(drives, DRIVES, loc="upper left"))
    lines = [
        series._replace(line_style=series.line_style._replace(marker=""))
        for series in heated_curves
    ]
    plotting.add_legend(panel.main, lines, title="lines: rate equations", loc="lower right")
    plotting.add_notes(figure, drawn)
    title = rf"Driven disks, $r = {plotting.RESTITUTION:g}$"
    gases = [heated, *boundaries]
    message = plotting.judged_title(__file__, "one_curve_for_all_drives", gases, DRAWN)
    plotting.add_title(panel.main, [heated], title, message)
    return figure


def _over_measured_share(series: plotting.Series) -> plotting.Series:
    """Return a series at the measured shares of rotation in the drive's work, with theory there."""
    share = series.data.input_spin_share.values
    return series._replace(x=share, theory=series.predict(spin_share=share))
