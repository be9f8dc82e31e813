"""Any command line, on valid, spoiled or foreign files, gives a result or one line, and leaves no
file half-written."""

import os
import shutil

import pytest
import xarray as xr
from hypothesis import strategies as st
from tests.entry import outcome
from tests.files import COMBINE, COVERAGE, DRAW, write_all
from tests.fuzz.spoiling import EACH_EFFORT, LEAST_SHARE, outcomes, share

WORDS = ["", "-", "--", "x", "é", "fig1a", "accuracy", "-1", "0.9", "1e-300", "nan", "10" * 30]
WORDS += ["a\nb"]
JSON = ["{", "[]", "3", "null", "NaN", "{}", '{"a": 1}', '{"experiments": null}', '{"scale": "x"}']
COMMANDS = ["show", "show --json", "reduce -o out.nc", "table -o out.csv"]
COMMANDS += ["claims --json out.json --markdown out.md"]
COMMANDS += ["explore --points . -o out.html", "document -o out.html", "run_times -o out.md"]
COMMANDS += [COMBINE.replace("{} ", "")]
COMMANDS += ["crate -o out.zip"]
"""Command lines without their files, which follow the command."""
VALID_LINES = [
    "table reduced.nc -o out.csv",
    "document page.md -o out.html",
    COMBINE.format("task.nc"),
    DRAW.format("studies.nc"),
    "run_times reduced.nc -o out.md",
]
"""Valid command lines."""
OPTIONS = ["--json", "-o", "--output", "--points", "--verify", "--markdown", "--help"]
OPTIONS += ["--configuration", "--x"]
OUTPUTS = ["out.csv", "out.nc", "out.md", "out.html", "out.png", "out.zip", "no/out.json", "out"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return write_folder(tmp_path_factory.mktemp("files") / "files")


def write_folder(folder):
    """Fill a folder with a file of each kind, a truncated copy of each, and foreign files."""
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


def check(folder, monkeypatch, arguments):
    """Run a command line in a copy of the folder, where it may move files: "done" or "refused"."""
    working_copy = folder.with_name("copy")
    shutil.copytree(folder, working_copy, copy_function=os.link)  # inputs are never written to
    monkeypatch.chdir(working_copy)
    try:
        status, errors = outcome(arguments)
        assert status in (0, 1, 2)
        if status:
            assert errors.count("\n") == 1 and errors.startswith("roughgas: error: "), errors
        assert not list(working_copy.rglob("*.tmp"))
        return "refused" if status else "done"
    finally:
        monkeypatch.chdir(folder)
        shutil.rmtree(working_copy)


@st.composite
def valid_lines(draw):
    """A valid command line."""
    number = draw(st.integers(0, 10**6))
    return draw(st.sampled_from(VALID_LINES)).replace("out", f"out{number}").split()


@st.composite
def command_lines(draw, names):
    """A command with files in the usual order, or with words and options anywhere."""
    files = st.sampled_from([*names, "none.nc", "."])
    if draw(st.booleans()):
        command, *rest = draw(st.sampled_from(COMMANDS)).split()
        return [command, *draw(st.lists(files, min_size=1, max_size=3)), *rest]
    line = [draw(st.sampled_from(COMMANDS)).split()[0]]
    line += draw(st.lists(st.one_of(files, st.sampled_from(WORDS)), max_size=3))
    for option in draw(st.lists(st.sampled_from(OPTIONS), max_size=3)):
        line.append(option)
        line += draw(st.lists(st.sampled_from([*OUTPUTS, *JSON, *WORDS]), max_size=1))
    return line


@EACH_EFFORT
def test_any_command_line_is_carried_out_or_refused_in_one_line(folder, monkeypatch, effort):
    lines = command_lines(sorted(os.listdir(folder)))
    counts = outcomes(effort, lines, lambda line: check(folder, monkeypatch, line), valid_lines())
    assert share(counts, "done") > LEAST_SHARE


@pytest.mark.parametrize("text", JSON)
@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "cooling", "--r=0.9", "--beta=0", "-o", "out.nc", "--settings"],
        ["effective_config", "config.yaml", "--scale=paper", "-o", "out", "--changes"],
        ["task", str(COVERAGE), "gas", "--module=coverage", "-o", "out.nc", "--settings"],
        ["crate", "page.md", "-o", "out.zip", "--configuration"],
    ],
)
def test_any_json_in_an_option_is_accepted_or_refused_in_one_line(
    folder, monkeypatch, arguments, text
):
    check(folder, monkeypatch, [*arguments, text])
