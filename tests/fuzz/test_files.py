"""A command on a spoiled file gives a result or one line."""

import shutil

import pytest
from hypothesis import strategies as st
from tests.fuzz.files import attempts, real_files
from tests.fuzz.spoiling import EACH_EFFORT, LEAST_SHARE, outcomes, share
from tests.fuzz.test_commands import outcome


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    return real_files(tmp_path_factory.mktemp("real"))


def check(sources, folder, monkeypatch, data):
    """Spoil a file in an empty folder and run a command: "done" or "refused"."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    monkeypatch.chdir(folder)
    condition, line = data.draw(attempts(sources, folder))
    status, errors = outcome(line)
    assert status in (0, 1, 2), line
    if status:
        assert errors.count("\n") == 1 and errors.startswith("roughgas: error: "), (line, errors)
    assert condition != "damaged" or status, line
    assert not list(folder.rglob("*.tmp")) and not list(folder.rglob(".*")), line
    return "refused" if status else "done"


@EACH_EFFORT
def test_spoiled_files_give_a_result_or_one_line(sources, tmp_path_factory, monkeypatch, effort):
    folder = tmp_path_factory.getbasetemp() / "spoiled"
    counts = outcomes(effort, st.data(), lambda data: check(sources, folder, monkeypatch, data))
    assert share(counts, "done") > LEAST_SHARE
