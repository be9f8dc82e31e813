"""docs/config.md has every key of the schema, with what is legal."""

import pytest
from tests.config import page

TABLES = page.tables()


@pytest.mark.parametrize("name", TABLES)
def test_the_page_is_made_from_the_schema(name):
    """If not: python -m tests.config.page."""
    assert page.written(name) == TABLES[name]


def test_every_key_of_an_experiment_has_a_legal_range_and_a_meaning(paper):
    text = "".join(TABLES.values())
    for key in ("particles", "seeds", "relaxation_times", "EFFECT.PARAMETER"):
        assert f"| `{key}" in text
    rows = [line.split(" | ") for line in text.splitlines() if line.startswith("| `")]
    assert all(len(row) == 3 and row[2].strip(" |") and row[1] for row in rows)
    assert "None" not in text
