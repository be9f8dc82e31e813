"""`benchmarks.coverage`: its tallies and tables of runs whose numbers are made up."""

import itertools
import json
import math
from pathlib import Path

import numpy as np
import pytest
import yaml
from benchmarks import coverage
from benchmarks.coverage import LENGTH, PLAN, TARGET, TRUTH, Checkout, scenes_of, tasks_of
from benchmarks.coverage_tables import OURS, THEIRS, Comparison, Runs, Scene, tables_of, tally
from raw import build, run_point

from roughgas.config import experiment_of
from roughgas.statistics.estimates import Estimate
from roughgas.statistics.student import wallace_t

ROOT = Path(__file__).parent.parent
PLANNED = yaml.safe_load(PLAN.read_text(encoding="utf-8"))
CRITERIA = PLANNED["criteria"]


def made_up(departures, *, trusted=1, met=1, memory=math.nan, number=20, measure=200.0):
    """Runs whose R departs from 0.5 by these standard errors of 0.01, with 9 degrees of freedom."""
    runs = len(departures)
    variables = {
        "R": 0.5 + 0.01 * np.array(departures, float),
        "R_stderr": np.full(runs, 0.01),
        "R_dof": np.full(runs, 9.0),
        "R_ci95": np.full(runs, 0.01 * wallace_t(1.96, 9)),
        "R_ci95_trusted": np.broadcast_to(trusted, runs).astype(float),
        "target_met": np.broadcast_to(met, runs).astype(float),
        "target_blocks": np.full(runs, 3.0),
        "memory_of_R": np.broadcast_to(memory, runs).astype(float),
    }
    return Runs(number, measure, variables)


def scene(lengths, targets=(), truth=0.5):
    return Scene(10.0, 20.0, Estimate(truth, 1e-6, 9), lengths, targets)


def test_only_selected_runs_count():
    runs = made_up([0, 1, 3, -3, 3], trusted=[1, 1, 1, 0, -1])
    selected = scene([runs]).trusted(runs)
    assert (selected.runs, selected.selected, selected.misses) == (5, 3, 1)
    assert selected.missing == pytest.approx(1 / 3)


def test_departures_are_sigma_of_students_t():
    runs = made_up([0, -wallace_t(4.0, 9)])
    assert tally(runs, np.full(2, True), Estimate(0.5, 0.0)).sigmas == pytest.approx(4.0)
    # an error of the truth that equals the run's lowers the sigmas, in quadrature
    wider = tally(runs, np.full(2, True), Estimate(0.5, 0.01)).sigmas
    runs = made_up([wallace_t(4.0, 9) / math.sqrt(2)])
    assert wider == pytest.approx(tally(runs, np.full(1, True), Estimate(0.5, 0.0)).sigmas)


def test_a_run_without_an_interval_misses():
    runs = made_up([0, 0])
    runs["R_ci95"][1] = math.nan
    assert scene([runs]).all_runs(runs).misses == 1


def test_tallies_add_up_but_for_the_largest_departure():
    both = scene([made_up([0, 3]), made_up([1, 1, -4], trusted=[1, 0, 1])]).trusted_runs()
    assert (both.runs, both.selected, both.misses) == (5, 4, 2)
    assert both.sigmas == pytest.approx(scene([made_up([4])]).trusted_runs().sigmas)


def test_theory_says_how_many_memories_a_run_has():
    scene_runs = made_up([0, 0, 0], memory=[20.0, math.nan, math.inf], number=25)
    assert scene_runs.memories().tolist() == [10, 25, 25]
    # the first is too short to count, though it is not trusted
    runs = made_up([0, 0, 0], trusted=[0, 1, 0], memory=[20.0, 10.0, 5.0])
    long = scene([runs, made_up([0], number=12)]).trusted_long_runs()
    assert (long.runs, long.selected) == (2, 1)


def test_a_scene_may_miss_by_three_binomial_errors_more():
    comparison = Comparison({}, CRITERIA)
    assert comparison.limit(400) == pytest.approx(0.07 + 3 * math.sqrt(0.07 * 0.93 / 400))
    assert not comparison.exceeds(scene([made_up([0])]).trusted_runs())
    assert not comparison.exceeds(scene([made_up([3] * 10 + [0] * 90)]).trusted_runs())
    assert comparison.exceeds(scene([made_up([3] * 15 + [0] * 85)]).trusted_runs())
    assert not comparison.exceeds(scene([]).trusted_runs())


def test_tables_set_both_checkouts_side_by_side():
    lucky = scene([made_up([3] * 20 + [0] * 80)], [made_up([0] * 50, met=0, number=8)])
    honest = scene([made_up([3] * 5 + [0] * 95)], [made_up([0] * 50, number=8)])
    criteria, lengths, trusted, targets, notes = tables_of(
        Comparison({THEIRS: {"gas": lucky}, OURS: {"gas": honest}}, CRITERIA)
    ).split("\n\n")
    assert cells(criteria)[:2] == [
        ["trusted: misses of all scenes", "at most 7%", "**20.0% of 100**", "5.0% of 100"],
        ["trusted: scenes beyond 3 binomial errors of this", "none", "**1: gas**", "none"],
    ]
    assert cells(criteria)[3][2:] == ["– of 0", "0.0% of 50"]
    assert cells(lengths) == [["20", "100", "20.0%", "100", "20.0%", "100", "5.0%", "100", "5.0%"]]
    assert cells(trusted)[0][3:5] == ["100 of 100", "**20.0%**"]
    assert cells(trusted)[0][7:9] == ["100 of 100", "5.0%"]
    assert cells(targets)[0][3:] == ["0 of 50", "–", "–", "24", "50 of 50", "0.0%", "0.0", "24"]
    assert notes.startswith("R has the same bits before and after in 85 of 100 runs.")


def cells(table):
    """The cells of each row of a table in Markdown, without its head."""
    return [[cell.strip() for cell in row.split("|")[1:-1]] for row in table.splitlines()[2:]]


def test_what_is_not_simulated_is_a_dash():
    runs = {THEIRS: {"gas": scene([made_up([0, 1])], [made_up([0])])}, OURS: {}}
    criteria, lengths, trusted, targets, notes = tables_of(Comparison(runs, CRITERIA)).split("\n\n")
    assert {row[-1] for row in cells(criteria)} == {"–"}
    assert {cell for table in (lengths, trusted, targets) for cell in cells(table)[0][-4:]} == {"–"}
    assert "same bits" not in notes


def test_the_scenes_are_legal_and_no_seed_is_used_twice():
    tasks = [task for name in PLANNED["scenes"] for task in tasks_of(name, PLANNED)]
    seeds = [seed for task in tasks for seed in task.seeds]
    assert len(set(seeds)) == len(seeds)
    for task in tasks:
        _, _, settings = experiment_of(None, task.settings)
        build(settings, task.r, task.beta)
        schedule = task.settings["schedule"]
        periods = schedule["measure"] / schedule.get("period", schedule["sample_every"])
        assert periods == pytest.approx(round(periods))
    assert len({task.path for task in tasks}) == len(tasks)


def stored(checkout, task, sources, R=0.5):
    """Write made-up runs of a task."""
    variables = made_up([0] * len(task.seeds)).variables
    runs = {name: values.tolist() for name, values in variables.items()}
    runs["R"] = [R + 1e-6 * number for number in range(len(task.seeds))]
    file = checkout.file(task)
    file.parent.mkdir(parents=True, exist_ok=True)
    content = {"task": task.record(), "sources": sources, "runs": runs, "seconds": 1.0}
    file.write_text(json.dumps(content), encoding="utf-8")


def test_only_missing_runs_are_made(tmp_path):
    ours, theirs = Checkout(OURS, ROOT, tmp_path), Checkout(THEIRS, ROOT, tmp_path)
    tasks = tasks_of("heated, N=5", PLANNED)
    assert ours.missing(tasks) == tasks and scenes_of(ours, {"heated, N=5": tasks}, PLANNED) == {}
    for task in tasks:
        stored(ours, task, ours.sources())
    assert ours.missing(tasks) == []
    assert theirs.missing(tasks) == tasks[1:]  # both checkouts share the truth
    stored(ours, tasks[1], "other sources")
    assert ours.missing(tasks) == tasks[1:2]
    # of other settings or seeds: not in the tables either
    stored(ours, tasks[2], ours.sources())
    longer = tasks[2]._replace(seeds=[1, 2])
    assert ours.missing([longer]) == [longer] and ours.runs(longer) is None
    scene_runs = scenes_of(ours, {"heated, N=5": tasks}, PLANNED)["heated, N=5"]
    assert scene_runs.truth.value == pytest.approx(0.5, abs=1e-4)
    assert [runs.number for runs in scene_runs.lengths] == PLANNED["lengths"]
    assert [runs.number for runs in scene_runs.targets] == PLANNED["blocks"]


def test_the_page_is_changed_between_the_marks_only(tmp_path, monkeypatch):
    page = tmp_path / "accuracy.md"
    page.write_text(f"before\n{coverage.BEGIN}old\n{coverage.END}after\n", encoding="utf-8")
    monkeypatch.setattr(coverage, "PAGE", page)
    coverage.document("new\n")
    text = page.read_text(encoding="utf-8")
    assert text == f"before\n{coverage.BEGIN}new\n{coverage.END}after\n"


@pytest.mark.slow  # compiles kernels in a child process
def test_a_process_of_a_checkout_runs_the_program(tmp_path):
    plan = PLANNED | {"lengths": [5], "blocks": [3], "seeds": 2}
    plan["truth"] = {"seeds": 2, "memories": 5}
    checkout, tasks = Checkout(OURS, ROOT, tmp_path), tasks_of("heated, N=5", plan)
    lines = []
    coverage.simulate([checkout], {"heated, N=5": tasks}, jobs=1)
    checkout.simulate(tasks, lines.append)
    assert lines == []  # nothing was missing
    for task, kind in itertools.zip_longest(tasks, (TRUTH, LENGTH, TARGET)):
        assert task.kind == kind
        _, _, settings = experiment_of(None, task.settings)
        point = run_point(build(settings, task.r, task.beta), settings, task.seeds[1]).variables
        runs = checkout.runs(task)
        assert runs["R"][1] == point["R"] and runs["R_ci95"][1] == point["R_ci95"]
        assert runs["R_ci95_trusted"][1] == point["R_ci95_trusted"]
