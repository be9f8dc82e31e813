"""Each option of each command, each key of a schedule and each environment at its edges.

Whatever is given, a command ends with what it was to make, or with one line that names the key or
the value; inputs stay as they were, and nothing is left half-written.
"""

import hashlib
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from habits.conftest import environment
from schedules import COOLING, STEADY, TINY
from tests.cli.parsers import commands
from tests.files import write_all
from tests.fuzz import test_configurations
from tests.fuzz.spoiling import NUMBERS, OTHERS, WORDS
from tests.fuzz.test_commands import outcome

from roughgas.config.schema import keys

LIMIT = 60
"""Seconds that a process may take."""
LONG = "x" * 5000
POINTS = "points/gas/r0.9/beta0"
TEXTS = ["", "0", "0.5", "1", "2", "-1", "1e300", "nan", "inf", LONG, "a b'\"äü.nc", "-x.nc"]
TEXTS += ["/dev/null", "points", "/proc/none", "out.nc", "gas.nc", f"{POINTS}/seed1.nc"]
TEXTS += ["0.9", "3", "5", "10", "gas", "config.yaml", "new.nc"]
GAS = ["gas", "--r=0.9", "--beta=0", "--settings", json.dumps(TINY)]
DRIVEN = TINY | {
    "effects": test_configurations.WHOLE["experiments"]["sheared"]["effects"],
    "schedule": STEADY | {"equilibrate": 1, "measure": 4},
}
SWEPT = TINY | {"sweep": {"r": ["0.9"], "beta": ["0"], "seeds": 2}}
CONFIG = test_configurations.WHOLE
CONFIG = CONFIG | {"experiments": CONFIG["experiments"] | {"gas": SWEPT}}
RIGHT = {
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
"""For each command what it takes: the positional arguments first."""
LEFT_OUT = {"doctor", "crate"}
"""These have no options with values of their own, or take minutes or a whole project."""
OUTPUTS = {"output"}
SLOW = {"movie", "trajectory"}


def write_folder(folder):
    """A folder with a file of each kind."""
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
    """Each (command, option with a value) of the parser."""
    return [
        (name, action)
        for name, parser in PARSERS.items()
        if name not in LEFT_OUT
        for action in parser._actions
        if action.nargs != 0
    ]


def line_with(name, action, text):
    """The line that is right for a command, but for the value of one option."""
    line = list(RIGHT[name])
    if not action.option_strings:
        positional = [one for one in PARSERS[name]._actions if not one.option_strings]
        line[positional.index(action)] = text
        return [name, *line]
    option = action.option_strings[-1]
    for k in [k for k, word in enumerate(line) if word.partition("=")[0] == option]:
        del line[k : k + (1 if "=" in line[k] else 2)]
    return [name, *line, f"{option}={text}"]


def contents(folder):
    """The hash of each file below a folder."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


def check(folder, monkeypatch, line, names=(), replaced=()):
    """Run a command line in a copy of the folder: "done" or "refused". A refusal says one of
    `names`; no file but `replaced` changes."""
    copy = folder.with_name("copy")
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(folder, copy)
    monkeypatch.chdir(copy)
    replaced = {copy / name for name in replaced}
    before = {path: digest for path, digest in contents(copy).items() if path not in replaced}
    try:
        status, said = outcome(line)
        after = contents(copy)
        assert not status or set(after) - replaced == set(before) - replaced, said
        return judged(status, said, before, after, names)
    finally:
        monkeypatch.chdir(folder)


def judged(status, said, before, after, names=()):
    """What came of a command, which has said this and found and left these files."""
    assert {path: after.get(path) for path in before} == before, "an input has changed"
    new = [path for path in after if path not in before]
    assert not [path for path in new if path.suffix == ".tmp" or path.name.startswith(".")], new
    if not status:
        assert all(path.stat().st_size for path in new), new
        return "done"
    lines = [one for one in said.splitlines() if " so far" not in one]
    assert status in (1, 2) and len(lines) == 1 and lines[0].startswith("roughgas: error: "), said
    assert not names or any(name in lines[0] for name in filter(None, names)), said
    return "refused"


def check_option(folder, monkeypatch, name, action, text):
    """Give an option this value."""
    option = (action.option_strings or [action.dest])[-1].lstrip("-")
    names = [option, option.replace("-", " "), option.rstrip("s"), str(action.metavar)]
    names += [text[:10], Path(text).name, "file"] if text else [".", "file"]
    is_new = action.dest in OUTPUTS and text not in RIGHT[name]
    line = line_with(name, action, text)
    return check(folder, monkeypatch, line, names, [text] if is_new else [])


def schedule_keys():
    """Each (kind, key) of a schedule."""
    return [
        (kind, key)
        for kind, right in (("steady", STEADY), ("cooling", COOLING))
        for key in keys("schedule")
        if key in right
    ]


def check_schedule(folder, monkeypatch, kind, key, value):
    """Run a tiny gas whose schedule has this value."""
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
"""Changes of the environment, what a shell does first, and the folder that a command is run in."""
COMMANDS = (["run", *GAS], ["show", "INPUT"], ["experiments"], ["theory", "--r=0.9", "--beta=0"])


def check_environment(folder, tmp, name, command):
    """Run a command as a process in a new folder: "done" or "refused"."""
    changes, first, place = ENVIRONMENTS[name]
    place = tmp / place
    place.mkdir(parents=True, exist_ok=True)
    line = [word.replace("INPUT", str(folder / RIGHT["show"][0])) for word in command]
    done = subprocess.run(
        ["sh", "-c", f'{first} exec "$@"', "sh", sys.executable, "-m", "roughgas", *line],
        cwd=place,
        env=environment(**changes),
        capture_output=True,
        text=True,
        timeout=LIMIT,
    )
    return judged(done.returncode, done.stderr, {}, contents(tmp))


VALUES = [*NUMBERS, 0.25, 1.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, *WORDS[:3], *OTHERS[:4]]
"""Of keys of schedules."""


def cases():
    """All cases: a kind, and what it is about."""
    options_ = [("option", name, action, text) for name, action in options() for text in TEXTS]
    schedules = [("schedule", *key, value) for key in schedule_keys() for value in VALUES]
    around = [("environment", name, command) for name in ENVIRONMENTS for command in COMMANDS]
    return [*options_, *schedules, *around]


def attempt(folder, monkeypatch, case):
    """What came of a case."""
    kind, *about = case
    if kind == "environment":
        with tempfile.TemporaryDirectory() as tmp:
            return check_environment(folder, Path(tmp), *about)
    one = check_option if kind == "option" else check_schedule
    return one(folder, monkeypatch, *about)
