"""What the studies have found, as tables in Markdown: a function a study."""

import math
from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

PERCENT = "{:+.2f} ± {:.2f}"
SCENES = ("vibrated", "sheared", "cooling")
JUDGED = ("bias", "stated_over_true")


def statistical(data: xr.Dataset) -> str:
    """What an accuracy of R costs in each scene, and how errors fall with time."""
    head = ["scene", "R", "slope, longer runs", "slope, more seeds", "autocorrelation time"]
    rows = []
    for name in data.scene.values:
        one = data.sel(scene=name)
        slopes = (
            f"{float(one.slope.sel(way=way)):.3f} ± {float(one.slope_stderr.sel(way=way)):.3f}"
            for way in data.way.values
        )
        memory = (
            f"{float(one.autocorrelation_time):.2f} ± {float(one.autocorrelation_time_stderr):.2f}"
        )
        R = f"{float(one.R):.5f} ± {float(one.R_stderr):.5f}"
        rows.append([name, R, *slopes, f"{memory} {one.length_unit.item()}"])
    costs = ["scene", "equilibration", *(f"{x:.1%}" for x in data.relative_error.values)]
    priced = [_prices(data.sel(scene=name)) for name in data.scene.values]
    about = f"r = {data.attrs['r']}, β = {data.attrs['beta']}"
    return (
        f"## Statistical error ({about})\n\n{_table(head, rows)}\n"
        "CPU seconds of one core for a relative error of R, equilibration included, and how long"
        f" the run is:\n\n{_table(costs, priced)}"
    )


def discretisation(data: xr.Dataset) -> str:
    """Deviations of soft spheres and of the contact-time model, and what they cost."""
    steps = data.steps.values
    head = ["t_c ν", *(f"soft spheres, {n} steps" for n in steps)]
    rows = [
        [f"{t:g}", *(_percent(data, "soft", steps=n, contact_time=t) for n in steps)]
        for t in data.contact_time.values
    ]
    rows.append(["order in t_c", *_pairs(data.order, data.order_stderr, "{:.2f} ± {:.2f}")])
    rows.append(["R at t_c → 0", *_pairs(data.limit_R, data.limit_R_stderr, "{:.4f} ± {:.4f}")])
    for target in data.target.values:
        slower = data.slowdown.sel(target=target).values
        cells = ("–" if np.isnan(x) else f"{x:.0f} times" for x in slower)
        rows.append([f"slower than events at {target:.1%}", *cells])
    model = [
        [f"{t:g}", _percent(data, "model", model_contact_time=t), f"{float(touched):.2%}"]
        for t, touched in zip(data.model_contact_time.values, data.model_touched, strict=True)
    ]
    about = f"r = {data.attrs['r']}, β = {data.attrs['beta']}, packing {data.attrs['packing']}"
    reference = f"{float(data.reference_R):.5f} ± {float(data.reference_R_stderr):.5f}"
    return (
        f"## Discretisation error ({about})\n\n"
        f"Deviation of R in % from events, R = {reference}:\n\n{_table(head, rows)}\n"
        "The contact-time model:\n\n"
        f"{_table(['t_c ν', 'deviation of R in %', 'contacts changed'], model)}\n{_precision(data)}"
    )


def models(data: xr.Dataset) -> str:
    """What each model of a cooling gas tends to, and what the Maxwellian theory misses."""
    about = f"r = {data.attrs['r']:g}, β = {data.attrs['beta']:g}"
    R = f"{float(data.R_reference):.5f} ± {float(data.R_reference_stderr):.5f}"
    closed = _scaled(data, "closed_form_error")
    rows = [
        ["closed form, Eq. (K)", f"{closed} %", f"{float(data.closed_form_seconds):.1e} s"],
        ["rate equations", f"{closed} %", f"{float(data.rate_equations_seconds[-1]):.1e} s"],
        ["DSMC", f"{_scaled(data, 'dsmc_floor')} %", f"{_reached(data):.2g} s"],
        ["event-driven", "none", f"{_until(data, 0.01)} for 1 %"],
    ]
    parts = [
        [what, f"{_scaled(data, name)} %"]
        for what, name in (
            ("Maxwellian, uncorrelated velocities", "of_maxwellian"),
            ("infinitely many particles", "of_number"),
            ("no density, no correlations of positions", "of_dilution"),
        )
    ]
    return (
        f"## Model error ({about})\n\nAgainst events, R = {R}:\n\n"
        f"{_table(['model', 'tends to an error of R of', 'CPU time'], rows)}\n"
        f"What the error of the closed form is made of:\n\n"
        f"{_table(['assumption', 'changes R by'], parts)}\n"
        "R of the homogeneous gas (DSMC) over R of Eq. (K), minus 1, in %:\n\n" + _map(data)
    )


def coverage(data: xr.Dataset) -> str:
    """How often intervals hold the truth, a corner a row, with standard errors."""
    data = in_order(data)
    head = ["corner", "runs", "68 %, one run", "95 %, one run", "68 %, pooled", "95 %, pooled"]
    head += ["bias / scatter", "stated / true error", "window / τ"]
    rows = [_corner(data, k) for k in range(data.sizes["corner"])]
    return f"## Coverage of the stated intervals\n\n{_table(head, rows)}"


def in_order(data: xr.Dataset) -> xr.Dataset:
    """The corners by experiment, and there from weak to strong dissipation."""
    known = [*SCENES, *dict.fromkeys(data.experiment.values)]
    scene = [known.index(name) for name in data.experiment.values]
    r, beta = data.r.values.astype(float), data.beta.values.astype(float)
    return data.isel(corner=np.lexsort((-beta, -r, scene)))


def label(data: xr.Dataset, k: int) -> str:
    """How the corner with this number is called."""
    corner = data.isel(corner=k)
    beta = str(np.asarray(corner.beta)).replace("-", "−")
    return f"{corner.experiment.values}, r = {corner.r.values}, β = {beta}"


def _corner(data: xr.Dataset, k: int) -> list[str]:
    one = data.isel(corner=k)
    shares = zip(one.coverage.values.ravel(), one.coverage_stderr.values.ravel(), strict=True)
    cells = [_with_error(100 * value, 100 * stderr) for value, stderr in shares]
    cells += [_with_error(float(one[name]), float(one[f"{name}_stderr"])) for name in JUDGED]
    window = float(one.window / one.autocorrelation_time)
    return [label(data, k), f"{int(one.repetitions)}", *cells, f"{window:.0f}"]


def _with_error(value: float, stderr: float) -> str:
    digits = max(0, 1 - math.floor(math.log10(stderr))) if stderr > 0 else 2
    return f"{value:.{digits}f} ± {stderr:.{digits}f}"


def _scaled(data: xr.Dataset, name: str) -> str:
    return _with_error(100 * float(data[name]), 100 * float(data[f"{name}_stderr"]))


def _until(data: xr.Dataset, error: float) -> str:
    """CPU time after which events are as good as that, by the fit to their errors."""
    seconds = (error / float(data.event_driven_prefactor)) ** (1 / float(data.event_driven_slope))
    return f"{seconds:.2g} s"


def _reached(data: xr.Dataset) -> float:
    """CPU time of the shortest DSMC run whose noise has come down to its floor: within a third."""
    near = data.dsmc_error.values < 4 / 3 * float(data.dsmc_floor)
    return float(data.dsmc_seconds.values[near][0]) if near.any() else math.nan


def _map(data: xr.Dataset) -> str:
    head = ["β", *(f"r = {r:g}" for r in data.map_r.values)]
    gaps = zip(data.map_gap.values.T, data.map_gap_stderr.values.T, strict=True)
    rows = [
        [f"{beta:g}", *(_with_error(100 * g, 100 * e) for g, e in zip(*pair, strict=True))]
        for beta, pair in zip(data.map_beta.values, gaps, strict=True)
    ]
    return _table(head, rows)


def _prices(one: xr.Dataset) -> list[str]:
    unit = "T" if one.length_unit.item() == "T" else "c.p.p."
    cells = zip(
        one.seconds_needed.values,
        one.seconds_needed_stderr.values,
        one.length_needed.values,
        strict=True,
    )
    shown = (f"{s:.2g} ± {e:.1g} s ({length:.3g} {unit})" for s, e, length in cells)
    return [one.scene.item(), f"{float(one.equilibration_seconds):.2g} s", *shown]


def _precision(data: xr.Dataset) -> str:
    speed = float(data.elastic_speed_single / data.elastic_speed_double)
    drift = (
        f"{float(data.elastic_drift_single):.1e} ± {float(data.elastic_drift_stderr_single):.0e}"
    )
    double = f"{float(data.elastic_drift_double):.0e}"
    return (
        f"Trajectories kept in single precision: deviation of R {_percent(data, 'single')} %, an"
        f" elastic gas's energy drifts by {drift} of itself a collision ({double} in double"
        f" precision), {speed:.2f} times as fast.\n"
    )


def _percent(data: xr.Dataset, kind: str, **place: float) -> str:
    values = (data[f"{kind}_{name}"].sel(place) for name in ("deviation", "deviation_stderr"))
    return PERCENT.format(*(100 * float(value) for value in values))


def _pairs(values: xr.DataArray, errors: xr.DataArray, how: str) -> list[str]:
    return [how.format(*pair) for pair in zip(values.values, errors.values, strict=True)]


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)
