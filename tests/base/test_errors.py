"""A wrong name is answered with the legal ones, and with a guess where there is a good one."""

import pytest

from roughgas.base import not_one_of


@pytest.mark.parametrize(
    ("name", "guess"),
    [("'coolng'", "cooling"), ("'schedul'", "schedule"), ("fig9", None), (7, None)],
)
def test_a_guess_is_made_where_a_name_is_close(name, guess):
    text = str(not_one_of("key", name, ["cooling", "schedule", "fig8"]))
    assert text.startswith(f"key = {name}: must be one of cooling, schedule, fig8")
    assert text.endswith(f"; did you mean {guess}?" if guess else "fig8")
