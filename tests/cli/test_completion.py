"""Completion in a shell, by the shell itself."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from roughgas.cli import main

ROOT = Path(__file__).parents[2]
ASK = """
eval "$2"
COMP_LINE=$1 COMP_POINT=${#1} COMP_TYPE=9
read -ra COMP_WORDS <<< "$1"
_python_argcomplete roughgas
printf '%s\\n' "${COMPREPLY[@]}"
"""


def lines_for(shell, capsys):
    """What `roughgas completion` prints for a shell."""
    assert main(["completion", shell]) == 0
    return capsys.readouterr().out


def completed(line, script):
    """What bash would go on with after `line`, in the folder of the configuration."""
    place = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-c", ASK, "bash", line, script],
        cwd=ROOT,
        env=os.environ | {"PATH": place},
        capture_output=True,
        text=True,
        check=True,
    )
    return {word.strip() for word in done.stdout.splitlines()} - {""}


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("roughgas comp", {"compile", "completion"}),
        ("roughgas theory --dim", {"--dimension"}),
        ("roughgas theory --dimension ", {"2", "3"}),
        ("roughgas run cooling_s", {"cooling_spheres", "cooling_sizes"}),
        ("roughgas run vibrated_friction/mu0.0", {f"vibrated_friction/mu0.0{k}" for k in "13"}),
        ("roughgas plan sheared vibrated_i", {"vibrated_inertia"}),
        ("roughgas bench cooling --scale ", {"paper", "coarse", "fine", "small"}),
        ("roughgas run cooling --config config.", {"config.yaml"}),
        ("roughgas show READ", {"README.md"}),
        ("roughgas run cooling --config no.yaml --scale ", set()),
        ("roughgas completion ", {"-h", "--help", "bash", "zsh", "fish"}),
    ],
)
def test_what_is_offered(line, offered, capsys):
    assert completed(line, lines_for("bash", capsys)) == offered


@pytest.mark.parametrize(("name", "word"), [("zsh", "compdef"), ("fish", "complete --command")])
def test_the_other_shells_take_their_lines(name, word, tmp_path, capsys):
    script = lines_for(name, capsys)
    assert word in script and "roughgas" in script
    (tmp_path / "script").write_text(script)
    if shutil.which(name):
        subprocess.run([name, "-n", tmp_path / "script"], check=True)
