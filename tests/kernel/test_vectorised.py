"""The machine code of the two loops over particles computes with several of them at once."""

import pytest
from benchmarks.vectorised import decisions, packed_instructions, scenes, sweep

SCENES = {title: (scene, state) for title, scene, state in scenes()}


@pytest.mark.parametrize("title", SCENES)
@pytest.mark.parametrize(
    ("loop", "needed"), [(sweep, {"mulps", "subps"}), (decisions, {"mulpd", "divpd"})]
)
def test_instructions_are_packed(loop, needed, title):
    found = packed_instructions(loop, *SCENES[title])
    assert needed <= {name for name, _ in found}
