"""Completions, as bash offers them."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from roughgas.cli import main

ROOT = Path(__file__).parents[2]
BED = "friction.vibrated_friction"
COMPLETE = """
eval "$2"
COMP_LINE=$1 COMP_POINT=${#1} COMP_TYPE=9
read -ra COMP_WORDS <<< "$1"
_python_argcomplete roughgas
printf '%s\\n' "${COMPREPLY[@]}"
"""


def completions(line, script):
    """Return the completions that bash offers after `line`, in the folder of the configuration."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    process = subprocess.run(
        ["bash", "-c", COMPLETE, "bash", line, script],
        cwd=ROOT,
        env=os.environ | {"PATH": path},
        capture_output=True,
        text=True,
        check=True,
    )
    return {re.split("[:\t]", entry)[0].strip() for entry in process.stdout.splitlines()} - {""}


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("roughgas comp", {"completion"}),
        ("roughgas run spheres.c", {"spheres.cooling_spheres"}),
        (f"roughgas run {BED}/mu0.0", {f"{BED}/mu0.0{k}" for k in "13"}),
        ("roughgas experiments spheres.c", {"spheres.cooling_spheres"}),
        ("roughgas movie cooling --scale ", {"paper", "lean", "quick", "long", "small"}),
        ("roughgas run cooling --config no.yaml --scale ", set()),
    ],
)
def test_the_shell_offers_matching_names(line, expected, capsys):
    assert main(["completion", "bash"]) == 0
    assert completions(line, capsys.readouterr().out) == expected


def test_names_are_read_unchecked(tmp_path, monkeypatch):
    """This is fast, and mistakes in settings or in a study do not hide the other names."""
    (tmp_path / "config.yaml").write_text("experiments: {mine: {particles: -1}}")
    for name, text in (("sound", "experiments: {one: {}}"), ("broken", "experiments: [")):
        (tmp_path / "studies" / name).mkdir(parents=True)
        (tmp_path / "studies" / name / "config.yaml").write_text(text)
    monkeypatch.chdir(tmp_path)
    code = (
        "import sys, argparse\nfrom roughgas.cli import completers\n"
        "print(completers.experiments('', argparse.Namespace(config=None, scale=None)))\n"
        "sys.exit('jsonschema' in sys.modules)"
    )
    output = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE).stdout
    assert output.decode().strip() == "['mine', 'sound.one']"
