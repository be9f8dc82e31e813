"""Help, and the page of commands."""

import argparse
import inspect
import re
import shutil
from importlib import import_module
from pathlib import Path

import pytest

from cli import page
from cli.parsers import commands, examples
from roughgas import cli
from roughgas.cli import main

COMMANDS = commands()
ROOT = Path(__file__).parents[2]
REALLY_RUN = {  # what each prints; besides those that docs/command_line.md and other tests run
    "run vibrated --r 0.87 --beta 0.5 --seed 1 2 3 --scale small --json": (
        r'"seed": 1, .*"R": 0\.360.*\n.*"seed": 2, .*"R": 0\.363.*\n.*"seed": 3, .*"R": 0\.361'
    ),
    "theory --r 0.9 --beta -1:1:0.1 --dimension 2": r"\n2  0\.9 +0 +0\.2 +0\.31951 (.*\n){11}\n",
    "theory --r 0.8 0.9 0.99 --beta 0 --inertia 0.1 --json": r'"R_driven": 0\.0769230',
    "theory --r 0.9 --beta 0.5 --mu 0.3": r"\nR, cooling +0\.37269 +0\.40344 ",
    "theory --r 0.9 --beta -0.9:0.9:0.1 --spin-share 0.2 --csv": r"\n2,0\.9,-0\.9,0\.4674285714,",
}


def test_every_command_is_built_alone_as_with_all(capsys):
    assert list(COMMANDS) and set(COMMANDS) == {*cli.COMMANDS}
    for name, parser in COMMANDS.items():
        with pytest.raises(SystemExit):
            main([name, "--help"])
        assert capsys.readouterr().out == parser.format_help()


@pytest.mark.parametrize("name", COMMANDS)
def test_help_explains_the_command_and_its_examples_parse(name):
    parser = COMMANDS[name]
    assert parser.description.endswith(".") and len(parser.description) > 30
    assert all(one.help for one in parser._actions if one.help is not argparse.SUPPRESS)
    found = examples(parser)
    assert found
    for arguments in found:
        options = cli.parser_of(name).parse_args(arguments)
        assert arguments[0] == name and options.command.summary in cli.parser_of().epilog


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_calls_a_function_of_its_options(name):
    module, _, function = cli.COMMANDS[name].calls.partition(":")
    inspect.signature(getattr(import_module(f"roughgas.{module}"), function)).bind("options")


@pytest.fixture
def folder(tmp_path):
    """A folder with a configuration, as a person has it."""
    shutil.copy(ROOT / "config.yaml", tmp_path)
    return tmp_path


@pytest.mark.parametrize("line", REALLY_RUN)
def test_examples_run(folder, monkeypatch, capsys, line):
    monkeypatch.chdir(folder)
    assert line.split() in examples(COMMANDS[line.split()[0]])
    assert main(line.split()) == 0
    said = capsys.readouterr().out
    assert re.search(REALLY_RUN[line], said)


BLOCKS = page.blocks()


@pytest.fixture(scope="module")
def in_folder():
    """Where all blocks are run: later ones show what earlier ones have made."""
    with page.folder() as path:
        yield path


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[0])
def test_a_block_is_what_its_commands_print(in_folder, block):
    found = page.written(block, page.in_this_process)
    assert page.without_machine(found) == page.without_machine(block), (
        "write it anew: python tests/cli/page.py"
    )
