"""How long a cooling gas with friction keeps the R of the rate equations, and who ends that.

Sooner or later a particle spins so fast that sliding contacts cannot stop it before the gas around
it has cooled (roughgas.theory.friction), and in the end holds nearly all energy: R goes to 1. The
more particles, the sooner. Runs end at R > ESCAPED, or at a limit, which bounds the time.
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
    along,
    cell,
    dataset,
    markdown,
    mean,
    over,
    stacked,
    variables,
)

from .tasks import SIMULATED, gas_name

VARIABLES = Path(__file__).with_name("variables.yaml")
EXCLUDED = -math.log(0.05)
"""Mean number of escapes that is excluded at 95 % where none was seen."""
WAITING = 10.0
"""Times the growth of theory: gases that take longer have mostly waited for a particle."""


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return times of escape and participation over mu and the number of particles, by both
    methods; the rate at which particles cross the threshold; and an example over time."""
    r, beta, friction = float(settings["r"]), float(settings["beta"]), settings["mu"]
    found: dict[str, Any] = {"mu": friction}
    for kind in SIMULATED:
        particles = [one["particles"] for one in settings[kind]]
        rows = [[_escapes(parts[gas_name(kind, n, mu)]) for n in particles] for mu in friction]
        gases = stacked([stacked(row) for row in rows])
        found |= {f"{kind}_{name}": x for name, x in gases.items()}
        found[f"{kind}_particles"] = particles
    found |= _compared(found)
    numbers = np.array(found["dsmc_particles"])
    found |= stacked([_rate(parts, numbers, mu, (r, beta, mu)) for mu in friction])
    mu = np.array(friction)
    found["threshold"] = theory.runaway_spin(r, beta, mu)
    found["predicted_rate"] = theory.runaway_rate(r, beta, mu)
    found["predicted_time"] = theory.runaway_time(numbers, r, beta, mu[:, np.newaxis])
    found["maxwellian_share"] = theory.maxwellian_share(r, beta, mu)
    found |= _example(parts, settings["example"])
    about = {"r": r, "beta": beta, "packing": settings["packing"], "seed": settings["seed"]}
    return dataset(variables(VARIABLES), found, **about)


def time_of_escape(time: np.ndarray, observed: np.ndarray) -> tuple[Estimate, float]:
    """Return the mean time of escape with its error, and a lower bound at 95 % if none escaped.

    `time` is NaN for runs that were given up after `observed`. If there are such, the time is that
    of waiting at a constant rate: all that was observed over the number of escapes.
    """
    escapes, total = int(np.isfinite(time).sum()), float(observed.sum())
    if escapes == 0:
        return Estimate(math.nan, math.nan), total / EXCLUDED
    if escapes == len(time) > 1:
        return mean(time), math.nan
    return Estimate(total / escapes, total / escapes**1.5), math.nan


def _escapes(part: xr.Dataset) -> dict[str, Any]:
    """Return all variables of one gas: of those who ran away, median share and participation."""
    time, observed = part.time.values, part.observed.values
    value, bound = time_of_escape(time, observed)
    gone = np.isfinite(time)
    share, number = (part[name].values[gone] for name in ("largest_share", "participation"))
    return {
        "time": value,
        "bound": bound,
        "escapes": int(gone.sum()),
        "runs": len(time),
        "largest_share": np.median(share) if gone.any() else math.nan,
        "participation": np.median(number) if gone.any() else math.nan,
        "seconds": float(part.seconds.sum()),
    }


def _compared(found: Mapping[str, Any]) -> dict[str, Any]:
    """Return times by events over those by DSMC of as many particles; NaN where one is unknown."""
    ratios = np.full((2, *np.shape(found["events_time"])), math.nan)
    numbers = list(found["dsmc_particles"])
    for place in np.ndindex(ratios.shape[1:]):
        number = found["events_particles"][place[1]]
        if number in numbers:
            there = place[0], numbers.index(number)
            pair = (
                Estimate(*(float(found[name][at]) for name in (key, f"{key}_stderr")))
                for key, at in (("events_time", place), ("dsmc_time", there))
            )
            ratios[:, *place] = over(*pair)[:2]
    return {"events_over_dsmc": Estimate(*ratios)}


def _rate(parts, numbers, mu, gas) -> dict[str, Any]:
    """Return how many particles cross the threshold per particle and collision of a particle.

    From the gases without positions that have mostly waited for one.
    """
    escapes, exposed = 0, 0.0
    growth = np.asarray(theory.runaway_growth(numbers, *gas))
    for number, grown in zip(numbers, growth, strict=True):
        part = parts[gas_name("dsmc", number, mu)]
        gone, observed = int(np.isfinite(part.time).sum()), part.observed.values
        if observed.sum() > WAITING * grown * max(gone, 1):
            escapes += gone
            exposed += number * float((observed - grown * np.isfinite(part.time.values)).sum())
    rate = escapes / exposed if escapes else math.nan
    bound = EXCLUDED / exposed if exposed and not escapes else math.nan
    return {"rate": Estimate(rate, rate / math.sqrt(max(escapes, 1))), "rate_bound": bound}


def _example(parts, about) -> dict[str, Any]:
    """Return R and participation over time, of one gas at each mu."""
    runs = [parts[gas_name("example", about["particles"], mu)] for mu in about["mu"]]
    found = {
        f"example_{name}": np.array([one[name].values for one in runs])
        for name in ("R", "largest_share", "participation")
    }
    samples = found["example_R"].shape[1]
    passed = about["limit"] / samples * np.arange(1, samples + 1)
    found |= {"example_mu": about["mu"], "example_particles": about["particles"]}
    return found | {"passed": passed}


def table(data: xr.Dataset) -> str:
    """Return times of escape and the largest shares over mu and N, and the rates behind them."""
    kinds = {"dsmc": "homogeneous gases (DSMC)", "events": "event-driven gases"}
    parts = [_table_of_escapes(data, kind, about) for kind, about in kinds.items()]
    rows = []
    for one in along(data, "mu"):
        bound = f"< {one.rate_bound:.1e}" if np.isfinite(one.rate_bound) else "–"
        rate = f"{one.rate:.1e} ± {one.rate_stderr:.0e}" if np.isfinite(one.rate) else bound
        theory = f"{one.predicted_rate:.1e}" if np.isfinite(one.predicted_rate) else "–"
        share = f"{one.maxwellian_share:.0e}"
        rows.append([f"{one.mu:g}", f"{one.threshold:.3g}", rate, theory, share])
    head = ["μ", "threshold a w / √(T_tr/m)", "crossings", "large deviations", "Maxwellian share"]
    return (
        f"## Runaway spins (r = {data.attrs['r']}, β = {data.attrs['beta']}, packing"
        f" {data.attrs['packing']:g})\n\n"
        + "".join(parts)
        + f"Crossings of the threshold per particle and collision of a particle:\n\n"
        f"{markdown(head, rows)}"
    )


def _table_of_escapes(data, kind, about):
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
