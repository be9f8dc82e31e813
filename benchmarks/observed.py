"""Which window each observable needs for errors that are right: misses of 95 % intervals.

    python -m benchmarks.observed [--seeds 80] [--jobs 2] [--scenes sheared bed]

Runs four gases for WINDOWS e-folds of the slowest mode of their two temperatures, with all
observables that apply. An element misses where its interval, by Student's t, does not hold the mean
over all runs of the longest window. A kind is measured at the first window of CRITERIA from which
on at most MOST of its trusted elements miss in each scene; trusted, but for the length of the
window. Errors of shares are from the scatter over runs, since elements of a run are correlated.
"""

import argparse
import math
import warnings
from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import partial
from multiprocessing import Pool
from typing import Any, NamedTuple

import numpy as np

from benchmarks.tables import table as as_table
from roughgas import simulate
from roughgas.observables import KINDS
from roughgas.statistics.errors import YES, half_width

WINDOWS, CRITERIA = (12, 24, 48, 96), (24, 48, 96)  # e-folds
MOST = 0.08
FEWEST = 20  # runs with trusted elements that a share is of
SPIN = {"spin": {"inertia": 0.5}}
ALL: dict[str, dict[str, Any]] = {
    "profiles": {"bins": 10},
    "cumulants": {},
    "histograms": {"bins": 16, "reach": 4.0},
    "spin_correlation": {},
    "contacts": {},
    "mean_square_displacement": {"lags": 5},
    "autocorrelation": {"delays": 10},
}
CLOSED = ALL | {"pair_correlation": {"bins": 4, "reach": 6.0}, "stress": {}}
AT_REST = CLOSED | {"heat_flux": {}, "flux_autocorrelation": {"delays": 10}}
ON_FLOOR = ALL | {"profiles": {"bins": 15, "height": 60.0}, "layer": {"phases": 16}}


class Case(NamedTuple):
    """A gas, and how it is observed."""

    relaxation: float  # T, e-fold of the slowest mode by theory: `slowest_relaxation` of long runs
    wait: float  # T
    sample_every: float  # T
    observables: Mapping[str, Mapping[str, Any]]
    settings: Mapping[str, Any]
    beta: float = 0.0
    period: float | None = None


CASES = {
    "sheared": Case(
        *(22.5, 200.0, 1.0, CLOSED),
        {"particles": 40, "box": (25, 25), "effects": SPIN | {"shear": {"velocity": 2}}},
    ),
    "heated": Case(
        *(5.8, 60.0, 1.04, AT_REST),
        {
            "particles": 40,
            "box": (25, 25),
            "effects": SPIN | {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}},
        },
    ),
    "bath": Case(
        *(10.6, 100.0, 2.0, AT_REST),
        {
            "particles": 20,
            "box": (20, 20),
            "effects": SPIN | {"langevin": {"interval": 0.5, "drag": 0.05, "temperature": 1.0}},
        },
        beta=-0.5,
    ),
    "bed": Case(
        *(0.89, 50.0, 1 / 16, ON_FLOOR),
        {
            "particles": 40,
            "box": (12.5, "open"),
            "effects": SPIN
            | {
                "gravity": {"acceleration": 1},
                "floor": {"amplitude": 5, "period": 1, "restitution": 1, "roughness": -1},
            },
        },
        period=1.0,
    ),
}


class Values(NamedTuple):
    """A variable of a run, flat."""

    value: np.ndarray
    half: np.ndarray  # half width of the 95 % interval
    trusted: np.ndarray  # but for the length of the window


class Misses(NamedTuple):
    """Of the elements of a kind in runs of a window."""

    trusted: float  # share
    missed: float  # share of those that are trusted
    error: float  # of this
    of_all: float  # share of all that have an error
    runs: int  # with trusted elements


def main() -> None:
    """Print a table for each scene, and the window of each kind."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=80)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--scenes", nargs="+", choices=CASES, default=[*CASES])
    options = parser.parse_args()
    measurements = {}
    for scene in options.scenes:
        measurements[scene] = measured(scene, range(1, options.seeds + 1), options.jobs)
        print(f"{scene}\n\n{table(measurements[scene])}", flush=True)
    for kind in KINDS:
        windows = window_of(kind, measurements.values())
        print(f"{kind}: {windows:g} e-folds" if windows < math.inf else f"{kind}: not known")


def measured(scene: str, seeds: Iterable[int], jobs: int) -> dict[tuple[str, int], Misses]:
    """Return the misses of each variable, and of each kind of observable, in each window."""
    places = [(window, seed) for window in WINDOWS for seed in seeds]
    with Pool(jobs) as pool:
        runs = pool.starmap(partial(run, scene), places, chunksize=1)
    return judged([window for window, _ in places], runs)


def judged(
    windows: Iterable[int], runs: Iterable[dict[str, Values]]
) -> dict[tuple[str, int], Misses]:
    """Return the misses of each variable and each kind in runs of these windows."""
    by_window = defaultdict(list)
    for window, entry in zip(windows, runs, strict=True):
        by_window[window].append(entry)
    last = by_window[WINDOWS[-1]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # no particle has been in a layer
        truth = {
            name: np.nanmean([entry[name].value for entry in last], axis=0) for name in last[0]
        }
    parts = {name: [name] for name in truth}
    for name in truth:
        parts.setdefault(name.partition(".")[0], []).append(name)
    return {
        (name, window): misses(measurements, names, truth)
        for window, measurements in by_window.items()
        for name, names in parts.items()
    }


def run(scene: str, window: int, seed: int) -> dict[str, Values]:
    """Return the values of all observables in a run of `window` e-folds, by KIND.VARIABLE."""
    for kind in KINDS.values():  # of all criteria but the length of the window
        kind.relaxations, kind.beds, kind.doubtful = 0.0, True, ()
    case = CASES[scene]
    whole = case.period or case.sample_every
    schedule = {
        "kind": "steady",
        "equilibrate": case.wait,
        "measure": math.ceil(window * case.relaxation / whole) * whole,
        "sample_every": case.sample_every,
    } | ({"period": case.period} if case.period else {})
    point = simulate(
        r=0.9,
        beta=case.beta,
        seed=1000 * window + seed,
        schedule=schedule,
        observe=case.observables,
        progress=False,
        **case.settings,
    )
    return {
        f"{point[name].observable}.{name}": _values(point, str(name))
        for name in point.data_vars
        if f"{name}_trusted" in point and "observable" in point[name].attrs
    }


def _values(point, name):
    parts = [point[f"{name}{end}"].values.ravel() for end in ("", "_stderr", "_dof", "_trusted")]
    value, stderr, dof, trusted = parts
    half = [half_width(*entry, 0.95) for entry in zip(stderr, dof, strict=True)]
    return Values(value, np.array(half), trusted == YES)


def misses(
    runs: list[dict[str, Values]], names: list[str], truth: Mapping[str, np.ndarray]
) -> Misses:
    """Return the misses of some variables in runs of one window."""
    value, half, trusted = (
        np.array([np.concatenate([getattr(entry[name], part) for name in names]) for entry in runs])
        for part in Values._fields
    )
    expected = np.concatenate([truth[name] for name in names])
    away = np.abs(value - expected) > half
    known = (half > 0.0) & np.isfinite(expected)
    trusted &= known
    count = trusted.sum(axis=1)
    total = max(1, count.sum())
    share = (away & trusted).sum() / total
    scatter = ((away & trusted).sum(axis=1) - share * count).std() * math.sqrt(len(runs)) / total
    of_all = (away & known).sum() / max(1, known.sum())
    return Misses(total / trusted.size, share, scatter, of_all, int(np.count_nonzero(count)))


def table(measurements: Mapping[tuple[str, int], Misses]) -> str:
    """Return a row for each variable: of each window the share trusted, and misses in per cent."""
    names = sorted({name for name, _ in measurements})
    head = ["elements of", *(f"{window}: trusted, missed (all)" for window in WINDOWS)]
    rows = [[name, *(_cell(measurements[name, window]) for window in WINDOWS)] for name in names]
    return as_table(head, rows)


def _cell(entry: Misses) -> str:
    if not entry.runs:
        return f"0 ({100 * entry.of_all:.1f})"
    missed = f"{100 * entry.missed:.1f} ± {100 * entry.error:.1f}"
    return f"{100 * entry.trusted:.0f} %, {missed} ({100 * entry.of_all:.1f})"


def window_of(kind: str, scenes: Iterable[Mapping[tuple[str, int], Misses]]) -> float:
    """Return the e-folds from which on a kind misses at most MOST in each scene; infinite if none,
    or if too few runs show it."""
    needed = 0.0
    for measurements in scenes:
        shown = {w: measurements[kind, w] for w in CRITERIA if (kind, w) in measurements}
        good = [w for w, entry in shown.items() if entry.runs >= FEWEST and entry.missed <= MOST]
        bad = [w for w, entry in shown.items() if entry.runs >= FEWEST and entry.missed > MOST]
        if shown:
            later = [w for w in good if w > max(bad, default=0)]
            needed = max(needed, min(later, default=math.inf))
    return needed or math.inf


if __name__ == "__main__":
    main()
