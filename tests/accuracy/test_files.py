"""Studies from their tasks to one file, its tables and its figure."""

import pytest
import xarray as xr
from tests.entry import main
from tests.studies.small_runs import task_names
from tests.studies.small_studies import COVERAGE
from tests.study_modules import ROOT

from roughgas.base import InputError, sorted_json
from roughgas.data.netcdf import read_groups
from roughgas.tasks.running import combine

FOLDER = str(ROOT / "studies" / "coverage")
MODULE = {"modules": ["coverage"]}


@pytest.fixture(scope="module")
def tasks(tmp_path_factory):
    """The files of a study's tasks, written by the command."""
    folder, text = tmp_path_factory.mktemp("tasks"), settings()
    names = task_names("coverage.coverage")
    for name in names:
        command = ["task", FOLDER, name, "--module", "coverage", "--settings", text]
        assert main([*command, "-o", str(folder / f"{name}.nc")]) == 0
    return [folder / f"{name}.nc" for name in names]


def settings(**changes):
    return sorted_json({"study": COVERAGE.settings | changes, "experiments": COVERAGE.experiments})


def test_tasks_become_one_file_with_a_table_and_a_figure(tasks, tmp_path):
    combined, table, figure = (tmp_path / name for name in ("all.nc", "all.md", "all.png"))
    options = ["--modules", "coverage", "-o", str(combined), "--table", str(table)]
    assert main(["combine", FOLDER, *map(str, tasks), *options]) == 0
    data = read_groups(combined)["coverage"]
    assert data.sizes["corner"] == len(tasks) and data.attrs["scale"] == "paper"
    for name in data.data_vars:
        words = data[name].dtype.kind in "OU"
        assert "long_name" in data[name].attrs and words != ("units" in data[name].attrs), name
    assert table.read_text().startswith("## Coverage of the stated intervals\n")
    options = ["--shows", "coverage", "-o", str(figure)]
    assert main(["figure", FOLDER, "coverage", str(combined), *options]) == 0
    assert figure.stat().st_size > 10_000


def test_a_missing_task_is_named(tasks, tmp_path):
    with pytest.raises(InputError, match=r"tasks of coverage = without gas_r0\.9_beta0: must be"):
        combine(FOLDER, tasks[:1], **MODULE, output=tmp_path / "all.nc", table=tmp_path / "all.md")


def test_tasks_of_different_settings_are_refused(tasks, tmp_path):
    changed = xr.load_dataset(tasks[0])
    changed.attrs["settings_json"] = settings(repetitions=9)
    changed.to_netcdf(tmp_path / "other.nc")
    with pytest.raises(InputError, match="settings of coverage = 2 different ones: must be the s"):
        combine(
            FOLDER,
            [tmp_path / "other.nc", tasks[1]],
            **MODULE,
            output=tmp_path / "all.nc",
            table=tmp_path / "all.md",
        )
