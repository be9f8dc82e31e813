"""What every study with tasks fulfils: its tasks, data, table and figure, by small settings."""

import functools
import re
from itertools import combinations

import numpy as np
import pytest
import xarray as xr
from matplotlib import rc_context
from matplotlib.text import Text
from slow_cases import slow_but
from tests.show.figures.legibility import faults_of_letters
from tests.studies.small_runs import (
    STUDIES,
    combined,
    dataset_name,
    folder_and_module,
    modules_of,
    run_anew,
    task_names,
    task_results,
    task_run,
)
from tests.studies.small_studies import CONFIG, SMALL_STUDIES
from tests.study_modules import module_of_study, statements

from roughgas.claims import examine
from roughgas.claims.verdicts import HOLDS
from roughgas.data.netcdf import Content, content_of, read_groups, unit_of, write_netcdf
from roughgas.show.style import PARAMETERS
from roughgas.tasks import read_variables, running

CHEAP = {"profiles", "finite_size", "clustering", "coverage.coverage"}
CHEAP |= {"accuracy.statistical", "accuracy.models", "accuracy.waiting"}
"""Studies whose small tasks take a second or two; the others compile kernels of their own."""
CPU_TIMES = re.compile("seconds|equilibration")
"""Names of variables that differ from run to run."""


def described(name):
    """The variables of a study, or of a module among several, by its variables.yaml."""
    folder, module = folder_and_module(name)
    has_sections = len(CONFIG.studies[folder.name].modules) > 1
    return read_variables(folder / "variables.yaml", module if has_sections else None)


def figures_of_tasks():
    """Study, and names of the data, of each figure of nothing else than data of tasks."""
    figures = {}
    for study, of_study in CONFIG.studies.items():
        names = {module: f"{study}.{module}" for module in of_study.modules} or {"tasks": study}
        for figure, shown in (of_study.figures or {}).items():
            if set(shown) <= set(names):
                figures[figure] = study, [names[key] for key in shown]
    return figures


FIGURES = figures_of_tasks()
any_study = pytest.mark.parametrize("name", STUDIES)
each_study = pytest.mark.parametrize("name", slow_but(CHEAP, STUDIES))
each_figure = pytest.mark.parametrize(
    "figure", slow_but({"profiles", "accuracy", "coverage"}, FIGURES)
)


@any_study
def test_a_study_has_small_settings_and_all_that_the_workflow_calls(name):
    assert name.partition(".")[0] in CONFIG.studies, CONFIG.refused
    runs, results = modules_of(name)
    assert {"tasks", "run"} <= vars(runs).keys() and {"combine", "table"} <= vars(results).keys()
    assert described(name)
    assert name in SMALL_STUDIES, f"tests/studies/small_studies.py has no settings of {name}"


@any_study
def test_tasks_have_distinct_legal_names_at_every_scale(name):
    folder, module = folder_and_module(name)
    for settings in CONFIG.studies[folder.name].tasks.settings.values():
        assert running.task_names(folder, settings[module] if module else settings, module)


@each_study
def test_every_task_reports_its_progress_up_to_its_total(name):
    for task in task_names(name):
        reports = task_run(name, task).progress
        assert reports, f"{task} reports no progress"
        done, totals = zip(*reports, strict=True)
        assert len(set(totals)) == 1 and list(done) == sorted(done), task
        assert done[-1] == totals[-1] > 0, f"{task} ends at {done[-1]} of {totals[-1]}"


@each_study
def test_no_random_numbers_are_drawn_twice(name):
    """Neither by two tasks nor by two runs of a task, except for runs that share them."""
    drawn = {}
    for task in task_names(name):
        seeds = [
            seed
            for seed in task_run(name, task).seeds
            if seed[1] not in SMALL_STUDIES[name].shared_keys
        ]
        assert len(set(seeds)) == len(seeds), task
        drawn[task] = set(seeds)
    assert any(drawn.values())
    for first, second in combinations(drawn, 2):
        assert drawn[first].isdisjoint(drawn[second]), (first, second)


@each_study
def test_a_task_gives_the_same_data_again(name):
    """Except for CPU times."""
    task = SMALL_STUDIES[name].cheap_task
    first, again = task_run(name, task).result, run_anew(name, task).result
    times = [variable for variable in first.variables if CPU_TIMES.search(variable)]
    assert set(first.data_vars) - set(times)
    xr.testing.assert_identical(first.drop_vars(times), again.drop_vars(times))


@each_study
def test_combined_data_are_all_that_variables_yaml_describes(name):
    expected = {
        key: (variable.dims, variable.long_name, variable.units)
        for key, variable in described(name).items()
    }
    present = {
        key: (variable.dims, variable.attrs["long_name"], variable.attrs.get("units", ""))
        for key, variable in combined(name).variables.items()
    }
    assert present == expected
    assert combined(name).attrs["seed"] == SMALL_STUDIES[name].settings["seed"]


@each_study
def test_data_survive_a_file(name, tmp_path):
    """Data of tasks, before they are combined, and data of the study."""
    data = task_results(name) | {"combined": combined(name)}
    groups = {key: content_of(values) for key, values in data.items()}
    write_netcdf(tmp_path / "data.nc", Content({}, {"title": "Studies"}), groups)
    for key, values in read_groups(tmp_path / "data.nc").items():
        xr.testing.assert_equal(values, data[key])
        for variable, before in data[key].variables.items():
            after = values[variable]
            assert before.dtype.kind in "OU" or after.dtype == before.dtype, variable
            assert after.attrs.get("long_name") == before.attrs.get("long_name"), variable
            assert unit_of(after.attrs) == before.attrs.get("units", unit_of(after.attrs)), variable
        for attribute, value in data[key].attrs.items():
            assert np.array_equal(values.attrs[attribute], value), attribute


@each_study
def test_the_table_names_every_point(name):
    table, cells = modules_of(name)[1].table(combined(name)), SMALL_STUDIES[name].cells
    assert table.startswith("## ")
    assert {cell: table.count(f"| {cell} |") for cell in cells} == cells


@functools.cache
def drawn(figure):
    """A figure of small tasks in the style of all figures, and its datasets by name."""
    study, names = FIGURES[figure]
    draw = getattr(module_of_study(study, "figure"), f"draw{figure.removeprefix(study)}")
    data = {dataset_name(name): combined(name) for name in names}
    with rc_context(PARAMETERS):
        return draw(*data.values()), data


@each_figure
def test_letters_of_a_figure_are_legible(figure):
    """Few points may lie behind a legend; the studies' tests look at figures of made-up data."""
    assert faults_of_letters(lambda: drawn(figure)[0]) == []


@each_figure
def test_a_figure_states_no_conclusion_without_a_verdict(figure):
    picture, data = drawn(figure)
    texts = {text.get_text() for text in picture.findobj(Text)} - {""}
    for statement in statements().values():
        if statement.conclusion in texts:
            assert examine(statement, data).verdict == HOLDS, statement.name
