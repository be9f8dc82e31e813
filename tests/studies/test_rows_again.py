"""Twenty rows of the published table, drawn at random, simulated again from their settings.

They are drawn among rows of the study `exact` whose gas takes seconds: gases without positions
(cooling, Haff's law, rough gases). Each is run with the seeds of the table.
"""

import random

import pytest
from tests.study_modules import module_of_study

from roughgas.base.reading import read_yaml
from roughgas.results.comparison import read_rows

SETTINGS = read_yaml("studies/exact/config.yaml")["tasks"]
CHEAP = "cooling", "haff", "rough"
SEED, DRAWN = 20, 20
runs, results = module_of_study("exact", "tasks"), module_of_study("exact", "results")
evidence = module_of_study("exact", "evidence")


@pytest.mark.slow  # a minute
def test_twenty_rows_are_found_again():
    """All nine published digits, since the same seeds give the same bits."""
    cheap = [task for task in runs.tasks(SETTINGS) if task.split("_")[0] in CHEAP]
    task_results = {task: runs.run(task, SETTINGS, None, lambda *done: None) for task in cheap}
    again = evidence.rows(results.combine(task_results, SETTINGS))
    key = lambda row: (row.quantity, row.at, row.source)  # noqa: E731
    published = {key(row): row for study, row in read_rows("figures/evidence.csv")}
    simulated = [row for row in again if row.tier != "experiment"]
    assert {key(row) for row in simulated} <= set(published)
    for row in random.Random(SEED).sample(simulated, DRAWN):
        for ours, before in zip(row.ours, published[key(row)].ours, strict=True):
            assert ours == pytest.approx(before, rel=1e-8), key(row)
        assert row.theirs.value == pytest.approx(published[key(row)].theirs.value, rel=1e-8)
