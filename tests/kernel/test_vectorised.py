"""The machine code of the two loops over particles computes with several of them at once."""

import pytest
from benchmarks.vectorised import decisions, packed_instructions, scenes, sweep


@pytest.mark.parametrize(
    ("loop", "needed"), [(sweep, {"mulps", "subps"}), (decisions, {"mulpd", "divpd"})]
)
def test_instructions_are_packed(loop, needed):
    """Under shear, where an image has most to it."""
    (scene, state) = next(rest for title, *rest in scenes() if title == "sheared")
    found = packed_instructions(loop, scene, state)
    assert needed <= {name for name, _ in found}
