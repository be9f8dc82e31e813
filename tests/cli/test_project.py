"""`roughgas init`: the files of a new project, and the folders that it refuses."""

import pytest

from roughgas import config
from roughgas.cli import main

FILES = {"Snakefile", "config.yaml", "studies/mine/config.yaml"}


def files_below(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("exists", [False, True])
def test_a_project_is_written_to_a_folder_that_is_new_or_empty(exists, tmp_path, capsys):
    folder = tmp_path / "my gases"
    if exists:
        folder.mkdir()
    assert main(["init", str(folder)]) == 0
    assert files_below(folder) == FILES
    printed = f"{folder}: a project. Next:  cd '{folder}' && snakemake -j2 mine\n"
    assert capsys.readouterr().out == printed


def test_a_folder_with_content_is_refused_in_one_line(tmp_path, capsys):
    (tmp_path / "a.txt").write_text("of a person")
    for folder in (tmp_path, tmp_path / "a.txt"):
        assert main(["init", str(folder)]) == 2
        message = f"roughgas: error: FOLDER = {folder}: must be new or empty\n"
        assert capsys.readouterr().err == message
    assert files_below(tmp_path) == {"a.txt"}


def test_its_configuration_changes_the_shipped_one(tmp_path, monkeypatch):
    shipped = config.load(config.SHIPPED)
    assert main(["init", str(tmp_path)]) == 0
    monkeypatch.chdir(tmp_path)
    configuration = config.load("config.yaml")
    assert (configuration.scale, shipped.scale) == ("small", "paper")
    assert configuration.refused == {}
    added = configuration.experiments.keys() - shipped.experiments.keys()
    assert added == {"mine.sliding"}
    gas = configuration.experiment("mine.sliding", "small").for_points().raw
    assert gas["effects"]["friction"] == {"mu": 0.2} and gas["particles"] == 40
