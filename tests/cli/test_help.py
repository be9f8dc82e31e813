"""Help, and the page of commands."""

import argparse
import inspect
from importlib import import_module
from pathlib import Path

import pytest

from cli import page
from cli.parsers import commands, examples
from roughgas import cli
from roughgas.cli import main

COMMANDS = commands()
ROOT = Path(__file__).parents[2]


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
