"""What the studies have found, as tables in Markdown: a function a study."""

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

PERCENT = "{:+.2f} ± {:.2f}"


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
    costs = ["scene", "equilibration", *(f"{x:.1%}" for x in data.accuracy.values)]
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
        f"Deviation of R in % from events, R = {reference}:\n\n{_table(head, rows)}\nThe contact-time model:\n\n"
        f"{_table(['t_c ν', 'deviation of R in %', 'contacts changed'], model)}\n{_precision(data)}"
    )


def coverage(data: xr.Dataset) -> str:
    """How often intervals hold the truth, at each corner."""
    from roughgas.plotting.accuracy.coverage import table

    return "## Coverage of the stated intervals\n\n" + "\n".join(table(data)) + "\n"


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
