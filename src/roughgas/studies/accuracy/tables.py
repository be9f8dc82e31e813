"""What the studies have found, as tables in Markdown: a function a study."""

import math
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base.files import write_text
from roughgas.base.layout import markdown
from roughgas.statistics.estimate import Estimate
from roughgas.studies.accuracy.tasks import SCENES, STUDIES
from roughgas.studies.accuracy.variables import read_studies

SHARES = {
    "of_maxwellian": "Maxwellian, uncorrelated velocities",
    "of_number": "infinitely many particles",
    "of_dilution": "no density, no correlations of positions",
}


def write_tables(path: str | Path, output: str | Path) -> None:
    """Write the tables of all studies in a combined file as Markdown."""
    found = read_studies(path).items()
    write_text(output, "\n".join(TABLES[name](data) for name, data in found))


def statistical(data: xr.Dataset) -> str:
    """Return what an accuracy of R costs in each scene, and how errors fall with time."""
    head = ["scene", "R", "slope, longer runs", "slope, more seeds", "autocorrelation time"]
    costs = ["scene", "equilibration", *(f"{x:.1%}" for x in data.relative_error.values)]
    scenes = along(data, "scene")
    rows = [
        [
            one.scene.item(),
            f"{_estimate(one, 'R'):.5f}",
            *(f"{_estimate(way, 'slope'):.3f}" for way in along(one, "way")),
            f"{_estimate(one, 'autocorrelation_time'):.2f} {one.length_unit.item()}",
        ]
        for one in scenes
    ]
    return (
        f"## Statistical error ({_about(data)})\n\n{markdown(head, rows)}\n"
        "CPU seconds of one core for a relative error of R, equilibration included, and how long"
        f" the run is:\n\n{markdown(costs, map(_prices, scenes))}"
    )


def discretisation(data: xr.Dataset) -> str:
    """Return deviations of soft spheres and of the contact-time model, and what they cost."""
    soft = along(data, "steps")
    head = ["t_c ν", *(f"soft spheres, {n} steps" for n in data.steps.values)]
    rows = [
        [f"{t:g}", *(_percent(one.sel(contact_time=t), "soft") for one in soft)]
        for t in data.contact_time.values
    ]
    rows.append(["order in t_c", *(f"{_estimate(one, 'order'):.2f}" for one in soft)])
    rows.append(["R at t_c → 0", *(f"{_estimate(one, 'limit_R'):.4f}" for one in soft)])
    for target in data.target.values:
        slower = data.slowdown.sel(target=target).values
        cells = ("–" if np.isnan(x) else f"{x:.0f} times" for x in slower)
        rows.append([f"slower than events at {target:.1%}", *cells])
    model_head = ["t_c ν", "deviation of R in %", "contacts changed"]
    model = [
        [f"{one.model_contact_time:g}", _percent(one, "model"), f"{one.model_touched:.2%}"]
        for one in along(data, "model_contact_time")
    ]
    return (
        f"## Discretisation error ({_about(data)}, packing {data.attrs['packing']})\n\n"
        f"Deviation of R in % from events, R = {_estimate(data, 'reference_R'):.5f}:\n\n"
        f"{markdown(head, rows)}\nThe contact-time model:\n\n{markdown(model_head, model)}\n"
        f"{_precision(data)}"
    )


def models(data: xr.Dataset) -> str:
    """Return what each model of a cooling gas tends to, and what the Maxwellian theory misses."""
    closed = f"{_estimate(data, 'closed_form_error', 100):±} %"
    until = (0.01 / float(data.event_driven_prefactor)) ** (1 / float(data.event_driven_slope))
    rows = [
        ["closed form, Eq. (K)", closed, f"{data.closed_form_seconds:.1e} s"],
        ["rate equations", closed, f"{data.rate_equations_seconds[-1]:.1e} s"],
        ["DSMC", f"{_estimate(data, 'dsmc_floor', 100):±} %", f"{_reached(data):.2g} s"],
        ["event-driven", "none", f"{until:.2g} s for 1 %"],
    ]
    parts = [[what, f"{_estimate(data, name, 100):±} %"] for name, what in SHARES.items()]
    head = ["β", *(f"r = {r:g}" for r in data.map_r.values)]
    gaps = [
        [f"{row.map_beta:g}", *(f"{_estimate(x, 'map_gap', 100):±}" for x in along(row, "map_r"))]
        for row in along(data, "map_beta")
    ]
    return (
        f"## Model error (r = {data.attrs['r']:g}, β = {data.attrs['beta']:g})\n\n"
        f"Against events, R = {_estimate(data, 'R_reference'):.5f}:\n\n"
        f"{markdown(['model', 'tends to an error of R of', 'CPU time'], rows)}\n"
        f"What the error of the closed form is made of:\n\n"
        f"{markdown(['assumption', 'changes R by'], parts)}\n"
        f"R of the homogeneous gas (DSMC) over R of Eq. (K), minus 1, in %:\n\n"
        f"{markdown(head, gaps)}"
    )


def coverage(data: xr.Dataset) -> str:
    """Return how often intervals hold the truth, a corner a row, with standard errors."""
    data = in_order(data)
    head = ["corner", "runs", "68 %, one run", "95 %, one run", "68 %, pooled", "95 %, pooled"]
    head += ["bias / scatter", "stated / true error", "window / τ"]
    rows = map(_corner, along(data, "corner"))
    return f"## Coverage of the stated intervals\n\n{markdown(head, rows)}"


TABLES = dict(zip(STUDIES, (statistical, models, discretisation, coverage), strict=True))


def in_order(data: xr.Dataset) -> xr.Dataset:
    """Return the corners by experiment, and there from weak to strong dissipation."""
    known = [*SCENES, *dict.fromkeys(data.experiment.values)]
    scene = [known.index(name) for name in data.experiment.values]
    r, beta = data.r.values.astype(float), data.beta.values.astype(float)
    return data.isel(corner=np.lexsort((-beta, -r, scene)))


def along(data: xr.Dataset, dim: str) -> list[xr.Dataset]:
    """Return the parts of a dataset along a dimension."""
    return [data.isel({dim: k}) for k in range(data.sizes[dim])]


def label(corner: xr.Dataset) -> str:
    """Return what a corner is called."""
    beta = str(np.asarray(corner.beta)).replace("-", "−")
    return f"{corner.experiment.values}, r = {corner.r.values}, β = {beta}"


def _about(data):
    return f"r = {data.attrs['r']}, β = {data.attrs['beta']}"


def _estimate(one: xr.Dataset, name: str, factor: float = 1.0) -> Estimate:
    return Estimate(float(one[name]), float(one[f"{name}_stderr"])).scaled(factor)


def _percent(one: xr.Dataset, kind: str) -> str:
    return f"{_estimate(one, f'{kind}_deviation', 100):+.2f}"


def _corner(one: xr.Dataset) -> list[str]:
    shares = [share for way in along(one, "way") for share in along(way, "level")]
    cells = [f"{_estimate(share, 'coverage', 100):±}" for share in shares]
    cells += [f"{_estimate(one, name):±}" for name in ("bias", "stated_over_true")]
    window = float(one.window / one.autocorrelation_time)
    return [label(one), f"{int(one.repetitions)}", *cells, f"{window:.0f}"]


def _reached(data: xr.Dataset) -> float:
    """Return CPU seconds of the shortest DSMC run whose noise is down to its floor, within a third;
    NaN without one."""
    near = data.dsmc_error.values < 4 / 3 * float(data.dsmc_floor)
    return float(data.dsmc_seconds.values[near][0]) if near.any() else math.nan


def _prices(one: xr.Dataset) -> list[str]:
    unit = "T" if one.length_unit.item() == "T" else "c.p.p."
    shown = [
        f"{cell.seconds_needed:.2g} ± {cell.seconds_needed_stderr:.1g} s"
        f" ({cell.length_needed:.3g} {unit})"
        for cell in along(one, "relative_error")
    ]
    return [one.scene.item(), f"{one.equilibration_seconds:.2g} s", *shown]


def _precision(data: xr.Dataset) -> str:
    speed = data.elastic_speed_single / data.elastic_speed_double
    return (
        f"Trajectories kept in single precision: deviation of R {_percent(data, 'single')} %, an"
        f" elastic gas's energy drifts by {data.elastic_drift_single:.1e} ±"
        f" {data.elastic_drift_stderr_single:.0e} of itself a collision"
        f" ({data.elastic_drift_double:.0e} in double precision), {speed:.2f} times as fast.\n"
    )
