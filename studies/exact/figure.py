"""Figure of measured quantities against exact values, and of the cumulant a2 against theory."""

from collections import defaultdict

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.judging import SIGNIFICANT
from roughgas.plotting import GREY, LINE_STYLES, THEORY

from . import published
from .evidence import NAMES, Gas, rows

SIZE = (7.0, 6.4)  # inches
LARGEST_Z = 5.0  # abs(z) within the axis
SHORT_NAMES = {
    "compressibility factor Z from momentum transfer": "$Z$, momentum",
    "compressibility factor Z from the collision rate": "$Z$, collisions",
    "pair correlation at contact": "$g$ at contact",
    "first loss of T_tr from equilibrium, -dT_tr/dn over T_tr": "first loss",
    "first gain of T_rot from equilibrium, dT_rot/dn over T_tr": "first gain of spin",
    "first loss of T_tr of a species in a mixture, over T_tr": "first loss, mixture",
    "first gain of T_rot of a species in a mixture, over T_tr": "first gain, mixture",
    "T_0/T of a smooth tracer among elastic spheres": "tracer",
    "A of the tail exp(-A c) of a smooth gas cooling, c = v/sqrt(2 T/m)": "tail, cooling",
    "A of the tail exp(-A c^(3/2)) of a smooth gas driven by white noise, c = v/sqrt(2 T/m)": (
        "tail, white noise"
    ),
    "exponent p of T ~ t^-p of a homogeneous cooling gas": "Haff's exponent",
    "self-diffusion of smooth elastic particles, D nu/T over D/2": "diffusion",
}
"""Labels of exact quantities on the axis; all others are of single contacts."""
CONTACTS = "single contacts"
STATES = {
    "cooling": (published.sonine_cooling, published.sonine_cooling_closer),
    "noise": (published.sonine_driven,),
}
STYLES = {"-": "van Noije & Ernst", "--": "Montanero & Santos; Coppex et al."}
"""Line styles and the theory of each, in the order of the formulae in STATES."""
LABELS = {"cooling": "cooling", "noise": "white noise"}


def draw(data: xr.Dataset) -> Figure:
    """Draw the figure from the dataset of all gases."""
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 1, height_ratios=(1, 1.15))
    draw_exact(above, data)
    draw_cumulants(beneath, data)
    return figure


def draw_exact(axes: Axes, data: xr.Dataset) -> None:
    """Draw z of each quantity with an exact value, one line per quantity."""
    z_of_quantity: dict[str, list[float]] = defaultdict(list)
    for row in rows(data):
        if row.tier == "exact":
            z_of_quantity[SHORT_NAMES.get(row.quantity, CONTACTS)].append(row.z)
    for position, z in enumerate(z_of_quantity.values()):
        # values that agree to the last digit would overlap: spread them
        heights = position + np.linspace(-0.25, 0.25, len(z) + 2)[1:-1]
        axes.plot(
            np.clip(z, -LARGEST_Z, LARGEST_Z), heights, "o", color=LINE_STYLES[0].colour, ms=3.5
        )
    axes.axvspan(-SIGNIFICANT, SIGNIFICANT, color=GREY, alpha=0.15, lw=0)
    axes.axvline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set_yticks(range(len(z_of_quantity)), list(z_of_quantity))
    axes.set(xlim=(-LARGEST_Z - 0.2, LARGEST_Z + 0.2), ylim=(len(z_of_quantity) - 0.4, -0.6))
    axes.set_xlabel("$z$ of ours minus exact")
    beyond = sum(abs(z) > LARGEST_Z for values in z_of_quantity.values() for z in values)
    title = f"(a) numbers that are known exactly; grey: within {SIGNIFICANT:g} standard errors"
    title += f"; {beyond} beyond are at the edge" if beyond else ""
    axes.set_title(title, loc="left", fontsize=8.5)
    axes.tick_params(axis="y", which="both", left=False, right=False)


def draw_cumulants(axes: Axes, data: xr.Dataset) -> None:
    """Draw a2 of smooth gases over r, and theory."""
    r = np.linspace(0.0, 1.0, 201)
    gases = [Gas(data, str(task)) for task in data.task_name.values]
    series = [(kind, dimension) for kind in STATES for dimension in NAMES]
    for (kind, dimension), look in zip(series, LINE_STYLES, strict=False):
        shown = [gas for gas in gases if gas.kind == kind and gas.parameters[0] == dimension]
        a2 = [gas.number("a2") for gas in shown]
        axes.errorbar(
            [gas.parameters[1] for gas in shown],
            [estimate.value for estimate in a2],
            [estimate.stderr for estimate in a2],
            fmt=look.marker,
            color=look.colour,
            ms=4,
            lw=0.9,
            label=f"{NAMES[dimension]}, {LABELS[kind]}",
        )
        for formula, style in zip(STATES[kind], STYLES, strict=False):
            axes.plot(r, [formula(dimension, x) for x in r], style, color=look.colour, lw=0.9)
    for style, label in STYLES.items():
        axes.plot([], [], style, color=THEORY, lw=0.9, label=label)
    axes.axhline(0.0, color=GREY, lw=0.8, zorder=0)
    axes.set(xlabel="restitution $r$", ylabel="cumulant $a_2$", xlim=(0.0, 1.0))
    axes.legend(loc="upper right")
    axes.set_title("(b) smooth gases beside theory", loc="left", fontsize=8.5)
