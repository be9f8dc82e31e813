"""Coverage of the confidence intervals that datasets state.

At each corner (experiment, r, beta) a short point is repeated many times by the protocol of every
point, each time with another seed. The truth is the mean of a few long runs with the experiment's
own equilibration and other seeds. An interval at 95 % should hold the truth in 95 of 100
repetitions, both the interval of one run and that from several seeds pooled.
"""

import math
import zlib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from roughgas.base import NamedValues
from roughgas.base.fields import OwnSettings
from roughgas.scene import build
from roughgas.simulation import protocols
from roughgas.simulation.point import run_point
from roughgas.statistics.errors import half_width, pooled_error
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import YES
from roughgas.tasks import (
    dataset,
    markdown,
    point_title,
    read_variables,
    seed_sequence,
    slices_along,
    stack_rows,
    table_cell,
    timed,
)

from .corners import in_order

VARIABLES = Path(__file__).with_name("variables.yaml")
LEVELS = (0.68, 0.95)
INTERVALS = ("one run", "pooled seeds")
UNIT_OF_LENGTH = "T; in a cooling gas a collision per particle"
REGROUPINGS = 100
RUN_VARIABLES = ("R", "R_stderr", "R_dof", "equilibrated", "autocorrelation_time", "measured_from")


def tasks(settings: OwnSettings) -> list[str]:
    """Return the names of the tasks, one for each corner, in the order of the settings."""
    return [corner_name(corner) for corner in settings["corners"]]


def corner_name(corner: OwnSettings) -> str:
    """Return the name of the task for a corner."""
    return f"{corner['experiment']}_r{corner['r']}_beta{corner['beta']}"


def run(task: str, settings, experiments, progress: Callable[[int, int], None]) -> xr.Dataset:
    """Return RUN_VARIABLES of each repetition at a corner, and of each run of its reference
    (`truth_...`).

    A run of the reference has the experiment's own schedule with a longer measurement.
    """
    corner = next(row for row in settings["corners"] if corner_name(row) == task)
    experiment, reference = experiments[corner["experiment"]], settings["reference"]
    short = experiment.changed({"schedule": corner["schedule"]})
    key = protocols.protocol_of(experiment).LENGTH
    length = getattr(short.schedule, key)
    long = experiment.changed({"schedule": {key: reference["length"] * length}})
    work = [short] * settings["repetitions"] + [long] * reference["seeds"]
    seeds = seed_sequence(settings, zlib.crc32(task.encode())).generate_state(len(work), "u8") >> 1
    _point(short, corner, 0)  # compiles
    rows, seconds = [], 0.0
    for settings_of_run, seed in zip(work, seeds.tolist(), strict=True):
        numbers, passed = timed(_point, settings_of_run, corner, seed)
        rows.append(numbers)
        seconds += passed
        progress(len(rows), len(work))
    run_groups = np.split(np.array(rows, float), [settings["repetitions"]])
    values = {"cpu_seconds": seconds, "window": length * getattr(short.schedule, "replicas", 1)}
    for prefix, dim, group in zip(("", "truth_"), ("run", "long_run"), run_groups, strict=True):
        values |= {prefix + name: (dim, x) for name, x in zip(RUN_VARIABLES, group.T, strict=True)}
    return xr.Dataset(values)


def _point(experiment, corner, seed) -> list[float]:
    scene = build(experiment, float(corner["r"]), float(corner["beta"]))
    measured = run_point(scene, experiment, seed).variables
    return [measured[name] for name in RUN_VARIABLES]


def combine(task_results: Mapping[str, xr.Dataset], settings: OwnSettings) -> xr.Dataset:
    """Return coverage, bias and the size of the stated errors at every corner, from all tasks."""
    corners = settings["corners"]
    names = [corner_name(corner) for corner in corners]
    values = stack_rows([_corner(task_results[name], settings) for name in names])
    values |= {key: [corner[key] for corner in corners] for key in ("experiment", "r", "beta")}
    values |= {"corner": names, "way": list(INTERVALS), "level": list(LEVELS)}
    descriptions = read_variables(VARIABLES)
    return dataset(descriptions, values, seed=settings["seed"], unit_of_length=UNIT_OF_LENGTH)


def calibrate(
    runs: Estimate, truth: Estimate, levels: Sequence[float], seeds: int, rng: np.random.Generator
) -> NamedValues:
    """Return coverage over (way, level), of intervals of one run and of `seeds` pooled runs; bias,
    and the size of stated errors over the scatter.

    `runs` are estimates from independent runs, arrays of shape (runs,). The error of the bias
    includes the error of the truth. `rng` puts the runs into groups.
    """
    number, scatter = len(runs.value), float(runs.value.std(ddof=1))
    ways = one_run(runs, truth.value, levels), pooled_runs(runs, truth.value, levels, seeds, rng)
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
    """Return the share of single runs whose intervals hold `truth`, at each of `levels`.

    The error is from Laplace's estimate, (k + 1)/(n + 2), and does not vanish at 0 or 1.
    """
    shares = []
    for held in (_held(runs, truth, level) for level in levels):
        likely = (held.sum() + 1) / (len(held) + 2)
        shares.append(Estimate(float(held.mean()), math.sqrt(likely * (1 - likely) / len(held))))
    return shares


def pooled_runs(
    runs: Estimate, truth: float, levels: Sequence[float], seeds: int, rng: np.random.Generator
) -> list[Estimate]:
    """Return the share of groups of `seeds` runs whose pooled intervals hold `truth`, at each of
    `levels`.

    The runs are put into groups at random again and again: an incomplete U-statistic (Blom,
    Biometrika 63, 573 (1976)), several times as precise as one division into groups. To leading
    order its variance is, by Hoeffding, Ann. Math. Stat. 19, 293 (1948), seeds^2/runs times the
    variance, over runs, of the coverage of the groups with this run.
    """
    number = len(runs.value) // seeds * seeds
    orders = [rng.permutation(len(runs.value))[:number] for _ in range(REGROUPINGS)]
    groups = np.concatenate(orders).reshape(-1, seeds)
    errors = [pooled_error(*(column[group] for column in runs)) for group in groups]
    pools = Estimate(runs.value[groups].mean(axis=1), *np.array(errors).T)
    return [_hoeffding(_held(pools, truth, level), groups, len(runs.value)) for level in levels]


def _held(runs: Estimate, truth: float, level: float) -> np.ndarray:
    """Return whether the interval of each run holds the truth; a run without an interval does
    not."""
    errors = zip(runs.stderr, runs.dof, strict=True)
    widths = [half_width(stderr, dof, level) for stderr, dof in errors]
    return np.abs(runs.value - truth) <= np.array(widths)


def _hoeffding(held: np.ndarray, groups: np.ndarray, runs: int) -> Estimate:
    """Return the share of groups that hold the truth; its error is at least one run's share."""
    seeds, value = groups.shape[1], float(held.mean())
    times = np.bincount(groups.ravel(), minlength=runs)
    with_run = np.bincount(groups.ravel(), np.repeat(held, seeds), minlength=runs) / times
    chance = value * (1 - value) / times.mean()  # from a finite number of groups
    variance = seeds**2 / runs * max(0.0, float(with_run.var(ddof=1)) - chance)
    return Estimate(value, max(math.sqrt(variance + chance * seeds / runs), 1 / runs))


def _corner(task_result: xr.Dataset, settings: OwnSettings) -> NamedValues:
    """Return every variable of one corner."""
    runs, long = (
        Estimate(*(task_result[prefix + name].values for name in ("R", "R_stderr", "R_dof")))
        for prefix in ("", "truth_")
    )
    truth = Estimate(float(long.value.mean()), pooled_error(*long).stderr)
    rng = np.random.default_rng(np.random.SeedSequence(settings["seed"], spawn_key=(0,)))
    return calibrate(runs, truth, LEVELS, settings["pooled"], rng) | {
        "truth": truth,
        "dof": float(np.median(runs.dof)),
        "repetitions": len(runs.value),
        "equilibrated": float((task_result.equilibrated == YES).mean()),
        "autocorrelation_time": float(task_result.truth_autocorrelation_time.mean()),
        "window": float(task_result.window),
        "cpu_seconds": float(task_result.cpu_seconds),
    }


def table(data: xr.Dataset) -> str:
    """Return the coverage of intervals, one row per corner, with standard errors, Markdown."""
    head = ["corner", "runs", "68 %, one run", "95 %, one run", "68 %, pooled", "95 %, pooled"]
    head += ["bias / scatter", "stated / true error", "window / τ"]
    rows = []
    for corner in slices_along(in_order(data), "corner"):
        shares = [
            share for way in slices_along(corner, "way") for share in slices_along(way, "level")
        ]
        cells = [table_cell(share, "coverage", "±", 100) for share in shares]
        cells += [table_cell(corner, name, "±") for name in ("bias", "stated_over_true")]
        window = f"{float(corner.window / corner.autocorrelation_time):.0f}"
        rows.append([point_title(corner), f"{int(corner.repetitions)}", *cells, window])
    return f"## Coverage of the stated intervals\n\n{markdown(head, rows)}"
