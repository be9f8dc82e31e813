"""R of homogeneous gases in the limit of many particles: extrapolation, tables, and the judge."""

import numpy as np
import pytest
import xarray as xr
from tests.studies.small_runs import combined
from tests.studies.small_studies import CONFIG, SMALL_STUDIES
from tests.study_modules import module_of_study

from roughgas.claims.verdicts import FAILS, HOLDS, QUALIFIED, NotTestedError
from roughgas.results.long_table import LongRow, read_long_rows, write_long_rows
from roughgas.tasks import Estimate

STUDY = "megias_santos"
STATES = [(0.7, 0.0, 0.25), (0.9, -0.7, 0.9)]
RUNS, ERROR = 12, 5e-5
"""Runs of a gas; standard error of R of a homogeneous gas."""


@pytest.fixture(scope="module")
def results():
    return module_of_study(STUDY, "results")


@pytest.fixture
def long(tmp_path, monkeypatch):
    """The module of the table long.csv, which is read from a folder of the test."""
    module = module_of_study(STUDY, "long")
    monkeypatch.setattr(module, "TABLE", tmp_path / "long.csv")
    return module


def test_a_line_in_the_inverse_number_is_extrapolated_exactly(results):
    numbers = np.array([100.0, 400.0, 1600.0])
    R = (0.4 + 0.07 / numbers)[:, None] + 1e-4 * np.array([-1.0, 0.0, 1.0])
    limit, slope = results.extrapolated(numbers, R)
    assert limit.value == pytest.approx(0.4) and slope.value == pytest.approx(0.07)
    assert limit.dof == slope.dof == 7.0


def test_the_error_of_the_limit_is_that_of_its_scatter(results):
    """400 repetitions with a known error: the mean square error within 4 standard errors."""
    rng, numbers = np.random.default_rng(1), np.array([100.0, 400.0, 1600.0])
    limits = [
        results.extrapolated(numbers, 0.4 + 1e-3 * rng.normal(size=(3, 4)))[0] for _ in range(400)
    ]
    scatter = np.std([limit.value for limit in limits])
    stated = np.sqrt(np.mean([limit.stderr**2 for limit in limits]))
    assert scatter == pytest.approx(stated, rel=4 / np.sqrt(2 * 400))


def test_the_effect_of_kicks_is_of_second_order(results):
    """R = 0.4 + 0.01 h^2: at h = 0.2 it is off by 0.0004."""
    R = 0.4 + 0.01 * np.array([0.2, 0.8])[:, None] ** 2 + 1e-6 * np.array([-1.0, 1.0])
    effect = results.kick_effect([0.2, 0.8], R, 0.2)
    assert effect.value == pytest.approx(4e-4)


def test_only_boxes_of_equal_length_are_extrapolated(results):
    """R = 0.4 + 0.1/N where N times the packing is 5; other gases are far off."""
    gases = [(1000, 0.005, 0.3), (250, 0.005, 0.3), (1000, 0.005, 1.2), (100, 0.05, 0.3)]
    R = np.array([0.4001, 0.9, 0.9, 0.401])[:, None] + 1e-6 * np.array([-1.0, 0.0, 1.0])
    limit, slope = results.events_extrapolated(gases, R)
    assert limit.value == pytest.approx(0.4) and slope.value == pytest.approx(0.1)
    assert limit.dof == 4.0


def tasks_of(shift, runs_error=1e-3):
    """Return the combined dataset of tasks whose R is the published one plus `shift`."""
    published = module_of_study(STUDY, "published").published_R
    R = [published(*state).value + shift for state in STATES]
    columns = dict(zip(("r", "beta", "spin_share"), np.transpose(STATES), strict=True))
    columns |= {"R": np.array(R), "R_stderr": np.full(2, runs_error), "R_dof": np.full(2, 10.0)}
    return xr.Dataset({name: ("state", values) for name, values in columns.items()})


def commit(long, shift, error=ERROR):
    """Write a table whose R is the published one plus `shift`."""
    published = module_of_study(STUDY, "published").published_R
    names = ("r", "beta", "spin_share")
    rows = [
        LongRow(
            long.HOMOGENEOUS_R,
            dict(zip(names, state, strict=True)),
            Estimate(published(*state).value + shift, error, 40.0),
            0.1,
        )
        for state in STATES
    ]
    write_long_rows(rows, long.TABLE)


@pytest.mark.parametrize(("shift", "verdict"), [(0.0, HOLDS), (-2.9e-4, QUALIFIED), (1e-3, FAILS)])
def test_a_deviation_of_homogeneous_gases_is_judged(long, shift, verdict):
    """R = .9904 at one state: errors of theta are small there; the combined errors are 5e-5 to
    8e-5."""
    commit(long, shift)
    finding = module_of_study(STUDY, "judges").homogeneous_is_published(tasks_of(shift))
    assert finding.verdict == verdict, finding.reason


@pytest.mark.parametrize(("error", "again"), [(3e-4, 0.0), (ERROR, 0.01)])
def test_large_errors_and_tasks_that_disagree_are_not_judged(long, error, again):
    commit(long, 0.0, error)
    with pytest.raises(NotTestedError):
        module_of_study(STUDY, "judges").homogeneous_is_published(tasks_of(again))


def test_the_committed_table_has_all_states_of_the_tasks():
    settings = CONFIG.studies[STUDY].tasks.settings["long"]
    long = module_of_study(STUDY, "long")
    states = {long.State(*map(float, state)) for state in settings["states"]}
    for quantity in (long.HOMOGENEOUS_R, long.SIZE_EFFECT):
        assert set(long.committed(quantity)) == states
    quantities = {row.quantity for row in read_long_rows(long.TABLE)}
    of_events = {long.EVENT_R, long.EVENT_LIMIT, long.EVENT_SIZE_EFFECT}
    assert quantities == {long.HOMOGENEOUS_R, long.SIZE_EFFECT, long.KICK_EFFECT, *of_events}


@pytest.mark.slow
def test_the_long_table_has_every_gas_of_the_tasks(long):
    gases = SMALL_STUDIES[STUDY].settings["events"]["gases"]
    rows = list(long.long_table(combined(STUDY)))
    assert [row.quantity for row in rows].count(long.EVENT_R) == len(gases)
