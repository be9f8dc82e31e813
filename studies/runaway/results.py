"""Times for which a cooling gas with friction keeps the R of the rate equations, and the particles
that end this state.

Sooner or later a particle spins so fast that sliding contacts cannot stop it before the surrounding
gas has cooled (roughgas.theory.friction), and in the end holds nearly all energy: R goes to 1. The
more particles, the sooner. Runs end at R > RUNAWAY_R, or at a limit, which bounds the time.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from roughgas import theory
from roughgas.tasks import (
    Estimate,
    dataset,
    estimate_ratio,
    markdown,
    mean_estimate,
    read_variables,
    slices_along,
    stack_rows,
    table_cell,
)

from .tasks import SIMULATED, task_name

VARIABLES = Path(__file__).with_name("variables.yaml")
EXCLUDED_ESCAPES = -math.log(0.05)
"""Mean number of escapes excluded at 95 % by an observation of none."""
WAITING_FACTOR = 10.0
"""Multiple of the growth time in theory: gases that take longer have mostly waited for a
particle."""


def combine(task_results: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return times of escape and participation over mu and the number of particles, by both
    methods; the rate of crossings of the threshold; and an example over time."""
    r, beta, friction = float(settings["r"]), float(settings["beta"]), settings["mu"]
    values: dict[str, Any] = {"mu": friction}
    for kind in SIMULATED:
        particles = [gas["particles"] for gas in settings[kind]]
        rows = [
            [_escapes(task_results[task_name(kind, n, mu)]) for n in particles] for mu in friction
        ]
        gases = stack_rows([stack_rows(row) for row in rows])
        values |= {f"{kind}_{name}": x for name, x in gases.items()}
        values[f"{kind}_particles"] = particles
    values |= _events_over_dsmc(values)
    numbers = np.array(values["dsmc_particles"])
    values |= stack_rows([_rate(task_results, numbers, mu, (r, beta, mu)) for mu in friction])
    mu = np.array(friction)
    values["threshold"] = theory.runaway_spin(r, beta, mu)
    values["predicted_rate"] = theory.runaway_rate(r, beta, mu)
    values["predicted_time"] = theory.runaway_time(numbers, r, beta, mu[:, np.newaxis])
    values["maxwellian_share"] = theory.maxwellian_share(r, beta, mu)
    values |= _example(task_results, settings["example"])
    attributes = {"r": r, "beta": beta, "packing": settings["packing"], "seed": settings["seed"]}
    return dataset(read_variables(VARIABLES), values, **attributes)


def time_of_escape(time: np.ndarray, observed: np.ndarray) -> tuple[Estimate, float]:
    """Return the mean time of escape with its error, and a lower bound at 95 % if none escaped.

    `time` is NaN for runs that were ended after `observed`. With such runs, the time is the mean
    waiting time at a constant rate: all observed time over the number of escapes.
    """
    escapes, total = int(np.isfinite(time).sum()), float(observed.sum())
    if escapes == 0:
        return Estimate(math.nan, math.nan), total / EXCLUDED_ESCAPES
    if escapes == len(time) > 1:
        return mean_estimate(time), math.nan
    return Estimate(total / escapes, total / escapes**1.5), math.nan


def _escapes(runs: xr.Dataset) -> dict[str, Any]:
    """Return all variables of one gas; medians are over the runs with an escape."""
    time, observed = runs.time.values, runs.observed.values
    value, bound = time_of_escape(time, observed)
    gone = np.isfinite(time)
    share, number = (runs[name].values[gone] for name in ("largest_share", "participation"))
    return {
        "time": value,
        "bound": bound,
        "escapes": int(gone.sum()),
        "runs": len(time),
        "largest_share": np.median(share) if gone.any() else math.nan,
        "participation": np.median(number) if gone.any() else math.nan,
        "seconds": float(runs.seconds.sum()),
    }


def _events_over_dsmc(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return times by events over times by DSMC of equal numbers of particles; NaN if one is
    unknown."""
    ratios = np.full((2, *np.shape(values["events_time"])), math.nan)
    numbers = list(values["dsmc_particles"])
    for index in np.ndindex(ratios.shape[1:]):
        number = values["events_particles"][index[1]]
        if number in numbers:
            dsmc_index = index[0], numbers.index(number)
            pair = (
                Estimate(*(float(values[name][position]) for name in (key, f"{key}_stderr")))
                for key, position in (("events_time", index), ("dsmc_time", dsmc_index))
            )
            ratios[:, *index] = estimate_ratio(*pair)[:2]
    return {"events_over_dsmc": Estimate(*ratios)}


def _rate(task_results, numbers, mu, gas) -> dict[str, Any]:
    """Return the number of crossings of the threshold per particle and collision of a particle.

    It counts the gases without positions that have mostly waited for a crossing.
    """
    escapes, exposed = 0, 0.0
    growth = np.asarray(theory.runaway_growth(numbers, *gas))
    for number, grown in zip(numbers, growth, strict=True):
        runs = task_results[task_name("dsmc", number, mu)]
        gone, observed = int(np.isfinite(runs.time).sum()), runs.observed.values
        if observed.sum() > WAITING_FACTOR * grown * max(gone, 1):
            escapes += gone
            exposed += number * float((observed - grown * np.isfinite(runs.time.values)).sum())
    rate = escapes / exposed if escapes else math.nan
    bound = EXCLUDED_ESCAPES / exposed if exposed and not escapes else math.nan
    return {"rate": Estimate(rate, rate / math.sqrt(max(escapes, 1))), "rate_bound": bound}


def _example(task_results, example) -> dict[str, Any]:
    """Return R and participation over time, of one gas at each mu."""
    runs = [task_results[task_name("example", example["particles"], mu)] for mu in example["mu"]]
    values = {
        f"example_{name}": np.array([run[name].values for run in runs])
        for name in ("R", "largest_share", "participation")
    }
    samples = values["example_R"].shape[1]
    passed = example["limit"] / samples * np.arange(1, samples + 1)
    values |= {"example_mu": example["mu"], "example_particles": example["particles"]}
    return values | {"passed": passed}


def table(data: xr.Dataset) -> str:
    """Return times of escape and the largest shares over mu and N, and the rates of crossings,
    Markdown."""
    kinds = {"dsmc": "homogeneous gases (DSMC)", "events": "event-driven gases"}
    tables = [_escape_table(data, kind, description) for kind, description in kinds.items()]
    rows = []
    for gas in slices_along(data, "mu"):
        bound = f"< {gas.rate_bound:.1e}" if np.isfinite(gas.rate_bound) else "–"
        rate = f"{gas.rate:.1e} ± {gas.rate_stderr:.0e}" if np.isfinite(gas.rate) else bound
        theory = f"{gas.predicted_rate:.1e}" if np.isfinite(gas.predicted_rate) else "–"
        share = f"{gas.maxwellian_share:.0e}"
        rows.append([f"{gas.mu:g}", f"{gas.threshold:.3g}", rate, theory, share])
    head = ["μ", "threshold a w / √(T_tr/m)", "crossings", "large deviations", "Maxwellian share"]
    return (
        f"## Runaway spins (r = {data.attrs['r']}, β = {data.attrs['beta']}, packing"
        f" {data.attrs['packing']:g})\n\n"
        + "".join(tables)
        + f"Crossings of the threshold per particle and collision of a particle:\n\n"
        f"{markdown(head, rows)}"
    )


def _escape_table(data, kind, gases_text):
    """Return times of escape by one method, with escapes/runs and the largest share, Markdown."""
    numbers = data[f"{kind}_particles"].values
    rows = []
    for at_mu in slices_along(data, "mu"):
        row = [f"{at_mu.mu:g}"]
        for gas in slices_along(at_mu, f"{kind}_particles"):
            time, bound = table_cell(gas, f"{kind}_time", "±"), float(gas[f"{kind}_bound"])
            shown = f"> {bound:.0f}" if np.isfinite(bound) else time
            count = f"{int(gas[f'{kind}_escapes'])}/{int(gas[f'{kind}_runs'])}"
            share = float(gas[f"{kind}_largest_share"])
            row.append(f"{shown} ({count}{'' if np.isnan(share) else f'; {share:.2f}'})")
        rows.append(row)
    head = ["μ", *(f"N = {n}" for n in numbers)]
    return (
        f"Collisions per particle until R > 0.9 in {gases_text} (runs that escaped of all; largest"
        f" share of a particle in the energy of spins then):\n\n{markdown(head, rows)}\n"
    )
