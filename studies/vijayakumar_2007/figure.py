"""Figure of a channel: profiles of the flow between both walls, and the shear stress on them."""

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.plotting import GREY, LINE_STYLES, THEORY, TWO_WIDE, judged_title, key, particles_of

from .theory import wall_shear_stress

SIZE = (TWO_WIDE, 3.0)  # inches
MARKERS = "o", "s"
"""Markers of smooth walls and of rough walls; lines of the flow are full and dashed."""
LINES = "-", "--"
WALLS = "smooth walls", "rough walls"


def draw(smooth: xr.Dataset, rough: xr.Dataset) -> Figure:
    """Draw the figure from the reduced datasets of the channel between smooth and rough walls."""
    figure = Figure(figsize=SIZE, layout="constrained")
    left, right = figure.subplots(1, 2)
    for gas, marker, line in zip((smooth, rough), MARKERS, LINES, strict=True):
        _draw_flow(left, gas, line)
        _draw_stress(right, gas, marker)
    keys = [
        key(look.colour, rf"$\beta = {beta:g}$", "s")
        for beta, look in zip(smooth.beta.values, LINE_STYLES, strict=False)
    ]
    keys += [
        key(GREY, walls, marker, line)
        for walls, marker, line in zip(WALLS, MARKERS, LINES, strict=True)
    ]
    keys.append(key(THEORY, "balance of momentum", "", "-"))
    left.set(xlabel="height / a", ylabel="flow / (a/T)")
    right.set(xlabel=r"roughness $\beta$ of the disks", ylabel="shear stress on a wall\n/ (m/T²)")
    right.margins(x=0.1)
    for axes, statement, drawn in (
        (left, "rough_walls_slip_less", "Profiles of the flow"),
        (right, "walls_carry_the_body_force", "Shear stress on the walls"),
    ):
        data = [smooth, rough] if axes is left else [smooth]
        axes.set_title(judged_title(__file__, statement, data, drawn), loc="left", fontsize=8.5)
    figure.suptitle(f"Disks that a force drives along a channel, $N = {particles_of(smooth)}$")
    figure.legend(handles=keys, loc="outside lower center", ncols=3, fontsize=7)
    return figure


def _draw_flow(axes: Axes, gas: xr.Dataset, line: str) -> None:
    """Draw the flow over the height, a line for each roughness of the disks."""
    for beta, look in zip(gas.beta.values, LINE_STYLES, strict=False):
        flow = gas.flow_profile.sel(beta=beta, component="x").isel(r=0)
        axes.plot(gas.height, flow, line, color=look.colour, lw=1.0)


def _draw_stress(axes: Axes, gas: xr.Dataset, marker: str) -> None:
    """Draw the shear stress on each wall with its error, and the balance of momentum."""
    for wall in gas.wall.values:
        at = {"wall": wall, "component": "x"}
        for beta, look in zip(gas.beta.values, LINE_STYLES, strict=False):
            point = gas.sel(beta=beta, **at).isel(r=0)
            axes.errorbar(
                beta,
                point.wall_shear_stress,
                point.wall_shear_stress_stderr,
                fmt=marker,
                ms=3.5,
                color=look.colour,
            )
    expected = wall_shear_stress(gas).isel(r=0, wall=0, component=0)
    axes.plot(gas.beta, expected, color=THEORY, lw=0.9, zorder=1)
