"""Lines on how far work is, where no terminal shows a bar."""

import io

import pytest

from roughgas.simulation import progress
from roughgas.simulation.progress import Bar


@pytest.mark.parametrize("share", [None, 1.01])
def test_work_that_exceeds_its_estimate_is_shown_as_all_of_it(monkeypatch, share):
    """Neither "770 of 767" nor a negative time that is left."""
    monkeypatch.setattr(progress, "PATIENCE", -1.0)
    stream = io.StringIO()
    with Bar("cooling", 767, "T", stream) as bar:
        bar.reach(770, share=share)
    line = stream.getvalue()
    assert "100 %, 767 of 767 T" in line and "about 0 s left" in line
