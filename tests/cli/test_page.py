"""docs/command_line.md: its commands print what it says."""

import pytest

from cli import page

BLOCKS = page.blocks()


@pytest.fixture(scope="module")
def folder():
    """Where all blocks are run: later ones show what earlier ones have made."""
    with page.folder() as path:
        yield path


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.splitlines()[0])
def test_a_block_is_what_its_commands_print(folder, block):
    found = page.written(block, page.in_this_process)
    assert page.without_machine(found) == page.without_machine(block), (
        "write it anew: python tests/cli/page.py"
    )
