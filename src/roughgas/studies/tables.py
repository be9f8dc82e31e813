"""What the studies have found, as tables in Markdown: a function a study."""

import math
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base.files import write_text
from roughgas.studies.files import read_studies
from roughgas.studies.tasks import SCENES, STUDIES
from roughgas.tasks import along, cell, estimate, label, markdown
from roughgas.theory import moment_of_inertia

SHARES = {
    "of_maxwellian": "Maxwellian, uncorrelated velocities",
    "of_number": "infinitely many particles",
    "of_dilution": "no density, no correlations of positions",
}

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


def statistical(data: xr.Dataset) -> str:
    """Return what an accuracy of R costs in each scene, and how errors fall with time."""
    head = ["scene", "R", "slope, longer runs", "slope, more seeds", "autocorrelation time"]
    costs = ["scene", "equilibration", *(f"{x:.1%}" for x in data.relative_error.values)]
    rows, prices = [], []
    for one in along(data, "scene"):
        scene, unit = one.scene.item(), one.length_unit.item()
        slopes = [cell(way, "slope", ".3f") for way in along(one, "way")]
        time = f"{cell(one, 'autocorrelation_time', '.2f')} {unit}"
        rows.append([scene, cell(one, "R", ".5f"), *slopes, time])
        unit = "T" if unit == "T" else "c.p.p."
        cells = [
            f"{cost.seconds_needed:.2g} ± {cost.seconds_needed_stderr:.1g} s"
            f" ({cost.length_needed:.3g} {unit})"
            for cost in along(one, "relative_error")
        ]
        prices.append([scene, f"{one.equilibration_seconds:.2g} s", *cells])
    return (
        f"## Statistical error ({_about(data)})\n\n{markdown(head, rows)}\n"
        "CPU seconds of one core for a relative error of R, equilibration included, and how long"
        f" the run is:\n\n{markdown(costs, prices)}"
    )


def discretisation(data: xr.Dataset) -> str:
    """Return deviations of soft spheres and of the contact-time model, and what they cost."""
    soft = along(data, "steps")
    head = ["t_c ν", *(f"soft spheres, {n} steps" for n in data.steps.values)]
    rows = []
    for k, t in enumerate(data.contact_time.values):
        at = (one.isel(contact_time=k) for one in soft)
        rows.append([f"{t:g}", *(cell(one, "soft_deviation", "+.2f", 100) for one in at)])
    rows.append(["order in t_c", *(cell(one, "order", ".2f") for one in soft)])
    rows.append(["R at t_c → 0", *(cell(one, "limit_R", ".4f") for one in soft)])
    for target in data.target.values:
        slower = data.slowdown.sel(target=target).values
        cells = ("–" if np.isnan(x) else f"{x:.0f} times" for x in slower)
        rows.append([f"slower than events at {target:.1%}", *cells])
    model_head = ["t_c ν", "deviation of R in %", "contacts changed"]
    model = [
        [
            f"{one.model_contact_time:g}",
            cell(one, "model_deviation", "+.2f", 100),
            f"{one.model_touched:.2%}",
        ]
        for one in along(data, "model_contact_time")
    ]
    speed = data.elastic_speed_single / data.elastic_speed_double
    return (
        f"## Discretisation error ({_about(data)}, packing {data.attrs['packing']})\n\n"
        f"Deviation of R in % from events, R = {cell(data, 'reference_R', '.5f')}:\n\n"
        f"{markdown(head, rows)}\nThe contact-time model:\n\n{markdown(model_head, model)}\n"
        "Trajectories kept in single precision: deviation of R"
        f" {cell(data, 'single_deviation', '+.2f', 100)} %, an"
        f" elastic gas's energy drifts by {data.elastic_drift_single:.1e} ±"
        f" {data.elastic_drift_stderr_single:.0e} of itself a collision"
        f" ({data.elastic_drift_double:.0e} in double precision), {speed:.2f} times as fast.\n"
    )


def models(data: xr.Dataset) -> str:
    """Return what each model of a cooling gas tends to, and what the Maxwellian theory misses."""
    closed, floor = (f"{cell(data, x, '±', 100)} %" for x in ("closed_form_error", "dsmc_floor"))
    until = (0.01 / float(data.event_driven_prefactor)) ** (1 / float(data.event_driven_slope))
    # the shortest run of DSMC whose noise is down to its floor, within a third
    near = data.dsmc_seconds.values[data.dsmc_error.values < 4 / 3 * float(data.dsmc_floor)]
    rows = [
        ["closed form, the theory of free cooling", closed, f"{data.closed_form_seconds:.1e} s"],
        ["rate equations", closed, f"{data.rate_equations_seconds[-1]:.1e} s"],
        ["DSMC", floor, f"{near[0] if len(near) else math.nan:.2g} s"],
        ["event-driven", "none", f"{until:.2g} s for 1 %"],
    ]
    parts = [[what, f"{cell(data, name, '±', 100)} %"] for name, what in SHARES.items()]
    head = ["β", *(f"r = {r:g}" for r in data.map_r.values)]
    gaps = [
        [f"{row.map_beta:g}", *(cell(one, "map_gap", "±", 100) for one in along(row, "map_r"))]
        for row in along(data, "map_beta")
    ]
    return (
        f"## Model error (r = {data.attrs['r']:g}, β = {data.attrs['beta']:g})\n\n"
        f"Against events, R = {cell(data, 'R_reference', '.5f')}:\n\n"
        f"{markdown(['model', 'tends to an error of R of', 'CPU time'], rows)}\n"
        f"What the error of the closed form is made of:\n\n"
        f"{markdown(['assumption', 'changes R by'], parts)}\n"
        f"R of the homogeneous gas (DSMC) over R of the theory of free cooling, minus 1, in %:\n\n"
        f"{markdown(head, gaps)}"
    )


def coverage(data: xr.Dataset) -> str:
    """Return how often intervals hold the truth, a corner a row, with standard errors."""
    head = ["corner", "runs", "68 %, one run", "95 %, one run", "68 %, pooled", "95 %, pooled"]
    head += ["bias / scatter", "stated / true error", "window / τ"]
    rows = []
    for one in along(in_order(data), "corner"):
        shares = [share for way in along(one, "way") for share in along(way, "level")]
        cells = [cell(share, "coverage", "±", 100) for share in shares]
        cells += [cell(one, name, "±") for name in ("bias", "stated_over_true")]
        window = f"{float(one.window / one.autocorrelation_time):.0f}"
        rows.append([label(one), f"{int(one.repetitions)}", *cells, window])
    return f"## Coverage of the stated intervals\n\n{markdown(head, rows)}"


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


def in_order(data: xr.Dataset) -> xr.Dataset:
    """Return the corners by experiment, and there from weak to strong dissipation."""
    known = [*SCENES, *dict.fromkeys(data.experiment.values)]
    scene = [known.index(name) for name in data.experiment.values]
    r, beta = data.r.values.astype(float), data.beta.values.astype(float)
    return data.isel(corner=np.lexsort((-beta, -r, scene)))


def _written(data, name):
    """Return a value with its error if it has one."""
    if f"{name}_stderr" not in data:
        return f"{float(data[name]):.4f}"
    return cell(data, name, "")


def _about(data):
    return f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
