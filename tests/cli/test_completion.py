"""Completion in a shell, by the shell itself."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from roughgas.cli import main
from roughgas.cli.commands import COMMANDS

ROOT = Path(__file__).parents[2]
BED = "friction.vibrated_friction"
ASK = {  # each prints what the shell would offer, a word and perhaps its description a line
    "bash": """
eval "$2"
COMP_LINE=$1 COMP_POINT=${#1} COMP_TYPE=9
read -ra COMP_WORDS <<< "$1"
_python_argcomplete roughgas
printf '%s\\n' "${COMPREPLY[@]}"
""",
    "zsh": """
compdef() { :; }
_describe() { print -rl -- "${(@P)2}" }
eval "$2"
BUFFER=$1 CURSOR=${#1} words=(${(z)1})
_python_argcomplete
""",
    "fish": """
string join \\n $argv[2] | source
complete -C $argv[1]
""",
}
NAMED = {"bash": ["bash"], "zsh": ["zsh"], "fish": []}  # the first argument of a script, its name


def lines_for(shell, capsys):
    """What `roughgas completion` prints for a shell."""
    assert main(["completion", shell]) == 0
    return capsys.readouterr().out


def completed(line, script, shell="bash"):
    """What a shell would go on with after `line`, in the folder of the configuration."""
    place = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        [shell, "-c", ASK[shell], *NAMED[shell], line, script],
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
        ("roughgas theory --dim", {"--dimension"}),
        ("roughgas run spheres.c", {"spheres.cooling_spheres"}),
        (f"roughgas run {BED}/mu0.0", {f"{BED}/mu0.0{k}" for k in "13"}),
        ("roughgas run inertia.v", {"inertia.vibrated_inertia"}),
        ("roughgas movie cooling --scale ", {"paper", "small"}),
        ("roughgas run cooling --config config.", {"config.yaml"}),
        ("roughgas show READ", {"README.md"}),
        ("roughgas run cooling --config no.yaml --scale ", set()),
        ("roughgas completion ", {"-h", "--help", "bash", "zsh", "fish"}),
    ],
)
def test_what_is_offered(line, offered, capsys):
    assert completed(line, lines_for("bash", capsys)) == offered


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


def test_zsh_describes_each_command_by_its_summary(tmp_path):
    line, offered = "roughgas ", tmp_path / "offered"
    about = {"_ARGCOMPLETE": "1", "_ARGCOMPLETE_SHELL": "zsh", "_ARGCOMPLETE_IFS": "\n"}
    about |= {"_ARGCOMPLETE_STDOUT_FILENAME": str(offered)}
    about |= {"COMP_LINE": line, "COMP_POINT": str(len(line)), "COMP_TYPE": "9"}
    subprocess.run([sys.executable, "-m", "roughgas"], env=os.environ | about, timeout=60)
    described = dict(one.split(":", 1) for one in offered.read_text().splitlines())
    assert described["run"] == COMMANDS["run"].summary
    assert set(described) > set(COMMANDS) and "None" not in described.values()
