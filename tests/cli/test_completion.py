"""Completion in a shell, by the shell itself."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from roughgas.cli import main

ROOT = Path(__file__).parents[2]
BED = "friction.vibrated_friction"
ASK = """
eval "$2"
COMP_LINE=$1 COMP_POINT=${#1} COMP_TYPE=9
read -ra COMP_WORDS <<< "$1"
_python_argcomplete roughgas
printf '%s\\n' "${COMPREPLY[@]}"
"""


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
    return {re.split("[:\t]", one)[0].strip() for one in done.stdout.splitlines()} - {""}


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("roughgas comp", {"completion"}),
        ("roughgas run spheres.c", {"spheres.cooling_spheres"}),
        (f"roughgas run {BED}/mu0.0", {f"{BED}/mu0.0{k}" for k in "13"}),
        ("roughgas movie cooling --scale ", {"paper", "quick", "small"}),
        ("roughgas run cooling --config no.yaml --scale ", set()),
    ],
)
def test_what_is_offered(line, offered, capsys):
    assert main(["completion", "bash"]) == 0
    assert completed(line, capsys.readouterr().out) == offered


def test_names_are_read_unchecked_which_is_fast(tmp_path, monkeypatch):
    """Nor do a mistake, and a study that cannot be read, keep other names from being offered."""
    (tmp_path / "config.yaml").write_text("experiments: {mine: {particles: -1}}")
    for name, text in (("sound", "experiments: {one: {}}"), ("broken", "experiments: [")):
        (tmp_path / "studies" / name).mkdir(parents=True)
        (tmp_path / "studies" / name / "config.yaml").write_text(text)
    monkeypatch.chdir(tmp_path)
    code = (
        "import sys, argparse\nfrom roughgas.cli import parser\n"
        "print(parser._experiments('', argparse.Namespace(config=None, scale=None)))\n"
        "sys.exit('jsonschema' in sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE).stdout
    assert said.decode().strip() == "['mine', 'sound.one']"
