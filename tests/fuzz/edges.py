"""Extreme values of each option of each command, of each key of a schedule, and of the environment.

Whatever the values, a command makes its output, or ends with one line that names the key or the
value; inputs do not change, and no file is left half-written.
"""

import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from robustness.conftest import environment
from schedules import COOLING, STEADY, TINY
from tests.cli.parsers import commands
from tests.files import write_all
from tests.fuzz import test_configurations
from tests.fuzz.spoiling import NUMBERS, OTHER_VALUES, WORDS
from tests.fuzz.test_commands import outcome

from roughgas.simulation.protocols import PROTOCOLS

TIME_LIMIT = 60
"""Seconds that a process may take."""
LONG_TEXT = "x" * 5000
POINTS = "points/gas/r0.9/beta0"
TEXTS = ["", "0", "0.5", "1", "2", "-1", "1e300", "nan", "inf", LONG_TEXT, "a b'\"äü.nc", "-x.nc"]
TEXTS += ["/dev/null", "points", "/proc/none", "out.nc", "gas.nc", f"{POINTS}/seed1.nc"]
TEXTS += ["0.9", "3", "5", "10", "gas", "config.yaml", "new.nc"]
GAS = ["gas", "--r=0.9", "--beta=0", "--settings", json.dumps(TINY)]
DRIVEN = TINY | {
    "effects": test_configurations.CONFIGURATION["experiments"]["sheared"]["effects"],
    "schedule": STEADY | {"equilibrate": 1, "measure": 4},
}
SWEPT = TINY | {"sweep": {"r": ["0.9"], "beta": ["0"], "seeds": 2}}
CONFIG = test_configurations.CONFIGURATION
CONFIG = CONFIG | {"experiments": CONFIG["experiments"] | {"gas": SWEPT}}
VALID_ARGUMENTS = {
    "run": [*GAS, "--output", "out.nc"],
    "movie": [*GAS, "--frames=3", "--length=1", "--output", "out.gif"],
    "trajectory": [*GAS, "--frames=3", "--length=1", "--output", "out.xyz"],
    "show": [f"{POINTS}/seed1.nc"],
    "plot": ["gas.nc", "--output", "out.png"],
    "experiments": ["--config=config.yaml"],
    "theory": ["--r=0.9", "--beta=0"],
    "completion": ["bash"],
    "reduce": [f"{POINTS}/seed1.nc", f"{POINTS}/seed2.nc", "--output", "out.nc"],
}
"""Valid arguments of each command, the positional ones first."""
SKIPPED_COMMANDS = {"crate", "doctor", "init"}
"""Commands without options of their own, or that take minutes or an entire project."""
OUTPUT_OPTIONS = {"output"}
SLOW_COMMANDS = {"movie", "trajectory"}


def write_folder(folder):
    """Fill a folder with a file of each kind, and return it."""
    folder.mkdir()
    write_all(folder)
    (folder / "config.yaml").write_text(json.dumps(CONFIG))
    shutil.rmtree(folder / "points")
    (folder / POINTS).mkdir(parents=True)
    points = [str(folder / POINTS / f"seed{seed}.nc") for seed in (1, 2)]
    for line in (
        ["run", *GAS, "--seed", "1", "2", "--output", *points],
        ["reduce", *points, "--output", str(folder / "gas.nc")],
    ):
        assert outcome(line)[0] == 0, outcome(line)
    return folder


PARSERS = commands()


def options():
    """All (command, option with a value) of the parser."""
    return [
        (name, action)
        for name, parser in PARSERS.items()
        if name not in SKIPPED_COMMANDS
        for action in parser._actions
        if action.nargs != 0
    ]


def line_with(name, action, value):
    """A valid line of a command, with this value of an option."""
    line = list(VALID_ARGUMENTS[name])
    if not action.option_strings:
        positional = [
            argument for argument in PARSERS[name]._actions if not argument.option_strings
        ]
        line[positional.index(action)] = value
        return [name, *line]
    option = action.option_strings[-1]
    for position in [
        position for position, word in enumerate(line) if word.partition("=")[0] == option
    ]:
        del line[position : position + (1 if "=" in line[position] else 2)]
    return [name, *line, f"{option}={value}"]


def contents(folder):
    """Path -> hash of each file below a folder."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def check(folder, monkeypatch, line, expected_words=(), replaced=()):
    """Run a command line in a copy of the folder, and return "done" or "refused".

    A refusal names an expected word; only files in `replaced` may change.
    """
    working_copy = folder.with_name("copy")
    shutil.rmtree(working_copy, ignore_errors=True)
    shutil.copytree(folder, working_copy)
    monkeypatch.chdir(working_copy)
    replaced = {working_copy / name for name in replaced}
    contents_before = {
        path: digest for path, digest in contents(working_copy).items() if path not in replaced
    }
    try:
        status, message = outcome(line)
        contents_after = contents(working_copy)
        assert not status or set(contents_after) - replaced == set(contents_before) - replaced, (
            message
        )
        return checked_outcome(status, message, contents_before, contents_after, expected_words)
    finally:
        monkeypatch.chdir(folder)


def checked_outcome(status, message, contents_before, contents_after, expected_words=()):
    """The outcome of a command, "done" or "refused", from its status, its message and its files.

    Asserts that inputs are unchanged, and that a refusal is a single line.
    """
    assert {path: contents_after.get(path) for path in contents_before} == contents_before, (
        "an input has changed"
    )
    new_files = [path for path in contents_after if path not in contents_before]
    assert not [path for path in new_files if path.suffix == ".tmp" or path.name.startswith(".")], (
        new_files
    )
    if not status:
        assert all(path.stat().st_size for path in new_files), new_files
        return "done"
    lines = [line for line in message.splitlines() if " so far" not in line]
    assert status in (1, 2) and len(lines) == 1 and lines[0].startswith("roughgas: error: "), (
        message
    )
    assert not expected_words or any(name in lines[0] for name in filter(None, expected_words)), (
        message
    )
    return "refused"


def check_option(folder, monkeypatch, name, action, text):
    """Run a command with this value of an option: "done" or "refused"."""
    option = (action.option_strings or [action.dest])[-1].lstrip("-")
    expected_words = [option, option.replace("-", " "), option.rstrip("s"), str(action.metavar)]
    expected_words += [text[:10], Path(text).name, "file"] if text else [".", "file"]
    replaces_output = action.dest in OUTPUT_OPTIONS and text not in VALID_ARGUMENTS[name]
    line = line_with(name, action, text)
    return check(folder, monkeypatch, line, expected_words, [text] if replaces_output else [])


def schedule_keys():
    """All (kind, key) of schedules."""
    return [
        (kind, key)
        for kind, schedule in (("steady", STEADY), ("cooling", COOLING))
        for key in ("kind", *PROTOCOLS[kind].SETTINGS.__struct_fields__)
        if key in schedule
    ]


def check_schedule(folder, monkeypatch, kind, key, value):
    """Run a tiny gas with this value in its schedule: "done" or "refused"."""
    gas = DRIVEN if kind == "steady" else TINY
    settings = gas | {"schedule": gas["schedule"] | {key: value}}
    line = ["run", *GAS[:-1], json.dumps(settings)]
    return check(folder, monkeypatch, [*line, "--output", "out.nc"], (key, "--settings"))


ENVIRONMENTS = {
    "as it is": ({}, "", "."),
    "no HOME": ({"HOME": None, "XDG_CACHE_HOME": None}, "", "."),
    "HOME that cannot be written": ({"HOME": "/proc/none", "XDG_CACHE_HOME": None}, "", "."),
    "plain locale": ({"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0"}, "", "."),
    "dumb terminal": ({"TERM": "dumb", "COLUMNS": "0"}, "", "."),
    "narrow umask": ({}, "umask 077;", "."),
    "no TMPDIR": ({"TMPDIR": "/none"}, "", "."),
    "closed stdin": ({}, "exec <&-;", "."),
    "closed stdout": ({}, "exec >&-;", "."),
    "full stdout": ({}, "exec >/dev/full;", "."),
    "folder that cannot be written": ({}, "", "/proc"),
    "folder that is gone": ({}, "mkdir gone; cd gone; rmdir ../gone;", "."),
    "odd folder": ({}, "", "a b'\"c\nä$(x)"),
    "folder like an option": ({}, "", "-x"),
}
"""(changes of the environment, commands of the shell before, folder of the run), by name."""
COMMANDS = (["run", *GAS], ["show", "INPUT"], ["experiments"], ["theory", "--r=0.9", "--beta=0"])


def check_environment(folder, tmp, name, command):
    """Run a command as a process in a new folder: "done" or "refused"."""
    changes, shell_prefix, subfolder = ENVIRONMENTS[name]
    working_folder = tmp / subfolder
    working_folder.mkdir(parents=True, exist_ok=True)
    line = [word.replace("INPUT", str(folder / VALID_ARGUMENTS["show"][0])) for word in command]
    process = subprocess.run(
        ["sh", "-c", f'{shell_prefix} exec "$@"', "sh", sys.executable, "-m", "roughgas", *line],
        cwd=working_folder,
        env=environment(**changes),
        capture_output=True,
        text=True,
        timeout=TIME_LIMIT,
    )
    return checked_outcome(process.returncode, process.stderr, {}, contents(tmp))


VALUES = [*NUMBERS, 0.25, 1.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, *WORDS[:3], *OTHER_VALUES[:4]]
"""Values of keys of schedules."""


def cases():
    """All cases (kind, arguments of the check)."""
    option_cases = [("option", name, action, text) for name, action in options() for text in TEXTS]
    schedule_cases = [("schedule", *key, value) for key in schedule_keys() for value in VALUES]
    environment_cases = [
        ("environment", name, command) for name in ENVIRONMENTS for command in COMMANDS
    ]
    return [*option_cases, *schedule_cases, *environment_cases]


def attempt(folder, monkeypatch, case):
    """The outcome of a case: "done" or "refused"."""
    kind, *arguments = case
    if kind == "environment":
        with tempfile.TemporaryDirectory() as tmp:
            return check_environment(folder, Path(tmp), *arguments)
    check_setting = check_option if kind == "option" else check_schedule
    return check_setting(folder, monkeypatch, *arguments)
