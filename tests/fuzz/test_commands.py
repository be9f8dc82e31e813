"""Whatever a person may type, about files of ours, spoiled ones and foreign ones, gives a result or
one line, and leaves nothing half-written."""

import contextlib
import io
import os
import shutil

import pytest
import xarray as xr
from hypothesis import strategies as st
from tests.entry import main
from tests.files import write_all
from tests.fuzz.spoiling import ENOUGH, OFTEN, outcomes, share

WORDS = ["", "-", "--", "x", "é", "fig1a", "accuracy", "-1", "0.9", "1e-300", "nan", "10" * 30]
WORDS += ["a\nb"]
JSON = ["{", "[]", "3", "null", "NaN", "{}", '{"a": 1}', '{"experiments": null}', '{"scale": "x"}']
MEANT = ["show", "show --json", "reduce -o out.nc", "table -o out.csv"]
MEANT += ["claims --json out.json --markdown out.md"]
MEANT += ["explore --points . -o out.html", "document -o out.html", "run_times -o out.md"]
MEANT += ["accuracy_table -o out.md", "accuracy_data -o out.nc"]
MEANT += ["crate -o out.zip"]
"""Command lines without their files, which come after the command."""
RIGHT = [
    "table reduced.nc -o out.csv",
    "document page.md -o out.html",
    "accuracy_data task.nc -o out.nc",
    "accuracy_table studies.nc -o out.md",
    "run_times reduced.nc -o out.md",
]
"""Command lines that are right."""
OPTIONS = ["--json", "-o", "--output", "--points", "--verify", "--markdown", "--help"]
OPTIONS += ["--configuration", "--x"]
OUTPUTS = ["out.csv", "out.nc", "out.md", "out.html", "out.png", "out.zip", "no/out.json", "out"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_folder(tmp_path_factory.mktemp("files") / "files")


def write_folder(folder):
    """A folder with a file of each kind, a copy of each cut short, and foreign ones."""
    folder.mkdir()
    for kind, path in write_all(folder).items():
        content = path.read_bytes()
        (folder / f"{kind}_cut.nc").write_bytes(content[: len(content) // 2])
    xr.Dataset({"R": 1.0}).to_netcdf(folder / "foreign.nc")
    (folder / "empty.nc").write_bytes(b"")
    (folder / "text.nc").write_text("text")
    (folder / "list.json").write_text("[]")
    (folder / "page.md").write_text("# Words")
    return folder


def outcome(arguments):
    """The exit status of a command line, and what it has said."""
    said, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(errors):
        try:
            status = main(arguments)
        except SystemExit as end:
            status = end.code
    return status, errors.getvalue()


def check(folder, monkeypatch, arguments):
    """Run a command line in a copy of the folder, since some put damaged files aside."""
    copy = folder.with_name("copy")
    shutil.copytree(folder, copy, copy_function=os.link)  # inputs are never written to
    monkeypatch.chdir(copy)
    try:
        status, errors = outcome(arguments)
        assert status in (0, 1, 2)
        if status:
            assert errors.count("\n") == 1 and errors.startswith("roughgas: error: "), errors
        assert not list(copy.rglob("*.tmp"))
        return "refused" if status else "done"
    finally:
        monkeypatch.chdir(folder)
        shutil.rmtree(copy)


@st.composite
def right_lines(draw):
    """A command with a file that it takes."""
    number = draw(st.integers(0, 10**6))
    return draw(st.sampled_from(RIGHT)).replace("out", f"out{number}").split()


@st.composite
def command_lines(draw, names):
    """A command with files, as it is meant to be given or with words and options anywhere."""
    files = st.sampled_from([*names, "none.nc", "."])
    if draw(st.booleans()):
        command, *rest = draw(st.sampled_from(MEANT)).split()
        return [command, *draw(st.lists(files, min_size=1, max_size=3)), *rest]
    line = [draw(st.sampled_from(MEANT)).split()[0]]
    line += draw(st.lists(st.one_of(files, st.sampled_from(WORDS)), max_size=3))
    for option in draw(st.lists(st.sampled_from(OPTIONS), max_size=3)):
        line.append(option)
        line += draw(st.lists(st.sampled_from([*OUTPUTS, *JSON, *WORDS]), max_size=1))
    return line


@OFTEN
def test_command_lines(folder, monkeypatch, often):
    lines = command_lines(sorted(os.listdir(folder)))
    found = outcomes(often, lines, lambda line: check(folder, monkeypatch, line), right_lines())
    assert share(found, "done") > ENOUGH


@pytest.mark.parametrize("text", JSON)
@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "cooling", "--r=0.9", "--beta=0", "-o", "out.nc", "--settings"],
        ["effective_config", "config.yaml", "--scale=paper", "-o", "out", "--changes"],
        ["accuracy_task", "statistical", "cooling-reference", "-o", "out.nc", "--settings"],
        ["crate", "page.md", "-o", "out.zip", "--configuration"],
    ],
)
def test_options_that_take_json(folder, monkeypatch, arguments, text):
    check(folder, monkeypatch, [*arguments, text])
