"""Whatever has become of a file, a command about it gives a result or one line."""

import shutil

import pytest
from hypothesis import strategies as st
from tests.fuzz.files import real_files, tries
from tests.fuzz.spoiling import ENOUGH, OFTEN, outcomes, share
from tests.fuzz.test_commands import outcome


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    return real_files(tmp_path_factory.mktemp("real"))


def check(sources, folder, monkeypatch, data):
    """Spoil a file in an empty folder and run a command: "done" or "refused"."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    monkeypatch.chdir(folder)
    became, line = data.draw(tries(sources, folder))
    status, errors = outcome(line)
    assert status in (0, 1, 2), line
    if status:
        assert errors.count("\n") == 1 and errors.startswith("roughgas: error: "), (line, errors)
    assert became != "damaged" or status, line
    assert not list(folder.rglob("*.tmp")) and not list(folder.rglob(".*")), line
    return "refused" if status else "done"


@OFTEN
def test_spoiled_files(sources, tmp_path_factory, monkeypatch, often):
    folder = tmp_path_factory.getbasetemp() / "spoiled"
    found = outcomes(often, st.data(), lambda data: check(sources, folder, monkeypatch, data))
    assert share(found, "done") > ENOUGH
