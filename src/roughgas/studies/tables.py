"""What the studies have found, as tables in Markdown: a function a study."""

from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base.files import write_text
from roughgas.studies.files import read_studies
from roughgas.studies.tasks import STUDIES
from roughgas.tasks import along, cell, estimate, label, markdown
from roughgas.theory import moment_of_inertia

BED = {
    "R": "mean of R(t)",
    "R_quarters": "at the paper's four phases",
    "R_ratio_of_means": "ratio of means",
    "R_weighted": "slices and phases, by their contacts",
    "R_level": "pairs at one height, by relative speed",
    "R_meeting": "those near that approach",
    "R_collisional": "at contacts",
    "R_lun": "Lun's formula",
    "speed_factor": "{g³}/{g}, over Maxwellian",
}
SHEARED = {
    "theta": "θ",
    "factor": "theory.shear's factor",
    "rate": "g",
    "stress": "p",
    "difference": "d",
    "spin_over_vorticity": "spin over half the vorticity",
    "flow_deviation": "flow beyond linear, over thermal",
    "R_collisional": "R at contacts, flow included",
}


def write_tables(input: str | Path, *, output: str | Path) -> None:
    """Write the tables of all studies in a combined file as Markdown."""
    found = read_studies(input).items()
    write_text(output, "\n".join(TABLES[name](data) for name, data in found))


def profiles(data: xr.Dataset) -> str:
    """Return R of beds by each average, and what makes R of sheared gases what it is."""
    points = along(data, "point")
    beds = [one for one in points if np.isnan(one.theta)]
    head = ["bed", *(text for text in BED.values())]
    rows = [[point_label(one), *(_written(one, name) for name in BED)] for one in beds]
    sheared = ["sheared gas", *(text for text in SHEARED.values())]
    gases = [
        [point_label(one), *(_written(one, name) for name in SHEARED)]
        for one in points
        if np.isfinite(one.theta)
    ]
    return (
        f"## Averages of R in a bed\n\n{markdown(head, rows)}\n"
        f"## Sheared gases\n\n{markdown(sheared, gases)}"
    )


def point_label(point: xr.Dataset) -> str:
    """Return what a point of the study of profiles is called."""
    what = "spheres" if int(point.dimension) == 3 else "disks"
    usual = moment_of_inertia(int(point.dimension))
    q = "" if float(point.inertia) == usual else f", q = {float(point.inertia):g}"
    beta = str(point.beta.values).replace("-", "−")
    return f"{what}, r = {point.r.values}, β = {beta}{q}"


def finite_size(data: xr.Dataset) -> str:
    """Return R of a cooling gas by number of particles, and what a box adds at each packing."""
    numbers = [f"N = {n}" for n in data.particles.values]
    rows, tails = [], []
    for one in along(data, "point"):
        gases = along(one, "particles")
        gap = estimate(gases[-1], "dsmc_R").scaled(100 / float(one.theory))
        missing = f"{gap._replace(value=gap.value - 100):+±} %"
        cells = [cell(gas, "dsmc_R", ".4f") for gas in gases]
        rows.append([label(one), f"{float(one.theory):.4f}", *cells, missing])
        tails.append([label(one), *(cell(gas, "dsmc_a02", "±") for gas in gases)])
    head = ["point", "theory of free cooling", *numbers, "the last over the theory of free cooling"]
    return (
        f"## Number and box of a cooling gas\n\nR of the homogeneous gas (DSMC):\n\n"
        f"{markdown(head, rows)}\nThe fourth cumulant a02 of its spins:\n\n"
        f"{markdown(['point', *numbers], tails)}"
        + "".join(_in_boxes(place, numbers) for place in along(data, "packing"))
    )


def _in_boxes(data, numbers):
    """Return what events find at one packing, over DSMC of as many particles."""
    rows = [
        [label(one), *(cell(gas, "over_dsmc", "+±", 100) for gas in along(one, "particles"))]
        for one in along(data, "point")
    ]
    waves = [
        [label(one), *(cell(gas, "flow", "±", 100) for gas in along(one, "particles"))]
        for one in along(data, "point")
    ]
    return (
        f"\nR by events at packing {float(data.packing):g} over that by DSMC, minus 1, in %:\n\n"
        f"{markdown(['point', *numbers], rows)}\nThere, the share of E_trans in the longest shear"
        f" waves, in % (uncorrelated: 2/N, spheres 4/N):\n\n{markdown(['point', *numbers], waves)}"
    )


def runaway(data: xr.Dataset) -> str:
    """Return times of escape and the largest shares over mu and N, and the rates behind them."""
    kinds = {"dsmc": "homogeneous gases (DSMC)", "events": "event-driven gases"}
    parts = [_escapes(data, kind, about) for kind, about in kinds.items()]
    rows = []
    for one in along(data, "mu"):
        bound = f"< {one.rate_bound:.1e}" if np.isfinite(one.rate_bound) else "–"
        rate = f"{one.rate:.1e} ± {one.rate_stderr:.0e}" if np.isfinite(one.rate) else bound
        theory = f"{one.predicted_rate:.1e}" if np.isfinite(one.predicted_rate) else "–"
        share = f"{one.maxwellian_share:.0e}"
        rows.append([f"{one.mu:g}", f"{one.threshold:.3g}", rate, theory, share])
    head = ["μ", "threshold a w / √(T_tr/m)", "crossings", "large deviations", "Maxwellian share"]
    return (
        f"## Runaway spins ({_about(data)}, packing {data.attrs['packing']:g})\n\n"
        + "".join(parts)
        + f"Crossings of the threshold per particle and collision of a particle:\n\n"
        f"{markdown(head, rows)}"
    )


def _escapes(data, kind, about):
    """Return times of escape by one method, with escapes/runs and the largest share."""
    numbers = data[f"{kind}_particles"].values
    rows = []
    for one in along(data, "mu"):
        row = [f"{one.mu:g}"]
        for place in along(one, f"{kind}_particles"):
            time, bound = cell(place, f"{kind}_time", "±"), float(place[f"{kind}_bound"])
            shown = f"> {bound:.0f}" if np.isfinite(bound) else time
            count = f"{int(place[f'{kind}_escapes'])}/{int(place[f'{kind}_runs'])}"
            share = float(place[f"{kind}_largest_share"])
            row.append(f"{shown} ({count}{'' if np.isnan(share) else f'; {share:.2f}'})")
        rows.append(row)
    head = ["μ", *(f"N = {n}" for n in numbers)]
    return (
        f"Collisions per particle until R > 0.9 in {about} (runs that escaped of all; largest"
        f" share of a particle in the energy of spins then):\n\n{markdown(head, rows)}\n"
    )


TABLES = {name: globals()[name] for name in STUDIES}


def _written(data, name):
    """Return a value with its error if it has one."""
    if f"{name}_stderr" not in data:
        return f"{float(data[name]):.4f}"
    return cell(data, name, "")


def _about(data):
    return f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
