"""Lines of progress where no terminal shows a bar."""

import io

import pytest

from roughgas.simulation import progress
from roughgas.simulation.progress import ProgressBar


@pytest.mark.parametrize("share", [None, 1.01])
def test_work_beyond_its_estimate_is_shown_as_complete(monkeypatch, share):
    """Neither "770 of 767" nor a negative time left."""
    monkeypatch.setattr(progress, "FIRST_LINE_AFTER", -1.0)
    stream = io.StringIO()
    with ProgressBar("cooling", 767, "T", stream) as bar:
        bar.reach(770, share=share)
    line = stream.getvalue()
    assert "100 %, 767 of 767 T" in line and "about 0 s left" in line
