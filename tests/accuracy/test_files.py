"""Studies from their tasks to one file, its tables and its figure."""

import pytest
import xarray as xr
from tests.accuracy.test_coverage import EXPERIMENTS, SETTINGS
from tests.entry import main

from roughgas import config
from roughgas.accuracy import coverage
from roughgas.accuracy.running import combine, read_studies, write_tables
from roughgas.base import InputError


@pytest.fixture(scope="module")
def tasks(tmp_path_factory):
    """The files of a study's tasks, made by the command."""
    folder, text = tmp_path_factory.mktemp("tasks"), settings()
    names = coverage.tasks(SETTINGS)
    for name in names:
        command = ["accuracy_task", "coverage", name, "--settings", text]
        assert main([*command, "-o", str(folder / f"{name}.nc")]) == 0
    return [folder / f"{name}.nc" for name in names]


def settings(**others):
    return config.as_text({"study": SETTINGS | others, "experiments": EXPERIMENTS})


def test_tasks_become_one_file_with_a_table_and_a_figure(tasks, tmp_path):
    combined, table, figure = (tmp_path / name for name in ("all.nc", "all.md", "all.png"))
    assert main(["accuracy_data", *map(str, tasks), "-o", str(combined)]) == 0
    data = read_studies(combined)["coverage"]
    assert data.sizes["corner"] == len(tasks) and data.attrs["scale"] == "paper"
    for name in data.data_vars:
        words = data[name].dtype.kind in "OU"
        assert "long_name" in data[name].attrs and words != ("units" in data[name].attrs), name
    write_tables(combined, output=table)
    assert table.read_text().startswith("## Coverage of the stated intervals\n")
    assert main(["accuracy_figure", "coverage", str(combined), "-o", str(figure)]) == 0
    assert figure.stat().st_size > 10_000


def test_a_missing_task_is_named(tasks, tmp_path):
    with pytest.raises(InputError, match=r"tasks of coverage = without gas_r0\.9_beta0: must be"):
        combine(tasks[:1], output=tmp_path / "all.nc")


def test_tasks_of_different_settings_are_refused(tasks, tmp_path):
    other = xr.load_dataset(tasks[0])
    other.attrs["settings_json"] = settings(repetitions=9)
    other.to_netcdf(tmp_path / "other.nc")
    with pytest.raises(InputError, match="settings of coverage = 2 different ones: must be the s"):
        combine([tmp_path / "other.nc", tasks[1]], output=tmp_path / "all.nc")
