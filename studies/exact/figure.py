"""The figure of what is known exactly, and of the cumulant a2, beside what was measured."""

from collections import defaultdict

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from roughgas.judging import SIGNIFICANT
from roughgas.plotting import GREY, LOOKS, THEORY

from . import published
from .evidence import NAMES, Gas, rows

SIZE = (7.0, 6.4)  # inches
FARTHEST = 5.0  # abs(z) within the axis
SHORT = {
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
"""Exact numbers by what the axis calls them; all others are of single contacts."""
CONTACTS = "single contacts"
STATES = {
    "cooling": (published.sonine, published.sonine_closer),
    "noise": (published.sonine_driven,),
}
STYLES = {"-": "van Noije & Ernst", "--": "Montanero & Santos; Coppex et al."}
"""Of lines: whose theory each is, in the order of the formulae above."""
LABELS = {"cooling": "cooling", "noise": "white noise"}


def draw(data: xr.Dataset) -> Figure:
    """Return the figure, of what all gases have shown."""
    figure = Figure(figsize=SIZE, layout="constrained")
    above, beneath = figure.subplots(2, 1, height_ratios=(1, 1.15))
    draw_exact(above, data)
    draw_cumulants(beneath, data)
    return figure


def draw_exact(axes: Axes, data: xr.Dataset) -> None:
    """Draw z of each number with a known exact value, a line for each quantity."""
    found: dict[str, list[float]] = defaultdict(list)
    for row in rows(data):
        if row.tier == "exact":
            found[SHORT.get(row.quantity, CONTACTS)].append(row.z)
    for place, z in enumerate(found.values()):
        # numbers that agree to the last digit lie on each other: spread them
        heights = place + np.linspace(-0.25, 0.25, len(z) + 2)[1:-1]
        axes.plot(np.clip(z, -FARTHEST, FARTHEST), heights, "o", color=LOOKS[0].colour, ms=3.5)
    axes.axvspan(-SIGNIFICANT, SIGNIFICANT, color=GREY, alpha=0.15, lw=0)
    axes.axvline(0.0, color=THEORY, lw=0.8, zorder=0)
    axes.set_yticks(range(len(found)), list(found))
    axes.set(xlim=(-FARTHEST - 0.2, FARTHEST + 0.2), ylim=(len(found) - 0.4, -0.6))
    axes.set_xlabel("$z$ of ours minus exact")
    axes.set_title("(a) numbers that are known exactly", loc="left", fontsize=8.5)
    axes.tick_params(axis="y", which="both", left=False, right=False)


def draw_cumulants(axes: Axes, data: xr.Dataset) -> None:
    """Draw a2 of smooth gases over r, beside theory."""
    r = np.linspace(0.0, 1.0, 201)
    gases = [Gas(data, str(task)) for task in data.task_name.values]
    series = [(kind, dimension) for kind in STATES for dimension in NAMES]
    for (kind, dimension), look in zip(series, LOOKS, strict=False):
        these = [one for one in gases if one.kind == kind and one.parameters[0] == dimension]
        a2 = [one.number("a2") for one in these]
        axes.errorbar(
            [one.parameters[1] for one in these],
            [one.value for one in a2],
            [one.stderr for one in a2],
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
