"""Help of all commands, and the outputs in docs/command_line.md."""

import argparse
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

from cli import page
from cli.parsers import commands, examples
from roughgas import cli
from roughgas.cli import main

COMMANDS = commands()
ROOT = Path(__file__).parents[2]


def test_a_parser_alone_has_the_same_help(capsys):
    assert list(COMMANDS) and set(COMMANDS) == {*cli.COMMANDS}
    for name, parser in COMMANDS.items():
        with pytest.raises(SystemExit):
            main([name, "--help"])
        assert capsys.readouterr().out == parser.format_help()


@pytest.mark.parametrize("name", COMMANDS)
def test_help_explains_the_command_and_its_examples_parse(name):
    parser = COMMANDS[name]
    assert parser.description.endswith(".") and len(parser.description) > 30
    assert all(action.help for action in parser._actions if action.help is not argparse.SUPPRESS)
    command_lines = examples(parser)
    assert command_lines
    for arguments in command_lines:
        function, options = cli.parser_of(name).call_of(arguments)
        assert arguments[0] == name == function.__name__
        inspect.signature(function).bind(**options)
    assert cli.COMMANDS[name].summary in cli.parser_of().epilog


def test_help_imports_no_slow_library():
    """The libraries of simulations and figures take a second to import."""
    code = "import sys\nfrom roughgas import cli\n"
    code += "cli.parser_of().format_help()\nprint(*sys.modules)"
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    loaded = set(process.stdout.split())
    assert loaded.isdisjoint({"numpy", "numba", "netCDF4", "matplotlib", "yaml", "jsonschema"})


BLOCKS = page.blocks()


@pytest.fixture(scope="module")
def in_folder():
    """The folder of all blocks: later blocks use files of earlier ones."""
    with page.folder() as path:
        yield path


@pytest.mark.slow
@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[0])
def test_outputs_on_the_page_are_current(in_folder, block):
    rewritten = page.with_outputs(block, page.in_this_process)
    assert page.comparable_lines(rewritten) == page.comparable_lines(block), (
        "write it anew: python tests/cli/page.py"
    )
