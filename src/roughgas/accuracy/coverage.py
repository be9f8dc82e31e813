"""How often the intervals that datasets state hold the truth.

At each corner (experiment, r, beta) a short point is repeated many times through the protocol that
every point goes through, each time with another seed. The truth is the mean of a few long runs with
the experiment's own equilibration and other seeds. An interval at 95 % should hold it in 95 of 100
repetitions: that of one run, and that of several seeds pooled.
"""

import math
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from roughgas.accuracy import VARIABLES, in_order
from roughgas.scene import build
from roughgas.simulation import schedule
from roughgas.simulation.point import run_point
from roughgas.statistics.errors import YES, Estimate, half_width, pooled
from roughgas.tasks import along, cell, dataset, label, markdown, stacked, stream, timed, variables

LEVELS = (0.68, 0.95)
WAYS = ("one run", "pooled seeds")
UNIT = "T; in a cooling gas a collision per particle"
REGROUPINGS = 100
MEASURED = ("R", "R_stderr", "R_dof", "equilibrated", "autocorrelation_time", "measured_from")


def tasks(settings: Mapping[str, Any]) -> list[str]:
    """Return the names of the tasks, one a corner, in the order of the settings."""
    return [corner_name(one) for one in settings["corners"]]


def corner_name(corner: Mapping[str, Any]) -> str:
    """Return the name of the task for a corner."""
    return f"{corner['experiment']}_r{corner['r']}_beta{corner['beta']}"


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return what each repetition at a corner states, and each run of its reference (`truth_...`).

    A run of the reference goes by the experiment's own schedule, but is longer.
    """
    corner = next(one for one in settings["corners"] if corner_name(one) == task)
    experiment, reference = experiments[corner["experiment"]], settings["reference"]
    short, length = experiment["schedule"] | corner["schedule"], schedule.of(experiment).LENGTH
    long = experiment["schedule"] | {length: reference["length"] * short[length]}
    work = [short] * settings["repetitions"] + [long] * reference["seeds"]
    drawn = stream(settings, zlib.crc32(task.encode())).generate_state(len(work), "u8") >> 1
    _point(experiment, short, corner, 0)  # compiles
    rows, seconds = [], 0.0
    for one, seed in zip(work, drawn.tolist(), strict=True):
        row, passed = timed(_point, experiment, one, corner, seed)
        rows.append(row)
        seconds += passed
        progress(len(rows), len(work))
    parts = np.split(np.array(rows, float), [settings["repetitions"]])
    found = {"cpu_seconds": seconds, "window": short[length] * short.get("replicas", 1)}
    for prefix, dim, part in zip(("", "truth_"), ("run", "long_run"), parts, strict=True):
        found |= {prefix + name: (dim, x) for name, x in zip(MEASURED, part.T, strict=True)}
    return xr.Dataset(found)


def _point(experiment, own_schedule, corner, seed) -> list[float]:
    settings = experiment | {"schedule": own_schedule}
    scene = build(settings, float(corner["r"]), float(corner["beta"]))
    measured = run_point(scene, settings, seed).variables
    return [measured[name] for name in MEASURED]


def combine(parts: Mapping[str, xr.Dataset], settings: Mapping[str, Any]) -> xr.Dataset:
    """Return coverage, bias and the size of the stated errors at every corner, from all tasks."""
    corners = settings["corners"]
    names = [corner_name(corner) for corner in corners]
    found = stacked([_corner(parts[name], settings) for name in names])
    found |= {key: [corner[key] for corner in corners] for key in ("experiment", "r", "beta")}
    found |= {"corner": names, "way": list(WAYS), "level": list(LEVELS)}
    known = variables(VARIABLES, "coverage")
    return dataset(known, found, seed=settings["seed"], unit_of_length=UNIT)


def calibrate(
    runs: Estimate, truth: Estimate, levels: Sequence[float], seeds: int, rng: np.random.Generator
) -> dict[str, Any]:
    """Return coverage over (way, level): of intervals of one run, and of `seeds` pooled; bias and
    errors. That of the bias allows for that of the truth. `rng` puts the runs into groups.

    `runs` is what independent runs state, arrays of shape (runs,).
    """
    number, scatter = len(runs.value), float(runs.value.std(ddof=1))
    ways = one_run(runs, truth.value, levels), several(runs, truth.value, levels, seeds, rng)
    shares = np.array([[share[:2] for share in way] for way in ways])
    square = runs.stderr**2
    stated = math.sqrt(square.mean()) / scatter
    off = (runs.value - runs.value.mean()) ** 2
    # Of a root of a quotient of two means: half of the relative errors of both
    uncertain = math.hypot(off.std() / off.mean(), square.std() / square.mean()) / 2
    bias = (float(runs.value.mean()) - truth.value) / scatter
    return {
        "coverage": Estimate(shares[..., 0], shares[..., 1]),
        "bias": Estimate(bias, math.hypot(1 / math.sqrt(number), truth.stderr / scatter)),
        "stated_over_true": Estimate(stated, stated * uncertain / math.sqrt(number)),
        "scatter": scatter,
    }


def one_run(runs: Estimate, truth: float, levels: Sequence[float]) -> list[Estimate]:
    """Return how often the intervals of single runs hold `truth`, at each of `levels`.

    The error is that of Laplace's estimate, (k + 1)/(n + 2), and does not vanish at 0 or 1.
    """
    shares = []
    for held in (_held(runs, truth, level) for level in levels):
        likely = (held.sum() + 1) / (len(held) + 2)
        shares.append(Estimate(float(held.mean()), math.sqrt(likely * (1 - likely) / len(held))))
    return shares


def several(
    runs: Estimate, truth: float, levels: Sequence[float], seeds: int, rng: np.random.Generator
) -> list[Estimate]:
    """Return how often the intervals of `seeds` runs pooled hold `truth`, at each of `levels`.

    The runs are put into groups at random again and again: an incomplete U-statistic (Blom,
    Biometrika 63, 573 (1976)), several times as precise as one division into groups. To leading
    order its variance is that of Hoeffding, Ann. Math. Stat. 19, 293 (1948): seeds^2/runs times the
    variance, over runs, of how often the groups with this run hold the truth.
    """
    number = len(runs.value) // seeds * seeds
    orders = [rng.permutation(len(runs.value))[:number] for _ in range(REGROUPINGS)]
    groups = np.concatenate(orders).reshape(-1, seeds)
    errors = [pooled(*(part[group] for part in runs)) for group in groups]
    pools = Estimate(runs.value[groups].mean(axis=1), *np.array(errors).T)
    return [_hoeffding(_held(pools, truth, level), groups, len(runs.value)) for level in levels]


def _held(runs: Estimate, truth: float, level: float) -> np.ndarray:
    """Return whether the interval of each run holds the truth; without an interval it does not."""
    known = zip(runs.stderr, runs.dof, strict=True)
    widths = [half_width(stderr, dof, level) for stderr, dof in known]
    return np.abs(runs.value - truth) <= np.array(widths)


def _hoeffding(held: np.ndarray, groups: np.ndarray, runs: int) -> Estimate:
    """Return the share of groups that hold the truth; never known better than to one run."""
    seeds, value = groups.shape[1], float(held.mean())
    times = np.bincount(groups.ravel(), minlength=runs)
    with_run = np.bincount(groups.ravel(), np.repeat(held, seeds), minlength=runs) / times
    chance = value * (1 - value) / times.mean()  # from a finite number of groups
    variance = seeds**2 / runs * max(0.0, float(with_run.var(ddof=1)) - chance)
    return Estimate(value, max(math.sqrt(variance + chance * seeds / runs), 1 / runs))


def _corner(part: xr.Dataset, settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return every variable of one corner."""
    runs, long = (
        Estimate(*(part[prefix + name].values for name in ("R", "R_stderr", "R_dof")))
        for prefix in ("", "truth_")
    )
    truth = Estimate(float(long.value.mean()), pooled(*long).stderr)
    rng = np.random.default_rng(np.random.SeedSequence(settings["seed"], spawn_key=(0,)))
    return calibrate(runs, truth, LEVELS, settings["pooled"], rng) | {
        "truth": truth,
        "dof": float(np.median(runs.dof)),
        "repetitions": len(runs.value),
        "equilibrated": float((part.equilibrated == YES).mean()),
        "autocorrelation_time": float(part.truth_autocorrelation_time.mean()),
        "window": float(part.window),
        "cpu_seconds": float(part.cpu_seconds),
    }


def table(data: xr.Dataset) -> str:
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
