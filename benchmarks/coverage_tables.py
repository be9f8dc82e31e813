"""Tables of the coverage of trusted intervals, before and after a change of the program.

A tally counts the runs that a verdict selects, and the selected runs whose interval R ± `R_ci95`
misses the truth. `tables_of` compares the tallies of two checkouts.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from benchmarks import tables
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.sample_sizes import YES
from roughgas.statistics.student import wallace_sigmas

THEIRS, OURS = "theirs", "ours"
COLUMNS = {THEIRS: "before", OURS: "after"}
EMPTY_CELL = "–"
Row = list[str]


@dataclass(frozen=True)
class Runs:
    """Runs of a scene with the same schedule: arrays of shape (runs,), by variable."""

    number: float  # memories of the pilot run in the measurement, or in its first block
    measure: float  # T
    variables: Mapping[str, np.ndarray]

    def __getitem__(self, name: str) -> np.ndarray:
        return self.variables[name]

    def memories(self) -> np.ndarray:
        """Return the lengths of the runs in memories: of theory, or else of the pilot run."""
        memory = self["memory_of_R"]
        return np.where(np.isfinite(memory), self.measure / memory, self.number)

    def where(self, selected: np.ndarray) -> "Runs":
        """Return the selected runs only."""
        variables = {name: values[selected] for name, values in self.variables.items()}
        return Runs(self.number, self.measure, variables)


@dataclass(frozen=True)
class Tally:
    """Numbers of runs, of selected runs, and of selected runs whose interval misses the truth."""

    runs: int = 0
    selected: int = 0
    misses: int = 0
    sigmas: float = 0.0  # largest departure from the truth

    def __add__(self, other: "Tally") -> "Tally":
        runs, selected = self.runs + other.runs, self.selected + other.selected
        return Tally(runs, selected, self.misses + other.misses, max(self.sigmas, other.sigmas))

    @property
    def missing(self) -> float:
        """Share of misses among the selected runs; NaN without any."""
        return self.misses / self.selected if self.selected else math.nan

    @property
    def share(self) -> float:
        """Share of selected runs; NaN without any runs."""
        return self.selected / self.runs if self.runs else math.nan


def tally(runs: Runs, selected: np.ndarray, truth: Estimate) -> Tally:
    """Return the tally of runs, with `selected` a mask of shape (runs,).

    A selected run without an interval misses. Departures are in sigmas of a Gaussian with the
    probability of Student's t; their standard errors include the error of the truth.
    """
    departure = runs["R"] - truth.value
    covered = np.abs(departure) <= runs["R_ci95"]
    ratios = departure / np.hypot(runs["R_stderr"], truth.stderr)
    sigmas = [
        abs(float(wallace_sigmas(ratio, dof))) if dof > 0 else math.inf
        for ratio, dof in zip(ratios[selected], runs["R_dof"][selected], strict=True)
    ]
    misses = int((selected & ~covered).sum())
    return Tally(len(departure), int(selected.sum()), misses, max(sigmas, default=0.0))


class Scene(NamedTuple):
    """The truth of a scene, and the runs of a checkout: of each length, and to a target."""

    memory: float  # T, of the pilot run
    min_memories: float  # length above which runs should be trusted
    truth: Estimate
    lengths: Sequence[Runs]
    targets: Sequence[Runs]

    def all_runs(self, runs: Runs) -> Tally:
        """Return the tally of all runs of a length, trusted or not."""
        return tally(runs, np.full(len(runs["R"]), True), self.truth)

    def trusted(self, runs: Runs) -> Tally:
        """Return the tally of the trusted runs of a length."""
        return tally(runs, runs["R_ci95_trusted"] == YES, self.truth)

    def trusted_runs(self) -> Tally:
        """Return the tally of the trusted runs of all lengths."""
        return total(map(self.trusted, self.lengths))

    def trusted_long_runs(self) -> Tally:
        """Return the tally of the trusted runs among the runs of sufficient length."""
        return total(
            self.trusted(runs.where(runs.memories() >= self.min_memories)) for runs in self.lengths
        )

    def met_targets(self) -> Tally:
        """Return the tally of the runs that met their target."""
        return total(tally(runs, runs["target_met"] == YES, self.truth) for runs in self.targets)

    def memories_to_target(self) -> list[float]:
        """Return the mean length, in memories, of the runs to a target, for each block."""
        return [float(runs["target_blocks"].mean()) * runs.number for runs in self.targets]

    def truth_error(self) -> float:
        """Return the error of the truth over the smallest error in the longest runs; NaN if there
        are none."""
        smallest = [float(runs["R_stderr"].min()) for runs in self.lengths[-1:]]
        return self.truth.stderr / smallest[0] if smallest else math.nan


def total(tallies: Iterable[Tally]) -> Tally:
    """Return the sum of tallies."""
    return sum(tallies, Tally())


def truth_of(runs: Runs) -> Estimate:
    """Return the mean of independent long runs, with the standard error of their scatter."""
    R = runs["R"]
    return Estimate(float(R.mean()), float(R.std(ddof=1)) / math.sqrt(len(R)), len(R) - 1)


class Comparison(NamedTuple):
    """Scenes by side and name, and the criteria of coverage.yaml."""

    scenes: Mapping[str, Mapping[str, Scene]]
    criteria: Mapping[str, float]

    def names(self) -> list[str]:
        """Return the names of the scenes of either side."""
        return list(dict.fromkeys(name for side in COLUMNS for name in self.scenes[side]))

    def pair(self, name: str) -> list[Scene | None]:
        """Return a scene before and after the change; None for a scene that is not simulated."""
        return [self.scenes[side].get(name) for side in COLUMNS]

    def limit(self, runs: int) -> float:
        """Return the largest legal share of misses among `runs` selected runs of a scene."""
        misses, errors = self.criteria["misses"], self.criteria["binomial_errors"]
        return misses + errors * math.sqrt(misses * (1 - misses) / runs) if runs else math.inf

    def exceeds(self, scene: Tally) -> bool:
        """Return whether the share of misses of a scene is above the legal limit."""
        return scene.selected > 0 and scene.missing > self.limit(scene.selected)


def tables_of(comparison: Comparison) -> str:
    """Return all tables in Markdown, with notes."""
    makers = (criteria_table, length_table, trusted_table, target_table, notes)
    return "\n\n".join(make(comparison) for make in makers) + "\n"


def criteria_table(comparison: Comparison) -> str:
    """Return the table of the criteria, with failures in bold."""
    limits = comparison.criteria
    bounds = (
        ("misses of all scenes", f"at most {limits['misses']:.0%}"),
        (f"scenes beyond {limits['binomial_errors']:g} binomial errors of this", "none"),
        ("largest departure, sigma", f"below {limits['sigmas']:g}"),
    )
    rows = [
        (f"{kind}: {text}", limit) for kind in ("trusted", "target met") for text, limit in bounds
    ]
    lengths = f"from {limits['memories']:g} memories on, beds {limits['memories_under_gravity']:g}"
    rows += [(f"trusted, {lengths}", f"at least {limits['trusted']:.0%}")]
    columns = [_criteria_cells(comparison, side) for side in COLUMNS]
    heads = ("criterion", "limit", *COLUMNS.values())
    return tables.table(heads, [(*row, *cells) for row, *cells in zip(rows, *columns, strict=True)])


def _criteria_cells(comparison: Comparison, side: str) -> Row:
    """Return the measured value of each criterion on one side."""
    scenes, limits = comparison.scenes[side], comparison.criteria
    if not scenes:
        return [EMPTY_CELL] * 7
    cells = []
    for tally_of in (Scene.trusted_runs, Scene.met_targets):
        tallies = {name: tally_of(scene) for name, scene in scenes.items()}
        pooled = total(tallies.values())
        failing = [name for name, scene in tallies.items() if comparison.exceeds(scene)]
        names = f"{len(failing)}: {'; '.join(failing)}"
        shares = f"{_percent(pooled.missing)} of {pooled.selected}"
        cells += [
            _bold_if_illegal(shares, not pooled.missing > limits["misses"]),
            _bold_if_illegal(names, False) if failing else "none",
            _bold_if_illegal(f"{pooled.sigmas:.1f}", pooled.sigmas < limits["sigmas"]),
        ]
    pooled = total(map(Scene.trusted_long_runs, scenes.values()))
    shares = f"{_percent(pooled.share)} of {pooled.runs}"
    return [*cells, _bold_if_illegal(shares, not pooled.share < limits["trusted"])]


def length_table(comparison: Comparison) -> str:
    """Return the table of all runs and of trusted runs of each length, over all scenes."""
    tallies = [_by_length(comparison.scenes[side].values()) for side in COLUMNS]
    heads = ["memories"]
    for word in COLUMNS.values():
        heads += [f"{word}: runs", "missed", "trusted", "missed of these"]
    lengths = sorted(set(itertools.chain(*tallies)))
    rows = [
        [f"{length:g}", *itertools.chain(*(_length_cells(side.get(length)) for side in tallies))]
        for length in lengths
    ]
    return tables.table(heads, rows)


def _by_length(scenes: Iterable[Scene]) -> dict[float, tuple[Tally, Tally]]:
    """Return the tallies of all runs, and of the trusted runs, by length in memories."""
    tallies: dict[float, tuple[Tally, Tally]] = {}
    for scene in scenes:
        for runs in scene.lengths:
            all_runs, trusted = tallies.get(runs.number, (Tally(), Tally()))
            tallies[runs.number] = all_runs + scene.all_runs(runs), trusted + scene.trusted(runs)
    return tallies


def _length_cells(tallies: tuple[Tally, Tally] | None) -> Row:
    if tallies is None:
        return [EMPTY_CELL] * 4
    all_runs, trusted = tallies
    shares = _percent(all_runs.missing), _percent(trusted.missing)
    return [str(all_runs.runs), shares[0], str(trusted.selected), shares[1]]


def trusted_table(comparison: Comparison) -> str:
    """Return the table of the trusted runs of each scene."""

    def cells(scene: Scene) -> Row:
        long = _percent(scene.trusted_long_runs().share, 0)
        return [*_tally_cells(comparison, scene.trusted_runs()), long]

    return _scene_table(comparison, ["trusted", "missed", "sigma", "long trusted"], cells)


def target_table(comparison: Comparison) -> str:
    """Return the table of the runs to a target of each scene."""

    def cells(scene: Scene) -> Row:
        lengths = " and ".join(f"{number:.0f}" for number in scene.memories_to_target())
        return [*_tally_cells(comparison, scene.met_targets()), lengths or EMPTY_CELL]

    return _scene_table(comparison, ["met", "missed", "sigma", "memories"], cells)


def _scene_table(
    comparison: Comparison, column_heads: Sequence[str], cells: Callable[[Scene], Row]
) -> str:
    """Return a table with a row for each scene, and its cells before and after the change."""
    sides = [f"{side}: {column_heads[0]}" for side in COLUMNS.values()]
    heads = [
        "scene",
        "memory, T",
        "R",
        *(head for side in sides for head in (side, *column_heads[1:])),
    ]
    rows = []
    for name in comparison.names():
        pair = comparison.pair(name)
        scene = next(side for side in pair if side)
        row = [name, f"{scene.memory:g}", f"{scene.truth}"]
        for side in pair:
            row += cells(side) if side else [EMPTY_CELL] * len(column_heads)
        rows.append(row)
    return tables.table(heads, rows)


def _tally_cells(comparison: Comparison, scene: Tally) -> Row:
    """Return the cells of the tally of a scene."""
    share = _bold_if_illegal(_percent(scene.missing), not comparison.exceeds(scene))
    sigmas = f"{scene.sigmas:.1f}" if scene.selected else EMPTY_CELL
    return [f"{scene.selected} of {scene.runs}", share, sigmas]


def _percent(share: float, decimals: int = 1) -> str:
    return EMPTY_CELL if math.isnan(share) else f"{share:.{decimals}%}"


def _bold_if_illegal(text: str, legal: bool) -> str:
    return text if legal else f"**{text}**"


def notes(comparison: Comparison) -> str:
    """Return a line on bit-identical values of R on both sides, and on the error of the truth."""
    equal_bits = [_equal_bits(*comparison.pair(name)) for name in comparison.names()]
    equal_runs, runs = (
        sum(int(bits.sum()) for bits in equal_bits),
        sum(len(bits) for bits in equal_bits),
    )
    errors = [scene.truth_error() for side in COLUMNS for scene in comparison.scenes[side].values()]
    largest = max((error for error in errors if math.isfinite(error)), default=math.nan)
    text = f"R has the same bits before and after in {equal_runs} of {runs} runs. " if runs else ""
    return f"{text}The truth's error is at most {largest:.2f} standard errors of a run."


def _equal_bits(before: Scene | None, after: Scene | None) -> np.ndarray:
    """Return a mask of the runs whose R is bit-identical on both sides."""
    if not (before and after):
        return np.empty(0, bool)
    R = {runs.number: runs["R"] for runs in before.lengths}
    pairs = [(R[runs.number], runs["R"]) for runs in after.lengths if runs.number in R]
    return np.concatenate([np.empty(0, bool), *(first == second for first, second in pairs)])
