"""Parsers made from the signatures of functions."""

from collections.abc import Sequence
from typing import Annotated, Literal

import pytest

from roughgas.cli.parser import Command, Option, Parser, add_arguments


def weigh(
    inputs: list[str],
    unit: Annotated[Literal["m", "kg"], Option("of mass", "UNIT")] = "m",
    *,
    output: str,
    spin_share: str | None = None,
    changes: Annotated[Sequence[str], Option("what differs", "KEY=VALUE", "--set")] = (),
    json: bool = False,
    csv: bool = False,
) -> None:
    """Weigh particles ..."""


def parser_of(function, exclusive=()):
    parser = Parser(prog="roughgas")
    add_arguments(parser, function, exclusive)
    return parser


@pytest.mark.parametrize(
    ("line", "changed"),
    [
        ("a b -o c", {"inputs": ["a", "b"], "output": "c"}),
        ("a -o c --spin-share -1", {"spin_share": "-1"}),
        ("a -o c --set x=1 y=2 --set z=3", {"changes": ["x=1", "y=2", "z=3"]}),
        ("a --json --output=c", {"json": True}),
    ],
)
def test_options_become_arguments_of_the_function(line, changed):
    function, arguments = parser_of(weigh).call_of(line.split())
    defaults = {"inputs": ["a"], "unit": "m", "output": "c", "spin_share": None, "changes": ()}
    assert function is weigh
    assert arguments == defaults | {"json": False, "csv": False} | changed


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("-o c", "the following arguments are required: inputs"),
        ("a", "the following arguments are required: -o/--output"),
        ("a -o c -o d", "argument -o/--output: given twice, the second time as d"),
        ("a -o c --json --csv", "argument --csv: not allowed with argument --json"),
        ("a -o c --changes x=1", "option = '--changes': must be one of"),
    ],
)
def test_illegal_command_lines_are_refused(line, message, capsys):
    with pytest.raises(SystemExit):
        parser_of(weigh, exclusive=("json", "csv")).call_of(line.split())
    assert f"roughgas: error: {message}" in capsys.readouterr().err


def test_help_comes_from_annotations_and_docstrings():
    text = parser_of(weigh).format_help()
    assert "UNIT                  of mass (default: m)" in text
    assert "--set KEY=VALUE [KEY=VALUE ...]" in text
    assert Command(weigh, ()).summary == "weigh particles ..."
    assert Command(test_illegal_command_lines_are_refused, ()).summary == ""
