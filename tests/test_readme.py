"""README.md is true: it is short, and what it says to type does what it says, in a fresh clone."""

import json
import os
import re
import shlex
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path
from urllib.request import urlopen

import pytest

from roughgas import config
from roughgas.cli import parser_of
from roughgas.config.reading import parse_yaml, read_yaml

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
CLONE = "git clone ADDRESS roughgas"
MADE = (
    *("cooling_r0.9_beta0.5_seed1.nc", "bed.mp4", "figures/small/mine.png"),
    *(f"results/small/{page}.html" for page in ("report", "explore", "living")),
)

JUPYTER = ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "IPYTHONDIR")
SERVER = """
c.ServerApp.allow_root, c.ServerApp.open_browser, c.ServerApp.port = True, False, {port}
c.IdentityProvider.token = ""
"""


def blocks(language):
    """The text of each fenced block of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.M | re.S)


def commands():
    """What is typed, without remarks, line by line."""
    lines = [line for block in blocks("console") for line in block.splitlines()]
    return [re.sub(r"\s{2,}# .*", "", line[2:]) for line in lines if line.startswith("$ ")]


def answers():
    """What is printed, line by line."""
    lines = [line for block in blocks("console") for line in block.splitlines()]
    return [line for line in lines if not line.startswith("$ ") and line != "..."]


def test_its_links_lead_to_files():
    linked = re.findall(r"\]\(([^)#\s]+)", README)
    assert len(linked) > 20 and not [path for path in linked if not (ROOT / path).exists()]


def test_its_commands_are_commands():
    told = [shlex.split(line) for line in commands()]
    asked = [line[1:] for line in told if line[0] == "roughgas"]
    assert len(asked) == 3
    for arguments in asked:
        parser_of(arguments[0]).parse_args(arguments)
    targets = re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(), re.M)
    assert {line[-1] for line in told if line[0] == "make"} <= set(targets)


def test_its_snippet_is_a_study(tmp_path, monkeypatch):
    (snippet,) = blocks("yaml")
    shutil.copy(ROOT / "config.yaml", tmp_path)
    (tmp_path / "studies" / "mine").mkdir(parents=True)
    (tmp_path / "studies" / "mine" / "config.yaml").write_text(snippet)
    monkeypatch.chdir(tmp_path)
    found = config.load("config.yaml")
    assert found["broken"] == {} and "mine.hollow" in found["experiments"]


def test_its_three_lines_change_a_study():
    text = (ROOT / "studies" / "friction" / "config.yaml").read_text()
    (line,) = (line for line in commands() if line.startswith("sed"))
    done = subprocess.run(
        ["sed", shlex.split(line)[2]], input=text, capture_output=True, text=True, check=True
    )
    old, new = text.splitlines(), done.stdout.splitlines()
    assert sum(one != other for one, other in zip(old, new, strict=True)) >= 3
    assert read_yaml(ROOT / "studies" / "friction" / "config.yaml") != parse_yaml(done.stdout, "")


@pytest.fixture(scope="module")
def typed(tmp_path_factory):
    """All that is printed where every command is typed, in its order, and the clone."""
    folder = tmp_path_factory.mktemp("typed")
    first, *rest = commands()
    assert first.startswith(CLONE)
    script = [first.replace("ADDRESS", shlex.quote(str(ROOT)), 1), *rest]
    command, around = ["bash", "-e", "-c", "\n".join(script)], environment(folder)
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=around)
    said = ran.stdout + ran.stderr
    assert ran.returncode == 0, said[-3000:]
    return [line.rstrip() for line in said.splitlines()], folder / "roughgas"


@pytest.mark.slow
def test_all_of_it_typed_in_a_fresh_clone(typed):
    """It prints what is said, and git sees no file that was not there."""
    lines, clone = typed
    assert not [line for line in answers() if line.rstrip() not in lines]
    assert any(re.fullmatch(r"  50 of \d+ packages", line) for line in lines)
    assert all((clone / path).stat().st_size > 1000 for path in MADE)
    status = subprocess.run(
        ["git", "status", "--porcelain"], cwd=clone, capture_output=True, text=True, check=True
    )
    assert status.stdout.split() == ["??", "studies/mine/"]


@pytest.mark.slow
def test_make_notebook_serves_the_tutorial(typed, tmp_path):
    """It installs Jupyter by itself; a browser is not opened here."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    (tmp_path / "jupyter_server_config.py").write_text(SERVER.format(port=port))
    around = environment(tmp_path) | dict.fromkeys(JUPYTER, str(tmp_path))
    serving = subprocess.Popen(["make", "notebook"], cwd=typed[1], env=around, process_group=0)
    address = f"http://127.0.0.1:{port}/api/contents/tutorial.ipynb?content=0"
    try:
        while not (found := asked(address)):
            assert serving.poll() is None
            time.sleep(0.5)
    finally:
        os.killpg(serving.pid, signal.SIGTERM)
        serving.wait()
    assert found["type"] == "notebook" and found["size"] > 5000


def asked(address):
    """What a server answers; None as long as there is none."""
    try:
        with urlopen(address, timeout=10) as answer:
            return json.load(answer)
    except OSError:
        return None


def environment(folder):
    """That of somebody who has never used the program: no caches, no paths of this process."""
    own = ("PYTHONPATH", "VIRTUAL_ENV", "ROUGHGAS_CACHE_DIR")
    kept = {key: value for key, value in os.environ.items() if key not in own}
    return kept | {"XDG_CACHE_HOME": str(folder / "cache")}
