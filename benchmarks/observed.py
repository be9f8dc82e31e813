"""Window that each observable needs for correct errors, from misses of 95 % intervals.

    python -m benchmarks.observed [--seeds 80] [--jobs 2] [--scenes sheared bed]

Runs five gases for WINDOWS e-folds of the slowest mode of their two temperatures, with all
applicable observables. An element misses if its interval, by Student's t, does not contain the mean
over all runs of the longest window. The window of an observable is the first of CRITERIA from where
on at most a share MAX_MISSES of its trusted elements miss in each scene; trust by window length is
switched off. Errors of shares are from the scatter over runs, as elements of a run are correlated.
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
from roughgas.observables import OBSERVABLES
from roughgas.statistics.errors import half_width
from roughgas.statistics.sample_sizes import YES

WINDOWS, CRITERIA = (12, 24, 48, 96), (24, 48, 96)  # e-folds
MAX_MISSES = 0.08
MIN_RUNS = 20  # with trusted elements, for a share
SPIN = {"spin": {"inertia": 0.5}}
OPEN_OBSERVABLES: dict[str, dict[str, Any]] = {
    "profiles": {"bins": 10},
    "cumulants": {},
    "histograms": {"bins": 16, "reach": 4.0},
    "spin_correlation": {},
    "contacts": {},
    "mean_square_displacement": {"lags": 5},
    "autocorrelation": {"delays": 10},
}
CLOSED_OBSERVABLES = OPEN_OBSERVABLES | {
    "pair_correlation": {"bins": 4, "reach": 6.0},
    "stress": {},
}
RESTING_OBSERVABLES = CLOSED_OBSERVABLES | {"heat_flux": {}, "flux_autocorrelation": {"delays": 10}}
BED_OBSERVABLES = OPEN_OBSERVABLES | {
    "profiles": {"bins": 15, "height": 60.0},
    "layer": {"phases": 16},
    "wall_forces": {},
}


class Case(NamedTuple):
    """A gas, its schedule, and its observables."""

    relaxation: float  # T, e-fold of the slowest mode by theory: `slowest_relaxation` of long runs
    wait: float  # T
    sample_every: float  # T
    observables: Mapping[str, Mapping[str, Any]]
    settings: Mapping[str, Any]
    beta: float = 0.0
    period: float | None = None


CASES = {
    "sheared": Case(
        *(22.5, 200.0, 1.0, CLOSED_OBSERVABLES),
        {"particles": 40, "box": (25, 25), "effects": SPIN | {"shear": {"velocity": 2}}},
    ),
    "heated": Case(
        *(5.8, 60.0, 1.04, RESTING_OBSERVABLES),
        {
            "particles": 40,
            "box": (25, 25),
            "effects": SPIN | {"thermostat": {"power": 0.1, "interval": 0.5, "spin_share": 0}},
        },
    ),
    "bath": Case(
        *(10.6, 100.0, 2.0, RESTING_OBSERVABLES),
        {
            "particles": 20,
            "box": (20, 20),
            "effects": SPIN | {"langevin": {"interval": 0.5, "drag": 0.05, "temperature": 1.0}},
        },
        beta=-0.5,
    ),
    "bed": Case(
        *(0.89, 50.0, 1 / 16, BED_OBSERVABLES),
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
    "walled": Case(
        *(250.0, 500.0, 1.0, {"wall_forces": {}}),  # the e-fold of its flow
        {
            "particles": 40,
            "box": (20, 30),
            "effects": SPIN
            | {
                "bottom_wall": {"velocity": -1, "temperature": 1},
                "lid": {"restitution": 0.9, "roughness": 0.5},
            },
        },
    ),
}


class VariableValues(NamedTuple):
    """Values of a variable in a run, flattened."""

    value: np.ndarray
    half: np.ndarray  # half width of the 95 % interval
    trusted: np.ndarray  # by all criteria except the length of the window


class Misses(NamedTuple):
    """Misses among the elements of a variable or observable, in runs of a window."""

    trusted: float  # share of trusted elements
    missed: float  # share of misses among trusted elements
    error: float  # standard error of `missed`
    missed_of_all: float  # share of misses among all elements with an error
    runs: int  # number of runs with trusted elements


def main() -> None:
    """Print a table for each scene, and the window of each observable."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=80)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--scenes", nargs="+", choices=CASES, default=[*CASES])
    options = parser.parse_args()
    measurements = {}
    for scene in options.scenes:
        measurements[scene] = misses_of_scene(scene, range(1, options.seeds + 1), options.jobs)
        print(f"{scene}\n\n{table(measurements[scene])}", flush=True)
    for kind in OBSERVABLES:
        windows = window_of(kind, measurements.values())
        print(f"{kind}: {windows:g} e-folds" if windows < math.inf else f"{kind}: not known")


def misses_of_scene(scene: str, seeds: Iterable[int], jobs: int) -> dict[tuple[str, int], Misses]:
    """Simulate a scene; return the misses of each variable and each observable in each window."""
    window_seeds = [(window, seed) for window in WINDOWS for seed in seeds]
    with Pool(jobs) as pool:
        runs = pool.starmap(partial(run, scene), window_seeds, chunksize=1)
    return misses_by_window([window for window, _ in window_seeds], runs)


def misses_by_window(
    windows: Iterable[int], runs: Iterable[dict[str, VariableValues]]
) -> dict[tuple[str, int], Misses]:
    """Return the misses of each variable and each observable in runs of these windows."""
    by_window = defaultdict(list)
    for window, run in zip(windows, runs, strict=True):
        by_window[window].append(run)
    longest_runs = by_window[WINDOWS[-1]]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of layers without any particle
        truth = {
            name: np.nanmean([run[name].value for run in longest_runs], axis=0)
            for name in longest_runs[0]
        }
    names_by_key = {name: [name] for name in truth}
    for name in truth:
        names_by_key.setdefault(name.partition(".")[0], []).append(name)
    return {
        (name, window): misses(measurements, names, truth)
        for window, measurements in by_window.items()
        for name, names in names_by_key.items()
    }


def run(scene: str, window: int, seed: int) -> dict[str, VariableValues]:
    """Return the values of all observables in a run of `window` e-folds, by KIND.VARIABLE."""
    for kind in OBSERVABLES.values():  # switches off the criterion of the window's length
        kind.relaxations, kind.valid_in_beds, kind.unvalidated = 0.0, True, ()
    case = CASES[scene]
    time_step = case.period or case.sample_every
    schedule = {
        "kind": "steady",
        "equilibrate": case.wait,
        "measure": math.ceil(window * case.relaxation / time_step) * time_step,
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
    columns = [point[f"{name}{end}"].values.ravel() for end in ("", "_stderr", "_dof", "_trusted")]
    value, stderr, dof, trusted = columns
    half_widths = [half_width(*pair, 0.95) for pair in zip(stderr, dof, strict=True)]
    return VariableValues(value, np.array(half_widths), trusted == YES)


def misses(
    runs: list[dict[str, VariableValues]], names: list[str], truth: Mapping[str, np.ndarray]
) -> Misses:
    """Return the misses of some variables in runs of a window."""
    value, half, trusted = (
        np.array([np.concatenate([getattr(run[name], field) for name in names]) for run in runs])
        for field in VariableValues._fields
    )
    expected = np.concatenate([truth[name] for name in names])
    is_missed = np.abs(value - expected) > half
    has_interval = (half > 0.0) & np.isfinite(expected)
    trusted &= has_interval
    count = trusted.sum(axis=1)
    total = max(1, count.sum())
    share = (is_missed & trusted).sum() / total
    scatter = (
        ((is_missed & trusted).sum(axis=1) - share * count).std() * math.sqrt(len(runs)) / total
    )
    missed_of_all = (is_missed & has_interval).sum() / max(1, has_interval.sum())
    return Misses(total / trusted.size, share, scatter, missed_of_all, int(np.count_nonzero(count)))


def table(measurements: Mapping[tuple[str, int], Misses]) -> str:
    """Return a table with a row for each variable: for each window, the share of trusted elements,
    and misses in per cent."""
    names = sorted({name for name, _ in measurements})
    head = ["elements of", *(f"{window}: trusted, missed (all)" for window in WINDOWS)]
    rows = [[name, *(_cell(measurements[name, window]) for window in WINDOWS)] for name in names]
    return as_table(head, rows)


def _cell(cell_misses: Misses) -> str:
    if not cell_misses.runs:
        return f"0 ({100 * cell_misses.missed_of_all:.1f})"
    missed = f"{100 * cell_misses.missed:.1f} ± {100 * cell_misses.error:.1f}"
    return f"{100 * cell_misses.trusted:.0f} %, {missed} ({100 * cell_misses.missed_of_all:.1f})"


def window_of(kind: str, scenes: Iterable[Mapping[tuple[str, int], Misses]]) -> float:
    """Return the window (e-folds) of an observable: from there on its misses are at most MAX_MISSES
    in each scene; infinite without any, or with too few runs."""
    longest = 0.0
    for measurements in scenes:
        by_window = {w: measurements[kind, w] for w in CRITERIA if (kind, w) in measurements}
        passed = [
            w
            for w, run_misses in by_window.items()
            if run_misses.runs >= MIN_RUNS and run_misses.missed <= MAX_MISSES
        ]
        failed = [
            w
            for w, run_misses in by_window.items()
            if run_misses.runs >= MIN_RUNS and run_misses.missed > MAX_MISSES
        ]
        if by_window:
            later_passed = [w for w in passed if w > max(failed, default=0)]
            longest = max(longest, min(later_passed, default=math.inf))
    return longest or math.inf


if __name__ == "__main__":
    main()
