"""Drives that put energy into rotation, too. R against their share of it.

A stochastic drive has the share that is chosen. A rough floor, the floor of a bed between rough
side walls, and shaken side walls have the one that their energy books say.
"""

import xarray as xr
from matplotlib.figure import Figure

from roughgas import plotting
from roughgas.plotting import GREY, LOOKS

from .boundaries import draw as draw_boundaries

__all__ = ["draw", "draw_boundaries"]

DRIVES = {
    "random kicks": "o",
    "rough floor": "^",
    "rough side walls": "v",
    "rough shaken walls": "D",
}
"""Their markers, in the order of the datasets."""
MESSAGE = "The share of rotation in the drive sets R"


def draw(heated: xr.Dataset, *boundaries: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the drives: colours and lines stand for beta,
    symbols for the drive.

    `boundaries` are the bed on rough floors, the bed between rough walls, and the gas between
    shaken walls.
    """
    averages = plotting.averages_of(heated)
    low = min(0.0, *(float(data.input_spin_share.min()) for data in boundaries))
    axis = plotting.SPIN_SHARE._replace(limits=(low - 0.03, 1.03), drawn=(low, 1))
    figure, (one,) = plotting.ratio_panels([axis], averages=averages)
    drawn = []
    for data, marker in zip((heated, *boundaries), DRIVES.values(), strict=True):
        looks = [look._replace(marker=marker) for look in LOOKS]
        part = plotting.series_for_each(data, "beta", looks=looks)
        part = part if data is heated else [_over_measured_share(series) for series in part]
        plotting.draw_series(one, part, averages)
        drawn += part
    of_heated = drawn[: heated.beta.size]
    plotting.draw_theory(one, of_heated)
    plotting.frame_rows(one, drawn, drawn, averages)
    drives = [one.main.plot([], [], mark, color=GREY)[0] for mark in DRIVES.values()]
    one.main.add_artist(one.main.legend(drives, DRIVES, loc="upper left"))
    lines = [series._replace(look=series.look._replace(marker="")) for series in of_heated]
    plotting.add_legend(one.main, lines, title="lines: rate equations", loc="lower right")
    plotting.add_notes(figure, drawn)
    title = rf"Driven disks, $r = {plotting.RESTITUTION:g}$"
    plotting.add_title(one.main, [heated], title, MESSAGE)
    return figure


def _over_measured_share(one: plotting.Series) -> plotting.Series:
    """Move points to the share of the drive's work that was measured to go into rotation."""
    share = one.data.input_spin_share.values
    return one._replace(at=share, theory=one.predict(spin_share=share))
